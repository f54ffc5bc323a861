# SPDX-License-Identifier: GPL-3.0-or-later
"""Bones of limbs paired by their order and their lengths, where a map says which limbs belong together, but no more."""

from __future__ import annotations

from collections.abc import Set as AbstractSet
from typing import NamedTuple

import numpy as np

from ...geometry.procrustes import least_turns
from ...runtime.arrays import TINY, Bools, Floats, Ints, lengths_along, unit_vectors
from ..rig.skeleton import Skeleton

_ANGLE = np.radians(30.0)
"""By how much partners point elsewhere, first bones laid onto each other, that costs as much as a bone that shares the
partner of the one before, as a wrist does that of a hand; bent against that one, it costs as much again."""

_PLACE = 0.35
"""How far apart along the limb partners begin, in units of its length, that costs the same."""

_LEFT = 2.5
"""What each bone costs that is left at the trunk, such as a collar bone, in the same units, beside the part of the limb
that is lost with it: a thigh is no collar bone.  With these three, all bones of the limbs of the knight have the right
partners, in both ways, in `maker_rigs` of the benchmarks; so they have with 2 and with 3 (both tried once)."""

_WIDTH, _NARROWEST = 2.0, 0.01
"""What it costs, in the same units, if one limb begins further from that on the other side by the factor e, in units of
its length; and the least distance: collar bones begin near the middle, upper arms do not.  With it the knight's arms
are paired with those of an avatar that has straight collar bones (``maker_rigs --guided``); with half of it, tried
once, they are not."""


class _Limb(NamedTuple):
    """Bones in a row.

    Their numbers (k,), and where they point (k, 3); how far along the limb their heads, and its end, are (k + 1,); and
    how far their heads are from those on the other side (k,).
    """

    bones: Ints
    ways: Floats
    lengths: Floats
    apart: Floats

    def starting(self, first: int) -> _Limb:
        """Leave out bones before one."""
        return _Limb(self.bones[first:], self.ways[first:], self.lengths[first:], self.apart[first:])

    @property
    def width(self) -> float:
        """Logarithm of how far the limb is from that on the other side, in units of its length."""
        return float(np.log(max(self.apart[0] / max(self.lengths[-1] - self.lengths[0], TINY), _NARROWEST)))

    @property
    def bends(self) -> Floats:
        """What it costs that bones are bent against those before, (k,)."""
        before = np.concatenate([self.ways[:1], self.ways[:-1]])
        return _cost((before * self.ways).sum(axis=1))

    @property
    def places(self) -> Floats:
        """Part of the length of the limb that lies above each bone, (k,)."""
        along = self.lengths - self.lengths[0]
        return along[:-1] / max(along[-1], TINY)


def in_order(
    pairs: Ints,
    scores: Floats,
    trees: tuple[Skeleton, Skeleton],
    moving: tuple[Bools, Bools],
    mirrors: tuple[Ints, Ints],
    *,
    given: AbstractSet[tuple[int, int]] = frozenset(),
) -> Ints:
    """Pair the bones of limbs anew, in their order, that have more pairs with each other than with other limbs.

    The large foot of a short leg covers a long one up to the knee, by the map of the surface.  So bones of two limbs
    are partners that begin at the same part of the length, and point the same way once the first ones are laid onto
    each other.  Of all ways that keep their order the one of least cost is found by dynamic time warping [1]_: some may
    share a partner, but hardly across a bend, such as at a heel; and the first of one limb may be left alone, such as a
    collar bone, if the limbs are as far from those on the other side then.

    Parameters
    ----------
    pairs : (k, 2) array of int
        Bones of the source and of the target that are paired by the surface.
    scores : (b, a) array of float
        How well any two agree.
    trees : pair of Skeleton
        Source, a bones, and target, b bones, each at rest and as a whole turned alike.  The last bone of a limb should
        end where what it moves does.
    moving : pair of arrays of bool, (a,) and (b,)
        Which bones move anything.
    mirrors : pair of arrays of int, (a,) and (b,)
        The bone on the other side of each: itself in the middle, -1 for none.
    given : set of (int, int), optional
        Pairs that stay, and all others of their limbs.

    Returns
    -------
    (l, 2) array of int
        All pairs, in the order of the target's bones.

    References
    ----------
    .. [1] H. Sakoe, S. Chiba, "Dynamic programming algorithm optimization for spoken word recognition", IEEE
       Transactions on Acoustics, Speech, and Signal Processing 26(1), 1978.
    """
    mine, others = (_limbs(*each) for each in zip(trees, moving, mirrors, strict=True))
    shared = np.array([[_shared(pairs, scores, one, other) for other in others] for one in mine])
    for first, one in enumerate(mine):
        for second, other in enumerate(others):
            best = 0 < shared[first, second] >= max(shared[first].max(), shared[:, second].max())
            if best and not any(a in one.bones or b in other.bones for a, b in given):
                lost = np.isin(pairs[:, 0], one.bones) | np.isin(pairs[:, 1], other.bones)
                known = scores[np.ix_(other.bones, one.bones)].T.clip(min=0)
                sides = [(one, other), *_on_other_side((one, mine, mirrors[0]), (other, others, mirrors[1]))]
                pairs = np.concatenate([pairs[~lost], _aligned(sides, known)])
    return pairs[np.lexsort(pairs.T)]


def _on_other_side(*ends: tuple[_Limb, list[_Limb], Ints]) -> list[tuple[_Limb, _Limb]]:
    """Find the limbs that are mirror images of two, each among those of its rig, as a pair; none if there are none."""
    found = [
        next((one for one in limbs if set(one.bones) == set(mirrors[limb.bones])), None)
        for limb, limbs, mirrors in ends
    ]
    first, second = found
    return [] if first is None or second is None else [(first, second)]


def _limbs(tree: Skeleton, moving: Bools, mirrors: Ints) -> list[_Limb]:
    """Find the limbs: bones of either side that move something, one after the other, with no branch between."""
    limbs = (mirrors >= 0) & (mirrors != np.arange(len(tree)))
    above = tree.nearest_above(moving)
    below = [np.flatnonzero(moving & (above == bone)) for bone in range(len(tree))]
    found = []
    for last in np.flatnonzero(moving & limbs & np.array([len(each) != 1 for each in below])):
        row = [int(last)]
        while above[row[-1]] >= 0 and limbs[above[row[-1]]] and len(below[above[row[-1]]]) == 1:
            row.append(int(above[row[-1]]))
        bones = np.array(row[::-1])
        joints = np.concatenate([tree.heads[bones], tree.tails[last, None]])
        steps, lengths = np.diff(joints, axis=0), lengths_along(joints)
        if len(bones) > 1 and lengths[-1] > TINY:
            steps[-1] = steps[-2]  # what the last bone moves does not say well where it points
            apart = np.linalg.norm(tree.heads[bones] - tree.heads[mirrors[bones]], axis=1)
            found.append(_Limb(bones, unit_vectors(steps), lengths, apart))
    return found


def _shared(pairs: Ints, scores: Floats, one: _Limb, other: _Limb) -> float:
    """Sum of the scores of the pairs between two limbs."""
    between = pairs[np.isin(pairs[:, 0], one.bones) & np.isin(pairs[:, 1], other.bones)]
    return float(scores[between[:, 1], between[:, 0]].clip(min=0).sum())


def _aligned(sides: list[tuple[_Limb, _Limb]], known: Floats) -> Ints:
    """Pair the bones of two limbs, (k, 2), at the least cost; what the surface says of any two (a, b) is taken off.

    If there are such limbs on the other side as well, costs are the mean of both: what is a close choice is made alike.
    """
    best: tuple[float, list[tuple[int, int]]] = np.inf, []
    for first in (first for first in np.ndindex(known.shape) if not min(first)):
        costs = [_costs(one.starting(first[0]), other.starting(first[1])) for one, other in sides]
        apart, mine, others, width = (sum(each) / len(sides) for each in zip(*costs, strict=True))
        alike = known[first[0] :, first[1] :]
        cost, found = _cheapest(apart - alike, 1 + mine[:, None] - alike, 1 + others - alike)
        left = sum(
            _LEFT * start + (limb.places[start] / _PLACE) ** 2 for limb, start in zip(sides[0], first, strict=True)
        )
        cost += float(left) + width
        if cost < best[0]:
            best = cost, [(a + first[0], b + first[1]) for a, b in found]
    one, other = sides[0]
    return np.array([(one.bones[a], other.bones[b]) for a, b in best[1]], np.int64).reshape(-1, 2)


def _costs(here: _Limb, there: _Limb) -> tuple[Floats, Floats, Floats, float]:
    """Find what it costs to pair bones (a, b), that bones share a partner (a,) and (b,), and that widths differ."""
    turn = least_turns(here.ways[0], there.ways[0])
    apart = ((here.places[:, None] - there.places) / _PLACE) ** 2 + _cost(here.ways @ turn.T @ there.ways.T)
    return apart, here.bends, there.bends, _WIDTH * (here.width - there.width) ** 2


def _cost(cosines: Floats) -> Floats:
    """Cost of angles."""
    return (np.arccos(cosines.clip(-1, 1)) / _ANGLE) ** 2


def _cheapest(new: Floats, further: Floats, other: Floats) -> tuple[float, list[tuple[int, int]]]:
    """Pair rows and columns in order, from the first of both to the last of both: what it costs, and the pairs.

    Either goes on to a `new` pair, or a `further` row shares the column of the one before it, or the `other` way round.
    """
    sums, before = np.full(new.shape, np.inf), dict[tuple[int, int], tuple[int, int]]()
    sums[0, 0] = new[0, 0]
    for a, b in list(np.ndindex(new.shape))[1:]:
        place = (a, b)
        ways = {(a - 1, b - 1): new[place], (a - 1, b): further[place], (a, b - 1): other[place]}
        ways = {way: sums[way] + cost for way, cost in ways.items() if min(way) >= 0}
        before[place] = min(ways, key=lambda way: ways[way])
        sums[place] = ways[before[place]]
    found = [(new.shape[0] - 1, new.shape[1] - 1)]
    while found[-1] in before:
        found.append(before[found[-1]])
    return float(sums[-1, -1]), found[::-1]
