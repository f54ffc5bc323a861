# SPDX-License-Identifier: GPL-3.0-or-later
"""Small patches that a map takes to another part of the surface, which is near in space."""

import numpy as np
import pytest
from scipy.sparse import coo_array
from scipy.sparse.csgraph import dijkstra

from engine import TriangleMesh
from engine.mesh.closest_points import ClosestPoints
from engine.registration.prolongation import lift_steps
from engine.registration.torn_patches import NearVertices, with_patches_mended
from engine.runtime.progress import run
from engine.shapes.proxy import Proxy
from tests.shapes import icosphere, plane

AROUND, ACROSS = 121, 16


@pytest.fixture(scope="module")
def roll():
    """A strip rolled up twice, its layers nearer to each other than its vertices: their normals agree."""
    vertices, triangles = [], []
    for i, angle in enumerate(np.linspace(0, 4 * np.pi, AROUND)):
        radius = 1 + 0.03 * angle / (2 * np.pi)
        vertices += [[radius * np.cos(angle), radius * np.sin(angle), z] for z in np.linspace(0, 1, ACROSS)]
        if i + 1 < AROUND:
            first = np.arange(i * ACROSS, (i + 1) * ACROSS - 1)
            triangles += [[a, a + ACROSS, a + 1] for a in first] + [[a + 1, a + ACROSS, a + ACROSS + 1] for a in first]
    return TriangleMesh(np.array(vertices), np.array(triangles))


def torn(roll, size):
    """Map the roll to itself, but a square patch of its inner turn to the outer one: the map, and the patch."""
    column, row = np.divmod(np.arange(roll.vertex_count), ACROSS)
    patch = (abs(column - 20) <= size) & (abs(row - 8) <= size)
    images = np.arange(roll.vertex_count)
    images[patch] += (AROUND // 2) * ACROSS
    return images, patch


@pytest.mark.parametrize("rings", [1, 2, 3])
def test_near_are_vertices_that_few_edges_lead_to(rings):
    mesh = TriangleMesh(*icosphere(4))
    n, (a, b) = mesh.vertex_count, mesh.edges.T
    steps = dijkstra(coo_array((np.ones(len(a)), (a, b)), shape=(n, n)), directed=False, unweighted=True)
    first, second = np.divmod(np.arange(n * n), n)
    np.testing.assert_array_equal(NearVertices(mesh, rings).pairs(first, second), steps.ravel() <= rings)


def test_a_small_patch_gets_the_images_of_what_is_around_it(roll):
    images, patch = torn(roll, 1)
    before = images.copy()
    mended = with_patches_mended(roll, images, roll, NearVertices(roll, 3))
    np.testing.assert_array_equal(mended[~patch], np.flatnonzero(~patch))
    assert not patch[mended].any()
    gaps = np.linalg.norm(roll.vertices[mended[patch]] - roll.vertices[patch], axis=1)
    assert gaps.max() < 3 * roll.edge_lengths.mean()
    assert (mended[patch] < (AROUND // 2) * ACROSS).all()
    np.testing.assert_array_equal(images, before)


def test_what_is_large_or_not_torn_is_left_alone(roll):
    near = NearVertices(roll, 3)
    images, patch = torn(roll, 5)
    assert roll.vertex_areas[patch].sum() > 0.02 * roll.area
    np.testing.assert_array_equal(with_patches_mended(roll, images, roll, near), images)
    flat = TriangleMesh(*plane(9))
    turned = np.arange(flat.vertex_count)[::-1]
    np.testing.assert_array_equal(with_patches_mended(flat, turned, flat, NearVertices(flat, 3)), turned)


def test_long_edges_are_not_torn_where_the_target_has_many_vertices_between_their_ends():
    coarse, fine = TriangleMesh(*plane(6)), TriangleMesh(*plane(61))
    images = np.square(fine.vertices[None] - coarse.vertices[:, None]).sum(axis=2).argmin(axis=1)
    np.testing.assert_array_equal(with_patches_mended(coarse, images, fine, NearVertices(fine, 3)), images)
    turned = np.arange(coarse.vertex_count)[::-1]
    np.testing.assert_array_equal(
        with_patches_mended(coarse, images[turned], fine, NearVertices(fine, 3)), images[turned]
    )


def test_a_lift_keeps_to_the_layer_that_the_surroundings_are_on(roll):
    images, patch = torn(roll, 1)
    identity = Proxy.identity(roll)
    ends = roll, identity, roll.vertices, roll
    points = run(lift_steps(*ends, target_proxy=identity, proxy_map=images, search=ClosestPoints(roll)))
    gaps = np.linalg.norm(points.positions - roll.vertices, axis=1)
    assert gaps[patch].max() < 0.5 * roll.edge_lengths.mean()
    assert (points.nearest_vertices[patch] < (AROUND // 2) * ACROSS).all()
    assert gaps.max() < 0.5 * roll.edge_lengths.mean()
