# SPDX-License-Identifier: GPL-3.0-or-later
"""Vertices at which several sheets of a surface touch, and their separation."""

from __future__ import annotations

import numpy as np

from ...runtime.arrays import Bools, Ints, group_smallest, numbered
from .components import joined_components
from .halfedges import following

_LONGEST_WALK = 1000
"""Most steps around a vertex: longer ones, at the hub of thousands of triangles, cost more than they save."""


def split_fans(triangles: Ints, twins: Ints, vertex_count: int) -> tuple[Ints, Ints]:
    """Give each fan of triangles a vertex of its own.

    Parameters
    ----------
    triangles : (m, 3) array of int
        Corners of each triangle; neighbours agree in orientation.
    twins : (3m,) array of int
        Twin of each half-edge, -1 at the boundary.
    vertex_count : int
        Number of vertices, n.

    Returns
    -------
    triangles : (m, 3) array of int
        The triangles with new vertices, numbered from n on.
    copied : (k,) array of int
        The vertex that each of the new ones is a copy of.

    Notes
    -----
    A fan is a set of triangles around a vertex that hang together across its edges.  The largest fan keeps the vertex.
    """
    tail = triangles.ravel()
    faulty = several_fans(tail, twins, vertex_count)
    if not faulty.any():
        return triangles, np.empty(0, np.int64)
    corners = np.flatnonzero(faulty[tail])
    number = numbered(corners, len(tail))
    around = _next_around(twins, corners)
    joined = around >= 0
    fans = joined_components(len(corners), np.flatnonzero(joined), number[around[joined]])
    count = int(fans.max()) + 1
    vertex_of_fan = np.empty(count, np.int64)
    vertex_of_fan[fans] = tail[corners]
    first = group_smallest(fans, corners, count, len(tail))
    order = np.lexsort((first, -np.bincount(fans), vertex_of_fan))
    extra = order[1:][vertex_of_fan[order][1:] == vertex_of_fan[order][:-1]]
    new_vertex = vertex_of_fan.copy()
    new_vertex[extra] = vertex_count + np.arange(len(extra))
    split = tail.copy()
    split[corners] = new_vertex[fans]
    return split.reshape(-1, 3), vertex_of_fan[extra]


def several_fans(tail: Ints, twins: Ints, vertex_count: int) -> Bools:
    """Find the vertices at which several fans of triangles touch.

    Parameters
    ----------
    tail : (3m,) array of int
        Vertex that each half-edge starts at.
    twins : (3m,) array of int
        Twin of each half-edge, -1 at the boundary.
    vertex_count : int
        Number of vertices, n.

    Returns
    -------
    (n,) array of bool
        Whether a vertex has triangles which a walk around it does not come by.  Walks that take too long end early:
        their vertices are found, too, but have perhaps one fan only.
    """
    open_start = np.flatnonzero(twins < 0)
    start = numbered(tail, vertex_count)
    start[tail[open_start]] = open_start  # a walk around a boundary vertex begins at the boundary
    left = np.bincount(tail, minlength=vertex_count)
    walking = np.flatnonzero(start >= 0)
    corners = start[walking]
    for _ in range(_LONGEST_WALK):
        if not len(walking):
            break
        left[walking] -= 1
        corners = _next_around(twins, corners)
        going = (corners >= 0) & (corners != start[walking])
        walking, corners = walking[going], corners[going]
    return left > 0


def _next_around(twins: Ints, corners: Ints) -> Ints:
    """For corners, named by the half-edges that start there, the next around the same vertex; -1 at the boundary."""
    return twins[following(following(corners))]
