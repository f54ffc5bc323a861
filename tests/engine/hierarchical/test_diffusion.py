# SPDX-License-Identifier: GPL-3.0-or-later
"""Diffusion distances and heat kernels: the sums themselves, analytic kernels, and invariances."""

import numpy as np
import pytest
from scipy.spatial.distance import cdist

from engine import HierMatchError, TriangleMesh
from engine.geometry.eigenpairs import Spectrum, eigenpairs
from engine.hierarchical.diffusion import automatic_time, diffusion_places, positive_values
from tests.shapes import creature, icosphere, permuted, plane, rotation


@pytest.fixture(scope="module")
def spectrum():
    return eigenpairs(TriangleMesh(*creature(0.0, 10)[:2]), 60)


@pytest.fixture(scope="module")
def sphere():
    return TriangleMesh(*icosphere(16)), eigenpairs(TriangleMesh(*icosphere(16)), 100)


def legendre_kernel(cosine, time):
    """Heat kernel of the unit sphere, times its area."""
    weights = [(2 * degree + 1) * np.exp(-degree * (degree + 1) * time) for degree in range(60)]
    return np.polynomial.legendre.legval(cosine, weights)


def distances(spectrum, sources, time):
    places = diffusion_places(spectrum, time)
    return cdist(places[sources], places)


def heat_kernel(spectrum, time, sources):
    places = diffusion_places(spectrum, time / 2)
    return 1 + places[sources] @ places.T


def test_it_is_the_sum_of_the_paper(spectrum):
    time = 0.02
    rows = distances(spectrum, [3, 50], time)
    weights = np.exp(-2 * spectrum.values * spectrum.area * time) * spectrum.area
    for row, source in zip(rows, (3, 50), strict=True):
        differences = spectrum.functions - spectrum.functions[source]
        np.testing.assert_allclose(row, np.sqrt((differences**2) @ weights), atol=1e-6)


@pytest.mark.parametrize("time", [0.01, 0.05, 0.3])
def test_heat_kernel_of_a_sphere(sphere, time):
    mesh, spectrum = sphere
    cosines = mesh.vertices[[0, 30]] @ mesh.vertices.T
    exact = legendre_kernel(cosines, 4 * np.pi * time)
    np.testing.assert_allclose(heat_kernel(spectrum, time, [0, 30]), exact, atol=0.02 * exact.max())


@pytest.mark.parametrize("time", [0.01, 0.1])
def test_diffusion_distances_of_a_sphere(sphere, time):
    mesh, spectrum = sphere
    cosines = mesh.vertices[[0, 30]] @ mesh.vertices.T
    kernel = legendre_kernel(cosines, 8 * np.pi * time)
    exact = np.sqrt(2 * legendre_kernel(1.0, 8 * np.pi * time) - 2 * kernel)
    np.testing.assert_allclose(distances(spectrum, [0, 30], time), exact, atol=0.02 * exact.max())


def test_heat_is_neither_lost_nor_found(spectrum):
    heat = heat_kernel(spectrum, 0.01, np.arange(40)) @ spectrum.mass / spectrum.area
    np.testing.assert_allclose(heat, 1, rtol=1e-9)
    np.testing.assert_allclose(heat_kernel(spectrum, 50.0, [0, 7]), 1, rtol=1e-6)


def test_after_a_long_time_it_is_the_sum_of_the_slowest_functions(sphere):
    """Those of a sphere are its coordinates: what remains of the distances are straight lines, however short."""
    mesh, spectrum = sphere
    straight = cdist(mesh.vertices[[0, 30]], mesh.vertices)
    least = positive_values(spectrum)[0]
    for time in (1.0, 10.0):
        places = diffusion_places(spectrum, time, least)
        found = cdist(places[[0, 30]], places)
        np.testing.assert_allclose(found / found.max(), straight / straight.max(), atol=0.02)


def test_it_is_a_metric(spectrum):
    vertices = np.arange(0, len(spectrum.mass), 7)
    square = distances(spectrum, vertices, automatic_time(spectrum))[:, vertices]
    np.testing.assert_array_equal(np.diagonal(square), 0)
    np.testing.assert_allclose(square, square.T, atol=1e-7)
    assert square[~np.eye(len(square), dtype=bool)].min() > 0
    detour = (square[:, :, None] + square[None, :, :]).min(axis=1)
    assert (square <= detour + 1e-7).all()


def test_units_order_and_motion_do_not_matter():
    vertices, triangles = creature(0.5, 10)[:2]
    one = eigenpairs(TriangleMesh(vertices, triangles), 40)
    moved, shuffled, new = permuted(vertices @ rotation([1, 0, 2], 1.0).T, triangles)
    other = eigenpairs(TriangleMesh(100 * moved, shuffled), 40)
    assert automatic_time(other) == pytest.approx(automatic_time(one), rel=1e-6)
    times = automatic_time(one), automatic_time(other)
    rows = [distances(one, [0, 9], times[0]), distances(other, new[[0, 9]], times[1])[:, new]]
    np.testing.assert_allclose(rows[0], rows[1], atol=1e-3 * rows[0].max())


def test_poses_have_nearly_one_metric():
    rows = [
        distances(eigenpairs(TriangleMesh(*creature(pose, 14)[:2]), 60), np.arange(0, 1000, 50), 0.02)
        for pose in (0.0, 1.0)
    ]
    assert abs(rows[0] - rows[1]).mean() < 0.05 * rows[0].mean()


def test_the_automatic_time(spectrum):
    time = automatic_time(spectrum)
    weights = np.exp(-2 * spectrum.values[1:] * spectrum.area * time)
    assert weights.sum() == pytest.approx(8)
    fewer = Spectrum(spectrum.values[:40], spectrum.functions[:, :40], spectrum.mass, complete=True)
    assert automatic_time(fewer) == pytest.approx(time, rel=0.02)
    two = Spectrum(spectrum.values[:2], spectrum.functions[:, :2], spectrum.mass, complete=True)
    assert np.isfinite(automatic_time(two))


def test_constant_functions_do_not_suffice():
    with pytest.raises(HierMatchError, match="not constant"):
        automatic_time(eigenpairs(TriangleMesh(*plane(5)), 1))
    with pytest.raises(HierMatchError, match="not constant"):
        diffusion_places(eigenpairs(TriangleMesh(*plane(5)), 1), 0.1)
