# SPDX-License-Identifier: GPL-3.0-or-later
"""A hand laid onto its part of a target by articulated closest points: each bone moves, and joints hold together."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from scipy.sparse import csr_array
from scipy.spatial.transform import Rotation

from ...geometry.procrustes import nearest_rotations
from ...mesh.closest_points import FoundPoints
from ...mesh.triangle_mesh import TriangleMesh
from ...runtime.arrays import TINY, Floats, Ints, group_sums, spread_rows, squared_differences, unit_vectors
from ..weights.skin_weights import row_sums
from .digit_groups import DigitGroup
from .skeleton import Skeleton

_SAMPLES = 350
"""Points of either surface that are compared."""

_WIDE, _NARROW = 0.35, 0.06
"""Distance at which a match counts half, at first and at last, in lengths of the hand."""

_NORMALS = (0.25, 0.08)
"""How much a unit of difference of the normals counts, at first and at last, in lengths of the hand."""

_STIFF, _LOOSE = 3.0, 0.3
"""How much a transform that is no similarity counts, at first and at last."""

_JOINT = 10.0
_HELD = 100.0
"""How much joints that come apart count, and how much the bone that the hand hangs on is held."""

_UNTWIST = 0.7
"""How much is taken back, in each round, of a digit's turn around itself, which its joints hardly allow: free to turn,
the digits take hold of one another's surfaces."""


@dataclass(frozen=True, eq=False)
class HandPose:
    """Where the k bones of a hand take it, around its wrist at rest.

    Attributes
    ----------
    unknowns : (k, 4, 3) array of float
        The transposed linear part of each transform, and in the last row its translation.
    rotations : (k, 3, 3) array of float
        The rotations nearest to the linear parts.
    scales : (k,) array of float
        By what factor each bone is larger than at rest.
    cost : float
        How badly the pose fits, see `HandSolver.cost`; infinite if that is not known.
    """

    unknowns: Floats
    rotations: Floats
    scales: Floats
    cost: float = np.inf


@dataclass(frozen=True, eq=False)
class Hand:
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
    numbers: Ints
    points: Floats
    normals: Floats
    weights: Floats
    places: Floats
    sides: Floats
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
    ) -> Hand | None:
        """Cut the hand out of both surfaces; None if one of them has none."""
        tips = skeleton.tails[[chain[-1] for chain in group.chains]]
        wrist = skeleton.heads[group.hub]
        length = float(np.median(np.linalg.norm(tips - wrist, axis=1)))
        own = row_sums(weights[:, group.bones])
        above = row_sums(weights[:, [group.above]])
        near = np.linalg.norm(body.vertices - wrist, axis=1) < length / 2
        belongs = (own > 0.5) | ((own + above > 0.5) & near)
        corners = body.triangles[matches.triangles]
        there = np.einsum("mc,mc->m", matches.barycentric, belongs[corners].astype(float)) > 0.5
        if belongs.sum() < 4 * len(group.bones) or there.sum() < 2 * len(group.bones):
            return None
        numbers = np.array([group.above, *group.bones])
        chosen = np.flatnonzero(belongs)
        chosen = chosen[_spread_out(body.vertices[chosen])]
        seen = np.flatnonzero(there)
        seen = seen[_spread_out(target.vertices[seen])]
        shares = weights[chosen][:, numbers].toarray()
        shares /= np.maximum(shares.sum(axis=1, keepdims=True), TINY)
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


def _spread_out(points: Floats) -> Ints:
    """Choose a part of the points, from the outermost on."""
    if len(points) <= _SAMPLES:
        return np.arange(len(points))
    outermost = np.square(points - points.mean(axis=0)).sum(axis=1).argmax()
    return spread_rows(points, int(outermost), _SAMPLES)


class HandSolver:
    """Articulated closest points of one hand: everything that does not change from round to round.

    Parameters
    ----------
    hand : Hand
        The hand, and its part of the target.
    length : float
        Of the hand on the target.
    found : HandPose
        The pose that was found first, which the bone that the hand hangs on keeps.
    """

    def __init__(self, hand: Hand, length: float, found: HandPose) -> None:
        self._hand, self._length, self._found = hand, length, found
        count = len(hand.numbers)
        ends = np.concatenate([hand.points, np.ones((len(hand.points), 1))], axis=1)
        self._design = (hand.weights[:, :, None] * ends[:, None, :]).reshape(len(ends), 4 * count)
        mass = hand.weights.mean(axis=0)
        centres = (hand.weights.T @ hand.points) / np.maximum(len(ends) * mass, TINY)[:, None]
        spread = np.square(hand.points[:, None] - centres).sum(axis=2)
        self._moments = np.maximum((hand.weights * spread).mean(axis=0) / 3, 1e-6 * hand.length**2)
        self._moments[0] *= _HELD
        place = {int(bone): number for number, bone in enumerate(hand.numbers)}
        digits = hand.group.bones[1:]
        self._own = np.array([place[int(bone)] for bone in digits])
        self._above = np.array([place[int(bone)] for bone in hand.skeleton.parents[digits]])
        self._axes = unit_vectors(hand.skeleton.axes[digits])
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

    def improved(self, pose: HandPose, begin: float, rounds: int) -> HandPose:
        """Match closest points and solve for the bones in turn, forgiving less and less; from `begin` of the way on."""
        for done in np.linspace(begin, 1.0, rounds):
            pose = self._round(pose, float(done))
        return replace(pose, cost=self.cost(pose))

    def _placed(self, pose: HandPose) -> tuple[Floats, Floats]:
        """Points (s, 3) and normals of the hand in a pose."""
        points = self._design @ pose.unknowns.reshape(-1, 3)
        turns = (self._hand.weights @ pose.rotations.reshape(-1, 9)).reshape(-1, 3, 3)
        return points, unit_vectors(np.einsum("sij,sj->si", turns, self._hand.normals))

    def _found_pairs(self, pose: HandPose, reach: float) -> tuple[Ints, Ints, Floats, Floats]:
        """Match both ways: numbers in the hand and in the target, distances, and cosines of the normals."""
        hand = self._hand
        points, normals = self._placed(pose)
        here = np.concatenate([points, reach * normals], axis=1)
        there = np.concatenate([hand.places, reach * hand.sides], axis=1)
        # All pairs: so few points are compared faster than trees over them are built.
        apart = squared_differences(here, there)
        onto, back = apart.argmin(axis=1), apart.argmin(axis=0)
        own = np.concatenate([np.arange(len(here)), back])
        other = np.concatenate([onto, np.arange(len(there))])
        distances = np.linalg.norm(points[own] - hand.places[other], axis=1)
        return own, other, distances, np.einsum("kd,kd->k", normals[own], hand.sides[other])

    def _round(self, pose: HandPose, done: float) -> HandPose:
        """One round."""
        hand, count = self._hand, len(self._hand.numbers)
        reach = self._length * (_NORMALS[0] + (_NORMALS[1] - _NORMALS[0]) * done)
        doubt = self._length * (_WIDE + (_NARROW - _WIDE) * done)
        own, other, distances, agree = self._found_pairs(pose, reach)
        trust = np.clip(agree, 0, 1) / (1 + (distances / doubt) ** 2)
        # Both surfaces count alike, however many points stand for them.
        trust /= np.where(np.arange(len(own)) < len(hand.points), len(hand.points), len(hand.places))
        per_point = np.bincount(own, trust, len(hand.points))
        drawn = group_sums(own, trust[:, None] * hand.places[other], len(hand.points))
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
        return HandPose(unknowns, rotations, np.sqrt(scales * np.median(scales)))

    def _untwisted(self, rotations: Floats) -> Floats:
        """Take back most of the turn of each digit's bones around themselves, against the bones that they hang on."""
        relative = rotations[self._above].transpose(0, 2, 1) @ rotations[self._own]
        skew = relative - relative.transpose(0, 2, 1)
        spin = np.einsum("kd,kd->k", skew[:, [2, 0, 1], [1, 2, 0]], self._axes)
        angles = 2 * np.arctan2(spin, 1 + np.trace(relative, axis1=1, axis2=2))
        turned = rotations.copy()
        back = Rotation.from_rotvec(-_UNTWIST * angles[:, None] * self._axes)
        turned[self._own] = rotations[self._own] @ back.as_matrix()
        return turned

    def cost(self, pose: HandPose) -> float:
        """Mean distance across both surfaces, normals included, in lengths of the hand; far is far."""
        own, other, _, agree = self._found_pairs(pose, _NORMALS[1] * self._length)
        points, normals = self._placed(pose)
        apart = (self._hand.places[other] - points[own]) / self._length
        # Across the surfaces: along them the distance to a sample says only how far apart the samples are.
        across = [np.abs(np.einsum("kd,kd->k", apart, side)) for side in (normals[own], self._hand.sides[other])]
        each = np.minimum(np.maximum(*across) + 0.2 * (1 - agree), 0.5)
        count = len(self._hand.points)
        return float(each[:count].mean() + each[count:].mean()) if len(own) else np.inf
