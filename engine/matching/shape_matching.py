# SPDX-License-Identifier: GPL-3.0-or-later
"""Matching of two surfaces as they are: some points exactly, then more of them, then all vertices."""

from __future__ import annotations

import time
from dataclasses import dataclass, field, replace

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.optimize import linear_sum_assignment
from scipy.spatial import cKDTree

from ..dense.dense_hypotheses import SparseStart, map_domains
from ..dense.dense_registration import EIGENPAIRS, registered_pair_steps
from ..dense.densify import MEASURED, dense_match_steps
from ..dense.quality import DenseMatch, with_alternatives
from ..dense.rough_maps.extremity_maps import RoughSearch
from ..hierarchical.hierarchy import refine_steps
from ..hierarchical.sampled_pair import Pair
from ..hierarchical.settings import MatchSettings
from ..hierarchical.sparse_match import Answer, at_samples, moved, solve_steps
from ..hierarchical.sparse_result import CoarseMatch
from ..mesh.surface_map import SurfaceMap
from ..mesh.surface_points import SurfacePoints
from ..runtime.arrays import Floats, Ints
from ..runtime.progress import Steps, within
from ..shapes.genus_reduction import evened_steps
from ..shapes.landmarks import Landmarks, locate_landmarks, placed_at_vertices
from ..shapes.shape import Shape, check_vertex_count
from ..shapes.shape_preparation import Wanted, finer_shapes_steps, prepared_shapes_steps
from ..shapes.surface_distances import SurfaceDistances
from .result import MIRRORED, MatchResult, turned_name

_AGREEING = 0.15
"""Mean distance, in sqrt(area), up to which a sparse answer and the dense map are taken for the same."""


class Clock:
    """Seconds between laps, by name."""

    def __init__(self) -> None:
        self.laps: dict[str, float] = {}
        self._last = time.perf_counter()

    def lap(self, name: str) -> None:
        """Add the time since the last lap under a name."""
        now = time.perf_counter()
        self.laps[name] = self.laps.get(name, 0.0) + now - self._last
        self._last = now

    def noted(self, result: MatchResult) -> MatchResult:
        """Note on a result, and on its alternatives, all laps until now."""
        alternatives = tuple(self.noted(answer) for answer in result.alternatives)
        return replace(result, alternatives=alternatives, seconds=dict(self.laps))


@dataclass(frozen=True, eq=False)
class MatchTask:
    """What is wanted of a match.

    Attributes
    ----------
    settings : MatchSettings
        How many points, and how hard to search.
    landmarks : (k, 2) array_like of int or None
        Vertices of the original meshes that are known to correspond.
    clock : Clock
        Takes the time of each stage.
    least : float
        Likeness of the surfaces below which a dense match is of no use.
    least_softly : float
        The same of what has been registered softly, though it may rise.
    begun : SurfaceMap, optional
        A map of the source to the target that a dense match begins with; then no other is looked for.
    assumed : bool
        Whether landmarks are not known to correspond, but tried: the result does not rely on them.
    """

    settings: MatchSettings
    landmarks: ArrayLike | None
    clock: Clock = field(default_factory=Clock)
    least: float = -np.inf
    least_softly: float = -np.inf
    begun: SurfaceMap | None = None
    assumed: bool = False


def matched_steps(x: Shape, y: Shape, task: MatchTask) -> Steps[MatchResult]:
    """Match two surfaces as they are; see `match`.

    Parameters
    ----------
    x, y : Shape
        The source and the target.
    task : MatchTask
        What is wanted.
    """
    settings, landmarks, clock = task.settings, task.landmarks, task.clock
    x, y = yield from within(evened_steps(x, y), 0.0, 0.0)
    clock.lap("preparation")
    settings = fitting_settings(x, y, settings)
    known = None if landmarks is None else locate_landmarks(x, y, landmarks, settings.points, assumed=task.assumed)
    if known is not None:
        x, y = x.starting_with(known.source.matched), y.starting_with(known.target.matched)
    samples, measured = _samples_of(settings)
    sparse_end = 0.5 if settings.dense else 1.0
    sampled = 0.2 if settings.dense else 0.6
    eigenpairs = settings.eigenpairs if Pair.needs_spectrum(settings) else EIGENPAIRS if settings.dense else 0
    yield from within(prepared_shapes_steps(x, y, Wanted(samples, measured, eigenpairs)), 0.0, sampled)
    clock.lap("geodesics")
    limited = x.limited(samples, measured), y.limited(samples, measured)
    pair = Pair(*limited, settings, 0 if known is None else len(known))
    clock.lap("descriptors")
    searched: RoughSearch | None = None
    finer = limited
    if settings.dense:
        finer = yield from within(finer_shapes_steps(*limited, EIGENPAIRS), sampled, sampled)
    steps = solve_steps(pair, clock.lap)
    if settings.dense and known is None and eigenpairs == EIGENPAIRS and task.begun is None:
        # What the dense map needs first can be looked for beside the sparse answers.
        search = RoughSearch(map_domains(*finer), (1,))
        answers, searched = yield from within(search.beside_steps(steps), sampled, sparse_end)
    else:
        answers = yield from within(steps, sampled, sparse_end)
    notes = tuple(note for shape in (x, y) for note in shape.surface.cleaned.notes)
    if not settings.dense:
        results = []
        for answer in answers:
            rows = yield from _distance_rows_steps(answer)
            results.append(_result(answer, known, notes, clock.laps, rows))
        return replace(results[0], alternatives=tuple(replace(other, name=MIRRORED) for other in results[1:2]))
    direct, others, dense = yield from within(_dense_steps(answers, finer, known, searched, task), sparse_end, 1.0)
    if task.assumed:
        known = None
    return replace(
        _result(direct, known, notes, clock.laps),
        alternatives=tuple(replace(_result(other, known, notes, clock.laps), name=name) for name, other in others),
        source_to_target=dense.source_to_target,
        target_to_source=dense.target_to_source,
        quality=with_alternatives(dense.quality, sum(name != MIRRORED for name, _ in others)),
    )


def fitting_settings(x: Shape, y: Shape, settings: MatchSettings) -> MatchSettings:
    """Return settings with no more points than two shapes have vertices: a dense map has every vertex all the same.

    Raises
    ------
    MatchError
        If either has fewer than coarse points, or without a dense map than points.
    """
    least = min(settings.coarse_points, settings.points) if settings.dense else settings.points
    for shape, name in ((x, "source"), (y, "target")):
        check_vertex_count(shape, settings.points, name, least)
    return replace(settings, points=min(settings.points, x.mesh.vertex_count, y.mesh.vertex_count))


def sampled_steps(x: Shape, y: Shape, settings: MatchSettings) -> Steps[None]:
    """Take as many samples of two shapes as they are matched with."""
    yield from prepared_shapes_steps(x, y, Wanted(*_samples_of(settings)))


def _samples_of(settings: MatchSettings) -> tuple[int, int | None]:
    """Tell how many samples are taken, and from how many of them distances are measured.

    A dense map is decided on by more than distances: from the points that are matched they are measured, from most
    other samples estimated.
    """
    samples = max(3 * settings.samples // 4 if settings.dense else settings.samples, 2 * settings.points)
    return samples, max(settings.points, MEASURED) if settings.dense else None


def _dense_steps(
    answers: list[Answer],
    finer: tuple[Shape, Shape],
    landmarks: Landmarks | None,
    searched: RoughSearch | None,
    task: MatchTask,
) -> Steps[tuple[Answer, list[tuple[str, Answer]], DenseMatch]]:
    """Find the dense map, the sparse answer that agrees with it, and its alternatives by their names.

    The map is found on finer shapes than those of the answers where these are coarse.
    """
    pair = answers[0].coarse.pair
    x, y = pair.source, pair.target
    starts = []
    # Mirrored maps serve only landmarks that ask for one.
    followed = answers if landmarks is not None else [a for a in answers if a.orientation > 0] or answers
    for answer in followed:
        places = y.samples.rows[:, answer.points.nearest_vertices].argmin(axis=0)
        rows = finer[0].samples.rows[: len(places)], finer[1].samples.rows[places]
        starts.append(SparseStart(*rows, "hierarchy"))
    if task.begun is not None:
        starts = [_begun_start(x, y, finer, task.begun)]
    clock, search = task.clock, task.begun is None and not task.assumed
    registering = registered_pair_steps(
        *finer,
        starts,
        search=search,
        landmarks=landmarks,
        searched=searched,
        least=task.least,
        least_softly=task.least_softly,
    )
    registered = yield from within(registering, 0.0, 0.75)
    clock.lap("registration")
    dense = yield from within(dense_match_steps(registered), 0.75, 0.9)
    clock.lap("lift")
    count = len(answers[0].points)
    found, vertices = dense.source_to_target, x.vertices[x.samples.vertices[:count]]

    def placed(points: SurfacePoints) -> SurfacePoints:
        """Put images on the original target where they are matched."""
        images = y.surface.on_mesh(points)
        if landmarks is None or landmarks.assumed:
            return images
        return placed_at_vertices(images, y.mesh, np.arange(len(landmarks)), landmarks.target.matched)

    images = placed(SurfacePoints.from_barycentric(y.original, found.triangles[vertices], found.barycentric[vertices]))
    direct, mirrored = yield from within(_agreeing_steps(answers, images), 0.9, 1.0)
    others = [] if mirrored is None else [(MIRRORED, mirrored)]
    fine_x, fine_y = finer
    for number, other in enumerate(registered.alternatives, start=1):
        places = other.triangles[fine_x.samples.vertices[:count]], other.barycentric[fine_x.samples.vertices[:count]]
        turned = placed(fine_y.surface.on_original(SurfacePoints.from_barycentric(fine_y.mesh, *places)))
        yield from within(pair.target_metric.prepare_nearest_steps(turned), 1.0, 1.0)
        others.append((turned_name(number), moved(direct, turned)))
    clock.lap("agreement")
    return direct, others, dense


def _begun_start(x: Shape, y: Shape, finer: tuple[Shape, Shape], begun: SurfaceMap) -> SparseStart:
    """Begin with where a map takes the samples that have a partner."""
    own = x.vertices[x.samples.vertices]
    shown = np.flatnonzero(begun.has_partner[own])
    nearest = cKDTree(y.original.vertices[y.vertices[y.samples.vertices]]).query(begun.positions[own[shown]])[1]
    return SparseStart(finer[0].samples.rows[shown], finer[1].samples.rows[nearest], "overlap")


def _agreeing_steps(answers: list[Answer], images: SurfacePoints) -> Steps[tuple[Answer, Answer | None]]:
    """Tell by the dense map which sparse answer is the true one, and put its points where the map takes them.

    The dense map is decided on by far more than distances between some points.  An answer that it contradicts is
    refined anew, from the samples that are nearest to its images.
    """
    pair = answers[0].coarse.pair
    y, count = pair.target, len(images)
    far = [float(np.linalg.norm(a.points.positions - images.positions, axis=1).mean()) / y.scale for a in answers]
    order = np.argsort(far)
    # Without landmarks the map keeps the orientation: an answer that mirrors is at best near to it here and there.
    nearest = order[0] if pair.landmarks else next((i for i in order if answers[i].orientation > 0), order[0])
    direct = answers[nearest]
    mirrored = next((answers[i] for i in order if i != nearest and answers[i].orientation <= 0), None)
    if far[nearest] > _AGREEING:
        start = _distinct_samples(y.samples.rows[:, images.nearest_vertices], pair.landmarks)
        levels = yield from refine_steps(pair, start, [count])
        direct = at_samples(direct, levels)
        mirrored = mirrored or next((a for a in answers if a.orientation <= 0), None)
    if pair.landmarks:  # these may ask for a map that mirrors: then the other answer does not
        mirrored = next((a for a in answers if (a.orientation > 0) != (direct.orientation > 0)), None)
    yield from pair.target_metric.prepare_nearest_steps(images)
    return moved(direct, images), mirrored


def _distinct_samples(rows: NDArray[np.float32], landmarks: int) -> Ints:
    """Assign to each point (k,) a sample of its own near to it, by distances (s, k); to landmarks their own."""
    _, samples = linear_sum_assignment(np.square(rows[landmarks:, landmarks:].T.astype(np.float64)))
    return np.concatenate([np.arange(landmarks), landmarks + samples])


def _distance_rows_steps(answer: Answer) -> Steps[tuple[Floats, Floats]]:
    """Distances from the matched points to all vertices: geodesic ones whatever the metric."""
    x, y = answer.coarse.pair.source, answer.coarse.pair.target
    metric = answer.coarse.pair.target_metric
    on_target = metric if isinstance(metric, SurfaceDistances) else SurfaceDistances(y)
    rows = yield from within(on_target.to_all_vertices_steps(answer.points), 1.0, 1.0)
    own = x.samples.rows[: len(answer.points)].astype(np.float64) * x.scale
    return x.surface.spread(own, np.inf), rows


def _result(
    answer: Answer,
    landmarks: Landmarks | None,
    notes: tuple[str, ...],
    seconds: dict[str, float],
    rows: tuple[Floats | None, Floats | None] = (None, None),
) -> MatchResult:
    pair, coarse = answer.coarse.pair, answer.coarse.matching
    x, y, count = pair.source, pair.target, len(answer.points)
    difference = pair.source_distances[:count, :count] - answer.distances
    # A landmark is itself and not a vertex of a coarse proxy near to it, or one that is welded to it.
    known = 0 if landmarks is None else len(landmarks)
    source_vertices, target_vertices = x.vertices[x.samples.vertices], y.vertices[y.samples.vertices]
    if landmarks is not None:
        source_vertices[:known], target_vertices[:known] = landmarks.source.original, landmarks.target.original

    def exact(points: SurfacePoints) -> SurfacePoints:
        """Put the landmarks among points at the very vertices that were given."""
        first = np.arange(min(known, len(points)))
        return placed_at_vertices(points, y.original, first, target_vertices[first]) if known else points

    return MatchResult(
        source_points=SurfacePoints.at_vertices(x.original, source_vertices[:count]),
        target_points=exact(y.surface.on_original(answer.points)),
        distortion=answer.distortion,
        linear=answer.linear,
        quadratic=answer.quadratic,
        point_distortion=np.sqrt(np.square(difference).sum(axis=1) / max(count - 1, 1)),
        orientation=answer.orientation,
        levels=tuple(replace(level, target_points=exact(level.target_points)) for level in answer.levels),
        coarse=CoarseMatch(
            source_vertices[: len(coarse.assignment)],
            target_vertices[coarse.assignment],
            answer.candidates,
            coarse.cost,
            coarse.lower_bound,
            coarse.proven,
            coarse.nodes,
        ),
        source_distances=rows[0],
        target_distances=rows[1],
        notes=notes,
        seconds=dict(seconds),
    )
