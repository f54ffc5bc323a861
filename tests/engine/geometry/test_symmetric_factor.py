# SPDX-License-Identifier: GPL-3.0-or-later
"""Factors of symmetric positive definite matrices."""

import numpy as np
from scipy.sparse import eye_array

from engine import TriangleMesh
from engine.geometry.laplacian import laplace_beltrami
from engine.geometry.symmetric_factor import symmetric_factor
from tests.shapes import icosphere


def test_it_solves():
    matrix = laplace_beltrami(TriangleMesh(*icosphere(6))).stiffness
    matrix = matrix + 0.1 * eye_array(matrix.shape[0])
    wanted = np.random.default_rng(0).normal(size=(matrix.shape[0], 3))
    np.testing.assert_allclose(symmetric_factor(matrix).solve(matrix @ wanted), wanted, atol=1e-9)
