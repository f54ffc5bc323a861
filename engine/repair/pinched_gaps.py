# SPDX-License-Identifier: GPL-3.0-or-later
"""Single faces that are missing where gaps meet in a vertex."""

from __future__ import annotations

import numpy as np

from ..mesh.connectivity.boundary_loops import BoundaryLoops
from ..mesh.connectivity.halfedges import triangle_slots
from ..mesh.connectivity.nonmanifold_vertices import several_fans
from ..mesh.triangle_mesh import triangle_areas
from ..runtime.arrays import Bools, Floats, Ints, ranges
from .hole_filling import small_holes


def pinched_gaps(vertices: Floats, triangles: Ints, twins: Ints, area: float) -> tuple[Ints, Ints]:
    """Find the gaps of one triangle that meet other gaps in a vertex.

    Where many faces are missing here and there, the surface would fall into shreds if it was cut apart in all vertices
    in which gaps meet.

    Parameters
    ----------
    vertices : (n, 3) array of float
        Positions.
    triangles : (m, 3) array of int
        Corners of each triangle; neighbours agree in orientation.
    twins : (3m,) array of int
        Twin of each half-edge, -1 at the boundary.
    area : float
        Area of the whole surface; larger gaps than other holes that are filled, and the ends of tubes, are left.

    Returns
    -------
    faces : (g, 3) array of int
        The missing triangles, which agree with the surface in orientation.
    half_edges : (g, 3) array of int
        The twins of their half-edges.
    """
    nothing = np.empty((0, 3), np.int64)
    n, tails, heads = len(vertices), triangles.ravel(), np.roll(triangles, -1, axis=1).ravel()
    if (twins >= 0).all():
        return nothing, nothing
    pinched = several_fans(tails, twins, n)
    if not pinched.any():
        return nothing, nothing
    # An edge that other triangles share, though they are not paired across it, has no room for another.
    edges = np.minimum(tails, heads) * n + np.maximum(tails, heads)
    _, number, counts = np.unique(edges, return_inverse=True, return_counts=True)
    alone = np.flatnonzero((twins < 0) & (counts[number.ravel()] == 1))
    gaps = _cycles_of_three(alone, tails[alone], heads[alone], n)
    gaps = gaps[(gaps[:, :1] // 3 != gaps // 3).any(axis=1)]  # others are the outlines of triangles on their own
    gaps = gaps[pinched[tails[gaps]].any(axis=1)]
    used = np.bincount(gaps.ravel(), minlength=len(tails))
    gaps = gaps[(used[gaps] == 1).all(axis=1)]
    if not len(gaps):
        return nothing, nothing
    gaps = gaps[_in_sheets(vertices, triangles, gaps, area)]
    # Against the boundary, from the end of the first half-edge to its start.
    first, second, third = gaps.T
    return np.stack([heads[first], tails[first], tails[third]], axis=1), np.stack([first, third, second], axis=1)


def _cycles_of_three(numbers: Ints, tails: Ints, heads: Ints, n: int) -> Ints:
    """List the half-edges of each closed walk of three of them, the least number first, (c, 3)."""
    order = np.argsort(tails * n + heads)
    numbers, tails, heads = numbers[order], tails[order], heads[order]
    keys = tails * n + heads
    begin, end = (np.searchsorted(tails, heads, side) for side in ("left", "right"))
    first = np.repeat(np.arange(len(tails)), end - begin)
    second = ranges(begin, end - begin)
    wanted = heads[second] * n + tails[first]
    third = np.minimum(np.searchsorted(keys, wanted), len(keys) - 1)
    walks = numbers[np.stack([first, second, third], axis=1)[keys[third] == wanted]]
    return walks[(walks[:, 0] < walks[:, 1]) & (walks[:, 0] < walks[:, 2])]


def _in_sheets(vertices: Floats, triangles: Ints, gaps: Ints, area: float) -> Bools:
    """Tell which gaps (g, 3) are holes to fill."""
    half_edges = gaps.ravel()
    tails, heads = (triangle_slots(triangles, half_edges, shift) for shift in (0, 1))
    a, b, c = vertices[tails.reshape(-1, 3)].transpose(1, 0, 2)
    areas = triangle_areas(vertices, tails.reshape(-1, 3))
    loops = BoundaryLoops(half_edges, tails, heads, np.repeat(np.arange(len(gaps)), 3), (a + b + c) / 3, areas)
    return small_holes(vertices, triangles, loops, area)
