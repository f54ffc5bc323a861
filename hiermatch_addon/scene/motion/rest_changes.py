# SPDX-License-Identifier: GPL-3.0-or-later
"""Rest poses of bones as they are remembered, and what became of the space of their armature since then."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from ....engine import nearest_similarity
from ..armatures import armature_of

if TYPE_CHECKING:
    from collections.abc import Sequence

    import bpy
    from numpy.typing import NDArray

REST_NUMBERS = 9
"""How many numbers are remembered of a bone: head, tail, and a point beside the head, which shows turns about it."""

_SAME = 0.02
"""How far the ends of a bone may lie from where the others take them, as part of the extent of all, for it to have
gone along: on a person a joint of a finger, or a hand that is turned by some twenty degrees.  Guessed; Apply leaves a
part in a million, and a pose that is applied as rest pose moves whole limbs.
"""

_ALIKE = 0.999
"""Part of the largest agreement from which on two similarities count as equally good, and the first one is taken: of
bones in a line, heads and tails do not say how they are turned about it.  Rounding costs a part in ten thousand.
"""


def rest_points(armature: bpy.types.Object, names: Sequence[str]) -> NDArray[np.float64]:
    """Return what is remembered of bones at rest, in the armature's own space, (n, 9)."""
    bones = [armature_of(armature).bones[name] for name in names]
    points = [
        (bone.head_local, bone.tail_local, bone.head_local + bone.matrix_local.to_3x3().col[2] * bone.length)
        for bone in bones
    ]
    return np.array(points, np.float64).reshape(-1, REST_NUMBERS)


def change_of_rest(
    then: NDArray[np.float64], now: NDArray[np.float64]
) -> tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.bool_]]:
    """Find the similarity that most bones went through since they were remembered, such as an applied scale.

    It is the one of all bones, with or without the turns about themselves, or of one of them; whichever most others,
    by their length, agree with.

    Parameters
    ----------
    then, now : (n, 9) array of float
        Bones as `rest_points` returns them; zeros for one of which nothing is remembered.

    Returns
    -------
    linear : (3, 3) array of float
        A rotation times a scale.
    translation : (3,) array of float
        What is added then.
    held : (n,) array of bool
        Which bones went along; those of which nothing is remembered count as such.
    """
    known = then.any(axis=1)
    if not known.any():
        return np.eye(3), np.zeros(3), ~known
    before, after = then.reshape(-1, 3, 3), now.reshape(-1, 3, 3)
    start, goal = before[known], after[known]
    near = _SAME * float(np.ptp(goal.reshape(-1, 3), axis=0).max())
    lengths = np.linalg.norm(goal[:, 1] - goal[:, 0], axis=1)
    found = [
        nearest_similarity(start[:, :count].reshape(-1, 3), goal[:, :count].reshape(-1, 3)) for count in (3, 2)
    ] + [nearest_similarity(one, other) for one, other in zip(start, goal, strict=True)]
    agreeing = np.array([lengths @ np.maximum(0, 1 - _ways(start, goal, change) / near) for change in found])
    best = found[int(np.argmax(agreeing >= _ALIKE * agreeing.max()))]
    return *best, ~known | (_ways(before, after, best) <= near)


def _ways(
    before: NDArray[np.float64], after: NDArray[np.float64], change: tuple[NDArray[np.float64], NDArray[np.float64]]
) -> NDArray[np.float64]:
    """Return how far each bone's ends lie from where a similarity takes them, the farther one of both, (n,)."""
    linear, translation = change
    return np.linalg.norm(before[:, :2] @ linear.T + translation - after[:, :2], axis=2).max(axis=1)
