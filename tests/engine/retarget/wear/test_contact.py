# SPDX-License-Identifier: GPL-3.0-or-later
"""Clearance of points above a surface."""

import numpy as np
import pytest

from engine import TriangleMesh
from engine.retarget.wear.contact import Surface
from tests.shapes import cylinder, icosphere, irregular


@pytest.mark.parametrize("walking", [False, True])
@pytest.mark.parametrize("shape", [irregular(*icosphere(5), rounds=1), cylinder(16, 12, 0.5, 2.0)])
def test_a_moved_surface_is_the_one_that_is_made_there(shape, walking):
    mesh, random = TriangleMesh(*shape), np.random.default_rng(0)
    there = TriangleMesh(mesh.vertices * [1, 1.3, 0.8] + 0.1 * np.sin(3 * mesh.vertices[:, ::-1]), mesh.triangles)
    points = random.normal(size=(200, 3))
    starts = random.integers(0, mesh.vertex_count, 200) if walking else None
    moved, made = (
        Surface(mesh).moved(there.vertices).clearance(points, starts),
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
