# SPDX-License-Identifier: GPL-3.0-or-later
"""Squared Euclidean distances between the rows of two arrays."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray

__all__ = ["squared_differences"]


def squared_differences(first: NDArray[np.float64], second: NDArray[np.float64]) -> NDArray[np.float64]:
    """Squared Euclidean distance of every row of `first` (n, d) from every row of `second` (m, d): (n, m)."""
    square = np.square(first).sum(axis=1)[:, None] + np.square(second).sum(axis=1) - 2 * first @ second.T
    return np.maximum(square, 0)
