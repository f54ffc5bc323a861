# SPDX-License-Identifier: GPL-3.0-or-later
"""Factors of shifted matrices: solutions, and counts of eigenvalues."""

import numpy as np
import pytest
from scipy.sparse import csr_array, diags_array

from engine import TriangleMesh
from engine.geometry.laplacian import laplace_beltrami
from engine.geometry.shifted_factor import ShiftedFactor
from tests.shapes import cylinder, icosphere, irregular, plane, torus


def matrix_of(shape):
    operator = laplace_beltrami(TriangleMesh(*shape))
    inverse = diags_array(1 / np.sqrt(operator.mass))
    return csr_array(inverse @ operator.stiffness @ inverse)


SHAPES = {"sphere": icosphere(9), "torus": irregular(*torus(30, 14)), "plane": plane(30), "tube": cylinder(6, 120)}


@pytest.mark.parametrize("shape", SHAPES.values(), ids=SHAPES)
def test_solves_and_counts(shape):
    matrix = matrix_of(shape)
    values = np.linalg.eigvalsh(matrix.toarray())
    right = np.random.default_rng(0).standard_normal((matrix.shape[0], 3))
    gaps = np.flatnonzero(np.diff(values) > 1e-3 * values[1:]) + 1
    for below in (0, *gaps[[0, 3, 20]]):
        shift = (values[below - 1] + values[below]) / 2 if below else -0.1
        factor = ShiftedFactor(matrix, shift)
        assert factor.negative_count == below
        assert factor.is_accurate()
        solution = factor.solve(right)
        np.testing.assert_allclose(matrix @ solution - shift * solution, right, atol=1e-7)


def test_the_order_serves_other_shifts():
    matrix = matrix_of(SHAPES["torus"])
    first = ShiftedFactor(matrix, 3.0)
    second = ShiftedFactor(matrix, 3.0, first.order)
    assert sorted(first.order) == list(range(matrix.shape[0]))
    assert second.negative_count == first.negative_count
    right = np.random.default_rng(0).standard_normal((matrix.shape[0], 2))
    np.testing.assert_allclose(second.solve(right), first.solve(right), rtol=1e-6, atol=1e-9)
    np.testing.assert_allclose(ShiftedFactor(matrix, 3.0, second.order).solve(right), first.solve(right), atol=1e-6)


def test_a_shift_close_to_an_eigenvalue_is_noticed():
    matrix = matrix_of(icosphere(5))
    value = np.linalg.eigvalsh(matrix.toarray())[4]
    try:
        factor = ShiftedFactor(matrix, value)
    except RuntimeError:
        return
    assert not factor.is_accurate()
