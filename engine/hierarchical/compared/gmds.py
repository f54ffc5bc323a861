# SPDX-License-Identifier: GPL-3.0-or-later
"""Generalised multidimensional scaling: the distances alone, matched by points that move continuously.

This is the method that hierarchical matching is measured against.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal

import numpy as np

from ...mesh.surface_points import SurfacePoints
from ...runtime.arrays import Floats, Ints
from ...runtime.errors import MatchError
from ...runtime.progress import Progress, Steps, within
from ...shapes.shape import Shape
from ...shapes.surface_distances import PointDistances, SurfaceDistances, symmetric_roots
from ..hierarchy import level_sizes
from ..problem import MatchingProblem
from ..relaxation import descend
from .stress_descent import Settled, Stress, joined, settle_steps
from .vertex_stress import PairStress

Norm = Literal["L2", "Linf"]
"""What is minimised: the sum of the squared differences of distances, or the largest difference."""

_COARSE = 10  # points at the first level of its own start: as many as the hierarchical method matches exactly
_START_SAMPLES = 512  # places where the first point may start
_DESCENTS = 32  # starts that are improved before the best is taken
_EXPONENTS = (4, 8, 16, 32, 64)  # on the way from L2 to L-infinity
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
    norm : {"L2", "Linf"}
        What was minimised.
    quadratic : float
        Sum over ordered pairs of the squared differences of distances, as `MatchResult.quadratic`.
    largest : float
        Largest difference of the distances of a pair.
    distances : (k, k) array of float
        Distances between the points on Y.
    levels : tuple of GmdsLevel
        Coarse to fine; for "Linf", all of them minimise L2, and the points move on from the last.
    """

    source_points: SurfacePoints
    target_points: SurfacePoints
    norm: Norm
    quadratic: float
    largest: float
    distances: Floats
    levels: tuple[GmdsLevel, ...]


def gmds_steps(
    source: Shape,
    target: Shape,
    points: int,
    *,
    norm: Norm = "L2",
    start: SurfacePoints | None = None,
    levels: Sequence[int] | None = None,
    wanted: Floats | None = None,
    distances: PointDistances | None = None,
) -> Steps[GmdsResult]:
    r"""Match the farthest point samples of X to points anywhere on Y so that their distances are kept.

    .. math:: \min_{y_1 \dots y_k \in Y} \sum_{i, j} (d_X(x_i, x_j) - d_Y(y_i, y_j))^2
              \quad\text{or}\quad \max_{i, j} |d_X(x_i, x_j) - d_Y(y_i, y_j)|

    by generalised multidimensional scaling [1]_, with the y_i moving over the triangles of Y (see `settle_steps`).

    Parameters
    ----------
    source, target : Shape
        The surfaces X and Y.
    points : int
        How many points of X to match.
    norm : {"L2", "Linf"}
        Which of the two to minimise.
    start : SurfacePoints, optional
        Points on the whole target to which the first samples of the source are matched at first, such as those of an
        exact coarse matching.  By default it starts by itself.
    levels : sequence of int, optional
        Numbers of points of the levels, ascending, the last being `points`.  By default they double from 10, or from
        the points of `start`.
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
        If a surface has too few vertices, or the levels or the start do not fit.

    Notes
    -----
    *Its own start.*  For each sample of Y as the place of the first point, the points of the first level are placed
    one after the other at the sample that keeps the distances to those before best; the best few are improved by
    moving single points, and the best of them is taken.  *Levels.*  New points start at the best of all vertices for
    the distances to the points already matched; then all points move continuously.  *L-infinity* is reached from L2
    by minimising sums of powers, with exponents that double from 4 to 64, each by Newton steps in which the larger
    differences weigh more (iteratively reweighted least squares); the points with the smallest largest difference on
    the way are returned.

    References
    ----------
    .. [1] A. M. Bronstein, M. M. Bronstein, R. Kimmel, "Generalized multidimensional scaling: a framework for
       isometry-invariant partial surface matching", PNAS 103 (2006).
    """
    sizes = _checked_levels(source, target, points, start, levels)
    yield from within(source.sample_steps(points), 0.0, 0.2)
    if distances is None:
        distances = SurfaceDistances(target)
    if wanted is None:
        wanted = source.sample_distances[:points, :points]
    if start is None:
        yield from within(target.sample_steps(_START_SAMPLES), 0.2, 0.4)
        yield Progress(0.4, "Placing the first points")
        # Only the first samples, however many another match has taken: the result must not depend on it.
        places = SurfacePoints.at_vertices(target.mesh, target.samples[:_START_SAMPLES])
        yield from within(distances.prepare_steps(places), 0.4, 0.4)
        best = _own_start(symmetric_roots(distances.squares_between(places)), wanted[: sizes[0], : sizes[0]])
        placed = SurfacePoints.at_vertices(target.mesh, target.samples[best])
    else:
        placed = target.surface.on_mesh(start)
    done = []
    for number, size in enumerate(sizes):
        begin, end = (0.4 + 0.5 * part / len(sizes) for part in (number, number + 1))
        placed = yield from within(_inserted_steps(distances, placed, wanted[:size]), begin, begin)
        steps = settle_steps(distances, placed, Stress(wanted[:size, :size]))
        settled = yield from within(steps, begin, end, f"Moving {size} points over the surface")
        placed = settled.points
        done.append(
            GmdsLevel(size, settled.sweeps, settled.start, settled.stress, target.surface.on_original(settled.points))
        )
    if norm == "Linf":
        settled = yield from within(_minimax_steps(distances, settled, wanted), 0.9, 1.0)
    difference = settled.distances - wanted
    return GmdsResult(
        SurfacePoints.at_vertices(source.original, source.vertices[source.samples[:points]]),
        target.surface.on_original(settled.points),
        norm,
        float(np.square(difference).sum()),
        float(np.abs(difference).max()),
        settled.distances,
        tuple(done),
    )


def _checked_levels(
    source: Shape, target: Shape, points: int, start: SurfacePoints | None, levels: Sequence[int] | None
) -> list[int]:
    for shape, name in ((source, "source"), (target, "target")):
        if shape.mesh.vertex_count < points:
            raise MatchError(
                f"{points} points cannot be matched: the {name} has only {shape.mesh.vertex_count} vertices. "
                "Use fewer points or subdivide the mesh."
            )
    known = 1 if start is None else len(start)
    sizes = level_sizes(_COARSE if start is None else known, points) if levels is None else list(levels)
    if not sizes or sizes[-1] != points or sizes[0] < known or sorted(set(sizes)) != sizes:
        raise MatchError(
            f"The levels {sizes} do not lead from {known} points at the start to {points}: "
            "they have to ascend, and the last is the number of points."
        )
    return sizes


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


def _minimax_steps(distances: PointDistances, start: Settled, wanted: Floats) -> Steps[Settled]:
    """Lower the largest difference by growing exponents."""
    best = settled = start
    largest = float(np.abs(start.distances - wanted).max())
    for number, exponent in enumerate(_EXPONENTS):
        unit = float(np.abs(settled.distances - wanted).max())
        if unit == 0:
            break
        stress = Stress(wanted, pair=PairStress(1.0, exponent, unit))
        steps = settle_steps(distances, settled.points, stress)
        begin, end = (part / len(_EXPONENTS) for part in (number, number + 1))
        settled = yield from within(steps, begin, end, "Lowering the largest difference")
        now = float(np.abs(settled.distances - wanted).max())
        if now < largest:
            best, largest = settled, now
    return best
