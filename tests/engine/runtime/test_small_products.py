# SPDX-License-Identifier: GPL-3.0-or-later
import numpy as np
import pytest

from engine.runtime.small_products import product


@pytest.mark.parametrize(
    ("rows", "inner", "columns"),
    [(3, 4, 5), (64, 64, 512), (512, 64, 64), (700, 70, 1), (1, 900, 900), (640, 300, 200)],
)
def test_it_is_the_matrix_product(rows, inner, columns):
    rng = np.random.default_rng(0)
    first, second = rng.standard_normal((rows, inner)), rng.standard_normal((inner, columns))
    np.testing.assert_allclose(product(first, second), first @ second, atol=1e-10)
    np.testing.assert_allclose(product(first, second[:, 0]), first @ second[:, 0], atol=1e-10)
