# SPDX-License-Identifier: GPL-3.0-or-later
"""Directions that are spread evenly over the sphere."""

from __future__ import annotations

import numpy as np

from ..runtime.arrays import Floats


def spread_directions(count: int) -> Floats:
    """Spread unit vectors evenly over all directions, (count, 3), along a spiral."""
    heights = 1 - (2 * np.arange(count) + 1) / count
    angles = np.pi * (1 + np.sqrt(5)) * np.arange(count)
    radii = np.sqrt(1 - heights**2)
    return np.stack([radii * np.cos(angles), radii * np.sin(angles), heights], axis=1)
