# SPDX-License-Identifier: GPL-3.0-or-later
"""The triangulation dual to regions of a surface, and what keeps it from being a manifold."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...mesh.connectivity.components import vertex_components
from ...mesh.connectivity.halfedges import group_half_edges
from ...mesh.connectivity.nonmanifold_vertices import several_fans
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
    edges = np.minimum(tail, head) * count + np.maximum(tail, head)
    joined = np.isin(neighbours.min(axis=1) * count + neighbours.max(axis=1), edges)
    faulty[neighbours[~joined]] = True

    no_disc, at_end = _no_discs(triangles, count)
    faulty |= no_disc | ~marked(triangles, count)
    faulty |= at_end != marked(regions[cells.at_boundary], count)
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
        bad, _ = _no_discs(rest, vertex_count)
        if not bad.any():
            break
        kept = kept[~bad[rest].any(axis=1)]
    if not len(kept):
        return kept
    parts = vertex_components(triangles[kept], vertex_count)[triangles[kept, 0]]
    return kept[parts == np.bincount(parts).argmax()]


def _no_discs(triangles: Ints, count: int) -> tuple[Bools, Bools]:
    """Tell around which vertices triangles are no part of a disc, and which are at ends of the surface, (count,) each.

    They are none where an edge has two triangles on one side, or where they fall into several fans.
    """
    groups = group_half_edges(triangles, count)
    tail, head = triangles.ravel(), np.roll(triangles, -1, axis=1).ravel()
    twins = groups.twins
    one, other = groups.pairs
    crowded = np.append(groups.order[groups.starts[groups.counts > 2]], one[tail[one] == tail[other]])
    bad = several_fans(tail, twins, count) | marked(tail[crowded], count) | marked(head[crowded], count)
    return bad, marked(tail[twins < 0], count) | marked(head[twins < 0], count)
