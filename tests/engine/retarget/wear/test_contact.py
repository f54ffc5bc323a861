# SPDX-License-Identifier: GPL-3.0-or-later
"""Clearance of points above a surface."""

import numpy as np
import pytest
from scipy.spatial import cKDTree

from engine import TriangleMesh
from engine.retarget.wear.contact import Surface, surface_samples
from tests.shapes import cylinder, icosphere, irregular


@pytest.mark.parametrize("walking", [False, True])
@pytest.mark.parametrize("shape", [irregular(*icosphere(5), rounds=1), cylinder(16, 12, 0.5, 2.0)])
def test_a_moved_surface_is_the_one_that_is_made_there(shape, walking):
    mesh, random = TriangleMesh(*shape), np.random.default_rng(0)
    there = TriangleMesh(mesh.vertices * [1, 1.3, 0.8] + 0.1 * np.sin(3 * mesh.vertices[:, ::-1]), mesh.triangles)
    points = random.normal(size=(200, 3))
    starts = random.integers(0, mesh.vertex_count, 200) if walking else None
    before = Surface(mesh)
    before.clearance(points, starts)
    moved, made = (
        before.moved(there.vertices).clearance(points, starts),
        Surface(there).clearance(points, starts),
    )
    for name in ("distances", "feet", "normals", "vertices", "known"):
        np.testing.assert_array_equal(getattr(moved, name), getattr(made, name))


def test_inside_is_negative_and_what_is_nearest_to_a_rim_is_not_known():
    sphere = Surface(TriangleMesh(*icosphere(8)))
    directions = np.random.default_rng(1).normal(size=(50, 3))
    directions /= np.linalg.norm(directions, axis=1, keepdims=True)
    np.testing.assert_allclose(sphere.clearance(1.5 * directions).distances, 0.5, atol=0.02)
    np.testing.assert_allclose(sphere.clearance(0.5 * directions).distances, -0.5, atol=0.02)
    vertices, triangles = icosphere(8)
    bowl = Surface(TriangleMesh(vertices, triangles[(vertices[triangles][:, :, 2] < 0.3).all(axis=1)]))
    found = bowl.clearance(np.array([[0, 0, 3.0], [0, 0, -3.0]]))
    assert found.known.tolist() == [False, True]


@pytest.mark.parametrize("walking", [False, True])
def test_a_surface_that_is_cut_open_at_every_edge_is_searched_as_a_whole(walking):
    whole, random = TriangleMesh(*irregular(*cylinder(16, 12, 0.5, 2.0), rounds=1)), np.random.default_rng(0)
    corners = whole.triangles.ravel()
    opened = Surface(TriangleMesh(whole.vertices[corners], np.arange(len(corners)).reshape(-1, 3)))
    points, starts = random.normal((0, 0, 1), size=(200, 3)), random.integers(0, len(corners), 200)
    found = opened.clearance(points, starts if walking else None)
    wanted = Surface(whole).clearance(points, corners[starts] if walking else None)
    for name in ("distances", "feet", "normals", "known"):
        np.testing.assert_allclose(getattr(found, name), getattr(wanted, name), atol=1e-12)
    np.testing.assert_array_equal(corners[found.vertices], wanted.vertices)
    np.testing.assert_array_equal(opened.rim, Surface(whole).rim[corners])
    there = opened.moved(2.0 * opened.mesh.vertices)
    np.testing.assert_allclose(there.clearance(2.0 * points).distances, 2.0 * opened.clearance(points).distances)


@pytest.mark.parametrize("spacing", [0.08, 0.15, 0.4, 10.0])
def test_samples_are_as_near_to_each_other_as_is_asked_for_and_lie_in_their_triangles(spacing):
    mesh = TriangleMesh(*irregular(*icosphere(3), rounds=1))
    shares, owners = surface_samples(mesh, spacing)
    points = shares @ mesh.vertices
    np.testing.assert_allclose(shares.sum(axis=1), 1)
    np.testing.assert_array_equal(points[: mesh.vertex_count], mesh.vertices)
    assert set(owners.tolist()) == set(range(mesh.triangle_count))
    for row, owner in zip(shares[[*range(mesh.vertex_count, len(points))]].toarray(), owners, strict=True):
        assert set(np.flatnonzero(row)) <= set(mesh.triangles[owner].tolist())
    some = np.random.default_rng(0).dirichlet(np.ones(3), 40)
    everywhere = (some @ mesh.vertices[mesh.triangles]).reshape(-1, 3)
    longest = mesh.edge_lengths.max()
    # At most six parts a side; in the middle of a triangle of samples their distance by the root of three.
    assert cKDTree(points).query(everywhere)[0].max() < max(spacing, longest / 6) / np.sqrt(3) + 0.01 * longest


def test_few_points_see_the_same_normals_as_many():
    mesh, random = TriangleMesh(*irregular(*icosphere(8), rounds=1)), np.random.default_rng(3)
    points = random.normal(size=(400, 3))
    many, few = Surface(mesh).clearance(points), [Surface(mesh).clearance(points[[each]]) for each in range(30)]
    np.testing.assert_allclose([found.normals[0] for found in few], many.normals[:30])
    np.testing.assert_allclose([found.distances[0] for found in few], many.distances[:30])


def test_normals_of_vertices_do_not_depend_on_how_faces_are_cut():
    """A cube, whose corners have two triangles of some sides and one of others."""
    vertices = np.array(list(np.ndindex(2, 2, 2)), float)
    sides = np.array([[0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3]])
    triangles = np.concatenate([sides[:, :3], sides[:, [0, 2, 3]]])
    np.testing.assert_allclose(Surface(TriangleMesh(vertices, triangles)).normals, (2 * vertices - 1) / np.sqrt(3))


def test_above_the_middle_of_a_single_triangle_it_is_known_what_is_above_and_below():
    sheet = Surface(TriangleMesh(np.eye(3), np.array([[0, 1, 2]])))
    found = sheet.clearance(np.array([[0.4, 0.4, 0.4], [0.2, 0.2, 0.2], [2.0, 0, 0]]))
    assert found.known.tolist() == [True, True, False]
    np.testing.assert_allclose(found.distances[:2], np.array([0.2, -0.4]) / np.sqrt(3))


def test_a_triangle_of_short_sides_has_one_sample_in_its_middle():
    mesh = TriangleMesh(np.eye(3), np.array([[0, 1, 2]]))
    np.testing.assert_allclose(surface_samples(mesh, 10.0)[0].toarray(), [*np.eye(3), np.full(3, 1 / 3)])
