# SPDX-License-Identifier: GPL-3.0-or-later
"""The triangulation dual to regions of a surface, and what keeps it from being a manifold."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...mesh.connectivity.components import joined_components
from ...mesh.connectivity.halfedges import following
from ...runtime.arrays import Bools, Ints, marked
from .surface_cells import SurfaceCells


@dataclass(frozen=True, eq=False)
class DualTriangulation:
    """A triangle wherever three regions meet.

    Attributes
    ----------
    triangles : (t, 3) array of int
        The regions, in the orientation of the surface.
    faulty : (k,) array of bool
        The regions around which the triangles are no manifold, or not one like the surface.
    """

    triangles: Ints
    faulty: Bools


def dual_triangulation(cells: SurfaceCells, regions: Ints, count: int) -> DualTriangulation:
    """Triangulate regions of cells.

    Parameters
    ----------
    cells : SurfaceCells
        Cells of an oriented surface.
    regions : (c,) array of int
        The region of each cell; regions are connected.
    count : int
        Number of regions, k.

    Returns
    -------
    DualTriangulation
        The triangles, and the regions to split.

    Notes
    -----
    If all regions are discs, each two share at most one stretch of border and each three at most one point, then the
    dual is a triangulation of the surface [1]_.  A region is faulty if

    - it is no disc: its Euler characteristic is not one,
    - it meets the same two others in more than one triangle, or an edge has two triangles on one side,
    - it has a neighbour, but no triangle with it,
    - its triangles are none, or more than one fan,
    - it is at the boundary of the triangulation, but not of the surface, or the other way round.

    References
    ----------
    .. [1] H. Edelsbrunner, N. Shah, "Triangulating topological spaces", Int. J. Comput. Geom. Appl. 7, 1997.
    """
    corners = regions[cells.triples]
    low, middle, high = np.sort(corners, axis=1).T
    meeting = (low != middle) & (middle != high)
    corners = corners[meeting]
    keys = (low[meeting] * count + middle[meeting]) * count + high[meeting]
    _, first, counts = np.unique(keys, return_index=True, return_counts=True)
    triangles = corners[first]
    faulty = marked(triangles[counts > 1], count)

    pairs = regions[cells.pairs]
    inside = pairs[:, 0] == pairs[:, 1]
    characteristics = np.bincount(regions, cells.characteristics, count)
    characteristics += np.bincount(pairs[inside, 0], cells.pair_characteristics[inside], count)
    characteristics += np.bincount(low[low == high], minlength=count)
    faulty |= characteristics != 1

    neighbours = pairs[~inside]
    tail, head = triangles.ravel(), np.roll(triangles, -1, axis=1).ravel()
    joined = np.isin(neighbours.min(axis=1) * count + neighbours.max(axis=1), _edge_keys(tail, head, count))
    faulty[neighbours[~joined]] = True

    crowded, open_ends = _edge_faults(triangles, count)
    faulty[crowded] = True
    faulty |= _fan_counts(triangles, count) != 1
    at_boundary = marked(regions[cells.at_boundary], count)
    faulty |= at_boundary != marked(open_ends, count)
    return DualTriangulation(triangles, faulty)


def manifold_part(triangles: Ints, vertex_count: int) -> Ints:
    """Leave out triangles until the rest is a manifold, and of that take the part of most triangles.

    Parameters
    ----------
    triangles : (t, 3) array of int
        Triangles.
    vertex_count : int
        Number of vertices.

    Returns
    -------
    (t',) array of int
        Indices of the triangles that stay; there may be none.
    """
    kept = np.arange(len(triangles))
    while len(kept):
        rest = triangles[kept]
        crowded, _ = _edge_faults(rest, vertex_count)
        bad = _fan_counts(rest, vertex_count) > 1
        bad[crowded] = True
        if not bad.any():
            break
        kept = kept[~bad[rest].any(axis=1)]
    if not len(kept):
        return kept
    a, b, c = triangles[kept].T
    parts = joined_components(vertex_count, np.concatenate([a, b]), np.concatenate([b, c]))[a]
    return kept[parts == np.bincount(parts).argmax()]


def _edge_keys(tail: Ints, head: Ints, count: int) -> Ints:
    """One number for each edge, whatever its direction."""
    return np.minimum(tail, head) * count + np.maximum(tail, head)


def _edge_faults(triangles: Ints, count: int) -> tuple[Ints, Ints]:
    """Vertices of half-edges that occur more than once, and vertices of edges with only one triangle."""
    tail, head = triangles.ravel(), np.roll(triangles, -1, axis=1).ravel()
    keys, counts = np.unique(tail * count + head, return_counts=True)
    crowded = np.concatenate(np.divmod(keys[counts > 1], count))
    open_ = keys[~np.isin(keys, head * count + tail)]
    return crowded, np.concatenate(np.divmod(open_, count))


def _fan_counts(triangles: Ints, count: int) -> Ints:
    """Into how many fans the triangles around each vertex fall that hang together across edges, (count,)."""
    tail, head = triangles.ravel(), np.roll(triangles, -1, axis=1).ravel()
    onward = following(np.arange(len(tail)))
    keys = _edge_keys(tail, head, count)
    order = np.argsort(keys, kind="stable")
    first = np.flatnonzero(keys[order][1:] == keys[order][:-1])
    one, other = order[first], order[first + 1]
    opposite = tail[one] == head[other]
    one, other = one[opposite], other[opposite]
    first, second = np.concatenate([one, onward[one]]), np.concatenate([onward[other], other])
    fans = joined_components(len(tail), first, second)
    vertex_of_fan = np.empty(int(fans.max()) + 1 if len(fans) else 0, np.int64)
    vertex_of_fan[fans] = tail
    return np.bincount(vertex_of_fan, minlength=count)
