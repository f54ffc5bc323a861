# SPDX-License-Identifier: GPL-3.0-or-later
"""Squared distances between rows."""

import numpy as np
import pytest
from scipy.spatial.distance import cdist

from engine.geometry.squared_differences import squared_differences


@pytest.mark.parametrize("shape", [(1, 1, 1), (7, 4, 3), (5, 9, 20), (0, 3, 2), (4, 0, 2)])
def test_they_are_the_squares_of_the_distances(shape):
    n, m, d = shape
    rng = np.random.default_rng(0)
    first, second = rng.normal(size=(n, d)), rng.normal(size=(m, d))
    found = squared_differences(first, second)
    assert found.shape == (n, m)
    np.testing.assert_allclose(found, cdist(first, second, "sqeuclidean"), rtol=1e-10, atol=1e-12)


def test_exact_on_whole_numbers():
    first, second = np.array([[0.0, 0], [3, 4]]), np.array([[3.0, 4], [0, 0], [-3, 4]])
    np.testing.assert_array_equal(squared_differences(first, second), [[25, 0, 25], [0, 25, 36]])


def test_rounding_makes_none_negative():
    rows = np.random.default_rng(1).normal(size=(200, 3)) + 1e5
    found = squared_differences(rows, rows)
    # Without a limit, half of the zeros on the diagonal would be below.
    assert (found >= 0).all()
    assert np.isfinite(np.sqrt(found)).all()
    assert np.diag(found).max() < 1e-4


def test_exchanging_the_arrays_transposes():
    rng = np.random.default_rng(2)
    first, second = rng.random((6, 5)), rng.random((8, 5))
    np.testing.assert_allclose(squared_differences(first, second), squared_differences(second, first).T, atol=1e-14)
