# SPDX-License-Identifier: GPL-3.0-or-later
"""Regions around seeds."""

import numpy as np
import pytest

from engine import TriangleMesh
from engine.runtime.progress import run
from engine.shapes.remeshing.surface_cells import SurfaceCells, grid_labels
from engine.shapes.remeshing.voronoi_regions import VoronoiRegions, spread_regions_steps
from tests.shapes import icosphere, plane, torus


def cells_of(vertices, triangles, size=0.05):
    mesh = TriangleMesh(vertices, triangles)
    return mesh, SurfaceCells.build(mesh, grid_labels(mesh, size * np.sqrt(mesh.area)))


@pytest.mark.parametrize("count", [60, 150])
@pytest.mark.parametrize("shape", [icosphere(24), torus(90, 36), plane(45)])
def test_there_are_about_as_many_as_asked_for(shape, count):
    _, cells = cells_of(*shape, size=0.02)
    regions = run(spread_regions_steps(cells, count))
    assert 0.75 * count < len(regions.seeds) < 1.25 * count
    assert len(np.unique(regions.seeds)) == len(regions.seeds)
    np.testing.assert_array_equal(regions.labels[regions.seeds], np.arange(len(regions.seeds)))
    assert (regions.distances[regions.seeds] == 0).all()
    assert np.isfinite(regions.distances).all()


def test_regions_of_a_sphere_are_alike():
    _, cells = cells_of(*icosphere(30), size=0.02)
    regions = run(spread_regions_steps(cells, 100))
    areas = np.bincount(regions.labels, cells.areas)
    assert areas.std() < 0.3 * areas.mean()


def test_more_seeds_go_where_the_surface_bends():
    vertices, triangles = icosphere(40)
    _, cells = cells_of(vertices * [1, 1, 4], triangles, size=0.01)
    regions = run(spread_regions_steps(cells, 200))
    tips = np.abs(cells.positions[:, 2]) > 3.6
    share = cells.areas[tips].sum() / cells.areas.sum()
    assert tips[regions.seeds].mean() > 1.5 * share


def test_adding_seeds_gives_what_all_seeds_give():
    _, cells = cells_of(*torus(60, 24), size=0.03)
    seeds = np.random.default_rng(3).permutation(cells.count)[:40]
    together = VoronoiRegions.around(cells, seeds)
    added = VoronoiRegions.around(cells, seeds[:25]).with_seeds(seeds[25:33]).with_seeds(seeds[33:])
    np.testing.assert_allclose(added.distances, together.distances)
    assert (added.labels == together.labels).mean() > 0.99  # but for cells half-way between two
    np.testing.assert_array_equal(added.seeds, seeds)


def test_repair_leaves_nothing_faulty():
    mesh, cells = cells_of(*torus(120, 16, thickness=0.05), size=0.02)
    few = VoronoiRegions.around(cells, np.array([0]))
    assert few.dual.faulty.any()
    whole = few.repaired(mesh)
    assert not whole.dual.faulty.any()
    triangles = whole.dual.triangles
    edges = np.unique(np.sort(triangles[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2), axis=1), axis=0)
    assert len(whole.seeds) - len(edges) + len(triangles) == 0
