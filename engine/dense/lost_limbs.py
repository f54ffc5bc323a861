# SPDX-License-Identifier: GPL-3.0-or-later
"""Ends of limbs that maps lose on both surfaces, and which of them belong together."""

from __future__ import annotations

import numpy as np

from ..runtime.arrays import Floats, Ints
from ..shapes.extremities import limb_tips
from ..shapes.shape import Shape
from .functional_maps import PointMaps

_LOST = 0.15
"""Distance, in sqrt(area), between the end of a limb and where both maps bring it, from which on it is lost: that in
which ends of limbs are told apart, see `limb_tips`."""

_AT_HOME = 0.05
"""The same distance up to which a place is believed to be where the map takes it."""

_FEWEST = 8
"""Places that are needed to tell which ends belong together."""


def lost_limbs(x: Shape, y: Shape, maps: PointMaps) -> Ints:
    """Pair ends of limbs that neither of two maps brings home.

    Where two limbs of X lie on one of Y, the other one of Y is left over: it is near to both in space, but as far along
    the surface from all that lies right as the one that was lost.  Ends that only one surface has are left alone.

    Parameters
    ----------
    x, y : Shape
        The surfaces, with samples.
    maps : PointMaps
        Between all their vertices.

    Returns
    -------
    (k, 2) array of int
        Vertices of X and of Y, each nearest to the other by its distances from the places that both maps bring home.
    """
    trips, trips_back = _trips(x, maps.on_y, maps.on_x), _trips(y, maps.on_x, maps.on_y)
    tips, ends = limb_tips(x), limb_tips(y)
    tips, ends = tips[trips[tips] > _LOST], ends[trips_back[ends] > _LOST]
    known = np.flatnonzero(trips < _AT_HOME)
    if not len(tips) or not len(ends) or len(known) < _FEWEST:
        return np.empty((0, 2), np.int64)
    here = x.samples.distances[np.ix_(tips, known)]
    there = y.samples.rows[np.ix_(ends, maps.on_y[x.samples.vertices[known]])]
    weights = x.samples.cell_areas[known]
    apart = np.average(np.abs(here[:, None] - there), axis=2, weights=weights)
    mine, yours = apart.argmin(axis=1), apart.argmin(axis=0)
    mutual = np.flatnonzero(yours[mine] == np.arange(len(tips)))
    return np.column_stack([x.samples.vertices[tips[mutual]], y.samples.vertices[ends[mine[mutual]]]])


def _trips(shape: Shape, there: Ints, back: Ints) -> Floats:
    """Distances, in sqrt(area), between samples and where two maps bring them, there and back, (s,)."""
    samples = shape.samples
    rows: Floats = samples.rows[np.arange(len(samples.vertices)), back[there[samples.vertices]]].astype(np.float64)
    return rows
