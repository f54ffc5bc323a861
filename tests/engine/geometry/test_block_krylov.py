# SPDX-License-Identifier: GPL-3.0-or-later
"""Lowest eigenpairs of matrices whose spectra are known or hard: multiple, clustered, far from what was guessed."""

import numpy as np
import pytest
from scipy.sparse import block_diag, csr_array, diags_array, kron

from engine.geometry import block_krylov
from engine.geometry.block_krylov import lowest_eigenpairs_steps
from engine.runtime.progress import run


def path(n):
    """Laplacian of a path: eigenvalues 2 - 2 cos(pi i / n)."""
    matrix = diags_array([-np.ones(n - 1), np.full(n, 2.0), -np.ones(n - 1)], offsets=[-1, 0, 1]).tolil()
    matrix[0, 0] = matrix[n - 1, n - 1] = 1
    return csr_array(matrix)


def grid(n, m):
    """Laplacian of a grid, with its eigenvalues."""
    identity = [diags_array(np.ones(size)) for size in (n, m)]
    values = [2 - 2 * np.cos(np.pi * np.arange(size) / size) for size in (n, m)]
    matrix = kron(path(n), identity[1]) + kron(identity[0], path(m))
    return csr_array(matrix), np.sort((values[0][:, None] + values[1]).ravel())


def lowest(matrix, count, guess):
    n = matrix.shape[0]
    return run(lowest_eigenpairs_steps(matrix, np.full(n, n**-0.5), count, guess))


def check(pairs, matrix, exact, count):
    assert pairs.complete
    assert pairs.values[0] == 0
    np.testing.assert_allclose(pairs.values[1:], exact[1:count], rtol=1e-6)
    np.testing.assert_allclose(pairs.vectors.T @ pairs.vectors, np.eye(count), atol=1e-10)
    residuals = np.linalg.norm(matrix @ pairs.vectors - pairs.vectors * pairs.values, axis=0)
    assert residuals.max() < 1e-2 * pairs.values[-1] + 1e-12


@pytest.mark.parametrize("count", [1, 2, 3, 5, 8, 30, 77, 160])
def test_a_square_grid_has_double_eigenvalues(count):
    matrix, exact = grid(40, 40)  # 160 may fall within a pair
    check(lowest(matrix, count, exact[count - 1] + 1e-3), matrix, exact, count)


@pytest.mark.parametrize(("n", "scale"), [(11, 1e-11), (11, 0.001), (12, 1e-8), (13, 1e-4), (14, 1e-7), (14, 1.0)])
def test_small_grids_are_solved_in_any_units(n, scale):
    matrix, exact = grid(n, n)
    check(lowest(csr_array(scale * matrix), 100, scale * exact[99]), scale * matrix, scale * exact, 100)


@pytest.mark.parametrize("factor", [1e-6, 0.01, 0.3, 1, 3, 100, 1e6])
def test_the_guess_may_be_far_off(factor):
    matrix, exact = grid(37, 41)
    check(lowest(matrix, 40, factor * exact[39]), matrix, exact, 40)


def test_a_path_is_no_surface():
    matrix = path(3000)
    exact = 2 - 2 * np.cos(np.pi * np.arange(3000) / 3000)
    check(lowest(matrix, 50, 0.1), matrix, exact, 50)


@pytest.mark.parametrize("n", [60, 400])
def test_halves_that_hardly_hang_together_have_orthonormal_eigenvectors(n):
    # To the last digit the eigenvalue zero is there twice: 60 rows are solved as a dense matrix, 400 are not.
    matrix = block_diag([path(n // 2), path(n // 2)]).tolil()
    one, other = n // 2 - 1, n // 2
    matrix[one, other] = matrix[other, one] = -1e-16
    exact = np.repeat(2 - 2 * np.cos(np.pi * np.arange(5) / (n // 2)), 2)
    pairs = lowest(csr_array(matrix), 10, exact[-1])
    assert pairs.complete
    np.testing.assert_allclose(pairs.vectors[:, 0], n**-0.5)
    np.testing.assert_allclose(pairs.values, exact, rtol=1e-6, atol=1e-12)
    np.testing.assert_allclose(pairs.vectors.T @ pairs.vectors, np.eye(10), atol=1e-10)


def with_multiplicities(sizes, n=1500, seed=0):
    """Matrix with a random basis: eigenvalues zero once, 1, 2, ... with given multiplicities, then much larger ones."""
    random = np.random.default_rng(seed)
    start = np.concatenate([np.full((n, 1), n**-0.5), random.standard_normal((n, n - 1))], axis=1)
    basis = np.linalg.qr(start)[0]
    low = np.repeat(np.arange(1.0, len(sizes) + 1), sizes)
    exact = np.concatenate([[0.0], low, np.linspace(len(sizes) + 5, 50, n - 1 - len(low))])
    return csr_array((basis * exact) @ basis.T), exact


def test_eigenvalues_more_often_there_than_a_block_is_wide_are_all_found():
    matrix, exact = with_multiplicities([30, 20, 10])
    pairs = lowest(matrix, 55, 3.5)
    assert pairs.complete
    np.testing.assert_allclose(pairs.values, exact[:55], atol=1e-6)


def test_a_missing_eigenvalue_is_noticed_and_searched_for(monkeypatch):
    matrix, exact = grid(30, 31)
    attempts = []
    original = block_krylov._krylov_steps  # noqa: SLF001 -- to be disturbed

    def forgetful(factor, null, wanted, block, seed):
        ritz = yield from original(factor, null, wanted, block, seed)
        attempts.append(block)
        if len(attempts) == 1:  # overlook the last of the wanted ones
            keep = np.arange(len(ritz.values)) != wanted - 1
            ritz = ritz._replace(values=ritz.values[keep], coefficients=ritz.coefficients[:, keep])
        return ritz

    monkeypatch.setattr(block_krylov, "_krylov_steps", forgetful)
    check(lowest(matrix, 20, exact[19]), matrix, exact, 20)
    assert len(attempts) == 2
    assert attempts[1] > attempts[0]


def test_without_success_it_says_so(monkeypatch):
    matrix, exact = grid(30, 31)
    monkeypatch.setattr(block_krylov, "_count_below", lambda *_: None)
    pairs = lowest(matrix, 20, exact[19])
    assert not pairs.complete
    np.testing.assert_allclose(pairs.values[1:], exact[1:20], rtol=1e-6)


def test_progress_grows_to_one():
    matrix, exact = grid(60, 60)
    n = matrix.shape[0]
    steps = [p.fraction for p in lowest_eigenpairs_steps(matrix, np.full(n, n**-0.5), 60, exact[60])]
    assert len(steps) > 10
    assert (np.diff(steps) >= 0).all()
    assert min(steps) >= 0
    assert max(steps) <= 1
