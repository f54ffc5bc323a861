# SPDX-License-Identifier: GPL-3.0-or-later
"""Rotations between rest poses: trunks and feet that differ little are built otherwise, and not posed otherwise."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from ...geometry.procrustes import least_turns
from ...runtime.arrays import Floats, Ints, unit_vectors
from ..rig.skeleton import Skeleton
from .bone_pairing import BonePairing
from .limbs import Limb
from .segments import Segments

_BUILT = np.radians(60.0)
"""Up to this angle a trunk or a foot is built in another way: more is a body that lies, or a foot that hangs.  Chosen
by strips of walks and runs, horse to cow, and fox to dog and cat, whose paws are up to 56 degrees apart."""


def posed_rotations(
    pairing: BonePairing, segments: Segments, limbs: Sequence[Limb], trees: tuple[Skeleton, Skeleton], up: Floats
) -> Floats:
    """Rotations by which the rest poses of two rigs differ, without those that come from how the bodies are built.

    A cow's back falls off where a horse's does not, and heels are higher or lower.  The cow is to walk as level as it
    stands, so its trunk turns as much as the horse's, from its own rest; and so do feet.  What a finger's small surface
    tells is not enough: joints tell how it is bent.

    Parameters
    ----------
    pairing : BonePairing
        The pairs, k.
    segments : Segments
        What stands for what.
    limbs : sequence of Limb
        Legs and arms among them.
    trees : pair of Skeleton
        The source's and the target's bones at rest.
    up : (3,) array of float
        Direction away from the ground in the target's space, of length one.

    Returns
    -------
    (k, 3, 3) array of float
        As `pairing.rotations`; but as `pairing.upright` where the trunk, which carries half of the limbs, and feet are
        turned against that by less than it takes to lie or hang; feet however far around the axis on which they stand,
        because none stands backwards: only the map of a thin leg may be turned around it.  So legs that stand are bent
        but not twisted.  Toes rest as their feet do, and fingers are bent against their hands but not twisted.
    """
    rotations = pairing.rotations.copy()
    cosines = (np.einsum("kij,ij->k", rotations, pairing.upright) - 1) / 2
    tilts = rotations @ pairing.upright.T @ up @ up
    above = [segments.above(part) for part in range(len(segments))]
    ends = {limb.parts[1]: limb.foot for limb in limbs}
    carriers = [sum(part in above[limb.parts[0]] for limb in limbs) for part in range(len(segments))]
    legs = {part for limb in limbs if limb.foot for part in (*limb.parts, *above[limb.parts[0]]) if carriers[part] < 2}
    for part in sorted(range(len(segments)), key=lambda part: len(above[part])):
        rows, carried = segments.rows[part], carriers[part]
        standing = [ends[each] for each in above[part] if each in ends][:1]
        is_trunk = carried > 1 and 2 * carried >= len(limbs)
        if is_trunk or standing == [True]:
            turned = cosines if is_trunk else tilts
            rotations[rows[turned[rows] > np.cos(_BUILT)]] = pairing.upright
        if part in legs and not is_trunk:
            along = _next_joints(trees[0], pairing.sources[rows])
            told = along.any(axis=1)
            goals = np.einsum("kij,kj->ki", rotations[rows], along)
            rotations[rows[told]] = least_turns(along[told] @ pairing.upright.T, goals[told]) @ pairing.upright
        if set(above[part][1:]) & set(ends):
            held = rotations[segments.rows[above[part][0]][0]]
            starts = _next_joints(trees[0], pairing.sources[rows]) @ held.T
            goals = _next_joints(trees[1], pairing.targets[rows])
            told = starts.any(axis=1) & goals.any(axis=1)
            rotations[rows] = held
            if standing == [False]:
                rotations[rows[told]] = least_turns(starts[told], goals[told]) @ held
    return rotations


def _next_joints(tree: Skeleton, bones: Ints) -> Floats:
    """Directions from bones (k,) to the one that hangs on each, (k, 3); zero where none or several do."""
    below = [tree.children(int(bone)) for bone in bones]
    ends = [each[0] if len(each) == 1 else bone for bone, each in zip(bones, below, strict=True)]
    return unit_vectors(tree.heads[ends] - tree.heads[bones])
