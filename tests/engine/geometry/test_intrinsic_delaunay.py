# SPDX-License-Identifier: GPL-3.0-or-later
"""Intrinsic Delaunay triangulations: the condition itself, what flips may not change, and meshes in a mess."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial import Delaunay

from engine import TriangleMesh
from engine.geometry.intrinsic_delaunay import (
    corner_cotangents,
    intrinsic_delaunay,
    mollified_lengths,
    triangle_lengths,
)
from tests.shapes import creature, cylinder, icosphere, irregular, permuted, plane, plane_with_hole, torus


def edge_weights(triangles, lengths):
    """Sum of the cotangents opposite to each edge, by its two vertices and its length; and on how many sides it is."""
    cotangents = corner_cotangents(lengths)[0].ravel()
    ends = np.sort(np.stack([triangles, np.roll(triangles, -1, axis=1)], axis=-1).reshape(-1, 2), axis=1)
    edges = {}
    for (a, b), length, cotangent in zip(ends.tolist(), lengths.ravel(), cotangents, strict=True):
        total, sides = edges.get((a, b, round(length, 9)), (0.0, 0))
        edges[a, b, round(length, 9)] = (total + cotangent, sides + 1)
    return edges


def inner_weights(mesh):
    result = intrinsic_delaunay(mesh)
    edges = edge_weights(result.triangles, result.lengths)
    return np.array([weight for weight, sides in edges.values() if sides == 2])


@pytest.mark.parametrize(
    "shape",
    [
        irregular(*plane(12, jitter=0.4)),
        irregular(*icosphere(6), rounds=3),
        irregular(*plane_with_hole(10)),
        irregular(*torus(24, 10)),
        cylinder(5, 300),
        irregular(*creature(1.0, 10)[:2]),
    ],
    ids=["plane", "sphere", "hole", "torus", "long cylinder", "creature"],
)
def test_every_inner_edge_is_delaunay(shape):
    assert inner_weights(TriangleMesh(*shape)).min() > -1e-6


@pytest.mark.parametrize("seed", range(4))
def test_in_the_plane_it_is_the_delaunay_triangulation(seed):
    # Points in a ring of far ones, so that the boundary of the triangulation is that of the hull.
    random = np.random.default_rng(seed)
    angles = np.arange(12) * np.pi / 6
    points = np.concatenate([5 * np.stack([np.cos(angles), np.sin(angles)], axis=1), random.uniform(-2, 2, (60, 2))])
    wanted = Delaunay(points).simplices
    squeezed = Delaunay(points * [1, 9]).simplices  # of the same points, but a bad triangulation
    result = intrinsic_delaunay(TriangleMesh(np.column_stack([points, np.zeros(len(points))]), squeezed))
    assert result.flips > 20
    assert {frozenset(t) for t in result.triangles.tolist()} == {frozenset(t) for t in wanted.tolist()}
    straight = np.linalg.norm(points[result.triangles] - points[np.roll(result.triangles, -1, axis=1)], axis=2)
    np.testing.assert_allclose(result.lengths, straight, rtol=1e-10)


@pytest.mark.parametrize("shape", [irregular(*torus(20, 12)), irregular(*plane(10))], ids=["torus", "plane"])
def test_area_angles_and_vertices_are_kept(shape):
    mesh = TriangleMesh(*shape)
    result = intrinsic_delaunay(mesh)
    cotangents, areas = corner_cotangents(result.lengths)
    assert result.flips > 0
    assert areas.sum() == pytest.approx(mesh.area, rel=1e-5)
    # The sum of the angles around a vertex is intrinsic: flips do not know of it, but keep it.
    opposite = np.roll(np.arange(3), -2)
    around = np.bincount(result.triangles[:, opposite].ravel(), np.arctan2(1, cotangents).ravel(), mesh.vertex_count)
    before = np.bincount(
        mesh.triangles[:, opposite].ravel(),
        np.arctan2(1, corner_cotangents(triangle_lengths(mesh))[0]).ravel(),
        mesh.vertex_count,
    )
    np.testing.assert_allclose(around, before, atol=1e-3)


def test_a_delaunay_mesh_stays_as_it_is():
    mesh = TriangleMesh(*icosphere(8))
    result = intrinsic_delaunay(mesh)
    assert result.flips == 0
    np.testing.assert_array_equal(result.triangles, mesh.triangles)
    np.testing.assert_array_equal(result.lengths, triangle_lengths(mesh))


def edge_set(result):
    return {(*sorted(edge[:2]), edge[2]) for edge in edge_weights(result.triangles, result.lengths)}


def test_order_and_orientation_of_the_triangles_do_not_matter():
    vertices, triangles = irregular(*creature(0.0, 9)[:2], rounds=1)
    expected = edge_set(intrinsic_delaunay(TriangleMesh(vertices, triangles)))
    moved, shuffled, new = permuted(vertices, triangles)
    shuffled[::3] = shuffled[::3, ::-1]
    old = np.argsort(new)
    edges = edge_set(intrinsic_delaunay(TriangleMesh(moved, shuffled)))
    found = {(*sorted((int(old[a]), int(old[b]))), length) for a, b, length in edges}
    assert len(found ^ expected) <= 0.001 * len(expected)  # lengths are rounded for the comparison


def test_a_moebius_strip_is_cut_where_its_sides_meet():
    count = 40
    angle = 2 * np.pi * np.arange(count) / count
    vertices = np.concatenate(
        [
            np.stack([r * np.cos(angle), r * np.sin(angle), side * 0.3 * np.sin(angle / 2)], axis=1)
            for side in (-1, 1)
            for r in [1 + side * 0.3 * np.cos(angle / 2)]
        ]
    )
    i = np.arange(count - 1)
    triangles = np.concatenate(
        [
            np.stack([i, i + 1, count + i], axis=1),
            np.stack([i + 1, count + i + 1, count + i], axis=1),
            [[count - 1, count, 2 * count - 1], [count, 0, 2 * count - 1]],  # the ends, turned by half
        ]
    )
    result = intrinsic_delaunay(TriangleMesh(vertices, triangles))
    assert len(result.triangles) == len(triangles)
    assert corner_cotangents(result.lengths)[1].sum() == pytest.approx(TriangleMesh(vertices, triangles).area, rel=1e-3)


def test_edges_of_three_triangles_are_never_flipped():
    # Three flat wings on one edge, two of which would like to flip it.
    vertices = np.array([[0, 0, 0], [1, 0, 0], [0.5, 0.1, 0], [0.5, -0.1, 0], [0.5, 0, 0.1]], float)
    triangles = np.array([[0, 1, 2], [1, 0, 3], [0, 1, 4]])
    assert intrinsic_delaunay(TriangleMesh(vertices[:4], triangles[:2])).flips == 1
    result = intrinsic_delaunay(TriangleMesh(vertices, triangles))
    assert result.flips == 0
    np.testing.assert_array_equal(np.sort(result.triangles, axis=1), np.sort(triangles, axis=1))


def test_two_edges_may_join_the_same_vertices():
    # A sharp roof over a short base: the flips lead around it and end at edges that exist already.
    vertices, triangles = cylinder(3, 40, radius=0.02, height=1.0)
    assert inner_weights(TriangleMesh(vertices * [1, 1, 3], triangles)).min() > -1e-6


def test_triangles_without_area_get_one():
    vertices = np.array([[0, 0, 0], [1, 0, 0], [2, 0, 0], [1, 1, 0], [1, 0, 0]], float)
    triangles = np.array([[0, 1, 3], [1, 2, 3], [0, 2, 1], [1, 4, 2]])
    lengths = mollified_lengths(triangle_lengths(TriangleMesh(vertices, triangles)))
    cotangents, areas = corner_cotangents(lengths)
    assert areas.min() > 0
    assert np.isfinite(cotangents).all()
    result = intrinsic_delaunay(TriangleMesh(vertices, triangles))
    assert corner_cotangents(result.lengths)[1].sum() == pytest.approx(1, rel=0.01)


@given(st.integers(0, 10_000), st.floats(-6, 6))
@settings(max_examples=20, deadline=None)
def test_any_soup_of_triangles_ends_well(seed, exponent):
    random = np.random.default_rng(seed)
    corners = random.integers(0, 12, (30, 3))
    corners = corners[(corners != np.roll(corners, 1, axis=1)).all(axis=1)]
    points = random.integers(0, 3, (12, 3)) * 1.0
    points[:, 2] *= 0.1
    points[0] = [10, 10, 10]
    mesh_triangles = np.array([*corners, [0, 1, 2]])
    points[1:3] = [[0, 0, 5], [1, 0, 5]]
    result = intrinsic_delaunay(TriangleMesh(points * 10**exponent, mesh_triangles))
    cotangents, areas = corner_cotangents(result.lengths)
    assert np.isfinite(result.lengths).all()
    assert np.isfinite(cotangents).all()
    assert (areas > 0).all()


def test_scale_does_not_matter():
    vertices, triangles = irregular(*icosphere(5))
    one, other = (intrinsic_delaunay(TriangleMesh(size * vertices, triangles)) for size in (1.0, 2.0**-30))
    np.testing.assert_array_equal(one.triangles, other.triangles)
    np.testing.assert_allclose(one.lengths, 2.0**30 * other.lengths, rtol=1e-12)
