# SPDX-License-Identifier: GPL-3.0-or-later
"""Match two surfaces: the engine's front door."""

from __future__ import annotations

import time
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from .errors import MatchError
from .gmds import on_whole_surface
from .pair import Pair
from .progress import Progress, Steps, run, within
from .result import CoarseMatch, MatchResult
from .settings import MatchSettings
from .shape import Shape
from .solvers import Answer, solve_steps
from .surface import SurfacePoints
from .surface_distances import SurfaceDistances, to_all_vertices_steps

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
    answers = yield from within(solve_steps(pair, clock.lap), 0.7, 1.0)
    notes = [note for shape, name in ((x, "source"), (y, "target")) for note in _notes(shape, name)]
    result = yield from _result_steps(answers[0], tuple(notes), clock.laps)
    if len(answers) > 1:
        mirrored = yield from _result_steps(answers[1], tuple(notes), clock.laps)
        result = replace(result, mirrored=mirrored)
    yield Progress(1.0, "Done")
    return result


class _Clock:
    """Seconds between laps, by name."""

    def __init__(self) -> None:
        self.laps: dict[str, float] = {}
        self._last = time.perf_counter()

    def lap(self, name: str) -> None:
        """Record the time since the last lap under a name."""
        now = time.perf_counter()
        self.laps[name] = now - self._last
        self._last = now


def _notes(shape: Shape, name: str) -> list[str]:
    """Say what of a surface was left out."""
    count = int(shape.original.component_labels[shape.original.triangles].max()) + 1
    if count == 1:
        return []
    share = shape.mesh.area / shape.original.area
    return [f"The {name} has {count} separate parts: the largest ({share:.0%} of the area) was matched."]


def _result_steps(answer: Answer, notes: tuple[str, ...], seconds: dict[str, float]) -> Steps[MatchResult]:
    pair, coarse = answer.coarse.pair, answer.coarse.matching
    x, y, count = pair.source, pair.target, len(answer.points)
    difference = pair.source_distances[:count, :count] - answer.distances
    # Distances to all vertices are geodesic ones whatever the metric: they are for spreading values over the surface.
    metric = pair.target_metric if isinstance(pair.target_metric, SurfaceDistances) else SurfaceDistances(y)
    target_distances = yield from within(to_all_vertices_steps(metric, answer.points), 1.0, 1.0)
    return MatchResult(
        source_points=SurfacePoints.at_vertices(x.original, x.vertices[x.samples[:count]]),
        target_points=on_whole_surface(y, answer.points),
        distortion=answer.distortion,
        linear=answer.linear,
        quadratic=answer.quadratic,
        point_distortion=np.sqrt(np.square(difference).sum(axis=1) / max(count - 1, 1)),
        orientation=answer.orientation,
        levels=answer.levels,
        coarse=CoarseMatch(
            x.vertices[x.samples[: len(coarse.assignment)]],
            y.vertices[y.samples[coarse.assignment]],
            answer.candidates,
            coarse.cost,
            coarse.lower_bound,
            coarse.proven,
            coarse.nodes,
        ),
        mirrored=None,
        source_distances=_sample_distances(x, count),
        target_distances=target_distances,
        notes=notes,
        seconds=seconds,
    )


def _sample_distances(shape: Shape, count: int) -> NDArray[np.float64]:
    """Distances from the first samples to all vertices of the whole surface, in its units; inf on other parts."""
    whole = np.full((count, shape.original.vertex_count), np.inf)
    whole[:, shape.vertices] = shape.sample_rows[:count].astype(np.float64) * shape.scale
    return whole
