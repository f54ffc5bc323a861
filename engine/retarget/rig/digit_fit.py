# SPDX-License-Identifier: GPL-3.0-or-later
"""Fitting of hands and paws from many poses, as digits are easily taken for one another."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from scipy.sparse import csr_array
from scipy.spatial.transform import Rotation

from ...mesh.closest_points import FoundPoints
from ...mesh.triangle_mesh import TriangleMesh
from ...runtime.arrays import Floats, unit_vectors
from .articulated_hand import Hand, HandPose, HandSolver
from .bone_fit import BoneTransforms, skinned
from .digit_groups import digit_groups
from .skeleton import Skeleton

_ROLLS = (0.0, 30.0, -30.0, 60.0, -60.0, 180.0)
"""Degrees by which the palm is turned around its own axis to begin with."""

_CURLS = (0.0, 35.0, -35.0)
"""Degrees by which each joint of the digits is bent to begin with."""

_TURN = 25.0
"""Degrees by which the best poses are turned and bent anew."""

_FIRST_ROUNDS, _LAST_ROUNDS, _KEPT = 6, 24, 3
"""Rounds for every start, rounds for the best after them, and how many best there are."""

_GOOD = 0.04
"""Cost of a pose that nothing better is sought for: about that of samples of one and the same hand."""

_CLEARLY = 0.95
"""A pose is taken that costs less than this part of what the pose costs that was found first."""


def with_digits(
    body: TriangleMesh,
    weights: csr_array,
    skeleton: Skeleton,
    target: TriangleMesh,
    matches: FoundPoints,
    *,
    bones: BoneTransforms,
) -> BoneTransforms:
    """Pose the hands anew where another pose fits the target clearly better.

    Each hand, with the end of the limb that it hangs on, is laid onto that part of the target by an articulated form of
    iterative closest points, from many poses of the palm and the digits.

    Parameters
    ----------
    body : TriangleMesh
        The body at rest, n vertices.
    weights : (n, b) csr_array of float
        How the bones move it.
    skeleton : Skeleton
        The bones.
    target : TriangleMesh
        The target, m vertices.
    matches : FoundPoints
        For each vertex of the target a point of the body, m: right about which hand it is, if not which finger.
    bones : BoneTransforms
        The pose that was found first.

    Returns
    -------
    BoneTransforms
        The same with other transforms for the bones of some hands.
    """
    for group in digit_groups(skeleton, body.vertex_areas / body.area @ weights):
        hand = Hand.of(group, body, weights, skeleton, target, matches=matches)
        if hand is not None:
            bones = _PoseSearch(hand, bones).result()
    return replace(bones, posed=skinned(body.vertices, weights, bones.linear, bones.translations))


class _PoseSearch:
    """Tries many poses of one hand, beginning with the one that its bones have."""

    def __init__(self, hand: Hand, bones: BoneTransforms) -> None:
        self._hand, self._bones = hand, bones
        self._found = self._pose_of(bones)
        self._solver = HandSolver(hand, float(np.median(self._found.scales)) * hand.length, self._found)
        self._axes = _hand_axes(hand)

    def result(self) -> BoneTransforms:
        """Return the bones in the best pose if it is clearly better than the one that they have, or as they are."""
        first = self._solver.improved(self._found, 0.3, _LAST_ROUNDS)
        usual = min(first.cost, self._solver.cost(self._found))
        if usual < _GOOD:
            return self._bones
        best = self._best()
        return self._with_pose(best) if best.cost < _CLEARLY * usual else self._bones

    def _best(self) -> HandPose:
        """Find the best of many poses: first rough ones all around, then such near the best of them."""
        found, solver = self._found, self._solver
        stretched = replace(found, rotations=np.repeat(found.rotations[:1], len(self._hand.numbers), axis=0))
        starts = [
            solver.improved(self._straight(base, roll, curl), 0.0, _FIRST_ROUNDS)
            for base in (found, stretched)
            for roll in _ROLLS
            for curl in _CURLS
        ]
        starts = sorted(starts, key=lambda pose: pose.cost)[:_KEPT]
        near = [
            solver.improved(self._turned(pose, turn, curl), 0.0, _FIRST_ROUNDS)
            for pose in starts
            for turn, curl in self._variations()
        ]
        starts = sorted([*starts, *near], key=lambda pose: pose.cost)[:_KEPT]
        return min([solver.improved(start, 0.3, _LAST_ROUNDS) for start in starts], key=lambda pose: pose.cost)

    def _with_pose(self, pose: HandPose) -> BoneTransforms:
        """Give the hand's own bones a pose."""
        bones = self._bones
        wrist = self._hand.skeleton.heads[self._hand.group.hub]
        linear, translations = bones.linear.copy(), bones.translations.copy()
        rotations, scales = bones.rotations.copy(), bones.scales.copy()
        own = self._hand.numbers[1:]
        linear[own] = pose.unknowns[1:, :3].transpose(0, 2, 1)
        translations[own] = pose.unknowns[1:, 3] - np.einsum("kij,j->ki", linear[own], wrist)
        rotations[own], scales[own] = pose.rotations[1:], pose.scales[1:]
        return replace(bones, linear=linear, translations=translations, rotations=rotations, scales=scales)

    def _pose_of(self, bones: BoneTransforms) -> HandPose:
        """Pose of the hand, around its wrist, that bones have."""
        wrist = self._hand.skeleton.heads[self._hand.group.hub]
        linear = bones.linear[self._hand.numbers]
        shift = bones.translations[self._hand.numbers] + np.einsum("kij,j->ki", linear, wrist)
        unknowns = np.concatenate([linear.transpose(0, 2, 1), shift[:, None]], axis=1)
        return HandPose(unknowns, bones.rotations[self._hand.numbers], bones.scales[self._hand.numbers])

    def _variations(self) -> list[tuple[Floats, float]]:
        """List small turns of the hand, vectors of rotation in degrees at rest, and bends of all joints of digits."""
        along, across = self._axes
        turns = [sign * _TURN * axis for axis in (along, across, np.cross(along, across)) for sign in (1, -1)]
        return [(turn, 0.0) for turn in turns] + [(np.zeros(3), _TURN), (np.zeros(3), -_TURN)]

    def _straight(self, base: HandPose, roll: float, curl: float) -> HandPose:
        """Turn the palm around its axis, straighten the digits, and curl them."""
        along, _ = self._axes
        palm = base.rotations[1] @ _turn(roll * along)
        return self._arranged(base, np.repeat(palm[None], len(self._hand.numbers), axis=0), curl)

    def _turned(self, base: HandPose, turn: Floats, curl: float) -> HandPose:
        """Turn the hand at the wrist, and bend the digits more."""
        palm = base.rotations[1]
        return self._arranged(base, palm @ _turn(turn) @ palm.T @ base.rotations, curl)

    def _arranged(self, base: HandPose, rotations: Floats, curl: float) -> HandPose:
        """Give the hand's own bones rotations (k, 3, 3), and more bend the farther out; joints stay together."""
        skeleton, group = self._hand.skeleton, self._hand.group
        place = {int(bone): number for number, bone in enumerate(self._hand.numbers)}
        bend = _turn(curl * self._axes[1])
        size = float(np.median(base.scales))
        turns, unknowns = base.rotations.copy(), base.unknowns.copy()
        turns[1:] = rotations[1:]
        for chain in group.chains:
            more = np.eye(3)
            for bone in chain:
                more = more @ bend
                turns[place[bone]] = rotations[place[bone]] @ more
        for bone in group.bones:  # the palm first, and each digit from the palm outwards
            number, parent = place[int(bone)], place[int(skeleton.parents[bone])]
            head = skeleton.heads[bone] - skeleton.heads[group.hub]
            linear = size * turns[number]
            there = head @ unknowns[parent, :3] + unknowns[parent, 3]
            unknowns[number, :3], unknowns[number, 3] = linear.T, there - linear @ head
        scales = np.concatenate([base.scales[:1], np.full(len(self._hand.numbers) - 1, size)])
        return HandPose(unknowns, turns, scales)


def _hand_axes(hand: Hand) -> tuple[Floats, Floats]:
    """Direction from the wrist to the knuckles at rest, and that of the knuckles, (3,) each."""
    knuckles = hand.skeleton.heads[[chain[0] for chain in hand.group.chains]]
    along = unit_vectors(knuckles.mean(axis=0) - hand.skeleton.heads[hand.group.hub])
    across = np.linalg.svd(knuckles - knuckles.mean(axis=0))[2][0]
    return along, unit_vectors(across - (across @ along) * along)


def _turn(degrees: Floats) -> Floats:
    """Rotation (3, 3) by a vector of degrees."""
    return Rotation.from_rotvec(np.radians(degrees)).as_matrix()
