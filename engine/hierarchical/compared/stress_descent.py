# SPDX-License-Identifier: GPL-3.0-or-later
"""Continuous descent: points move over the triangles of a surface until their distances are the wanted ones."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from ...mesh.connectivity.components import joined_components
from ...mesh.surface_points import SurfacePoints
from ...mesh.triangle_mesh import TriangleMesh
from ...runtime.arrays import Floats, Ints, ranges
from ...runtime.progress import Progress, Steps
from ...shapes.surface_distances import PointDistances, symmetric_roots
from .vertex_stress import LocalStress

_TRIANGLES = 6  # around a point in which it is minimised: as many as a regular vertex has
_BLOCK = 500_000  # distances from a point to a triangle that are handled at once
_PASSES = 5
_NO_LENGTH = 1e-9  # of the mean edge


@dataclass(frozen=True, eq=False)
class Stress:
    r"""Distortion of points that may lie anywhere on Y.

    .. math:: s(y) = \sum_i f_i(y_i) + \sum_{i, j} (d_Y(y_i, y_j) - d_{ij})^2

    The second sum runs over ordered pairs, as in the distortion of `MatchingProblem`.

    Parameters
    ----------
    wanted : (k, k) array of float
        Distances d_ij of the points on X, symmetric with a zero diagonal.
    linear : (k, n) array of float, optional
        f at the vertices of Y, linear in between; nothing by default.
    """

    wanted: Floats
    linear: Floats | None = None

    def of_places(self, places: SurfacePoints, owner: Ints) -> Floats:
        """Evaluate the linear term at places (q,), each for the point of its number (q,)."""
        return (self.at_vertices(places.corners, owner[:, None]) * places.barycentric).sum(axis=1)

    def at_vertices(self, vertices: Ints, owner: Ints) -> Floats:
        """Evaluate the linear term at vertices of any shape, for the points `owner` that broadcast with it."""
        return np.zeros(vertices.shape) if self.linear is None else self.linear[owner, vertices]


@dataclass(frozen=True, eq=False)
class Settled:
    """Points that have come to rest.

    Attributes
    ----------
    points : SurfacePoints
        Where they are, (k,), on the part of the surface that is used.
    distances : (k, k) array of float
        Distances between them.
    start, stress : float
        Stress before and after; the latter is never larger.
    sweeps : int
        How often all points were moved.
    """

    points: SurfacePoints
    distances: Floats
    start: float
    stress: float
    sweeps: int


def settle_steps(
    distances: PointDistances, start: SurfacePoints, stress: Stress, *, max_sweeps: int = 30, tolerance: float = 1e-3
) -> Steps[Settled]:
    """Move points over a surface so that the stress falls, until it rests in a local minimum.

    Parameters
    ----------
    distances : PointDistances
        The surface Y and its metric.
    start : SurfacePoints
        Places (k,) to start from, on ``distances.mesh``.
    stress : Stress
        What to minimise, for these k points.
    max_sweeps : int
        Limit of the sweeps over all points.
    tolerance : float
        A sweep that lowers the stress by a smaller part is the last one.

    Yields
    ------
    Progress
        Several times in each sweep.

    Returns
    -------
    Settled
        The points at rest.

    Notes
    -----
    With all others at rest, a point is moved to the minimum over the triangles around it.  In each, the distances are
    linearised where it is, which leaves a convex quadratic problem in its barycentric coordinates, solved exactly,
    and again from there [1]_.  So points cross edges and corners and stop at boundaries.  All points of a sweep
    propose such a move at once, as fast marching from all new corners together is cheaper; then those moves are made
    that lower the stress together with the ones made before, so it never rises.

    References
    ----------
    .. [1] A. M. Bronstein, M. M. Bronstein, R. Kimmel, "Generalized multidimensional scaling: a framework for
       isometry-invariant partial surface matching", PNAS 103 (2006).
    """
    for _ in distances.prepare_steps(start):
        yield Progress(0.0, "Moving points over the surface")
    now = _Places(start, np.arange(len(start)), distances.squares_between(start), stress)
    around = _TrianglesAround(distances.mesh)
    first, sweep = now.value, 0
    for sweep in range(1, max_sweeps + 1):
        here = Progress((sweep - 1) / max_sweeps, "Moving points over the surface")
        owner, places = yield from _proposals(distances, around, now, here)
        union = joined(distances.mesh, now.points, places)
        for _ in distances.prepare_steps(union):
            yield here
        both = _Places(union, np.append(now.owner, owner), distances.squares_between(union), stress)
        before, now = now, _best_choice(now, both)
        yield here
        if before.value - now.value <= tolerance * now.value:
            break
    return Settled(now.points, now.distances, first, now.value, sweep)


@dataclass(frozen=True, eq=False)
class _Places:
    """Places (q,) on the surface, each for one of the k points, and the squared distances between them."""

    points: SurfacePoints
    owner: Ints
    squares: Floats
    stress: Stress

    @cached_property
    def distances(self) -> Floats:
        """Distances between all places, (q, q)."""
        return symmetric_roots(self.squares)

    @cached_property
    def linear(self) -> Floats:
        """What the linear term is at each place, (q,)."""
        return self.stress.of_places(self.points, self.owner)

    @cached_property
    def pairs(self) -> Floats:
        """What each pair of places contributes to the stress, (q, q)."""
        return np.square(self.distances - self.stress.wanted[np.ix_(self.owner, self.owner)])

    @cached_property
    def value(self) -> float:
        """The stress, if there is one place for each point."""
        return float(self.linear.sum() + self.pairs.sum())

    @cached_property
    def of_each(self) -> Floats:
        """What of the stress each place takes part in, (q,)."""
        return self.linear + 2 * self.pairs.sum(axis=1)

    @cached_property
    def asymmetry(self) -> Floats:
        """What squared distances by the rows of the first point lack to the mean of both directions, (q, q).

        It hardly changes from place to place, so where only one direction is known, it is added as it is here.
        """
        return (self.squares.T - self.squares) / 2

    def chosen(self, numbers: Ints) -> _Places:
        """Return some of the places."""
        squares = self.squares[np.ix_(numbers, numbers)]
        return _Places(self.points.at(numbers), self.owner[numbers], squares, self.stress)


def joined(mesh: TriangleMesh, first: SurfacePoints, second: SurfacePoints) -> SurfacePoints:
    """List points of a mesh, then others of the same mesh."""
    return SurfacePoints.from_barycentric(
        mesh,
        np.concatenate([first.triangles, second.triangles]),
        np.concatenate([first.barycentric, second.barycentric]),
    )


def _best_choice(now: _Places, both: _Places) -> _Places:
    """Choose for each of the k points between its present place and its proposed one, if it has one.

    `both` are the present places, then the proposed ones, ordered by point.  The stress does not rise.
    """
    count, movers = len(now.owner), both.owner[len(now.owner) :]
    old, new = np.arange(count), np.arange(count)
    new[movers] = np.arange(count, count + len(movers))
    best = now
    for start in (old, new):
        choice = start.copy()
        for _ in range(_PASSES):
            before = choice.copy()
            for i in movers:
                options = np.array([old[i], new[i]])
                # A point makes no pair with itself, in whichever of its places.
                with_others = both.pairs[np.ix_(options, choice)].sum(axis=1) - both.pairs[options, choice[i]]
                choice[i] = options[(both.linear[options] + 2 * with_others).argmin()]
            if (choice == before).all():
                break
        places = both.chosen(choice)
        if places.value < best.value:
            best = places
    return best


def _proposals(
    distances: PointDistances, around: _TrianglesAround, now: _Places, here: Progress
) -> Steps[tuple[Ints, SurfacePoints]]:
    """Find for each point, the others at rest, a better place in the triangles around it.

    Returns
    -------
    owner : (m,) array of int
        The points that have one, ascending.
    places : SurfacePoints
        Their better places (m,).
    """
    mesh, points = distances.mesh, now.points
    owner, triangles = around.of(points)
    vertices, corners = np.unique(mesh.triangles[triangles], return_inverse=True)
    corners = corners.reshape(-1, 3)
    squares = distances.squares_to_vertices(points, vertices)
    ends = np.searchsorted(owner, np.arange(len(points) + 1))
    per_block = max(1, int(_BLOCK / (len(points) * np.diff(ends).max())))
    found = []
    for first in range(0, len(points), per_block):
        part = slice(ends[first], ends[min(first + per_block, len(points))])
        kept = part.start + _most_promising(now, owner[part], corners[part], squares, vertices)
        local = LocalStress(
            owner[kept],
            now.stress.wanted[:, owner[kept]],
            squares[:, corners[kept].T].transpose(1, 0, 2) + now.asymmetry[:, owner[kept]],
            distances.squared_sides(triangles[kept]),
            now.stress.at_vertices(vertices[corners[kept]], owner[kept, None]),
        )
        barycentric, value = local.minimise()
        found.append((owner[kept], triangles[kept], barycentric, value))
        yield here
    owner, triangles, barycentric, value = (np.concatenate(arrays) for arrays in zip(*found, strict=True))
    order = np.lexsort((value, owner))
    best = order[np.diff(owner[order], prepend=-1) > 0]
    best = best[value[best] < now.of_each[owner[best]]]
    return owner[best], SurfacePoints.from_barycentric(mesh, triangles[best], barycentric[best])


def _most_promising(now: _Places, owner: Ints, corners: Ints, squares: Floats, vertices: Ints) -> Ints:
    """List for each point the few triangles at whose corners it would cost least.

    Parameters
    ----------
    now : _Places
        Where the points (k,) are.
    owner : (q,) array of int
        The point of each triangle, ascending.
    corners : (q, 3) array of int
        The corners of the triangles, numbers in `vertices`.
    squares : (k, v) array of float
        Squared distances from the points to the vertices.
    vertices : (v,) array of int
        The vertices.
    """
    keys, inverse = np.unique(owner[:, None] * len(vertices) + corners, return_inverse=True)
    point, vertex = np.divmod(keys, len(vertices))
    roots = np.sqrt(np.maximum(squares[:, vertex] + now.asymmetry[:, point], 0))
    cost = np.square(roots - now.stress.wanted[:, point])
    cost[point, np.arange(len(point))] = 0
    at_corners = now.stress.at_vertices(vertices[vertex], point) + 2 * cost.sum(axis=0)
    rank = at_corners[inverse.reshape(corners.shape)].sum(axis=1)
    order = np.lexsort((rank, owner))
    place = np.arange(len(owner)) - np.searchsorted(owner, owner)  # both are ordered by point
    return np.sort(order[place < _TRIANGLES])


class _TrianglesAround:
    """The triangles around points: those that share with a point's triangle a corner that has weight.

    Corners joined by edges of no length count as one: otherwise no point would leave a triangle without area.
    """

    def __init__(self, mesh: TriangleMesh) -> None:
        n, lengths = mesh.vertex_count, mesh.edge_lengths
        a, b = mesh.edges[lengths <= _NO_LENGTH * lengths.mean()].T
        self._place = joined_components(n, a, b)
        corners = self._place[mesh.triangles.ravel()]
        self._triangles = np.argsort(corners, kind="stable") // 3
        self._starts = np.append(0, np.cumsum(np.bincount(corners, minlength=n)))
        self._count = mesh.triangle_count

    def of(self, points: SurfacePoints) -> tuple[Ints, Ints]:
        """List the triangles (q,), and the point that each is around (q,), ascending."""
        point, corner = np.nonzero(points.barycentric > 0)
        place = self._place[points.corners[point, corner]]
        counts = self._starts[place + 1] - self._starts[place]
        entry = ranges(self._starts[place], counts)
        keys = np.unique(np.repeat(point, counts) * self._count + self._triangles[entry])
        owner, triangle = np.divmod(keys, self._count)
        return owner, triangle
