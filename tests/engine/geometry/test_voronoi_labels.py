# SPDX-License-Identifier: GPL-3.0-or-later
"""A surface divided among points."""

from __future__ import annotations

import numpy as np
import pytest

from engine import MeshError, TriangleMesh
from engine.geometry.geodesics import GeodesicSolver
from engine.geometry.voronoi_labels import NO_REGION, nearest_regions
from tests.shapes import icosphere


def ball(subdivisions):
    return TriangleMesh(*icosphere(subdivisions))


def two_spheres():
    one = ball(5)
    count = one.vertex_count
    return TriangleMesh(
        np.concatenate([one.vertices, one.vertices + 5]), np.concatenate([one.triangles, one.triangles + count])
    )


def test_each_vertex_belongs_to_the_nearest_point():
    mesh = ball(8)
    places = np.random.default_rng(1).choice(mesh.vertex_count, 12, replace=False)
    regions = nearest_regions(mesh, places)
    assert regions[places].tolist() == list(range(12))
    distances = GeodesicSolver(mesh).distances(places)
    own = distances[regions, np.arange(mesh.vertex_count)]
    assert (own <= 1.3 * distances.min(axis=0) + 1e-9).all()


def test_size_and_order_do_not_matter():
    mesh = ball(5)
    places = np.array([0, 30, 77])
    regions = nearest_regions(mesh, places)
    assert (nearest_regions(TriangleMesh(1024 * mesh.vertices, mesh.triangles), places) == regions).all()
    order = np.array([2, 0, 1])
    assert (order[nearest_regions(mesh, places[order])] == regions).mean() > 0.9  # but for what is equally near


def test_parts_without_a_point_have_no_region():
    mesh = two_spheres()
    regions = nearest_regions(mesh, [0, 5])
    half = mesh.vertex_count // 2
    assert set(regions[:half].tolist()) == {0, 1}
    assert (regions[half:] == NO_REGION).all()


def test_no_points_and_the_same_twice():
    mesh = ball(2)
    assert (nearest_regions(mesh, []) == NO_REGION).all()
    assert (nearest_regions(mesh, [3, 3]) == 0).all()


@pytest.mark.parametrize("bad", [-1, 10_000])
def test_vertices_that_are_not_there(bad):
    with pytest.raises(MeshError, match="numbered 0 to"):
        nearest_regions(ball(2), [bad])
