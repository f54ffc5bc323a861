# SPDX-License-Identifier: GPL-3.0-or-later
"""Directions in which almost straight limbs are bent: control rigs read from them which way elbows and knees go."""

from __future__ import annotations

import numpy as np

from ...runtime.arrays import Floats, Ints, unit_vectors
from .skeleton import Skeleton

_LEAST = 2e-3
"""Least way from a joint to the line between those beside it, in units of the length of that line, that is a bend."""

_KEPT = 0.5
"""Part of the bend, in the same units, that is left at least."""

_MOST = 0.05
"""Most that a joint is moved by, in the same units: what is bent more is another pose."""


def kept_bends(skeleton: Skeleton, heads: Floats, tails: Floats, turns: Floats, places: Ints) -> tuple[Floats, Floats]:
    """Bend limbs that came out straight, or bent a little the wrong way, as they were.

    Parameters
    ----------
    skeleton : Skeleton
        The bones before, b.
    heads, tails : (b, 3) array of float
        Their ends now.
    turns : (b, 3, 3) array of float
        How the body around each is turned.
    places : (2 b,) array of int
        For all heads, and then all tails, the number of their place: what is at one place, stays there.

    Returns
    -------
    heads, tails : (b, 3) array of float
        With joints in the middle of a limb moved where necessary.
    """
    before, after = skeleton.joints, np.concatenate([heads, tails])
    count = len(skeleton)
    for bone in skeleton.order:
        parent = skeleton.parents[bone]
        if parent < 0 or places[bone] != places[count + parent]:
            continue
        ends = parent, bone, count + bone  # where the parent begins, where both meet, where the bone ends
        bend, length = _bend(before[list(ends)])
        now, new_length = _bend(after[list(ends)])
        if not length * new_length > 0 or np.linalg.norm(bend) < _LEAST * length:
            continue
        line = unit_vectors(after[ends[2]] - after[ends[0]])
        wanted = (turns[parent] + turns[bone]) @ bend
        wanted -= (wanted @ line) * line
        direction = unit_vectors(wanted)
        least = _KEPT * np.linalg.norm(bend) / length * new_length
        lacking = least - now @ direction
        if 0 < lacking < _MOST * new_length:
            after[places == places[bone]] += lacking * direction
    return after[:count], after[count:]


def _bend(joints: Floats) -> tuple[Floats, float]:
    """Find the way (3,) to the second of three joints from the line between the others, and the length of that."""
    start, middle, end = joints
    line = end - start
    length = float(np.linalg.norm(line))
    if length <= 0:
        return np.zeros(3), 0.0
    return middle - start - ((middle - start) @ line) / length**2 * line, length
