# SPDX-License-Identifier: GPL-3.0-or-later
"""Marked edges of one mesh, such as sharp ones and seams, traced along the edges of another."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.sparse import csr_array
from scipy.sparse.csgraph import dijkstra
from scipy.spatial import cKDTree

from ...mesh.connectivity.edge_chains import edge_chains, way_to_root
from ...mesh.surface_map import SurfaceMap
from ...mesh.triangle_mesh import TriangleMesh
from ...runtime.arrays import TINY, Floats, Ints, distances_from_segments, lengths_along, ranges
from ...runtime.errors import MatchError
from ...runtime.progress import Progress, Steps

_PIECE = 8.0
"""Length of the pieces that a line is traced in, in edges of the target: short enough that no piece has a short cut
from one end of a bend to the other, long enough that the ends do not matter."""

_EXACT = 0.02
"""A vertex of the target lies in the same place as one of the line if it is no farther away, in edges of the target."""

_CORRIDOR = (3.0, 12.0)
"""How far from a line its trace may run, in edges of the target: at first, and where that leads nowhere."""

_ALONG = 0.1
"""Cost of an edge that lies on the line, compared with one that is a whole edge away from it."""

_DENSITY = 4
"""Samples of a line per edge of the target."""

_FAR = 4.0
"""A line is lost if most of its vertices are farther than this, in edges of the target, from what lies nearest."""

_TRIED = 8
"""Among how many edges with the nearest middles the nearest edge is sought."""


@dataclass(frozen=True, eq=False)
class CarriedValues:
    """Values on the target.

    Attributes
    ----------
    values : (k, ...) array
        One for each point, edge, face or corner, of the type of those on the source.
    lost : int
        How many lines of marked edges run where the target has nothing: inside a mouth that it lacks, say.
    """

    values: NDArray[Any]
    lost: int = 0

    def __repr__(self) -> str:
        return f"<{type(self).__name__}: {self.values.shape}, {self.lost} lost>"


def trace_edges_steps(
    marked: Ints,
    values: ArrayLike,
    source: TriangleMesh,
    edges: Ints,
    *,
    source_to_target: SurfaceMap,
    target_to_source: SurfaceMap,
) -> Steps[CarriedValues]:
    """Trace marked edges of the source along the edges of the target.

    The marked edges are joined to chains, which end at junctions.  Vertices along a chain, some edges of the target
    apart and at its bends, get a vertex of the target each, junctions the same one in all their chains; between these
    the trace is the path along the target's edges that costs least, where an edge costs its length times a part that
    grows with the square of its distance from the chain.  So lines stay connected, single, and as long as they were.

    Parameters
    ----------
    marked : (k, 2) array of int
        Vertices of the marked edges of the source.
    values : (k,) array_like of float
        Their values, positive.
    source : TriangleMesh
        The source.
    edges : (e, 2) array of int
        Vertices of the edges of the target.
    source_to_target, target_to_source : SurfaceMap
        The maps between the vertices of both.

    Yields
    ------
    Progress
        After each chain.

    Returns
    -------
    CarriedValues
        For each edge of the target the value of the marked edge that it follows, the largest if several; zero for all
        others.

    Raises
    ------
    MatchError
        If edges and maps do not belong together.
    """
    values = np.asarray(values, np.float64)
    _check(source, edges, source_to_target, target_to_source)
    traced, lost = np.zeros(len(edges)), 0
    if not len(marked) or not len(edges):
        return CarriedValues(traced)
    chains = edge_chains(marked)
    tracer = _Tracer(source, edges, source_to_target, target_to_source)
    for number, (vertices, numbers) in enumerate(chains):
        yield Progress(number / len(chains), "Tracing edges")
        found = tracer.trace(np.array(vertices), values[np.array(numbers)])
        if found is None:
            lost += 1
        else:
            np.maximum.at(traced, *found)
    return CarriedValues(traced, lost)


def nearest_edge_values(
    values: NDArray[Any], source: TriangleMesh, source_edges: Ints, edges: Ints, target_to_source: SurfaceMap
) -> NDArray[Any]:
    """Carry a value of each edge of the source, (e_x, ...), to the edges of the target, (e_y, ...): from the nearest.

    For values that all edges have; edges that are marked among others are to be traced.
    """
    ends = source.vertices[source_edges]
    middles = target_to_source.positions[edges].mean(axis=1)
    found = cKDTree(ends.mean(axis=1)).query(middles, np.arange(1, min(_TRIED, len(ends)) + 1))[1]
    start, along = ends[found, 0], ends[found, 1] - ends[found, 0]  # (e_y, tried, 3)
    away = distances_from_segments(middles[:, None], start, along)
    return values[np.take_along_axis(found, away.argmin(axis=1)[:, None], axis=1)[:, 0]]


class _Tracer:
    """The edges of the target as they lie on the source."""

    def __init__(
        self, source: TriangleMesh, edges: Ints, source_to_target: SurfaceMap, target_to_source: SurfaceMap
    ) -> None:
        self._vertices = source.vertices
        self._images = target_to_source.positions
        self._corners = source_to_target.corners
        self._edges = edges
        self._lengths = np.linalg.norm(self._images[edges[:, 0]] - self._images[edges[:, 1]], axis=1)
        self._tree = cKDTree(self._images)
        n, k = len(self._images), len(edges)
        tail, head = np.concatenate([edges, edges[:, ::-1]]).T
        # For each vertex its edges, numbered from one: zero is no entry of a sparse graph.
        self._graph = csr_array((np.tile(np.arange(k), 2) + 1, (tail, head)), shape=(n, n))
        self._reach = np.bincount(tail, np.tile(self._lengths, 2), n) / np.maximum(np.bincount(tail, minlength=n), 1)
        self._used = np.bincount(tail, minlength=n) > 0

    def trace(self, chain: Ints, values: Floats) -> tuple[Ints, Floats] | None:
        """Trace a chain of c + 1 vertices and c edges with values; return edges of the target and their values.

        None if the target has nothing where the chain runs.
        """
        points = self._vertices[chain]
        candidates, missed = self._counterparts(chain)
        step = max(float(np.median(self._reach[candidates])), TINY)
        if np.median(missed) > _FAR * step:
            return None
        anchors = self._anchors(points, missed, step)
        route: list[int] = [int(candidates[anchors[0]])]
        for first, last in pairwise(anchors):
            samples, _ = _sampled(points[first : last + 1], step / _DENSITY)
            self._extend(route, int(candidates[last]), samples, step)
        path = self._edges_between(route)
        samples, segment = _sampled(points, step / _DENSITY)
        middles = self._images[self._edges[path]].mean(axis=1)
        return path, values[segment[cKDTree(samples).query(middles)[1]]] if len(path) else np.zeros(0)

    def _counterparts(self, chain: Ints) -> tuple[Ints, Floats]:
        """For vertices of the source the vertex of the target that lies nearest on the source, and how far away."""
        corners = self._corners[chain]
        away = np.linalg.norm(self._images[corners] - self._vertices[chain][:, None], axis=2)
        best = np.where(self._used[corners], away, np.inf).argmin(axis=1)[:, None]
        return np.take_along_axis(corners, best, axis=1)[:, 0], np.take_along_axis(away, best, axis=1)[:, 0]

    def _anchors(self, points: Floats, missed: Floats, step: float) -> Ints:
        """Choose places along a chain, both ends among them, where it is to pass exactly.

        Those are the best of each piece, those where the target has a vertex in the same place, and bends.
        """
        along = lengths_along(points)
        pieces = max(round(float(along[-1]) / (_PIECE * step)), 1)
        if (points[0] == points[-1]).all():  # a loop needs three, or it would collapse
            pieces = max(pieces, 3)
        chosen = {0, len(points) - 1, *np.flatnonzero(missed < _EXACT * step).tolist()}
        for number in range(1, pieces):
            away = np.abs(along - along[-1] * number / pieces)
            near = np.flatnonzero(away <= max(float(away.min()), float(along[-1]) / (4 * pieces)))
            chosen.add(int(near[missed[near].argmin()]))
        return _with_bends(points, sorted(chosen), step)

    def _extend(self, route: list[int], end: int, samples: Floats, step: float) -> None:
        """Lead a route on to a vertex, along samples (s, 3) of the line; there may be no way."""
        start = route[-1]
        if start == end:
            return
        for width in _CORRIDOR:
            near = self._tree.query_ball_point(samples, width * step)
            inside = np.unique(np.concatenate([np.asarray(part, np.int64) for part in near] + [np.array([start, end])]))
            found = self._cheapest(inside, start, end, samples, step)
            if found is not None:
                break
        else:
            route.append(end)  # without edges between: the line is broken there
            return
        for vertex in found:
            if len(route) > 1 and route[-2] == vertex:
                route.pop()  # there and back again
            else:
                route.append(vertex)

    def _cheapest(self, inside: Ints, start: int, end: int, samples: Floats, step: float) -> list[int] | None:
        """Vertices of the cheapest path within a corridor, without its start; None if there is no path."""
        graph = self._graph[inside][:, inside].tocsr()
        numbers = graph.data - 1
        line = cKDTree(samples)
        away = line.query(self._images[inside])[0] ** 2
        row = np.repeat(np.arange(len(inside)), np.diff(graph.indptr))
        middle = line.query((self._images[inside[row]] + self._images[inside[graph.indices]]) / 2)[0] ** 2
        mean = (away[row] + away[graph.indices] + 4 * middle) / 6
        cost = (self._lengths[numbers] + TINY) * (_ALONG + mean / step**2)
        weighted = csr_array((cost, graph.indices, graph.indptr), shape=graph.shape)
        first, last = np.searchsorted(inside, [start, end])
        _, before = dijkstra(weighted, directed=True, indices=int(first), return_predecessors=True)
        return None if before[last] < 0 else inside[way_to_root(before, last)[-2::-1]].tolist()

    def _edges_between(self, route: list[int]) -> Ints:
        """Edges between successive vertices, as far as there are any."""
        vertices = np.array(route)
        while len(vertices) > 3 and vertices[0] == vertices[-1] and vertices[1] == vertices[-2]:
            vertices = vertices[1:-1]  # a loop that begins with a spur
        if len(vertices) < 2:
            return np.zeros(0, np.int64)
        numbers = np.asarray(self._graph[vertices[:-1], vertices[1:]]).ravel()
        return numbers[numbers > 0] - 1


def _with_bends(points: Floats, chosen: list[int], step: float) -> Ints:
    """Add places to some along a line until it stays within a step of the straight lines between them."""
    left, kept = list(pairwise(chosen)), set(chosen)
    while left:
        first, last = left.pop()
        if last - first < 2:
            continue
        away = distances_from_segments(points[first + 1 : last], points[first], points[last] - points[first])
        if away.max() > step:
            bend = first + 1 + int(away.argmax())
            kept.add(bend)
            left += [(first, bend), (bend, last)]
    return np.array(sorted(kept))


def _sampled(points: Floats, spacing: float) -> tuple[Floats, Ints]:
    """Points along a line (c + 1, 3), its own among them, and the number of the segment of each."""
    lengths = np.linalg.norm(np.diff(points, axis=0), axis=1)
    # An even number of parts, so that the middles of segments are among them.
    parts = 2 * np.maximum(np.ceil(lengths / (2 * spacing)), 1).astype(np.int64)
    segment = np.repeat(np.arange(len(parts)), parts)
    step = ranges(np.zeros_like(parts), parts)
    part = (step / parts[segment])[:, None]
    samples = (1 - part) * points[segment] + part * points[segment + 1]
    return np.concatenate([samples, points[-1:]]), np.append(segment, len(parts) - 1)


def _check(source: TriangleMesh, edges: Ints, source_to_target: SurfaceMap, target_to_source: SurfaceMap) -> None:
    """Make sure that all belong together."""
    known = (len(source_to_target), target_to_source.image_vertex_count)
    if known != (source.vertex_count, source.vertex_count):
        raise MatchError(f"The maps are of meshes of {known} vertices, but the source has {source.vertex_count}.")
    count = len(target_to_source)
    if source_to_target.image_vertex_count != count or edges.max(initial=-1) >= count:
        raise MatchError(f"The edges and the maps of the target, of {count} vertices, do not belong together.")
