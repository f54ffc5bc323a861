# SPDX-License-Identifier: GPL-3.0-or-later
"""Hands and paws: several digits that look alike are easily taken for one another, so that many poses are tried."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np
from scipy.spatial.transform import Rotation

from .bone_fit import skinned
from .procrustes import nearest_rotations

if TYPE_CHECKING:
    from numpy.typing import NDArray
    from scipy.sparse import csr_array

    from .bone_fit import BoneTransforms
    from .closest_points import FoundPoints
    from .mesh import TriangleMesh
    from .skeleton import Skeleton

__all__ = ["DigitGroup", "digit_groups", "with_digits"]

_LEAST_CHAINS = 3
"""Digits from which on they can be mistaken."""

_MOST_AREA = 0.15
"""Largest part of the body's area that a hand has: legs around a trunk are no digits."""

_ROLLS = (0.0, 30.0, -30.0, 60.0, -60.0, 180.0)
"""Degrees by which the palm is turned around its own axis to begin with."""

_CURLS = (0.0, 35.0, -35.0)
"""Degrees by which each joint of the digits is bent to begin with."""

_TURN = 25.0
"""Degrees by which the best poses are turned and bent anew."""

_SAMPLES = 350
"""Points of either surface that are compared."""

_FIRST_ROUNDS, _LAST_ROUNDS, _KEPT = 6, 24, 3
"""Rounds for every start, rounds for the best after them, and how many best there are."""

_GOOD = 0.04
"""Cost of a pose that nothing better is sought for: about that of samples of one and the same hand."""

_WIDE, _NARROW = 0.35, 0.06
"""Distance at which a match counts half, at first and at last, in lengths of the hand."""

_NORMALS = (0.25, 0.08)
"""How much a unit of difference of the normals counts, at first and at last, in lengths of the hand."""

_STIFF, _LOOSE = 3.0, 0.3
"""How much a transform that is no similarity counts, at first and at last."""

_JOINT = 10.0
_HELD = 100.0
"""How much joints that come apart count, and how much the bone that the hand hangs on is held."""

_CLEARLY = 0.95
"""A pose is taken that costs less than this part of what the pose costs that was found first."""

_UNTWIST = 0.7
"""How much is taken back, in each round, of a digit's turn around itself, which its joints hardly allow: free to turn,
the digits take hold of one another's surfaces."""

_TINY = np.finfo(float).tiny


@dataclass(frozen=True)
class DigitGroup:
    """A bone with several digits, each a chain of bones.

    Attributes
    ----------
    above : int
        The bone that it hangs on.
    hub : int
        The bone of the palm.
    chains : tuple of tuple of int
        The bones of each digit, from the palm outwards.
    """

    above: int
    hub: int
    chains: tuple[tuple[int, ...], ...]

    @property
    def bones(self) -> NDArray[np.int64]:
        """The palm and all digits."""
        return np.array([self.hub, *(bone for chain in self.chains for bone in chain)])


def digit_groups(skeleton: Skeleton, mass: NDArray[np.float64]) -> list[DigitGroup]:
    """Find the hands of a skeleton.

    Parameters
    ----------
    skeleton : Skeleton
        The bones, b.
    mass : (b,) array of float
        Area that each moves, as a part of the body's.
    """
    groups = []
    for hub in range(len(skeleton)):
        chains = []
        for first in skeleton.children(hub):
            chain = [int(first)]
            while len(skeleton.children(chain[-1])) == 1:
                chain.append(int(skeleton.children(chain[-1])[0]))
            if len(chain) > 1 and not len(skeleton.children(chain[-1])) and all(mass[bone] > 0 for bone in chain):
                chains.append(tuple(chain))
        above = int(skeleton.parents[hub])
        group = DigitGroup(above, hub, tuple(chains))
        alone = above >= 0 and mass[above] > 0 and mass[hub] > 0
        if len(chains) >= _LEAST_CHAINS and alone and mass[group.bones].sum() < _MOST_AREA:
            groups.append(group)
    return groups


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
    mass = body.vertex_areas / body.area @ weights
    for group in digit_groups(skeleton, mass):
        hand = _Hand.of(group, body, weights, skeleton, target, matches=matches)
        if hand is not None:
            bones = hand.posed_anew(bones)
    return replace(bones, posed=skinned(body.vertices, weights, bones.linear, bones.translations))


def _spread_out(points: NDArray[np.float64], count: int) -> NDArray[np.int64]:
    """Choose so many points, each the farthest from those before it."""
    if len(points) <= count:
        return np.arange(len(points))
    chosen = np.empty(count, np.int64)
    nearest = np.square(points - points.mean(axis=0)).sum(axis=1)
    chosen[0] = nearest.argmax()
    nearest = np.full(len(points), np.inf)
    for number in range(1, count):
        nearest = np.minimum(nearest, np.square(points - points[chosen[number - 1]]).sum(axis=1))
        chosen[number] = nearest.argmax()
    return chosen


@dataclass(frozen=True, eq=False)
class _Pose:
    """Transforms of the k bones of a hand, rows of 4 by 3: the transposed linear parts, and the translations."""

    unknowns: NDArray[np.float64]  # (k, 4, 3)
    rotations: NDArray[np.float64]  # (k, 3, 3)
    scales: NDArray[np.float64]  # (k,)
    cost: float = np.inf


@dataclass(frozen=True, eq=False)
class _Hand:
    """One hand of the body and the part of the target where it is.

    Attributes
    ----------
    group : DigitGroup
        Its bones.
    skeleton : Skeleton
        All bones.
    numbers : (k,) array of int
        The bone that it hangs on, and its own.
    points, normals : (s, 3) array of float
        Of the body at rest.
    weights : (s, k) array of float
        How the k bones move the points.
    places, sides : (t, 3) array of float
        Points of the target, and their normals.
    length : float
        Of the hand, at rest.
    """

    group: DigitGroup
    skeleton: Skeleton
    numbers: NDArray[np.int64]
    points: NDArray[np.float64]
    normals: NDArray[np.float64]
    weights: NDArray[np.float64]
    places: NDArray[np.float64]
    sides: NDArray[np.float64]
    length: float

    @classmethod
    def of(
        cls,
        group: DigitGroup,
        body: TriangleMesh,
        weights: csr_array,
        skeleton: Skeleton,
        target: TriangleMesh,
        *,
        matches: FoundPoints,
    ) -> _Hand | None:
        """Cut the hand out of both surfaces; None if one of them has none."""
        tips = skeleton.tails[[chain[-1] for chain in group.chains]]
        wrist = skeleton.heads[group.hub]
        length = float(np.median(np.linalg.norm(tips - wrist, axis=1)))
        own = np.asarray(weights[:, group.bones].sum(axis=1)).ravel()
        above = np.asarray(weights[:, [group.above]].sum(axis=1)).ravel()
        near = np.linalg.norm(body.vertices - wrist, axis=1) < length / 2
        belongs = (own > 0.5) | ((own + above > 0.5) & near)
        corners = body.triangles[matches.triangles]
        there = np.einsum("mc,mc->m", matches.barycentric, belongs[corners].astype(float)) > 0.5
        if belongs.sum() < 4 * len(group.bones) or there.sum() < 2 * len(group.bones):
            return None
        numbers = np.array([group.above, *group.bones])
        chosen = np.flatnonzero(belongs)
        chosen = chosen[_spread_out(body.vertices[chosen], _SAMPLES)]
        seen = np.flatnonzero(there)
        seen = seen[_spread_out(target.vertices[seen], _SAMPLES)]
        shares = weights[chosen][:, numbers].toarray()
        shares /= np.maximum(shares.sum(axis=1, keepdims=True), _TINY)
        return cls(
            group,
            skeleton,
            numbers,
            body.vertices[chosen] - wrist,
            body.vertex_normals[chosen],
            shares,
            target.vertices[seen],
            target.vertex_normals[seen],
            length,
        )

    def posed_anew(self, bones: BoneTransforms) -> BoneTransforms:
        """Try many poses, and take the best if it is clearly better than the one of the bones."""
        found = self._pose_of(bones)
        solver = _Solver(self, float(np.median(found.scales)) * self.length, found)
        first = solver.improved(found, 0.3, _LAST_ROUNDS)
        usual = min(first.cost, solver.cost(found))
        if usual < _GOOD:
            return bones
        best = self._best(solver, found)
        return self._with_pose(bones, best) if best.cost < _CLEARLY * usual else bones

    def _best(self, solver: _Solver, found: _Pose) -> _Pose:
        """Find the best of many poses: first rough ones all around, then such near the best of them."""
        stretched = replace(found, rotations=np.repeat(found.rotations[:1], len(self.numbers), axis=0))
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
        ends = [solver.improved(start, 0.3, _LAST_ROUNDS) for start in starts]
        return min(ends, key=lambda pose: pose.cost)

    def _with_pose(self, bones: BoneTransforms, pose: _Pose) -> BoneTransforms:
        """Give the hand's own bones a pose."""
        wrist = self.skeleton.heads[self.group.hub]
        linear, translations = bones.linear.copy(), bones.translations.copy()
        rotations, scales = bones.rotations.copy(), bones.scales.copy()
        own = self.numbers[1:]
        linear[own] = pose.unknowns[1:, :3].transpose(0, 2, 1)
        translations[own] = pose.unknowns[1:, 3] - np.einsum("kij,j->ki", linear[own], wrist)
        rotations[own], scales[own] = pose.rotations[1:], pose.scales[1:]
        return replace(bones, linear=linear, translations=translations, rotations=rotations, scales=scales)

    def _pose_of(self, bones: BoneTransforms) -> _Pose:
        """Pose of the hand, around its wrist, that bones have."""
        wrist = self.skeleton.heads[self.group.hub]
        linear = bones.linear[self.numbers]
        shift = bones.translations[self.numbers] + np.einsum("kij,j->ki", linear, wrist)
        unknowns = np.concatenate([linear.transpose(0, 2, 1), shift[:, None]], axis=1)
        return _Pose(unknowns, bones.rotations[self.numbers], bones.scales[self.numbers])

    def _axes(self) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Direction from the wrist to the knuckles at rest, and that of the knuckles, (3,) each."""
        knuckles = self.skeleton.heads[[chain[0] for chain in self.group.chains]]
        along = knuckles.mean(axis=0) - self.skeleton.heads[self.group.hub]
        along /= max(float(np.linalg.norm(along)), _TINY)
        across = np.linalg.svd(knuckles - knuckles.mean(axis=0))[2][0]
        across -= (across @ along) * along
        return along, across / max(float(np.linalg.norm(across)), _TINY)

    def _variations(self) -> list[tuple[NDArray[np.float64], float]]:
        """List small turns of the hand, vectors of rotation in degrees at rest, and bends of all joints of digits."""
        along, across = self._axes()
        turns = [sign * _TURN * axis for axis in (along, across, np.cross(along, across)) for sign in (1, -1)]
        return [(turn, 0.0) for turn in turns] + [(np.zeros(3), _TURN), (np.zeros(3), -_TURN)]

    def _straight(self, base: _Pose, roll: float, curl: float) -> _Pose:
        """Turn the palm around its axis, straighten the digits, and curl them."""
        along, _ = self._axes()
        palm = base.rotations[1] @ _turn(roll * along)
        return self._arranged(base, np.repeat(palm[None], len(self.numbers), axis=0), curl)

    def _turned(self, base: _Pose, turn: NDArray[np.float64], curl: float) -> _Pose:
        """Turn the hand at the wrist, and bend the digits more."""
        palm = base.rotations[1]
        return self._arranged(base, palm @ _turn(turn) @ palm.T @ base.rotations, curl)

    def _arranged(self, base: _Pose, rotations: NDArray[np.float64], curl: float) -> _Pose:
        """Give the hand's own bones rotations (k, 3, 3), and more bend the farther out; joints stay together."""
        skeleton, group = self.skeleton, self.group
        place = {int(bone): number for number, bone in enumerate(self.numbers)}
        bend = _turn(curl * self._axes()[1])
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
        scales = np.concatenate([base.scales[:1], np.full(len(self.numbers) - 1, size)])
        return _Pose(unknowns, turns, scales)


def _turn(degrees: NDArray[np.float64]) -> NDArray[np.float64]:
    """Rotation (3, 3) by a vector of degrees."""
    matrix: NDArray[np.float64] = Rotation.from_rotvec(np.radians(degrees)).as_matrix()
    return matrix


class _Solver:
    """Articulated closest points of one hand: everything that does not change from round to round."""

    def __init__(self, hand: _Hand, length: float, found: _Pose) -> None:
        self._hand, self._length, self._found = hand, length, found
        count = len(hand.numbers)
        ends = np.concatenate([hand.points, np.ones((len(hand.points), 1))], axis=1)
        self._design = (hand.weights[:, :, None] * ends[:, None, :]).reshape(len(ends), 4 * count)
        mass = hand.weights.mean(axis=0)
        centres = (hand.weights.T @ hand.points) / np.maximum(len(ends) * mass, _TINY)[:, None]
        spread = np.square(hand.points[:, None] - centres).sum(axis=2)
        self._moments = np.maximum((hand.weights * spread).mean(axis=0) / 3, 1e-6 * hand.length**2)
        self._moments[0] *= _HELD
        place = {int(bone): number for number, bone in enumerate(hand.numbers)}
        digits = hand.group.bones[1:]
        self._own = np.array([place[int(bone)] for bone in digits])
        self._above = np.array([place[int(bone)] for bone in hand.skeleton.parents[digits]])
        axes = hand.skeleton.tails[digits] - hand.skeleton.heads[digits]
        self._axes = axes / np.maximum(np.linalg.norm(axes, axis=1, keepdims=True), _TINY)
        self._ties = np.zeros((4 * count, 4 * count))
        for bone in hand.group.bones:
            child, parent = place[int(bone)], place[int(hand.skeleton.parents[bone])]
            head = hand.skeleton.heads[bone] - hand.skeleton.heads[hand.group.hub]
            row = np.zeros(4 * count)
            row[4 * child : 4 * child + 4] = [*head, 1.0]
            row[4 * parent : 4 * parent + 4] = [*-head, -1.0]
            self._ties += _JOINT * max(mass[child], 1e-3) * np.outer(row, row)
        # The limb that the hand hangs on is where it was found.
        self._anchor = np.zeros(4 * count)
        self._anchor[3] = _HELD * max(mass[0], 1e-3)

    def improved(self, pose: _Pose, begin: float, rounds: int) -> _Pose:
        """Match closest points and solve for the bones in turn, forgiving less and less; from `begin` of the way on."""
        for done in np.linspace(begin, 1.0, rounds):
            pose = self._round(pose, float(done))
        return replace(pose, cost=self.cost(pose))

    def _placed(self, pose: _Pose) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Points (s, 3) and normals of the hand in a pose."""
        points = self._design @ pose.unknowns.reshape(-1, 3)
        turns = (self._hand.weights @ pose.rotations.reshape(-1, 9)).reshape(-1, 3, 3)
        normals = np.einsum("sij,sj->si", turns, self._hand.normals)
        return points, normals / np.maximum(np.linalg.norm(normals, axis=1, keepdims=True), _TINY)

    def _found_pairs(
        self, pose: _Pose, reach: float
    ) -> tuple[NDArray[np.int64], NDArray[np.int64], NDArray[np.float64], NDArray[np.float64]]:
        """Match both ways: numbers in the hand and in the target, distances, and cosines of the normals."""
        hand = self._hand
        points, normals = self._placed(pose)
        here = np.concatenate([points, reach * normals], axis=1)
        there = np.concatenate([hand.places, reach * hand.sides], axis=1)
        # All pairs: so few points are compared faster than trees over them are built.
        apart = np.square(here).sum(axis=1)[:, None] + np.square(there).sum(axis=1) - 2 * here @ there.T
        onto, back = apart.argmin(axis=1), apart.argmin(axis=0)
        own = np.concatenate([np.arange(len(here)), back])
        other = np.concatenate([onto, np.arange(len(there))])
        distances = np.linalg.norm(points[own] - hand.places[other], axis=1)
        return own, other, distances, np.einsum("kd,kd->k", normals[own], hand.sides[other])

    def _round(self, pose: _Pose, done: float) -> _Pose:
        """One round."""
        hand, count = self._hand, len(self._hand.numbers)
        reach = self._length * (_NORMALS[0] + (_NORMALS[1] - _NORMALS[0]) * done)
        doubt = self._length * (_WIDE + (_NARROW - _WIDE) * done)
        own, other, distances, agree = self._found_pairs(pose, reach)
        trust = np.clip(agree, 0, 1) / (1 + (distances / doubt) ** 2)
        # Both surfaces count alike, however many points stand for them.
        trust /= np.where(np.arange(len(own)) < len(hand.points), len(hand.points), len(hand.places))
        per_point = np.bincount(own, trust, len(hand.points))
        drawn = np.stack(
            [np.bincount(own, trust * column, len(hand.points)) for column in hand.places[other].T], axis=1
        )
        pull = (_STIFF + (_LOOSE - _STIFF) * done) * self._moments
        pulls = np.zeros((count, 4))
        pulls[:, :3] = pull[:, None]
        wanted = np.zeros((count, 4, 3))
        wanted[:, :3] = pose.scales[:, None, None] * pose.rotations.transpose(0, 2, 1)
        wanted[0] = self._found.unknowns[0]
        diagonal = pulls.ravel() + self._anchor
        matrix = self._design.T @ (per_point[:, None] * self._design) + self._ties + np.diag(diagonal + 1e-12)
        right = self._design.T @ drawn + diagonal[:, None] * wanted.reshape(-1, 3)
        unknowns = np.linalg.solve(matrix, right).reshape(count, 4, 3)
        linear = unknowns[:, :3].transpose(0, 2, 1)
        rotations = self._untwisted(nearest_rotations(linear))
        scales = np.clip(np.einsum("kij,kij->k", rotations, linear) / 3, 0.2 * pose.scales, 5 * pose.scales)
        return _Pose(unknowns, rotations, np.sqrt(scales * np.median(scales)))

    def _untwisted(self, rotations: NDArray[np.float64]) -> NDArray[np.float64]:
        """Take back most of the turn of each digit's bones around themselves, against the bones that they hang on."""
        relative = rotations[self._above].transpose(0, 2, 1) @ rotations[self._own]
        skew = relative - relative.transpose(0, 2, 1)
        spin = np.einsum("kd,kd->k", skew[:, [2, 0, 1], [1, 2, 0]], self._axes)
        angles = 2 * np.arctan2(spin, 1 + np.trace(relative, axis1=1, axis2=2))
        turned = rotations.copy()
        back = Rotation.from_rotvec(-_UNTWIST * angles[:, None] * self._axes)
        turned[self._own] = rotations[self._own] @ back.as_matrix()
        return turned

    def cost(self, pose: _Pose) -> float:
        """Mean distance across both surfaces, normals included, in lengths of the hand; far is far."""
        own, other, _, agree = self._found_pairs(pose, _NORMALS[1] * self._length)
        points, normals = self._placed(pose)
        apart = (self._hand.places[other] - points[own]) / self._length
        # Across the surfaces: along them the distance to a sample says only how far apart the samples are.
        across = [np.abs(np.einsum("kd,kd->k", apart, side)) for side in (normals[own], self._hand.sides[other])]
        each = np.minimum(np.maximum(*across) + 0.2 * (1 - agree), 0.5)
        count = len(self._hand.points)
        return float(each[:count].mean() + each[count:].mean()) if len(own) else np.inf
