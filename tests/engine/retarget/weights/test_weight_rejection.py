# SPDX-License-Identifier: GPL-3.0-or-later
"""Vertices that a map tears away from their neighbours, and those that it does not."""

import numpy as np
import pytest
from scipy.sparse import csr_array

from engine import ClosestPoints, SurfaceMap, TriangleMesh
from engine.mesh.connectivity.welded_parts import WeldedParts
from engine.retarget.weights.skin_weights import carried
from engine.retarget.weights.weight_rejection import torn_weights
from tests.shapes import creature, plane
from tests.skeletons import creature_weights


@pytest.fixture(scope="module")
def body():
    vertices, triangles, rest = creature(0.0, 9)
    return TriangleMesh(vertices, triangles), creature_weights(rest)


def broken(mesh, groups):
    """The identity, but for patches of so many vertices that go to other places; and which vertices these are."""
    good = SurfaceMap.identity(mesh)
    triangles, barycentric = good.triangles.copy(), good.barycentric.copy()
    astray = np.zeros(mesh.vertex_count, bool)
    for size, (x, y) in groups:
        a, b = (np.argsort(np.linalg.norm(mesh.vertices - point, axis=1))[:size] for point in (x, y))
        triangles[a], barycentric[a] = good.triangles[b], good.barycentric[b]
        astray[a] = True
    return SurfaceMap.from_barycentric(mesh, triangles, barycentric), astray


def test_a_good_map_tears_nothing(body):
    mesh, weights = body
    parts = WeldedParts.of(mesh)
    assert not torn_weights(weights, SurfaceMap.identity(mesh), parts, mesh).any()


@pytest.mark.parametrize("size", [1, 2, 6, 12])
def test_patches_that_lie_elsewhere_are_found(body, size):
    mesh, weights = body
    leg, tail, head = [0.46, 0.2, -0.8], [-1.2, 0.0, 0.15], [1.2, 0.0, 0.4]
    surface_map, astray = broken(mesh, [(size, (leg, tail)), (size, (tail, head))])
    parts = WeldedParts.of(mesh)
    found = torn_weights(carried(weights, surface_map), surface_map, parts, mesh)
    assert found[astray].all()
    assert found.sum() <= 2 * astray.sum()  # the tip of the tail is cut off, too


def test_between_two_large_parts_those_are_told_a_third_of_whose_edges_is_torn():
    """The right half of a square is mirrored onto itself, so that its left border is at its right one."""
    mesh = TriangleMesh(*plane(16, jitter=0.35))
    right = mesh.vertices[:, 0] > 0.5
    found = ClosestPoints(mesh).nearest(
        np.where(right[:, None], [1.5, 0, 0] + mesh.vertices * [-1, 1, 1], mesh.vertices)
    )
    surface_map = SurfaceMap.from_barycentric(mesh, found.triangles, found.barycentric)
    weights = csr_array(np.stack([right, ~right], axis=1).astype(float))
    across = mesh.edges[right[mesh.edges[:, 0]] != right[mesh.edges[:, 1]]]
    torn, all_edges = (np.bincount(edges.ravel(), minlength=mesh.vertex_count) for edges in (across, mesh.edges))
    told = torn_weights(weights, surface_map, WeldedParts.of(mesh), mesh)
    assert 5 < told.sum() < (torn > 0).sum()
    np.testing.assert_array_equal(told, torn > all_edges / 3)


def test_scale_does_not_matter(body):
    mesh, weights = body
    surface_map, _ = broken(mesh, [(3, ([0.46, 0.2, -0.8], [-0.5, -0.2, -0.7]))])
    large = TriangleMesh(1000 * mesh.vertices, mesh.triangles)
    carried_weights = carried(weights, surface_map)
    first = torn_weights(carried_weights, surface_map, WeldedParts.of(mesh), mesh)
    second = torn_weights(carried_weights, surface_map, WeldedParts.of(large), mesh)
    assert first.sum() >= 3
    np.testing.assert_array_equal(first, second)


def test_a_map_that_only_stretches_is_good(body):
    mesh, _ = body
    surface_map, astray = broken(mesh, [(3, ([0.46, 0.2, -0.8], [-0.5, -0.2, -0.7]))])
    same = csr_array(np.ones((mesh.vertex_count, 1)))
    assert astray.any()
    assert not torn_weights(same, surface_map, WeldedParts.of(mesh), mesh).any()
