# SPDX-License-Identifier: GPL-3.0-or-later
"""Points spread over triangles."""

import numpy as np
import pytest

from engine import TriangleMesh
from engine.mesh.area_samples import area_samples, even_samples
from engine.mesh.closest_points import ClosestPoints
from tests.shapes import creature, icosphere


def test_points_stand_for_all_of_the_surface():
    mesh = TriangleMesh(*creature(0.4, 9)[:2])
    for area in (mesh.area, mesh.area / 1000, mesh.area / 30_000):
        samples = area_samples(mesh, area)
        assert samples.areas.max() <= area
        assert np.array_equal(np.unique(samples.triangles), np.arange(mesh.triangle_count))
        assert np.bincount(samples.triangles, samples.areas) == pytest.approx(mesh.triangle_areas)


def test_points_lie_in_their_triangles():
    mesh = TriangleMesh(*icosphere(2))
    samples = area_samples(mesh, mesh.area / 5000)
    corners = mesh.vertices[mesh.triangles[samples.triangles]]
    weights = np.linalg.solve(corners.transpose(0, 2, 1), samples.positions[:, :, None])[:, :, 0]
    assert weights.min() > -1e-9
    assert weights.sum(axis=1) == pytest.approx(1)


def test_points_are_spread_evenly_over_a_large_triangle():
    mesh = TriangleMesh([[0.0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]])
    samples = area_samples(mesh, mesh.area / 1000)
    assert samples.positions.mean(axis=0) == pytest.approx([1 / 3, 1 / 3, 0], abs=0.005)
    counts = np.histogram2d(*samples.positions[:, :2].T, bins=4, range=[[0, 1], [0, 1]])[0]
    full = np.add.outer(np.arange(4), np.arange(4)) < 3
    assert counts[full] == pytest.approx(125, rel=0.15)


def test_degenerate_triangles_have_a_point_of_no_area():
    mesh = TriangleMesh([[0.0, 0, 0], [1, 0, 0], [0, 1, 0], [2, 0, 0]], [[0, 1, 2], [0, 1, 3]])
    samples = area_samples(mesh, 0.01)
    assert samples.areas[samples.triangles == 1] == pytest.approx([0.0])
    assert np.isfinite(ClosestPoints(mesh).nearest(samples.positions).squared_distances).all()


def test_even_samples_do_not_depend_on_how_fine_the_triangles_are():
    coarse, fine = TriangleMesh(*icosphere(3)), TriangleMesh(*icosphere(40))
    for mesh in (coarse, fine):
        samples = even_samples(mesh, mesh.area / 500)
        points = samples.positions
        assert samples.areas.sum() == pytest.approx(mesh.area)
        own = mesh.vertices[mesh.triangles[samples.triangles]].mean(axis=1)
        assert np.linalg.norm(points - own, axis=1).max() < mesh.edge_lengths.max()
        assert len(points) == pytest.approx(500, abs=1)
        assert points.mean(axis=0) == pytest.approx(0, abs=0.05)
        assert np.histogram(points[:, 2], 4, (-1, 1))[0] == pytest.approx(125, rel=0.25)
    assert len(even_samples(coarse, 100.0).positions) == 1
