# SPDX-License-Identifier: GPL-3.0-or-later
"""Several coarse matchings followed up, and the choice between them.

A nearly symmetric shape has many matchings of almost equal distortion: the true one, its mirror image, and for people
the turn by 180 degrees that swaps left with right and front with back.  The exact optimum of the coarse problem is
often one of the wrong ones, so its best distinct solutions are all refined, and the choice is made where more points
can speak.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TypeVar

import numpy as np

from ..geometry.best_distinct import best_distinct
from ..runtime.arrays import TINY, Floats, Ints
from ..runtime.progress import Progress, Steps, within
from .exact.branch_and_bound import BoundedMatching, distinct_matchings_steps, matchings_of_each_steps
from .hierarchy import Refined, level_sizes, refine_steps
from .lifted_samples import CURVATURE_WEIGHT, curvature_agreement, mean_orientation, sample_misfits
from .sampled_pair import Pair

Result = TypeVar("Result")

_DISTINCT = 0.2  # two coarse matchings are distinct if half the points lie farther apart than this, in sqrt(area)
_SCREEN_POINTS = 20  # all hypotheses are refined up to this many points,
_DECISION_POINTS = 64  # the best of them up to this many, unless a dense map is to decide,
_KEPT = 4  # which are so many of each orientation,
_KEPT_DENSE = 2  # and fewer if a dense map is to decide:
_DENSE_SHARE = 2  # it has starts of its own, so that one in so many coarse matchings is enough.
_DISTINCT_SHARE = 0.1  # part of the points that has to differ (by half of _DISTINCT) for two refined ones to be kept
_SYMMETRIES = 2  # so many self-matchings of the source, beside the identity, are tried for the mirror image
_STRAINED = 0.7  # excess of score and strain of landmarks where a matching contradicts them
_EXACT = 0.01  # differences of distances, in sqrt(area), below which all are the same


@dataclass(frozen=True, eq=False)
class Coarse:
    """An exactly matched coarse problem.

    Attributes
    ----------
    pair : Pair
        The pair, with the signs of eigenfunctions under which it was matched.
    matching : BoundedMatching
        The matching of the first samples.
    """

    pair: Pair
    matching: BoundedMatching


@dataclass(frozen=True, eq=False)
class _Followed:
    """A coarse matching, and the levels since then."""

    coarse: Coarse
    levels: list[Refined]

    @property
    def assignment(self) -> Ints:
        """The matching of the last level, (j,)."""
        return self.levels[-1].assignment


@dataclass(frozen=True, eq=False)
class Hypothesis(_Followed):
    """One refined matching.

    Attributes
    ----------
    coarse : Coarse
        Where it started.
    levels : list of Refined
        The levels since then.
    orientation : float
        Mean agreement of orientation over the whole surface, -1 to 1.
    score : float
        Smaller is more credible; comparable between hypotheses of one pair.
    """

    orientation: float
    score: float


@dataclass(frozen=True, eq=False)
class _Lead(_Followed):
    """A coarse matching on its way to a hypothesis, with the orientation that it is to have."""

    orientation_term: Floats  # (S, T)

    @property
    def cost(self) -> float:
        """Distortion, with what the orientation adds to it."""
        count = len(self.assignment)
        return self.coarse.pair.problem(count, extra=self.orientation_term[:count]).cost(self.assignment)


def coarse_candidates(pair: Pair) -> int:
    """Count the samples of the target that are offered to the coarse points."""
    settings = pair.settings
    if settings.constraint == "bijective":
        return min(settings.coarse_points, settings.points)
    return min(settings.coarse_candidates, len(pair.target.samples))


def coarse_steps(pair: Pair) -> Steps[list[Coarse]]:
    """Match the coarse points exactly.

    Returns
    -------
    list of Coarse
        The best matchings that are distinct from each other; with eigenfunctions as descriptors, those of the most
        consistent sign sequences in turn.
    """
    settings = pair.settings
    points = min(settings.coarse_points, settings.points)
    candidates = coarse_candidates(pair)
    count = -(-settings.hypotheses // _DENSE_SHARE) if settings.dense else settings.hypotheses
    variants = yield from within(pair.variants_steps(count), 0.0, 0.0)
    problems = [variant.problem(points, candidates) for variant in variants]
    turns = [number % len(variants) for number in range(count)]
    apart = problems[0].target_distances > _DISTINCT
    found = yield from matchings_of_each_steps([problems[turn] for turn in turns], apart, settings.node_limit)
    return [Coarse(variants[turn], matching) for turn, matching in zip(turns, found, strict=False)]


def choose_steps(coarse: list[Coarse]) -> Steps[list[Hypothesis]]:
    """Follow up coarse matchings, each with either orientation, and choose.

    Returns
    -------
    list of Hypothesis
        One or two, see `two_answers`.
    """
    settings = coarse[0].pair.settings
    known = len(coarse[0].matching.assignment)
    sizes = level_sizes(known, max(known, min(settings.points, _SCREEN_POINTS if settings.dense else _DECISION_POINTS)))
    screen = [size for size in sizes if size <= _SCREEN_POINTS] or sizes[:1]
    further = sizes[len(screen) :]
    leads: list[_Lead] = []
    for sign in (1, -1):
        screened = []
        for number, start in enumerate(coarse):
            here = Progress(0.25 * ((sign < 0) + number / len(coarse)), "Comparing matchings")
            term = start.pair.orientation_term(start.matching.assignment, sign)
            levels = yield from _reporting(here, refine_steps(start.pair, start.matching.assignment, screen, term))
            screened.append(_Lead(start, levels, term))
        leads += _best_distinct(screened, _KEPT_DENSE if settings.dense else _KEPT)
    hypotheses: list[Hypothesis] = []
    for number, lead in enumerate(leads):
        here = Progress(0.5 + 0.35 * number / len(leads), "Comparing matchings")
        hypotheses.append((yield from _reporting(here, _follow_steps(lead, further))))
    hypotheses.sort(key=lambda hypothesis: hypothesis.score)
    if not coarse[0].pair.landmarks:  # which no symmetry of the source would respect
        missing = [sign for sign in (1, -1) if not any(h.orientation * sign > 0 for h in hypotheses)]
        steps = _reflected_steps(hypotheses, sizes, missing if settings.dense else [-1, 1])
        hypotheses += yield from _reporting(Progress(0.85, "Comparing matchings"), steps)
    return two_answers(hypotheses)


def two_answers(hypotheses: list[Hypothesis]) -> list[Hypothesis]:
    """Choose the most credible matching of either orientation, the one that keeps it first.

    With landmarks, both take each to its partner, but one that does so against all else is left out: so landmarks on
    one side of a symmetric body decide what the sides correspond to.
    """
    ranked = sorted(hypotheses, key=lambda hypothesis: hypothesis.score)
    keeping = [h for h in ranked if h.orientation > 0][:1]
    mirroring = [h for h in ranked if h.orientation <= 0][:1]
    both = keeping + mirroring
    if not ranked[0].coarse.pair.landmarks:
        return both
    strains = [h.score + _landmark_strain(h) for h in both]
    return [h for h, strain in zip(both, strains, strict=True) if strain < min(strains) + _STRAINED]


def _landmark_strain(hypothesis: Hypothesis) -> float:
    """Measure how badly landmarks fit the other points: logarithm of their root mean square difference of distances."""
    pair, assignment = hypothesis.coarse.pair, hypothesis.assignment
    count = min(pair.landmarks, len(assignment))
    source = pair.source.samples.distances[:count, : len(assignment)]
    target = pair.target.samples.distances[np.ix_(assignment[:count], assignment)]
    return float(np.log(_EXACT + np.sqrt(np.square(source - target).mean())))


def _follow_steps(lead: _Lead, further: list[int]) -> Steps[Hypothesis]:
    """Refine a lead to its last level, and there once more without the orientation term.

    So the result is a minimum of the distortion alone.
    """
    pair = lead.coarse.pair
    more = yield from refine_steps(pair, lead.assignment, further, lead.orientation_term)
    levels = lead.levels + more
    last = yield from refine_steps(pair, levels[-1].assignment, [len(levels[-1].assignment)])
    return assess(lead.coarse, levels[:-1] + last)


def _reflected_steps(hypotheses: list[Hypothesis], sizes: list[int], wanted: list[int]) -> Steps[list[Hypothesis]]:
    """Make matchings of the wanted orientations, from the best of the other one, by the symmetries of the source.

    A symmetry of the source, followed by a matching, is another matching.  So where only one of the true and the
    mirrored one is among the best coarse matchings, the other is found from it.
    """
    if not wanted:
        return []
    pair = hypotheses[0].coarse.pair
    mirror = Pair(pair.source, pair.source, pair.settings)
    offered = min(pair.settings.coarse_candidates, len(hypotheses[0].assignment))
    problem = mirror.problem(sizes[0], max(sizes[0], offered))
    # The best self-matching is the identity.
    selves = yield from distinct_matchings_steps(
        problem, 1 + _SYMMETRIES, _DISTINCT, node_limit=pair.settings.node_limit
    )
    found = []
    for sign in wanted:
        best = next((h for h in hypotheses if h.orientation * sign < 0), None)
        if best is None:
            continue
        for symmetry in selves[1:]:
            start = best.assignment[symmetry.assignment]
            term = best.coarse.pair.orientation_term(start, sign)
            levels = yield from refine_steps(best.coarse.pair, start, sizes[:1], term)
            found.append((yield from _follow_steps(_Lead(best.coarse, levels, term), sizes[1:])))
    return found


def _reporting(here: Progress, steps: Steps[Result]) -> Steps[Result]:
    """Report one fixed progress for every step of a short computation."""
    return (yield from within(steps, here.fraction, here.fraction, here.label))


def _best_distinct(leads: list[_Lead], most: int) -> list[_Lead]:
    """Keep the best few, leaving out those that have become the same as a better one."""

    def differ(lead: _Lead, other: _Lead) -> bool:
        """Say whether two leads take a good part of the points elsewhere."""
        moves = lead.coarse.pair.target.samples.distances[lead.assignment, other.assignment]
        return bool((moves > _DISTINCT / 2).mean() > _DISTINCT_SHARE)

    return best_distinct(sorted(leads, key=lambda lead: lead.cost), differ, most)


def assess(coarse: Coarse, levels: list[Refined]) -> Hypothesis:
    """Carry a matching to all samples, and see how well the surfaces agree there.

    Two things are asked of the lifted map: that it keeps the distances to the matched points, and that the surface
    bends the same way at both ends, outwards to outwards.  The second is extrinsic, so no isometry can fool it: it
    separates the true matching from the 180-degree turn of a person.
    """
    assignment = levels[-1].assignment
    pair = coarse.pair
    source, target = pair.source, pair.target
    # The sides must agree as the matching itself says, whichever it says.
    misfits = sample_misfits(source, target, assignment, 1 if pair.orientation(assignment) >= 0 else -1)
    lifted = misfits.all.argmin(axis=1)
    residual = max(float(misfits.distances[np.arange(len(lifted)), lifted].mean()), TINY)
    orientation = mean_orientation(source, target, assignment, lifted)
    score = float(np.log(residual) - CURVATURE_WEIGHT * curvature_agreement(source, target, lifted))
    return Hypothesis(coarse, levels, orientation, score)
