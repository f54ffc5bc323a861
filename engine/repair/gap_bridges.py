# SPDX-License-Identifier: GPL-3.0-or-later
"""Bridges across the gaps between solids that are near each other."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import label
from scipy.spatial import cKDTree

from ..runtime.arrays import Ints

_LEAST = 0.002
"""Part of all of the inside that a solid must have to be joined to others: half a finger of a person."""

_LONGER, _MORE = 1.5, 3.0
"""A way from one solid to the other is filled if it is not longer than so many times the shortest one, and so many
places of the grid more."""

_MOST_BRIDGES = 32
"""Gaps that are filled at most, which bounds the time."""


def bridged(values: NDArray[np.float32], level: float, widest: float) -> NDArray[np.float32]:
    """Fill the narrowest gaps between solids until these are one, or too far apart.

    Parameters
    ----------
    values : (a, b, c) array of float
        A function on a grid, larger inside.
    level : float
        Its value at the surface.
    widest : float
        How wide a gap may be, in places of the grid.

    Returns
    -------
    (a, b, c) array of float
        The function with larger values in the gaps.
    """
    result = values
    for _ in range(_MOST_BRIDGES):
        numbers, _ = label(result > level)
        sizes = np.bincount(numbers.ravel())
        sizes[0] = 0
        solids = np.flatnonzero(sizes >= _LEAST * sizes.sum())
        if len(solids) < 2:
            break
        nearest = _nearest_pair([np.argwhere(numbers == solid) for solid in solids[sizes[solids].argsort()]], widest)
        if nearest is None:
            break
        if result is values:
            result = values.copy()
        between = tuple(nearest.T)
        result[between] = np.maximum(result[between], (1 + level) / 2)
    return result


def _nearest_pair(solids: list[Ints], widest: float) -> Ints | None:
    """Find the two solids, of places (s, 3) each, with the narrowest gap: the places between them, (k, 3)."""
    trees = [cKDTree(places) for places in solids]
    best, pair = np.inf, None
    for i, places in enumerate(solids):
        for j in range(i + 1, len(solids)):
            distances = trees[j].query(places, distance_upper_bound=min(widest, best))[0]
            if distances.min() < best:
                best, pair = float(distances.min()), (i, j)
    if pair is None:
        return None
    first, second = pair
    reach = _LONGER * best + _MORE
    ways = []
    for here, there in ((first, second), (second, first)):
        distances, nearest = trees[there].query(solids[here], distance_upper_bound=reach)
        facing = np.flatnonzero(np.isfinite(distances))
        ways.append(np.stack([solids[here][facing], solids[there][nearest[facing]]], axis=1))
    begin, end = np.concatenate(ways).transpose(1, 0, 2)
    steps = np.linspace(0, 1, 2 * int(np.ceil(reach)) + 1)[:, None, None]
    between = (begin + steps * (end - begin)).reshape(-1, 3)
    return np.unique(np.concatenate([np.floor(between), np.ceil(between)]).astype(np.int64), axis=0)
