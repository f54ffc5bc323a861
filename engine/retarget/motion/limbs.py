# SPDX-License-Identifier: GPL-3.0-or-later
"""Limbs of two bones and what is at their ends, such as legs and arms, found in two paired rigs."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from ...mesh.connectivity.edge_chains import way_to_root
from ...runtime.arrays import TINY, Floats, Ints
from ..rig.skeleton import Skeleton
from .posed_motion import Motion
from .segments import Segments

_NEAR_GROUND = 0.15
"""How high the end of a leg may be above the lowest joint at rest, in units of the rig's height."""

_SHORTEST = 0.1
"""Least length of a limb, in units of the largest extent of the rig: what is shorter is a finger or an ear."""

_TIP = 0.75
"""Part of the length before it that the last bone of a limb counts at most when the two longest parts are chosen.

FBX and glTF know no ends of bones: importers make a foot without toes as long as its shin.
"""

Joint = tuple[int, bool]
"""A bone, and whether its tail is meant and not its head."""


@dataclass(frozen=True, eq=False)
class Limb:
    """A limb: two segments in a row, in both rigs.

    Attributes
    ----------
    parts : (int, int)
        The upper and the lower segment.
    upper, lower : arrays of int
        The target's bones in them.
    source_joints, target_joints : tuple of five joints
        Where the upper segment begins, the lower one begins and ends; and the last two joints of all that hangs on it,
        such as ankle and ball of a foot: the end again where nothing does.
    foot : bool
        Whether it reaches down to the ground in both rigs.
    source_length, target_length : float
        Length at rest, of both segments and of what is between them and the last two joints.
    """

    parts: tuple[int, int]
    upper: Ints
    lower: Ints
    source_joints: tuple[Joint, Joint, Joint, Joint, Joint]
    target_joints: tuple[Joint, Joint, Joint, Joint, Joint]
    foot: bool
    source_length: float
    target_length: float

    def joints(self, posed: Motion) -> Floats:
        """Where the target's upper segment begins, the lower one begins, and ends, (f, 3, 3)."""
        return np.stack([_place(posed, joint) for joint in self.target_joints[:3]], axis=-2)

    def target_points(self, posed: Motion | Skeleton) -> Floats:
        """Where the last two joints of the target's limb are, (f, 2, 3) or (2, 3)."""
        return np.stack([_place(posed, joint) for joint in self.target_joints[3:]], axis=-2)

    def source_points(self, posed: Motion | Skeleton) -> Floats:
        """Return the same two of the source."""
        return np.stack([_place(posed, joint) for joint in self.source_joints[3:]], axis=-2)


def _place(posed: Motion | Skeleton, joint: Joint) -> Floats:
    return (posed.tails if joint[1] else posed.heads)[..., joint[0], :]


def limbs_of(segments: Segments, source: Skeleton, target: Skeleton, ups: Floats) -> list[Limb]:
    """Find the limbs: of each way from a tip up to the trunk the two longest segments in a row.

    Parameters
    ----------
    segments : Segments
        What stands for what in the two rigs.
    source, target : Skeleton
        Their bones at rest.
    ups : (2, 3) array of float
        Directions away from the ground in either's space, of length one.

    Returns
    -------
    list of Limb
        Legs and arms, wings, and whatever else is bent in two.
    """
    lowest, heights, extents = [], [], []
    for tree, bones, up in ((source, segments.sources, ups[0]), (target, segments.targets, ups[1])):
        used = np.concatenate([np.zeros(0, np.int64), *bones])
        levels = np.concatenate([tree.heads[used], tree.tails[used]])
        lowest.append((levels @ up).min(initial=np.inf))
        heights.append(np.ptp(levels @ up) if len(levels) else 0.0)
        extents.append(np.ptp(levels, axis=0).max() if len(levels) else 0.0)
    found: dict[tuple[int, int], Limb] = {}
    bearing: list[set[int]] = [set() for _ in range(len(segments))]
    ways = []
    branches = np.bincount(segments.parents[segments.parents >= 0], minlength=len(segments))
    for tip in np.flatnonzero(branches == 0):
        way = way_to_root(segments.parents, tip)
        starts = [[(int(bones[part][0]), False) for part in way] for bones in (segments.sources, segments.targets)]
        ends = [
            [(int(bones[tip][-1]), True), *begin[:-1]]
            for bones, begin in ((segments.sources, starts[0]), (segments.targets, starts[1]))
        ]
        lengths = np.array(
            [
                [np.linalg.norm(_place(tree, a) - _place(tree, b)) for a, b in zip(*each, strict=True)]
                for tree, *each in ((source, starts[0], ends[0]), (target, starts[1], ends[1]))
            ]
        )
        reaches = np.cumsum(lengths, axis=1)  # from the tip
        for (below, part), reach in zip(pairwise(way), reaches.T, strict=False):
            if (reach > _SHORTEST * np.array(extents)).all():
                bearing[part].add(below)
        ways.append((way, starts, ends, lengths))
    for way, starts, ends, lengths in ways:
        # Nothing as long as a limb hangs beside the way: a back is followed by legs and is none.
        free = [not bearing[part] - {below} for below, part in pairwise([-1, *way])]
        pairs = [number for number in range(len(way) - 2) if branches[way[number + 1]] == 1 and all(free[: number + 1])]
        if not pairs:
            continue
        shares = lengths / np.maximum(np.array(extents), TINY)[:, None]
        shares[:, 0] = np.minimum(shares[:, 0], _TIP * shares[:, 1])
        low = max(pairs, key=lambda number: (shares[:, number] + shares[:, number + 1]).sum())
        last = min(low, 2)
        long = lengths[:, last : low + 2].sum(axis=1)
        key = way[low + 1], way[low]
        if key in found or (long < _SHORTEST * np.array(extents)).any():
            continue
        joints = []
        for side in range(2):
            beyond = ends[side][last], ends[side][max(last - 1, 0)]
            joints.append((starts[side][low + 1], starts[side][low], ends[side][low], *beyond))
        reach = [
            min(_place(tree, joint) @ up for joint in each[3:]) - level
            for tree, each, up, level in zip((source, target), joints, ups, lowest, strict=True)
        ]
        foot = all(high < _NEAR_GROUND * height for high, height in zip(reach, heights, strict=True))
        bones = segments.targets[key[0]], segments.targets[key[1]]
        found[key] = Limb(key, *bones, joints[0], joints[1], foot, float(long[0]), float(long[1]))
    return list(found.values())
