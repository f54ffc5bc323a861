# SPDX-License-Identifier: GPL-3.0-or-later
"""Hands that touch or nearly touch the body, and where they have to be in another one."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ...runtime.arrays import Floats, eased, shares_along

_TOUCHING, _APART = 0.25, 0.45
"""Up to what distance from the middle of another part a hand touches it, and from where on it is free, in units of the
arm: a trunk is as thick as a third of an arm."""

_SHARPNESS = 6
"""How fast parts that are further away than the nearest one cease to count."""


@dataclass(frozen=True, eq=False)
class BodyLine:
    """A line within a part of two bodies, from joint to joint, in motion.

    Attributes
    ----------
    source, target : (f, 2, 3) arrays of float
        Its two ends in either body.
    share : float
        How much of the way a hand goes there: half if the other hand comes to meet it.
    """

    source: Floats
    target: Floats
    share: float = 1.0


def hand_shifts(palms: Floats, target_palms: Floats, lines: Sequence[BodyLine], arm: float, turn: Floats) -> Floats:
    """Find how far a hand has to be shifted so that it is where it is in the source, seen from what it is near to.

    Parameters
    ----------
    palms, target_palms : (f, 3) arrays of float
        The hand in the source and in the target, pose after pose.
    lines : sequence of BodyLine
        Other parts of the body.
    arm : float
        Length of the source's arm.
    turn : (3, 3) array of float
        How the target is turned against the source, times how many times as large it is.

    Returns
    -------
    (f, 3) array of float
        The shift; it fades as the hand leaves the body.
    """
    distances, shifts = [], []
    for line in lines:
        start, along = line.source[:, 0], line.source[:, 1] - line.source[:, 0]
        share = shares_along(palms, start, along)[:, None]
        away = palms - start - share * along
        place = line.target[:, 0] + share * (line.target[:, 1] - line.target[:, 0])
        distances.append(np.linalg.norm(away, axis=1) / arm)
        shifts.append(line.share * (place + away @ turn.T - target_palms))
    if not lines:
        return np.zeros_like(palms)
    far = np.array(distances)  # (l, f)
    nearest = far.min(axis=0)
    weights = (np.maximum(nearest, 1e-6) / np.maximum(far, 1e-6)) ** _SHARPNESS
    blended: Floats = np.einsum("lf,lfi->fi", weights / weights.sum(axis=0), np.array(shifts))
    free = eased((nearest - _TOUCHING) / (_APART - _TOUCHING))
    return (1 - free)[:, None] * blended
