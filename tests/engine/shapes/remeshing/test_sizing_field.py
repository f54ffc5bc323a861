# SPDX-License-Identifier: GPL-3.0-or-later
"""Where a coarse mesh needs more vertices."""

import numpy as np
import pytest

from engine import TriangleMesh
from engine.shapes.remeshing.sizing_field import vertex_density
from engine.shapes.remeshing.surface_cells import SurfaceCells, grid_labels
from tests.shapes import icosphere, plane, torus


def cells_of(vertices, triangles, size=None):
    mesh = TriangleMesh(vertices, triangles)
    labels = np.arange(mesh.vertex_count) if size is None else grid_labels(mesh, size)
    return SurfaceCells.build(mesh, labels)


@pytest.mark.parametrize("size", [None, 0.1])
def test_a_sphere_is_covered_evenly(size):
    density = vertex_density(cells_of(*icosphere(24), size))
    assert np.median(density) == pytest.approx(1, abs=0.05)
    assert np.abs(density - 1).max() < 0.35


def test_what_is_flat_is_covered_evenly():
    np.testing.assert_allclose(vertex_density(cells_of(*plane(20, jitter=0.3))), 1)


def test_the_mean_over_the_surface_is_one():
    cells = cells_of(*torus(80, 30))
    assert np.average(vertex_density(cells), weights=cells.areas) == pytest.approx(1)


def test_tips_are_covered_more_densely_than_sides_but_these_as_well():
    vertices, triangles = icosphere(30)
    cells = cells_of(vertices * [1, 1, 4], triangles)
    density = vertex_density(cells)
    height = np.abs(cells.positions[:, 2])
    tips, sides = density[height > 3.8].mean(), density[height < 1].mean()
    assert tips > 3 * sides
    assert density.min() > 0.2
    assert density.max() < 6


def test_size_place_and_orientation_do_not_matter():
    vertices, triangles = icosphere(16)
    vertices = vertices * [1, 2, 3]
    first = vertex_density(cells_of(vertices, triangles))
    turned = vertex_density(cells_of(1e-3 * vertices[:, [2, 0, 1]] + 5, triangles))
    np.testing.assert_allclose(turned, first, rtol=1e-6)


def test_noise_makes_the_density_more_even():
    vertices, triangles = icosphere(30)
    vertices = vertices * [1, 1, 4]
    noise = 0.02 * np.random.default_rng(0).standard_normal(vertices.shape)
    smooth, rough = (vertex_density(cells_of(v, triangles)) for v in (vertices, vertices + noise))
    height = np.abs(vertices[:, 2])
    ratios = [d[height > 3.8].mean() / d[height < 1].mean() for d in (smooth, rough)]
    assert 1 < ratios[1] < ratios[0]
