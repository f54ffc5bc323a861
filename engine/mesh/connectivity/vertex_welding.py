# SPDX-License-Identifier: GPL-3.0-or-later
"""Welding of vertices along seams that a surface was cut open at, but not of surfaces that touch."""

from __future__ import annotations

import numpy as np
from scipy.spatial import cKDTree

from ...runtime.arrays import Bools, Floats, Ints, group_smallest
from .components import joined_components
from .halfedges import EdgeGroups, triangle_slots

_TOLERANCE = 0.01
"""How far apart two vertices may be to be one, as a part of the shortest edge at either."""

_NEIGHBOURS = 8
"""How many other places near a vertex are compared: about six corners meet at a vertex of a mesh of loose triangles."""


def weld_boundaries(vertices: Floats, triangles: Ints, groups: EdgeGroups) -> Ints:
    """Find which vertices at boundaries are one and the same point of the surface.

    Parameters
    ----------
    vertices : (n, 3) array of float
        Positions.
    triangles : (m, 3) array of int
        Corners of each triangle.
    groups : EdgeGroups
        The half-edges of each edge.

    Returns
    -------
    (n,) array of int
        For each vertex, the vertex that stands for it: the first of those it is one with, mostly itself.

    Notes
    -----
    Only vertices at the ends of edges with one triangle are welded: at a seam both sides are open, while two
    surfaces that touch, such as hands held together, are whole on either side and stay apart.
    """
    representatives = np.arange(len(vertices))
    open_edges = groups.order[groups.starts[groups.counts == 1]]
    if not len(open_edges):
        return representatives
    at_boundary = np.zeros(len(vertices), bool)
    for shift in (0, 1):
        at_boundary[triangle_slots(triangles, open_edges, shift)] = True
    boundary = np.flatnonzero(at_boundary)

    places, first = _equal_rows(vertices[boundary])
    shortest = _shortest_edges(vertices, triangles, groups, at_boundary)
    radius = group_smallest(places, _TOLERANCE * shortest[boundary], len(first))
    one, other = _close_pairs(vertices[boundary[first]], radius)
    clusters = joined_components(len(first), one, other)[places]

    earliest = group_smallest(clusters, boundary, int(clusters.max()) + 1, len(vertices))
    representatives[boundary] = earliest[clusters]
    return representatives


def _equal_rows(points: Floats) -> tuple[Ints, Ints]:
    """Give each different row of points (k, 3) a number: the number of each (k,), and the first row of each number."""
    # A hash of the bits sorts as one integer; that two different points share it is checked, and as good as impossible.
    bits = np.ascontiguousarray(points + 0.0).view(np.uint64)  # minus zero becomes zero
    mixed = np.zeros(len(points), np.uint64)
    for column, factor in enumerate((0x9E3779B97F4A7C15, 0xC2B2AE3D27D4EB4F, 0x165667B19E3779F9)):
        mixed = (mixed ^ (mixed >> np.uint64(29))) + bits[:, column] * np.uint64(factor)
    order = np.argsort(mixed, kind="stable")
    ordered = points[order]
    new = np.append(True, (ordered[1:] != ordered[:-1]).any(axis=1))
    numbers = np.empty(len(points), np.int64)
    numbers[order] = np.cumsum(new) - 1
    return numbers, order[new]


def _shortest_edges(vertices: Floats, triangles: Ints, groups: EdgeGroups, wanted: Bools) -> Floats:
    """Length of the shortest edge at each wanted vertex that is longer than zero, (n,); elsewhere infinite."""
    edges = groups.order[groups.starts]
    tail, head = (triangle_slots(triangles, edges, shift) for shift in (0, 1))
    near = wanted[tail] | wanted[head]
    tail, head = tail[near], head[near]
    lengths = np.linalg.norm(vertices[tail] - vertices[head], axis=1)
    lengths[lengths == 0] = np.inf
    return group_smallest(np.concatenate([tail, head]), np.tile(lengths, 2), len(vertices))


def _close_pairs(points: Floats, radius: Floats) -> tuple[Ints, Ints]:
    """Pairs of points (k, 3) that are closer than the radius (k,) of both."""
    finite = np.isfinite(radius)
    count = min(_NEIGHBOURS + 1, len(points))
    largest = float(radius[finite].max(initial=0.0))
    if count < 2 or not largest:
        return np.empty(0, np.int64), np.empty(0, np.int64)
    tree = cKDTree(points, balanced_tree=False, compact_nodes=False)
    distances, neighbours = tree.query(points, count, distance_upper_bound=largest * (1 + 1e-12))
    one, column = np.nonzero(np.isfinite(distances))
    other = neighbours[one, column]
    close = (one != other) & (distances[one, column] <= np.minimum(radius[one], radius[other]))
    return one[close], other[close]
