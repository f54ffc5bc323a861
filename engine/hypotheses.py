# SPDX-License-Identifier: GPL-3.0-or-later
"""Several coarse matchings followed up, and the choice between them.

A nearly symmetric shape has many matchings of almost equal distortion: the true one, its mirror image, and for people
the turn by 180 degrees that swaps left with right and front with back.  The exact optimum of the coarse problem is
often one of the wrong ones, so its best distinct solutions are all refined, and the choice is made where more points
can speak.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from .branch_and_bound import BoundedMatching, distinct_matchings_steps
from .hierarchy import Pair, Refined, level_sizes, refine_steps
from .orientation import orientation_agreement, signed_areas
from .progress import Progress, Steps, within

if TYPE_CHECKING:
    from numpy.typing import NDArray

__all__ = ["Hypothesis", "choose_steps", "coarse_steps"]

_DISTINCT = 0.2  # two coarse matchings are distinct if half the points lie farther apart than this, in sqrt(area)
_SCREEN_POINTS = 20  # all hypotheses are refined up to this many points,
_DECISION_POINTS = 64  # the best of them up to this many,
_KEPT = 4  # which are so many of each orientation.
_DISTINCT_SHARE = 0.1  # part of the points that has to differ (by half of _DISTINCT) for two refined ones to be kept
_CURVATURE_WEIGHT = 6.0
_LANDMARKS = 20  # the first matched points, to which the orientation of the others is measured


@dataclass(frozen=True, eq=False)
class Hypothesis:
    """One refined matching.

    Attributes
    ----------
    coarse : BoundedMatching
        Where it started.
    levels : list of Refined
        The levels since then.
    cost : float
        Distortion of the last level.
    orientation : float
        Mean agreement of orientation over the whole surface, -1 to 1.
    score : float
        Smaller is more credible; comparable between hypotheses of one pair.
    """

    coarse: BoundedMatching
    levels: list[Refined]
    cost: float
    orientation: float
    score: float

    @property
    def assignment(self) -> NDArray[np.int64]:
        """The matching of the last level, (j,)."""
        return self.levels[-1].assignment


@dataclass(frozen=True, eq=False)
class _Lead:
    """A coarse matching on its way to a hypothesis, with the orientation that it is to have."""

    coarse: BoundedMatching
    orientation_term: NDArray[np.float64]  # (S, T)
    levels: list[Refined]
    cost: float

    @property
    def assignment(self) -> NDArray[np.int64]:
        return self.levels[-1].assignment


def coarse_steps(pair: Pair) -> Steps[list[BoundedMatching]]:
    """Match the coarse points exactly: the best matchings that are distinct from each other, best first."""
    settings = pair.settings
    points = min(settings.coarse_points, settings.points)
    candidates = min(settings.coarse_candidates, pair.target.sample_count)
    problem = pair.problem(points, candidates)
    return (
        yield from distinct_matchings_steps(problem, settings.hypotheses, _DISTINCT, node_limit=settings.node_limit)
    )


def choose_steps(pair: Pair, coarse: list[BoundedMatching]) -> Steps[tuple[Hypothesis, Hypothesis | None]]:
    """Follow up coarse matchings, each with either orientation, and choose.

    Returns
    -------
    chosen : Hypothesis
        The most credible matching that keeps the orientation (of any orientation if none does).
    mirrored : Hypothesis or None
        The most credible one of the opposite orientation.
    """
    sizes = level_sizes(len(coarse[0].assignment), min(pair.settings.points, _DECISION_POINTS))
    screen = [size for size in sizes if size <= _SCREEN_POINTS] or sizes[:1]
    further = sizes[len(screen) :]
    leads: list[_Lead] = []
    for sign in (1, -1):
        screened = []
        for number, matching in enumerate(coarse):
            here = Progress(((sign < 0) + number / len(coarse)) / 4, "Comparing matchings")
            term = pair.orientation_term(matching.assignment, sign)
            levels = yield from _at(here, refine_steps(pair, matching.assignment, screen, term))
            cost = pair.problem(screen[-1], extra=term[: screen[-1]]).cost(levels[-1].assignment)
            screened.append(_Lead(matching, term, levels, cost))
        leads += _best_distinct(pair, screened)
    hypotheses = []
    for number, lead in enumerate(leads):
        here = Progress((1 + number / len(leads)) / 2, "Comparing matchings")
        more = yield from _at(here, refine_steps(pair, lead.assignment, further, lead.orientation_term))
        levels = lead.levels + more
        # Once more without the orientation term: the result is a minimum of the distortion alone.
        last = yield from _at(here, refine_steps(pair, levels[-1].assignment, sizes[-1:]))
        hypotheses.append(_assess(pair, lead.coarse, levels[:-1] + last))
    hypotheses.sort(key=lambda hypothesis: hypothesis.score)
    chosen = next((h for h in hypotheses if h.orientation > 0), hypotheses[0])
    mirrored = next((h for h in hypotheses if h.orientation * chosen.orientation < 0), None)
    return chosen, mirrored


def _at(here: Progress, steps: Steps[list[Refined]]) -> Steps[list[Refined]]:
    """Report one fixed progress for every step of a short computation."""
    return (yield from within(steps, here.fraction, here.fraction, here.label))


def _best_distinct(pair: Pair, leads: list[_Lead]) -> list[_Lead]:
    """Keep the best few, leaving out those that have become the same as a better one."""
    kept: list[_Lead] = []
    for lead in sorted(leads, key=lambda lead: lead.cost):
        moves = [pair.target.sample_distances[lead.assignment, other.assignment] for other in kept]
        if all((move > _DISTINCT / 2).mean() > _DISTINCT_SHARE for move in moves):
            kept.append(lead)
        if len(kept) == _KEPT:
            break
    return kept


def _assess(pair: Pair, coarse: BoundedMatching, levels: list[Refined]) -> Hypothesis:
    """Carry a matching to all samples, and see how well the surfaces agree there.

    Two things are asked of the lifted map: that it keeps the distances to the matched points, and that the surface
    bends the same way at both ends, outwards to outwards.  The second is extrinsic, so no isometry can fool it: it
    separates the true matching from the 180-degree turn of a person.
    """
    assignment = levels[-1].assignment
    count = len(assignment)
    source, target = pair.source, pair.target
    known, offered = source.sample_distances[:, :count], target.sample_distances[:, assignment]
    misfit = _squared_differences(known, offered) / count
    landmarks = min(count, _LANDMARKS)
    here, there = source.directions[:, :landmarks], target.directions[:, assignment[:landmarks]]
    first, second = signed_areas(here), signed_areas(there)
    # The sides must agree as the matching itself says, whichever it says.
    sign = 1 if pair.orientation(assignment) >= 0 else -1
    sides = _squared_differences(first, sign * second) / first.shape[1]
    lifted = (misfit + 0.01 * sides).argmin(axis=1)
    residual = float(misfit[np.arange(len(lifted)), lifted].mean())
    agreements = [
        _correlation(x, y[lifted], source.cell_areas) for x, y in zip(source.curvatures, target.curvatures, strict=True)
    ]
    orientation = float(orientation_agreement(here, there[lifted]).mean())
    score = float(np.log(max(residual, float(np.finfo(float).tiny))) - _CURVATURE_WEIGHT * np.mean(agreements))
    cost = pair.problem(count).cost(assignment)
    return Hypothesis(coarse, levels, cost, orientation, score)


def _squared_differences(first: NDArray[np.float64], second: NDArray[np.float64]) -> NDArray[np.float64]:
    """Squared distance between every row of `first` (s, d) and every row of `second` (t, d): (s, t)."""
    square = np.square(first).sum(axis=1)[:, None] + np.square(second).sum(axis=1) - 2 * first @ second.T
    return np.maximum(square, 0)


def _correlation(first: NDArray[np.float64], second: NDArray[np.float64], weights: NDArray[np.float64]) -> float:
    """Weighted Pearson correlation; 0 where one of the two is constant."""
    weights = weights / weights.sum()
    first, second = first - weights @ first, second - weights @ second
    size = np.sqrt((weights @ np.square(first)) * (weights @ np.square(second)))
    return float(weights @ (first * second) / size) if size > 0 else 0.0
