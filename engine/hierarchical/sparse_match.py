# SPDX-License-Identifier: GPL-3.0-or-later
"""Sparse matching of a pair: hierarchical, flat, or by generalised multidimensional scaling."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import partial

import numpy as np

from ..mesh.surface_points import SurfacePoints
from ..runtime.arrays import Floats, Ints
from ..runtime.progress import Steps, in_turn, within
from ..shapes.landmarks import placed_at_vertices
from ..shapes.surface_distances import symmetric_roots
from .compared.flat import flat_candidates
from .compared.gmds import gmds_steps
from .compared.stress_descent import Stress, settle_steps
from .exact.branch_and_bound import distinct_matchings_steps
from .hierarchy import Refined, level_sizes, refine_steps
from .sampled_pair import Pair
from .sparse_hypotheses import Coarse, Hypothesis, assess, choose_steps, coarse_candidates, coarse_steps, two_answers
from .sparse_result import Level


@dataclass(frozen=True, eq=False)
class Answer:
    """A matching, on the part of the target that is used.

    Attributes
    ----------
    coarse : Coarse
        The exact first step.
    candidates : int
        How many samples of the target were offered there.
    orientation : float
        Mean agreement of orientation, -1 to 1.
    points : SurfacePoints
        Images of the first k samples of the source, on ``Shape.mesh`` of the target.
    distances : (k, k) array of float
        Distances between the images.
    linear : float
        Sum of the descriptor differences, at the samples nearest to the images.
    levels : tuple of Level
        The hierarchy, on the whole target.
    """

    coarse: Coarse
    candidates: int
    orientation: float
    points: SurfacePoints
    distances: Floats
    linear: float
    levels: tuple[Level, ...]

    @property
    def quadratic(self) -> float:
        """Sum over ordered pairs of the squared differences of distances."""
        wanted = self.coarse.pair.source_distances[: len(self.points), : len(self.points)]
        return float(np.square(self.distances - wanted).sum())

    @property
    def distortion(self) -> float:
        """The distortion, equation 2."""
        return self.linear + self.coarse.pair.settings.quadratic_weight * self.quadratic


def solve_steps(pair: Pair, lap: Callable[[str], None]) -> Steps[list[Answer]]:
    """Match a pair by the solver that its settings name.

    Parameters
    ----------
    pair : Pair
        The two shapes.
    lap : callable
        Is told the name of each stage when it ends.

    Returns
    -------
    list of Answer
        The one that keeps the orientation and the one that mirrors it, as far as they were found.
    """
    if pair.settings.solver == "flat":
        answers = yield from _flat_steps(pair)
        lap("flat")
        return answers
    coarse = yield from within(coarse_steps(pair), 0.0, 0.2, "Matching the coarse points exactly")
    lap("coarse")
    hypotheses = yield from within(choose_steps(coarse), 0.2, 0.6)
    if pair.settings.solver == "gmds":
        answers = yield from within(in_turn(map(_gmds_steps, hypotheses)), 0.6, 1.0)
        lap("gmds")
        return _of_either_orientation(answers)
    answers = yield from within(_finished_steps(hypotheses), 0.6, 0.8)
    lap("hierarchy")
    if pair.settings.settle and not pair.settings.dense:
        answers = yield from within(in_turn(map(_settled_steps, answers)), 0.8, 1.0)
        lap("settling")
    return answers


def _finished_steps(hypotheses: list[Hypothesis]) -> Steps[list[Answer]]:
    """Go on from the level at which the hypotheses were compared to the finest."""
    pair, known = hypotheses[0].coarse.pair, len(hypotheses[0].assignment)
    sizes = level_sizes(known, pair.settings.points)[1:]
    found = yield from in_turn(refine_steps(h.coarse.pair, h.assignment, sizes) for h in hypotheses)
    candidates = coarse_candidates(pair)
    return [_at_samples(h, h.levels + levels, candidates) for h, levels in zip(hypotheses, found, strict=True)]


def _flat_steps(pair: Pair) -> Steps[list[Answer]]:
    settings = pair.settings
    candidates = flat_candidates(settings.points, len(pair.target.samples))
    variants = yield from within(pair.variants_steps(2), 0.0, 0.0)
    search = partial(distinct_matchings_steps, node_limit=settings.node_limit)
    found = yield from in_turn(search(variant.problem(settings.points, candidates)) for variant in variants)
    hypotheses = [
        assess(Coarse(variant, matching), [Refined(matching.assignment, 0)])
        for variant, matchings in zip(variants, found, strict=True)
        for matching in matchings
    ]
    return [_at_samples(hypothesis, hypothesis.levels, candidates) for hypothesis in two_answers(hypotheses)]


def _gmds_steps(hypothesis: Hypothesis) -> Steps[Answer]:
    coarse, pair = hypothesis.coarse, hypothesis.coarse.pair
    target, points = pair.target, pair.settings.points
    at_coarse = target.samples.vertices[hypothesis.levels[0].assignment]
    start = SurfacePoints.at_vertices(target.original, target.vertices[at_coarse])
    wanted = pair.source_distances[:points, :points]
    found = yield from gmds_steps(pair.source, target, points, start=start, wanted=wanted, distances=pair.target_metric)
    levels = tuple(Level(level.points, level.sweeps, level.stress, level.target_points) for level in found.levels)
    placed, distances = target.surface.on_mesh(found.target_points), found.distances
    if pair.landmarks:
        placed, distances = yield from _at_landmarks_steps(pair, placed)
    orientation = assess(coarse, [Refined(_nearest_samples(pair, placed), 0)]).orientation
    return Answer(coarse, coarse_candidates(pair), orientation, placed, distances, _linear(pair, placed), levels)


def _of_either_orientation(answers: list[Answer]) -> list[Answer]:
    """Keep the answer of the least distortion of either orientation, the one that keeps it first."""
    ranked = sorted(answers, key=lambda answer: answer.distortion)
    keeping = [answer for answer in ranked if answer.orientation > 0][:1]
    return keeping + [answer for answer in ranked if answer.orientation <= 0][:1]


def _at_landmarks_steps(pair: Pair, points: SurfacePoints) -> Steps[tuple[SurfacePoints, Floats]]:
    """Put the images of landmarks where they belong, and measure the distances between all images anew."""
    rows, target = np.arange(pair.landmarks), pair.target
    placed = placed_at_vertices(points, target.mesh, rows, target.samples.vertices[: pair.landmarks])
    yield from pair.target_metric.prepare_steps(placed)
    return placed, symmetric_roots(pair.target_metric.squares_between(placed))


def _at_samples(hypothesis: Hypothesis, levels: list[Refined], candidates: int) -> Answer:
    pair = hypothesis.coarse.pair
    target, assignment = pair.target, levels[-1].assignment

    def places(numbers: Ints) -> SurfacePoints:
        """Put samples of the target, by their numbers, on its mesh."""
        return SurfacePoints.at_vertices(target.mesh, target.samples.vertices[numbers])

    def finished(level: Refined) -> Level:
        """Say how a level ended."""
        matched = level.assignment
        cost = pair.problem(len(matched)).cost(matched)
        return Level(len(matched), level.iterations, cost, target.surface.on_original(places(matched)))

    distances = pair.target_distances[np.ix_(assignment, assignment)]
    linear = pair.problem(len(assignment)).linear_cost(assignment)
    known = hypothesis.coarse, candidates, hypothesis.orientation
    return Answer(*known, places(assignment), distances, linear, tuple(map(finished, levels)))


def at_samples(answer: Answer, levels: list[Refined]) -> Answer:
    """Replace the matching of an answer by another one of the same samples, found in these levels."""
    return _at_samples(assess(answer.coarse, levels), levels, answer.candidates)


def moved(answer: Answer, points: SurfacePoints) -> Answer:
    """Move the images of an answer to other points of the target; its metric was prepared for the nearest vertices."""
    pair = answer.coarse.pair
    return _at(answer, points, symmetric_roots(pair.target_metric.squares_by_nearest(points)))


def _at(answer: Answer, points: SurfacePoints, distances: Floats) -> Answer:
    """Put the images of an answer to points of the target, with these distances between them."""
    pair = answer.coarse.pair
    there = replace(answer, points=points, distances=distances, linear=_linear(pair, points))
    on_original = pair.target.surface.on_original(points)
    last = replace(answer.levels[-1], distortion=there.distortion, target_points=on_original)
    return replace(there, levels=(*answer.levels[:-1], last))


def _settled_steps(answer: Answer) -> Steps[Answer]:
    """Let the points leave the samples and come to rest anywhere on the surface, where that lowers the distortion."""
    pair = answer.coarse.pair
    wanted = pair.source_distances[: len(answer.points), : len(answer.points)]
    stress = Stress(wanted, _holding(pair, len(answer.points)) if pair.landmarks else None)
    settled = yield from settle_steps(pair.target_metric, answer.points, stress)
    better = _at(answer, settled.points, settled.distances)
    return better if better.distortion < answer.distortion else answer


def _holding(pair: Pair, count: int) -> Floats:
    """Linear term (count, n) at the vertices of the target that lets no image of a landmark leave its place."""
    farthest = max(float(pair.source_distances.max()), float(pair.target_distances.max()))
    linear = np.zeros((count, pair.target.mesh.vertex_count))
    linear[: pair.landmarks] = 1 + 2 * count * farthest**2
    linear[np.arange(pair.landmarks), pair.target.samples.vertices[: pair.landmarks]] = 0
    return linear


def _linear(pair: Pair, points: SurfacePoints) -> float:
    """Sum the descriptor differences, at the sample of the target nearest to each point."""
    return float(pair.linear[np.arange(len(points)), _nearest_samples(pair, points)].sum())


def _nearest_samples(pair: Pair, points: SurfacePoints) -> Ints:
    """Find the sample of the target nearest to each point, (k,)."""
    return pair.target.samples.rows[:, points.nearest_vertices].argmin(axis=0)
