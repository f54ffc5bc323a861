# SPDX-License-Identifier: GPL-3.0-or-later
"""Depths of places behind a surface, seen from many sides."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from ...geometry.directions import spread_directions
from ...runtime.arrays import Floats, group_largest


def depths_behind(surface: Floats, places: Floats, cell: float, count: int) -> Iterator[Floats]:
    """Tell for each of some directions how far places lie behind what is in front of them.

    Parameters
    ----------
    surface : (s, 3) array of float
        Points that stand for the surface.
    places : (k, 3) array of float
        Where it is asked.
    cell : float
        Width of the cells that are looked through: wide enough that points of the surface are in nearly all.
    count : int
        How many directions are spread over the sphere.

    Yields
    ------
    (k,) array of float
        Depths below the foremost point in the same cell; negative for places before it, minus infinity where there is
        none.
    """
    points = np.concatenate([surface, places])
    for direction in spread_directions(count):
        across = np.linalg.svd(direction[None])[2][1:]
        cells = np.floor(points @ across.T / cell).astype(np.int64)
        cells -= cells.min(axis=0)
        number = cells[:, 0] * (cells[:, 1].max() + 1) + cells[:, 1]
        front = group_largest(number[: len(surface)], surface @ direction, number.max() + 1, -np.inf)
        yield front[number[len(surface) :]] - places @ direction
