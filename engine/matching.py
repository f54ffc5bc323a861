# SPDX-License-Identifier: GPL-3.0-or-later
"""Match two surfaces: the engine's front door."""

from __future__ import annotations

import time
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from .errors import MatchError
from .hierarchy import Refined, level_sizes, refine_steps
from .hypotheses import Hypothesis, choose_steps, coarse_candidates, coarse_steps
from .pair import Pair
from .progress import Progress, Steps, run, within
from .result import CoarseMatch, Level, MatchResult
from .settings import MatchSettings
from .shape import Shape
from .surface import SurfacePoints

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from .mesh import TriangleMesh

__all__ = ["match", "match_steps"]


def match(
    source: TriangleMesh | Shape, target: TriangleMesh | Shape, settings: MatchSettings | None = None
) -> MatchResult:
    """Find corresponding points on two surfaces that differ by a non-rigid deformation.

    The first points are matched exactly by branch and bound; then points are added level by level, and all points are
    matched again at each level in a relaxed problem over their neighbourhoods [1]_.

    Parameters
    ----------
    source, target : TriangleMesh or Shape
        The surfaces X and Y.  Position, orientation, size, units, triangulation and vertex order do not matter.
        Pass a `Shape` to keep what is computed for it from one match to the next.
    settings : MatchSettings, optional
        How many points, and how hard to search.

    Returns
    -------
    MatchResult
        Corresponding points, their distortion, and the mirrored answer if the shapes are nearly symmetric.

    Raises
    ------
    MatchError
        If a surface has too few vertices for the points that were asked for.

    See Also
    --------
    match_steps : the same in short steps, with progress.

    References
    ----------
    .. [1] D. Raviv, A. Dubrovina, R. Kimmel, "Hierarchical Matching of Non-rigid Shapes", SSVM 2011.
    """
    return run(match_steps(source, target, settings))


def match_steps(
    source: TriangleMesh | Shape, target: TriangleMesh | Shape, settings: MatchSettings | None = None
) -> Steps[MatchResult]:
    """Match two surfaces in short steps; see `match`.

    Yields
    ------
    Progress
        About every tenth of a second for meshes of some thousand vertices.

    Returns
    -------
    MatchResult
        When the generator ends.  Closing it earlier cancels the match; nothing has to be cleaned up.
    """
    settings = settings or MatchSettings()
    clock = _Clock()
    x = source if isinstance(source, Shape) else Shape(source)
    y = target if isinstance(target, Shape) else Shape(target)
    for shape, name in ((x, "source"), (y, "target")):
        if shape.mesh.vertex_count < settings.points:
            raise MatchError(
                f"{settings.points} points cannot be matched: the {name} has only {shape.mesh.vertex_count} vertices"
                f"{' in its largest part' if shape.mesh is not shape.original else ''}. "
                "Use fewer points or subdivide the mesh."
            )
    samples = max(settings.samples, 2 * settings.points)
    yield from within(x.sample_steps(samples), 0.0, 0.3)
    yield from within(y.sample_steps(samples), 0.3, 0.6)
    clock.lap("geodesics")
    if Pair.needs_spectrum(settings):
        yield from within(x.spectrum_steps(settings.eigenpairs), 0.6, 0.65)
        yield from within(y.spectrum_steps(settings.eigenpairs), 0.65, 0.7)
        clock.lap("eigenpairs")
    pair = Pair(x.limited(samples), y.limited(samples), settings)
    clock.lap("descriptors")
    coarse = yield from within(coarse_steps(pair), 0.7, 0.8, "Matching the coarse points exactly")
    clock.lap("coarse")
    chosen, mirrored = yield from within(choose_steps(coarse), 0.8, 0.9)
    answers = []
    for number, hypothesis in enumerate(filter(None, (chosen, mirrored))):
        start = 0.9 + 0.05 * number
        levels = yield from within(_finish_steps(hypothesis), start, start + 0.05)
        answers.append((hypothesis, levels))
    clock.lap("hierarchy")
    yield Progress(1.0, "Done")
    notes = [note for shape, name in ((x, "source"), (y, "target")) for note in _notes(shape, name)]
    results = [_result(hypothesis, levels, tuple(notes), clock.laps) for hypothesis, levels in answers]
    return replace(results[0], mirrored=results[1]) if len(results) > 1 else results[0]


class _Clock:
    """Seconds between laps, by name."""

    def __init__(self) -> None:
        self.laps: dict[str, float] = {}
        self._last = time.perf_counter()

    def lap(self, name: str) -> None:
        now = time.perf_counter()
        self.laps[name] = now - self._last
        self._last = now


def _finish_steps(hypothesis: Hypothesis) -> Steps[list[Refined]]:
    """Go on from the level at which the hypotheses were compared to the finest."""
    pair = hypothesis.coarse.pair
    reached = len(hypothesis.assignment)
    sizes = level_sizes(reached, pair.settings.points)[1:]
    return hypothesis.levels + (yield from refine_steps(pair, hypothesis.assignment, sizes))


def _notes(shape: Shape, name: str) -> list[str]:
    """Say what of a surface was left out."""
    count = int(shape.original.component_labels[shape.original.triangles].max()) + 1
    if count == 1:
        return []
    share = shape.mesh.area / shape.original.area
    return [f"The {name} has {count} separate parts: the largest ({share:.0%} of the area) was matched."]


def _result(
    hypothesis: Hypothesis, levels: list[Refined], notes: tuple[str, ...], seconds: dict[str, float]
) -> MatchResult:
    pair, coarse = hypothesis.coarse.pair, hypothesis.coarse.matching
    x, y, assignment = pair.source, pair.target, levels[-1].assignment
    count = len(assignment)
    problem = pair.problem(count)
    difference = problem.source_distances - problem.target_distances[np.ix_(assignment, assignment)]
    return MatchResult(
        source_points=_points(x, np.arange(count)),
        target_points=_points(y, assignment),
        distortion=problem.cost(assignment),
        linear=problem.linear_cost(assignment),
        quadratic=problem.quadratic_cost(assignment),
        point_distortion=np.sqrt(np.square(difference).sum(axis=1) / max(count - 1, 1)),
        orientation=hypothesis.orientation,
        levels=tuple(
            Level(
                len(level.assignment),
                level.iterations,
                pair.problem(len(level.assignment)).cost(level.assignment),
                _points(y, level.assignment),
            )
            for level in levels
        ),
        coarse=CoarseMatch(
            x.vertices[x.samples[: len(coarse.assignment)]],
            y.vertices[y.samples[coarse.assignment]],
            coarse_candidates(pair),
            coarse.cost,
            coarse.lower_bound,
            coarse.proven,
            coarse.nodes,
        ),
        mirrored=None,
        source_distances=_distances(x, np.arange(count)),
        target_distances=_distances(y, assignment),
        notes=notes,
        seconds=seconds,
    )


def _points(shape: Shape, samples: NDArray[np.int64]) -> SurfacePoints:
    """Place samples on the whole surface, of which the shape may be a part."""
    return SurfacePoints.at_vertices(shape.original, shape.vertices[shape.samples[samples]])


def _distances(shape: Shape, samples: NDArray[np.int64]) -> NDArray[np.float64]:
    """Distances from samples to all vertices of the whole surface, in its units; inf on other parts."""
    rows = np.full((len(samples), shape.original.vertex_count), np.inf)
    rows[:, shape.vertices] = shape.sample_rows[samples] * shape.scale
    return rows
