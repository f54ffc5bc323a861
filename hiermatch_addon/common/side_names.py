# SPDX-License-Identifier: GPL-3.0-or-later
"""Names of the left and the right side: "Arm.L" and "Arm.R", "hand_l", "LeftFoot"."""

from __future__ import annotations

from typing import TYPE_CHECKING

import bpy
import numpy as np

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray


def flipped_name(name: str) -> str:
    """Return the name of the same thing on the other side; the name itself if it has no side.

    What stands before a colon, as in "rig:LeftArm", stays.
    """
    space, colon, own = name.rpartition(":")
    return space + colon + bpy.utils.flip_name(own)


def side_of(name: str) -> int:
    """Return 1 for a name of the left side, -1 for one of the right, 0 for others."""
    for mine, other in zip(name, flipped_name(name), strict=False):
        if mine != other:
            return 1 if mine in "lL" else -1
    return 0


def partners(names: Sequence[str]) -> NDArray[np.int64]:
    """Return for each of k names which of them names the other side, (k,): itself without a side, -1 if it lacks."""
    places = {name: place for place, name in enumerate(names)}
    return np.array([places.get(flipped_name(name), -1) for name in names], np.int64)
