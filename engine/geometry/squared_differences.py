# SPDX-License-Identifier: GPL-3.0-or-later
"""Squared Euclidean distances between the rows of two arrays."""

from __future__ import annotations

import numpy as np

from ..runtime.arrays import Floats


def squared_differences(first: Floats, second: Floats) -> Floats:
    """Squared Euclidean distance of every row of `first` (n, d) from every row of `second` (m, d): (n, m)."""
    square = np.square(first).sum(axis=1)[:, None] + np.square(second).sum(axis=1) - 2 * first @ second.T
    return np.maximum(square, 0)
