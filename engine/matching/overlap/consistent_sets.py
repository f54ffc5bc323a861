# SPDX-License-Identifier: GPL-3.0-or-later
"""Sets of candidates that go together."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ...geometry.best_distinct import best_distinct
from ...runtime.arrays import Bools, Floats, Ints
from .oriented_patches import OrientedPatches
from .patch_candidates import Candidates

_ROUNDS = 5
"""Rounds of the power iteration."""

_WEAK, _LEAST_SHARE = 0.08, 0.15
"""Support below which a candidate is dropped in a round; and share, of that of the best, below which it is not of the
set."""

_LEAST = 4
"""Candidates in a set at least."""

_COMMON, _APART = 0.4, 0.08
"""Part of the smaller of two sets that must be in both for them to be compared, and median length of the path between
their places from which on they are different."""

_TIE = 1e-9


@dataclass(frozen=True)
class Plan:
    """How sets are looked for.

    Attributes
    ----------
    radius : float
        Length of paths from its seed that a set extends over.
    seeds, most : int
        How many candidates are tried as seeds, and how many sets, none like another, are kept.
    """

    radius: float
    seeds: int
    most: int


PLANS = Plan(0.25, 400, 50), Plan(0.4, 300, 40), Plan(np.inf, 150, 12)
"""Small sets find what little two surfaces share, and need not know how bodies are posed; large ones are clearer."""


@dataclass(frozen=True, eq=False)
class ConsistentSet:
    """Candidates that go together, one at most for each place of the first surface.

    Attributes
    ----------
    members : (k,) array of int
        Their numbers.
    weights : (k,) array of float
        How much each is supported by the others, at most 1.
    """

    members: Ints
    weights: NDArray[np.float32]


class Together:
    """How well candidates go together, and the best of each place.

    Parameters
    ----------
    values : (k, k) array of float
        How well each two go together, see `compatibilities`.
    first : (k,) array of int
        Their places of the first surface, in order.
    """

    def __init__(self, values: NDArray[np.float32], first: Ints) -> None:
        self.values = values
        self.places, self._starts = np.unique(first, return_index=True)
        self._of = np.repeat(np.arange(len(self.places)), np.diff(np.append(self._starts, len(first))))
        self.best = np.maximum.reduceat(values, self._starts, axis=0)  # (p, k): how each goes with the best of a place

    def is_best(self, weights: NDArray[np.float32]) -> Bools:
        """Say whether each weight, (k,), is the largest of its place."""
        return weights >= np.maximum.reduceat(weights, self._starts)[self._of] - _TIE


def consistent_sets(
    candidates: Candidates,
    together: Together,
    patches: tuple[OrientedPatches, OrientedPatches],
    shares: Floats,
    plan: Plan,
) -> list[ConsistentSet]:
    """Find sets of candidates that go together, by power iterations from single ones.

    Parameters
    ----------
    candidates : Candidates
        The candidates, k.
    together : Together
        How well each two go together.
    patches : pair of OrientedPatches
        The places of the two surfaces.
    shares : (s,) array of float
        Part of the first surface that each of its places stands for.
    plan : Plan
        How many, and how large.

    Returns
    -------
    list of ConsistentSet
        The best supported first; no two of them take the same places to about the same places.
    """
    first, share = candidates.first, shares.astype(np.float32)
    near = patches[0].between < plan.radius
    support = ((near[first][:, together.places] * share[together.places]) * together.best.T).sum(axis=1)
    found: list[tuple[float, ConsistentSet]] = []
    for seed in _seeds(support, first, plan.seeds):
        grown = _grown(together, int(seed), share[first], near[first[seed]][first])
        if grown is not None:
            found.append(grown)
    found.sort(key=lambda pair: -pair[0])
    return _distinct([each for _, each in found], candidates, patches, plan.most)


def _seeds(support: NDArray[np.float32], first: Ints, most: int) -> Ints:
    """Take the best supported candidates, so many at most: first the best of each place (k,), then the second best.

    What many candidates support would else be found again and again, and what two surfaces share may be small.
    """
    order = np.lexsort((-support, first))
    counts = np.bincount(first)
    ranks = np.empty(len(first), np.int64)
    ranks[order] = np.arange(len(first)) - np.repeat(np.cumsum(counts) - counts, counts)
    return np.lexsort((-support, ranks))[:most]


def _grown(
    together: Together, seed: int, share: NDArray[np.float32], near: Bools
) -> tuple[float, ConsistentSet] | None:
    """Grow a set from a seed among candidates that are near, with its strength; None if it stays too small."""
    weights = together.values[seed] * near
    weights[seed] = 1
    for _ in range(_ROUNDS):
        kept = np.flatnonzero(together.is_best(weights) & (weights > 0))
        amounts = weights[kept] * share[kept]
        # Whole rows are gathered far faster than what of them is near.
        support = amounts @ together.values[kept] * near / max(float(amounts.sum()), _TIE)
        weights = support * (support > _WEAK)
        weights /= max(float(weights.max()), _TIE)
    kept = np.flatnonzero(together.is_best(weights) & (weights > _LEAST_SHARE))
    if len(kept) < _LEAST:
        return None
    amounts = weights[kept] * share[kept]
    strength = float(amounts @ together.values[np.ix_(kept, kept)] @ amounts / max(float(amounts.sum()), _TIE))
    return strength, ConsistentSet(kept, weights[kept])


def _distinct(
    sets: list[ConsistentSet], candidates: Candidates, patches: tuple[OrientedPatches, OrientedPatches], most: int
) -> list[ConsistentSet]:
    """Keep the first of sets that are alike, so many at most."""
    between = patches[1].between

    def images(each: ConsistentSet) -> Ints:
        """For each place of the first surface that of the second, or -1."""
        found = np.full(len(patches[0]), -1)
        found[candidates.first[each.members]] = candidates.second[each.members]
        return found

    ranked = ((each, images(each)) for each in sets)
    chosen = best_distinct(ranked, lambda one, other: not _are_alike(one[1], other[1], between), most)
    return [each for each, _ in chosen]


def _are_alike(images: Ints, others: Ints, between: Floats) -> bool:
    """Say whether two sets take what they share to about the same places, (s,) each, -1 for none."""
    both = (images >= 0) & (others >= 0)
    if both.sum() < _COMMON * min((images >= 0).sum(), (others >= 0).sum()):
        return False
    return bool(np.median(between[images[both], others[both]]) < _APART)
