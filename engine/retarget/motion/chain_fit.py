# SPDX-License-Identifier: GPL-3.0-or-later
"""Rotations of chains of bones that stand for others of another number: what they carry lies as in the source."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from ...geometry.procrustes import nearest_rotations
from ...runtime.arrays import TINY, Floats, Ints, distances_from_segments
from ..rig.skeleton import Skeleton
from .bone_pairing import BonePairing
from .limbs import Limb
from .segments import Segments, ways_up

_SAMPLES = 8
"""Points along each bone."""

_ROUNDS = 10
"""How often each bone of a chain is turned anew; two bones are within 0.01 % of the height after three."""

_LEAST_LENGTH = 1e-3
"""Least length of a bone, in units of the longest one."""


@dataclass(frozen=True, eq=False)
class FittedChain:
    r"""Bones of the target, k, that hang on one of them and do together what m bones of the source do.

    Points of the target are at :math:`\sum_b R_b u_b` if its bones turn by :math:`R_b`, and where the source has them
    at :math:`\sum_a S_a v_a`, seen from the head of the first bone.  The rotations make the sum of the squared
    differences least; what it takes of the points are second moments.

    Attributes
    ----------
    bones : (k,) array of int
        The target's bones.
    sources : (m,) array of int
        The source's bones.
    rests : (m, 3, 3) array of float
        How the target's surface around these is turned against the source's, both at rest.
    shares : (k, m) array of float
        Which part of each bone of the target each one of the source moves.
    own : (k, k, 3, 3) array of float
        Moments of the target's own :math:`u` with one another.
    wanted : (k, m, 3, 3) array of float
        Moments of these with the source's :math:`v`, and of each bone's thickness.
    """

    bones: Ints
    sources: Ints
    rests: Floats
    shares: Floats
    own: Floats
    wanted: Floats

    def __repr__(self) -> str:
        return f"<FittedChain: {len(self.bones)} bones for {len(self.sources)}>"

    def turns(self, source_turns: Floats) -> Floats:
        """How the chain's bones turn, (f, k, 3, 3), where the source's turn by (f, a, 3, 3) in the target's space."""
        turned = source_turns[:, self.sources] @ np.swapaxes(self.rests, -1, -2)
        if len(self.sources) == 1:
            return np.repeat(turned, len(self.bones), axis=1)
        shape = (len(turned), len(self.bones), 3, 3)
        found = nearest_rotations(np.einsum("bm,fmij->fbij", self.shares, turned).reshape(-1, 3, 3)).reshape(shape)
        goals = np.einsum("bmkj,fmij->fbik", self.wanted, turned)
        for bone in np.tile(np.arange(len(self.bones)), _ROUNDS):
            others = np.arange(len(self.bones)) != bone
            taken = np.einsum("fcij,cjk->fik", found[:, others], self.own[others, bone])
            found[:, bone] = nearest_rotations(goals[:, bone] - taken)
        return found


def fitted_chains(
    pairing: BonePairing,
    rests: Floats,
    segments: Segments,
    trees: tuple[Skeleton, Skeleton],
    holders: Ints,
    *,
    arms: Sequence[Limb] = (),
) -> list[FittedChain]:
    """Find what each bone of the target has to carry, and where the source takes it.

    A bone carries points along itself, as thick as it is long, and the joints of what hangs on it, which weigh as much
    as all bones there are long.  Where the source takes these follows from the places of its joints in the target.
    Its bones on the way to such a joint for which the target has none, such as a collar bone between chest and arm,
    take the joint along.  So one bone that stands for one, and carries the same, turns as it does.

    Parameters
    ----------
    pairing : BonePairing
        The pairs, k.
    rests : (k, 3, 3) array of float
        How the target's surface is turned against the source's, both at rest: see `posed_rotations`.
    segments : Segments
        What stands for what.
    trees : pair of Skeleton
        The source's and the target's bones at rest.
    holders : (b,) array of int
        The bone of the target that carries each, -1 for none.
    arms : sequence of Limb
        Limbs that are to point where the source's point, bent at the same joint wherever the map puts it.  Legs are to
        stand where those of the source stand, also if they are built in other pieces.

    Returns
    -------
    list of FittedChain
        With all bones of the target that have partners.
    """
    rigs = _Rigs(pairing, rests, segments, trees, holders)
    chains = []
    jointed = {arm.parts[1] for arm in arms}
    for parts, bones in segments.chains(pairing.sources, pairing.places, trees[1], jointed):
        left = bones.tolist()
        while left:
            top = next((bone for bone in left if not set(ways_up(holders, bone)) & set(left)), left[0])
            hanging = [bone for bone in left if bone != top and top in ways_up(holders, bone)]
            chains.append(rigs.chain(parts, [top, *hanging]))
            left = [bone for bone in left if bone not in (top, *hanging)]
    return chains


@dataclass(frozen=True)
class _Joints:
    """Joints of bones (n), their places in the target (n, 3), and the number of the one that each hangs on, or -1."""

    bones: list[int]
    places: Floats
    above: list[int]

    def levers(self, point: Floats, bone: int) -> Floats:
        """Vectors (n, 3) that the bones turn to take along a point on one of them, as seen from the first joint."""
        result, number = np.zeros_like(self.places), self.bones.index(bone)
        while number >= 0:
            result[number] += point - self.places[number]
            point, number = self.places[number], self.above[number]
        return result


class _Point(NamedTuple):
    """A point of the target, the bones of target and source that carry it, and what it weighs."""

    place: Floats
    bone: int
    source: int
    mass: float


class _Rigs:
    """Both rigs; where the target's bones end (b, 3), how long they are (b,), and what each segment weighs (s,)."""

    def __init__(
        self, pairing: BonePairing, rests: Floats, segments: Segments, trees: tuple[Skeleton, Skeleton], holders: Ints
    ) -> None:
        self.pairing, self.rests, self.segments, self.holders = pairing, rests, segments, holders
        self.source, self.target = trees
        before, after = (np.ptp(points, axis=0).max() for points in (trees[0].heads[pairing.sources], pairing.places))
        self.ratio = after / before if before > TINY else 1.0
        self.ends, self.lengths = trees[1].tails.copy(), np.zeros(len(trees[1]))
        paired = np.unique(pairing.targets).tolist()
        above = np.array([next((up for up in ways_up(holders, bone) if up in paired), -1) for bone in paired])
        for bone in paired:
            held = np.array(paired)[above == bone]
            joints = trees[1].heads[held] if len(held) else trees[1].tails[[bone]]
            self.ends[bone] = joints.mean(axis=0)
            self.lengths[bone] = np.linalg.norm(joints - trees[1].heads[bone], axis=1).mean()
        self.lengths = np.maximum(self.lengths, _LEAST_LENGTH * self.lengths.max())
        own = np.array([self.lengths[bones].sum() for bones in segments.targets])
        self.masses = (own + segments.hanging @ own).tolist()

    def chain(self, parts: Sequence[int], bones: list[int]) -> FittedChain:
        """Set up what segments do with some bones of the target, of which all hang on the first."""
        rows = self._rows(parts, bones)
        below = [part for above in parts for part in self.segments.below(above).tolist() if part not in parts]
        held = [point for part in below for point in self._held(part, bones, rows)]
        own = _Joints(bones, self.target.heads[bones], [-1, *(self._holder(bone, bones) for bone in bones[1:])])
        joints, rests = self._source_joints(rows, held)
        samples = self._along(bones, rows, joints, held, rests)
        points = [*samples, *held]
        u = np.array([own.levers(point.place, point.bone) for point in points])
        v = np.array([joints.levers(point.place, point.source) for point in points])
        v -= joints.levers(own.places[0], joints.bones[0])
        masses, shares = np.array([point.mass for point in points]), np.zeros((len(bones), len(joints.bones)))
        for point in samples:
            shares[bones.index(point.bone), joints.bones.index(point.source)] += 1 / _SAMPLES
        thickness = np.einsum("b,bm,ij->bmij", self.lengths[bones] ** 3 / 12, shares, np.eye(3))
        wanted = np.einsum("p,pbi,pmj->bmij", masses, u, v) + thickness
        moments = np.einsum("p,pbi,pcj->bcij", masses, u, u)
        return FittedChain(np.array(bones), np.array(joints.bones), rests, shares, moments, wanted)

    def _rows(self, parts: Sequence[int], bones: list[int]) -> dict[int, int]:
        """Find the source's bones that stand for some of the target, as they hang, and a pair of each."""
        found: dict[int, int] = {}
        for part in sorted(parts, key=lambda part: len(self.segments.above(part))):
            for bone in self.segments.sources[part].tolist():
                for row in self.segments.rows[part].tolist():
                    if self.pairing.sources[row] == bone and self.pairing.targets[row] in bones:
                        found.setdefault(bone, row)
        return found

    def _holder(self, bone: int, bones: list[int]) -> int:
        """Find the number of the one of some bones that a bone of the target hangs on, -1 for none."""
        return next((bones.index(up) for up in ways_up(self.holders, bone) if up in bones), -1)

    def _held(self, part: int, bones: list[int], rows: dict[int, int]) -> list[_Point]:
        """Find the joints by which a segment hangs on bones of the target, and what takes them along in the source."""
        above, tops = self.source.above(int(self.segments.sources[part][0])), self.segments.tops(part, self.target)
        hangs = bool(set(above) & set(rows))
        owner = next(bone for bone in (*above, *reversed(rows)) if bone in rows)
        found = []
        for top in tops:
            holder = self._holder(top, bones)
            # Where the target has a bone between as well, the two were told apart: neither takes the joint along.
            carrier = above[0] if hangs and self.holders[top] in bones else owner
            if holder >= 0:
                found.append(_Point(self.target.heads[top], bones[holder], carrier, self.masses[part] / len(tops)))
        return found

    def _source_joints(self, rows: dict[int, int], held: list[_Point]) -> tuple[_Joints, Floats]:
        """Place joints of the source, those of the pairs and those between these and what is held; and their rests."""
        tree = self.source
        places, rests = (
            {bone: values[row] for bone, row in rows.items()} for values in (self.pairing.places, self.rests)
        )
        ways = {up for bone in [*rows, *(point.source for point in held)] for up in [bone, *tree.above(bone)]}
        ranks = {bone: float(rank) for rank, bone in enumerate(rows)}
        carried = tree.hanging[list(rows)].any(axis=0)
        for bone in tree.order[carried[tree.order]].tolist():
            if bone in ways and bone not in rows:
                parent = int(tree.parents[bone])
                ranks[bone] = int(ranks[parent]) + 0.5
                rests[bone] = rests[parent]
                places[bone] = places[parent] + self.ratio * rests[bone] @ (tree.heads[bone] - tree.heads[parent])
        found = sorted(ranks, key=lambda bone: ranks[bone])
        # What hangs on none of them, such as a foot that a solver moves, hangs on the one before.
        ups = [[found.index(up) for up in tree.above(bone) if up in found[:rank]] for rank, bone in enumerate(found)]
        above = [each[0] if each else rank - 1 for rank, each in enumerate(ups)]
        placed, rested = (np.array([values[bone] for bone in found]) for values in (places, rests))
        return _Joints(found, placed, above), rested

    def _along(
        self, bones: list[int], rows: dict[int, int], joints: _Joints, held: list[_Point], rests: Floats
    ) -> list[_Point]:
        """Take points along bones of the target; of the source's bones the nearest takes each of them along."""
        lines = [(joints.bones[up], place) for up, place in zip(joints.above, joints.places, strict=True) if up >= 0]
        lines += [(point.source, point.place) for point in held]
        for number, bone in enumerate(joints.bones):
            if bone not in [owner for owner, _ in lines]:
                way = self.ratio * rests[number] @ self.source.axes[bone]
                lines.append((bone, joints.places[number] + way))
        lines = [line for line in lines if line[0] in rows]
        starts = np.array([joints.places[joints.bones.index(bone)] for bone, _ in lines])
        ways = np.array([end for _, end in lines]) - starts
        found = []
        for bone in bones:
            shares = (np.arange(_SAMPLES) + 0.5)[:, None] / _SAMPLES
            points = (1 - shares) * self.target.heads[bone] + shares * self.ends[bone]
            lines_of = distances_from_segments(points[:, None], starts, ways).argmin(axis=1)
            mass = self.lengths[bone] / _SAMPLES
            found += [_Point(point, bone, lines[line][0], mass) for point, line in zip(points, lines_of, strict=True)]
        return found
