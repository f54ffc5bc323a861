# SPDX-License-Identifier: GPL-3.0-or-later
import numpy as np
import pytest

from engine import TriangleMesh
from engine.dense.functional_maps import (
    FunctionalMaps,
    PointMaps,
    SampledBasis,
    fit_functional_maps,
    nearest_both_ways,
    points_from_functions,
    points_from_functions_steps,
    refine_bijective_steps,
    spectral_sizes,
)
from engine.geometry.eigenpairs import eigenpairs
from engine.runtime.progress import run
from tests.shapes import creature, permuted


@pytest.fixture(scope="module")
def functions():
    """Eigenfunctions of an asymmetric body, of mean square one, (n, 60)."""
    spectrum = eigenpairs(TriangleMesh(*creature(0.0, 9)[:2]), 60)
    return spectrum.functions * np.sqrt(spectrum.area)


def identity(count):
    return PointMaps(np.arange(count), np.arange(count))


def test_functional_maps_of_the_identity_are_the_identity(functions):
    basis = SampledBasis(functions)
    maps = fit_functional_maps(basis, basis, identity(len(functions)), 40)
    np.testing.assert_allclose(maps.onto_x, np.eye(40), atol=1e-10)
    np.testing.assert_allclose(maps.onto_y, np.eye(40), atol=1e-10)


def test_points_from_identity_maps_are_the_identity(functions):
    maps = FunctionalMaps(np.eye(60), np.eye(60))
    for points in points_from_functions(maps, functions, functions):
        # Of two vertices closer than float32 can tell by waves as long as these, either may be found.
        assert np.square(functions[points] - functions).sum(axis=1).max() < 1e-3
        assert (points == np.arange(len(functions))).mean() > 0.99


def test_a_fit_is_the_least_squares_solution():
    rng = np.random.default_rng(0)
    x, y = rng.standard_normal((50, 12)), rng.standard_normal((40, 12))
    points = PointMaps(rng.integers(0, 40, 50), rng.integers(0, 50, 40))
    maps = fit_functional_maps(SampledBasis(x), SampledBasis(y), points, 8)
    np.testing.assert_allclose(maps.onto_x, np.linalg.lstsq(x[:, :8], y[points.on_y, :8], rcond=None)[0], atol=1e-10)
    np.testing.assert_allclose(maps.onto_y, np.linalg.lstsq(y[:, :8], x[points.on_x, :8], rcond=None)[0], atol=1e-10)


def test_point_maps_minimise_the_energy_of_both_directions():
    rng = np.random.default_rng(1)
    x, y = rng.standard_normal((70, 6)), rng.standard_normal((90, 6))
    points = PointMaps(rng.integers(0, 90, 70), rng.integers(0, 70, 90))
    maps = fit_functional_maps(SampledBasis(x), SampledBasis(y), points, 6)
    energy = np.square((x @ maps.onto_x)[:, None] - y).sum(axis=2)
    energy += np.square(x[:, None] - y @ maps.onto_y).sum(axis=2)
    found = points_from_functions(maps, x, y)
    np.testing.assert_array_equal(found.on_y, energy.argmin(axis=1))
    np.testing.assert_array_equal(found.on_x, energy.argmin(axis=0))


@pytest.mark.parametrize(("m", "n"), [(1, 1), (5, 300), (300, 5), (64, 96), (130, 31)])
def test_nearest_rows_are_those_of_brute_force(m, n):
    rng = np.random.default_rng(m * n)
    x, y = rng.standard_normal((m, 4)), rng.standard_normal((n, 4))
    distance = np.square(x[:, None] - y).sum(axis=2)
    points = nearest_both_ways(x, y)
    np.testing.assert_array_equal(points.on_y, distance.argmin(axis=1))
    np.testing.assert_array_equal(points.on_x, distance.argmin(axis=0))


def test_blocks_of_the_product_do_not_show(monkeypatch):
    rng = np.random.default_rng(2)
    x, y = rng.standard_normal((200, 4)), rng.standard_normal((90, 4))
    whole = nearest_both_ways(x, y)
    monkeypatch.setattr("engine.dense.functional_maps._BLOCK", 90 * 37)
    parts = nearest_both_ways(x, y)
    np.testing.assert_array_equal(parts.on_y, whole.on_y)
    np.testing.assert_array_equal(parts.on_x, whole.on_x)


def test_long_products_report_their_progress(monkeypatch):
    rng = np.random.default_rng(6)
    x, y = rng.standard_normal((200, 4)), rng.standard_normal((90, 4))
    maps = FunctionalMaps(*rng.standard_normal((2, 4, 4)))
    monkeypatch.setattr("engine.dense.functional_maps._BLOCK", 90 * 50)
    fractions = [progress.fraction for progress in points_from_functions_steps(maps, x, y)]
    assert fractions == [0.25, 0.5, 0.75, 1]


def test_an_isometric_copy_is_recovered_from_a_coarse_start(functions):
    rest, triangles = creature(0.0, 9)[:2]
    other, order = _permuted_copy(rest, triangles)
    x, y = SampledBasis(functions), SampledBasis(other)
    # Every vertex is taken to that of another one nearby: right up to a tenth of the body only.
    near = np.square(rest[:, None] - rest).sum(axis=2) < 0.2**2
    rng = np.random.default_rng(3)
    blurred = np.array([rng.choice(np.flatnonzero(row)) for row in near])
    start = PointMaps(np.argsort(order)[blurred], blurred[order])
    refined = run(refine_bijective_steps(x, y, start, spectral_sizes(15, 60, 8)))
    assert np.linalg.norm(rest[order[refined.on_y]] - rest, axis=1).max() < 0.02
    assert np.linalg.norm(rest[refined.on_x] - rest[order], axis=1).max() < 0.02
    assert (order[refined.on_y] == np.arange(len(rest))).mean() > 0.98


def test_refined_maps_follow_a_change_of_vertex_order(functions):
    rng = np.random.default_rng(4)
    count = len(functions)
    other = functions + 0.05 * rng.standard_normal(functions.shape)
    start = PointMaps(rng.integers(0, count, count), rng.integers(0, count, count))
    sizes = spectral_sizes(10, 40, 4)
    plain = run(refine_bijective_steps(SampledBasis(functions), SampledBasis(other), start, sizes))
    p, q = rng.permutation(count), rng.permutation(count)
    back_p, back_q = np.argsort(p), np.argsort(q)
    turned = PointMaps(back_q[start.on_y[p]], back_p[start.on_x[q]])
    renumbered = run(refine_bijective_steps(SampledBasis(functions[p]), SampledBasis(other[q]), turned, sizes))
    np.testing.assert_array_equal(renumbered.on_y, back_q[plain.on_y[p]])
    np.testing.assert_array_equal(renumbered.on_x, back_p[plain.on_x[q]])


def test_signs_of_eigenfunctions_do_not_matter(functions):
    rng = np.random.default_rng(5)
    start = PointMaps(*(rng.integers(0, len(functions), (2, len(functions)))))
    signs = rng.choice([-1.0, 1.0], functions.shape[1])
    sizes = spectral_sizes(10, 40, 4)
    plain = run(refine_bijective_steps(SampledBasis(functions), SampledBasis(functions), start, sizes))
    turned = run(refine_bijective_steps(SampledBasis(functions), SampledBasis(functions * signs), start, sizes))
    np.testing.assert_array_equal(turned.on_y, plain.on_y)


def test_functions_that_samples_cannot_tell_apart_are_not_used():
    angle = np.arange(12) * 2 * np.pi / 12
    waves = np.stack([np.cos(k * angle) for k in range(12)], axis=1)  # that of 12 - k looks like that of k
    basis = SampledBasis(waves)
    assert basis.size == 7
    assert SampledBasis(np.ones((3, 9))).size == 1
    refined = run(refine_bijective_steps(basis, basis, identity(12), [5, 9, 12]))
    assert len(refined.on_y) == 12
    assert len(fit_functional_maps(basis, basis, identity(12), 8).onto_x) == 7


def test_sizes_grow_from_first_to_last():
    assert spectral_sizes(15, 30, 5) == [15, 18, 21, 25, 30]
    assert spectral_sizes(15, 9, 5) == [9]
    assert spectral_sizes(2, 3, 8) == [2, 3]


def _permuted_copy(rest, triangles):
    """Eigenfunctions computed in another vertex order, and the old number of each vertex."""
    vertices, faces, new = permuted(rest, triangles, seed=1)
    spectrum = eigenpairs(TriangleMesh(vertices, faces), 60)
    return spectrum.functions * np.sqrt(spectrum.area), np.argsort(new)
