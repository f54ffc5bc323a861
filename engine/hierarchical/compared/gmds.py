# SPDX-License-Identifier: GPL-3.0-or-later
"""Generalised multidimensional scaling: the distances alone, matched by points that move continuously.

This is the method that hierarchical matching is measured against.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...mesh.surface_points import SurfacePoints
from ...runtime.arrays import Floats, Ints
from ...runtime.progress import Progress, Steps, part_of, within
from ...shapes.shape import Shape
from ...shapes.surface_distances import PointDistances, SurfaceDistances, symmetric_roots
from ..hierarchy import level_sizes
from ..problem import MatchingProblem
from ..relaxation import descend
from .stress_descent import Stress, joined, settle_steps

_COARSE = 10  # points at the first level of its own start: as many as the hierarchical method matches exactly
_START_SAMPLES = 512  # places where the first point may start
_DESCENTS = 32  # starts that are improved before the best is taken
_BLOCK = 4096  # vertices at which new points are tried at once


@dataclass(frozen=True, eq=False)
class GmdsLevel:
    """One level, as it ended.

    Attributes
    ----------
    points : int
        Number of points.
    sweeps : int
        How often all points were moved.
    start, stress : float
        Sum over ordered pairs of the squared differences of distances, before and after; the latter is never larger.
    target_points : SurfacePoints
        Where the points lie at the end.
    """

    points: int
    sweeps: int
    start: float
    stress: float
    target_points: SurfacePoints


@dataclass(frozen=True, eq=False)
class GmdsResult:
    """A correspondence found by generalised multidimensional scaling.

    Distances are in units of the square root of each surface's area.

    Attributes
    ----------
    source_points, target_points : SurfacePoints
        Corresponding points on the whole surfaces, k on each.
    quadratic : float
        Sum over ordered pairs of the squared differences of distances, as `MatchResult.quadratic`.
    distances : (k, k) array of float
        Distances between the points on Y.
    levels : tuple of GmdsLevel
        Coarse to fine.
    """

    source_points: SurfacePoints
    target_points: SurfacePoints
    quadratic: float
    distances: Floats
    levels: tuple[GmdsLevel, ...]


def gmds_steps(
    source: Shape,
    target: Shape,
    points: int,
    *,
    start: SurfacePoints | None = None,
    wanted: Floats | None = None,
    distances: PointDistances | None = None,
) -> Steps[GmdsResult]:
    r"""Match the farthest point samples of X to points anywhere on Y so that their distances are kept.

    .. math:: \min_{y_1 \dots y_k \in Y} \sum_{i, j} (d_X(x_i, x_j) - d_Y(y_i, y_j))^2

    by generalised multidimensional scaling [1]_, with the y_i moving over the triangles of Y (see `settle_steps`).

    Parameters
    ----------
    source, target : Shape
        The surfaces X and Y.
    points : int
        How many points of X to match.
    start : SurfacePoints, optional
        Points on the whole target to which the first samples of the source are matched at first, such as those of an
        exact coarse matching.  By default it starts by itself.
    wanted : (points, points) array of float, optional
        Distances between the points on X; geodesic by default.
    distances : PointDistances, optional
        The metric on Y; geodesic by default.  Passing a `SurfaceDistances` keeps what is computed for it from one
        match to the next.

    Yields
    ------
    Progress
        About every tenth of a second for meshes of some thousand vertices.

    Returns
    -------
    GmdsResult
        The correspondence: a local minimum.

    Raises
    ------
    MatchError
        If the start does not lie on the part of the target that is matched.

    Notes
    -----
    *Its own start.*  For each sample of Y as the place of the first point, the points of the first level are placed
    one after the other at the sample that keeps the distances to those before best; the best few are improved by
    moving single points, and the best of them is taken.  *Levels.*  Their numbers of points
    double from 10, or from the points of `start`.  New points start at the best of all vertices for the distances to
    the points already matched; then all points move continuously.

    References
    ----------
    .. [1] A. M. Bronstein, M. M. Bronstein, R. Kimmel, "Generalized multidimensional scaling: a framework for
       isometry-invariant partial surface matching", PNAS 103 (2006).
    """
    sizes = level_sizes(_COARSE if start is None else len(start), points)
    yield from within(source.sample_steps(points), 0.0, 0.2)
    if distances is None:
        distances = SurfaceDistances(target)
    if wanted is None:
        wanted = source.samples.distances[:points, :points]
    if start is None:
        yield from within(target.sample_steps(_START_SAMPLES), 0.2, 0.4)
        yield Progress(0.4, "Placing the first points")
        # Only the first samples, however many another match has taken: the result must not depend on it.
        places = SurfacePoints.at_vertices(target.mesh, target.samples.vertices[:_START_SAMPLES])
        yield from within(distances.prepare_steps(places), 0.4, 0.4)
        best = _own_start(symmetric_roots(distances.squares_between(places)), wanted[: sizes[0], : sizes[0]])
        placed = SurfacePoints.at_vertices(target.mesh, target.samples.vertices[best])
    else:
        placed = target.surface.on_mesh(start)
    done = []
    for number, size in enumerate(sizes):
        begin, end = part_of(number, len(sizes), 0.4)
        placed = yield from within(_inserted_steps(distances, placed, wanted[:size]), begin, begin)
        steps = settle_steps(distances, placed, Stress(wanted[:size, :size]))
        settled = yield from within(steps, begin, end, f"Moving {size} points over the surface")
        placed = settled.points
        done.append(
            GmdsLevel(size, settled.sweeps, settled.start, settled.stress, target.surface.on_original(settled.points))
        )
    return GmdsResult(
        SurfacePoints.at_vertices(source.original, source.vertices[source.samples.vertices[:points]]),
        target.surface.on_original(settled.points),
        float(np.square(settled.distances - wanted).sum()),
        settled.distances,
        tuple(done),
    )


def _own_start(between: Floats, wanted: Floats) -> Ints:
    """Choose places with distances (s, s) for the first points by their distances (k, k) on X alone, (k,)."""
    squares = np.square(between)
    # Row s: a matching that begins at place s, and what each place would cost as the next one, but for constants.
    chosen = np.arange(len(between))[:, None]
    for k in range(1, len(wanted)):
        cost = np.zeros_like(between)
        for j in range(k):
            cost += squares[chosen[:, j]] - 2 * wanted[k, j] * between[chosen[:, j]]
        np.put_along_axis(cost, chosen, np.inf, axis=1)
        chosen = np.append(chosen, cost.argmin(axis=1)[:, None], axis=1)
    problem = MatchingProblem(np.zeros((len(wanted), len(between))), wanted, between)
    costs = np.array([problem.quadratic_cost(row) for row in chosen])
    improved = [descend(problem, chosen[s]) for s in np.argsort(costs, kind="stable")[:_DESCENTS]]
    return min(improved, key=problem.quadratic_cost)


def _inserted_steps(distances: PointDistances, placed: SurfacePoints, wanted: Floats) -> Steps[SurfacePoints]:
    """Add new points, each at the vertex that keeps best its distances to the points that are placed.

    `wanted` is (k, points): of the old points and then the new ones.
    """
    known = wanted[len(placed) :, : len(placed)]
    if not len(known):
        return placed
    yield from distances.prepare_steps(placed)
    mesh = distances.mesh
    least, best = np.full(len(known), np.inf), np.zeros(len(known), np.int64)
    for first in range(0, mesh.vertex_count, _BLOCK):
        vertices = np.arange(first, min(first + _BLOCK, mesh.vertex_count))
        offered = np.maximum(distances.squares_to_vertices(placed, vertices), 0)
        cost = offered.sum(axis=0) - 2 * known @ np.sqrt(offered)
        here = cost.argmin(axis=1)
        value = cost[np.arange(len(known)), here]
        least, best = np.where(value < least, value, least), np.where(value < least, vertices[here], best)
    return joined(mesh, placed, SurfacePoints.at_vertices(mesh, best))
