# SPDX-License-Identifier: GPL-3.0-or-later
"""Contacts of feet with the ground: when they stand, and where they have to stay meanwhile."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
from scipy.ndimage import binary_closing, binary_opening

from ...runtime.arrays import TINY, Bools, Floats, eased

_LOW = 0.08
"""How far above its lowest place a point may be that stands, in units of the leg."""

_SLOW = 0.2
"""How fast it may move, in legs per second: feet that swing are twenty times as fast."""

_LOWEST = 2.0
"""Percentile of the heights that is taken for the ground: a single pose may be too low by mistake."""

_SHORT = 0.06
"""Seconds for which a point stands at least, and for which it may seem to leave the ground without doing so."""

_FADE = 0.15
"""Seconds over which a foot that was held goes back to where it was."""


def contacts_of(points: Floats, up: Floats, length: float, rate: float) -> Bools:
    """Find out when points stand on the ground: those that are low and slow.

    Parameters
    ----------
    points : (f, p, 3) array of float
        Where they are, pose after pose.
    up : (3,) array of float
        Direction away from the ground, of length one.
    length : float
        Length of the leg.
    rate : float
        Poses per second.

    Returns
    -------
    (f, p) array of bool
        Whether each stands.
    """
    heights = points @ up
    low = heights - np.percentile(heights, _LOWEST, axis=0) <= _LOW * length
    steps = np.linalg.norm(np.diff(points, axis=0), axis=-1) * rate
    # The slower of the steps before and after: the first pose on the ground counts.
    steps = np.concatenate([steps[:1], steps, steps[-1:]])
    slow = np.minimum(steps[:-1], steps[1:]) <= _SLOW * length
    span = np.ones((max(2, round(_SHORT * rate)), 1), bool)
    touching = np.pad(low & slow, ((len(span), len(span)), (0, 0)), mode="edge")
    closed = binary_closing(touching, span)
    return np.asarray(binary_opening(closed, span))[len(span) : -len(span)]


def held_shifts(points: Floats, touching: Bools, heights: Floats, up: Floats, rate: float) -> Floats:
    """Find how far a foot has to be shifted in each pose so that what stands stays in place.

    The further point, the ball of a foot, is held if it stands, else the ankle.  Where one takes over from the other,
    it is held where it is by then, so that nothing jumps.

    Parameters
    ----------
    points : (f, 2, 3) array of float
        Ankle and ball of the foot.
    touching : (f, 2) array of bool
        When they stand.
    heights : (f, 2) array of float
        How high they are to be while they do, along `up`.
    up : (3,) array of float
        Direction away from the ground, of length one.
    rate : float
        Poses per second.

    Returns
    -------
    (f, 3) array of float
        The shift; it fades before the foot stands and after.
    """
    count = len(points)
    holding = np.where(touching[:, 1], 1, np.where(touching[:, 0], 0, -1))
    runs = np.append(np.flatnonzero(np.append(True, holding[1:] != holding[:-1])), count)
    shifts = np.zeros((count, 3))
    for begin, end in pairwise(runs):
        which = holding[begin]
        if which < 0:
            continue
        path, level = points[begin:end, which], heights[begin:end, which].mean()
        held = begin > 0 and holding[begin - 1] >= 0
        place = path[0] + shifts[begin - 1] if held else np.median(path, axis=0)
        place = place + (level - place @ up) * up
        shifts[begin:end] = place - path
    return _faded(shifts, holding >= 0, max(1, round(_FADE * rate)))


def grounded_lifts(heights: Floats, wanted: Floats, level: Floats, length: float) -> Floats:
    """Find how far a foot has to be lifted in each pose so that it is as near to the ground as it should be.

    This needs no foot that stands: in a walk on the spot the ground moves below it.

    Parameters
    ----------
    heights, wanted : (f, 2) array of float
        How high ankle and ball of the foot are, and how high they should be.
    level : (2,) array of float
        How high they are when the foot rests on the ground.
    length : float
        Length of the leg.

    Returns
    -------
    (f,) array of float
        The lift, none for a foot far above the ground; neither point is below the ground then unless it should be.
    """
    shares = (1 - (wanted - level) / (2 * _LOW * length)).clip(0, 1)
    lifts = (shares**2 * (wanted - heights)).sum(axis=1) / np.maximum(shares.sum(axis=1), TINY)
    sunk = np.minimum(wanted, level) - heights - lifts[:, None]
    return np.asarray(lifts + sunk.max(axis=1).clip(0))


def _faded(values: Floats, held: Bools, span: int) -> Floats:
    """Let values (f, d) fade smoothly where they are not held, over so many poses, or go over into the next ones."""
    places, frames = np.flatnonzero(held), np.arange(len(values))
    if not len(places):
        return values
    result, total = np.zeros_like(values), np.zeros(len(values))
    for numbers in (np.searchsorted(places, frames, "right") - 1, np.searchsorted(places, frames)):
        inside = numbers.clip(0, len(places) - 1)
        sides = places[inside]
        share = (numbers == inside) * (1 - eased(np.abs(frames - sides) / (span + 1)))
        result += share[:, None] * values[sides]
        total += share
    return result / np.maximum(total, 1)[:, None]
