# SPDX-License-Identifier: GPL-3.0-or-later
"""Paired half-edges of triangles, also where an edge has more than two."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.sparse import csr_array

from ...runtime.arrays import Bools, Floats, Ints, group_smallest, marked, ranges, unit_vectors
from .components import triangle_components

_MOST_TRIANGLES = 64
"""An edge of more triangles than this is left open: each of its triangles could only be paired by chance."""


@dataclass(frozen=True, eq=False)
class EdgeGroups:
    """The half-edges of a mesh, those of one edge side by side.

    Half-edge 3 t + i leads from corner i of triangle t to corner i + 1.

    Attributes
    ----------
    order : (3m,) array of int
        Half-edges sorted by the edge they belong to; those of one edge in increasing order.
    starts : (e,) array of int
        Where in `order` each edge begins.
    counts : (e,) array of int
        How many half-edges each edge has: one at a boundary, two inside a manifold.
    """

    order: Ints
    starts: Ints
    counts: Ints

    @property
    def pairs(self) -> tuple[Ints, Ints]:
        """The two half-edges of each edge that has just two, (p,) each; the lower numbers first."""
        doubles = self.starts[self.counts == 2]
        return self.order[doubles], self.order[doubles + 1]

    @property
    def twins(self) -> Ints:
        """The other half-edge of each edge that has just two, (3m,); -1 for all others."""
        twins = np.full(len(self.order), -1)
        one, other = self.pairs
        twins[one], twins[other] = other, one
        return twins


def following(half_edges: Ints) -> Ints:
    """Return the next half-edge of the same triangle for each half-edge."""
    return half_edges + np.where(half_edges % 3 == 2, -2, 1)


def triangle_slots(triangles: Ints, half_edges: Ints, shift: int) -> Ints:
    """Return a vertex of each half-edge's triangle: where it starts (shift 0), ends (1), or the opposite one (2)."""
    triangle, slot = np.divmod(half_edges, 3)
    return triangles[triangle, (slot + shift) % 3]


def group_half_edges(triangles: Ints, vertex_count: int) -> EdgeGroups:
    """Sort half-edges by the edge they belong to.

    Parameters
    ----------
    triangles : (m, 3) array of int
        Corners of each triangle, three different vertices.
    vertex_count : int
        Number of vertices, n.

    Returns
    -------
    EdgeGroups
        The half-edges of every edge.
    """
    tail, head = triangles.ravel(), np.roll(triangles, -1, axis=1).ravel()
    low, high = np.minimum(tail, head), np.maximum(tail, head)
    # Two counting sorts, the second stable, are twice as fast as one sort of combined keys.
    order = _counting_order(high, vertex_count)
    order = order[_counting_order(low[order], vertex_count)]
    low, high = low[order], high[order]
    first = np.ones(len(order), bool)
    first[1:] = (low[1:] != low[:-1]) | (high[1:] != high[:-1])
    starts = np.flatnonzero(first)
    return EdgeGroups(order, starts, np.diff(starts, append=len(order)))


def repeated_triangles(triangles: Ints, groups: EdgeGroups) -> Bools:
    """Say of each triangle whether an earlier one has the same three vertices, whichever way round, (m,)."""
    repeated = np.zeros(len(triangles), bool)
    # Two triangles with the same vertices share an edge, and are opposite to it at the same vertex.
    one, other = groups.pairs
    same = triangle_slots(triangles, one, 2) == triangle_slots(triangles, other, 2)
    repeated[other[same] // 3] = True

    half_edges, group = _crowded(groups, len(triangles) * 3)
    apex = triangle_slots(triangles, half_edges, 2)
    order = np.lexsort((half_edges, apex, group))
    same = (group[order][1:] == group[order][:-1]) & (apex[order][1:] == apex[order][:-1])
    repeated[half_edges[order[1:][same]] // 3] = True
    return repeated


def pair_half_edges(vertices: Floats, triangles: Ints, groups: EdgeGroups) -> Ints:
    """Find for each half-edge the one of the triangle that the surface goes on with across its edge.

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
    (3m,) array of int
        The twin of each half-edge; -1 at the boundary.

    Notes
    -----
    At an edge of two triangles these are paired, even if their normals disagree.  At an edge of more, those two are
    that continue each other best, then the best of the rest, and so on: two that hang together elsewhere, across edges
    of two triangles, come before others, so that a fin is told from what it stands on; two that agree in orientation
    before others; then those with the flattest dihedral angle.  Two that disagree in orientation are paired only if the
    angle between them is obtuse.
    """
    twins = groups.twins
    if not (groups.counts > 2).any():
        return twins
    one, other = _crowded_pairs(vertices, triangles, groups, triangle_components(twins))
    twins[one], twins[other] = other, one
    return twins


def twins_of(vertices: Floats, triangles: Ints) -> Ints:
    """Pair the half-edges of triangles that have not been grouped yet; see `pair_half_edges`."""
    return pair_half_edges(vertices, triangles, group_half_edges(triangles, len(vertices)))


def _crowded(groups: EdgeGroups, most: int) -> tuple[Ints, Ints]:
    """Half-edges of the edges with more than two, but no more than `most`, and the number of the edge of each."""
    edges = np.flatnonzero((groups.counts > 2) & (groups.counts <= most))
    counts = groups.counts[edges]
    group = np.repeat(np.arange(len(edges)), counts)
    return groups.order[ranges(groups.starts[edges], counts)], group


def _crowded_pairs(vertices: Floats, triangles: Ints, groups: EdgeGroups, patches: Ints) -> tuple[Ints, Ints]:
    """Pair half-edges at the edges of more than two triangles; `patches` (m,) says which hang together elsewhere."""
    half_edges, group = _crowded(groups, _MOST_TRIANGLES)
    if not len(half_edges):
        return half_edges, half_edges
    tail, head, apex = (triangle_slots(triangles, half_edges, shift) for shift in range(3))
    forward = tail < head
    start, end = vertices[np.minimum(tail, head)], vertices[np.maximum(tail, head)]
    along = unit_vectors(end - start)
    side = vertices[apex] - start
    side = unit_vectors(side - np.einsum("kd,kd->k", side, along)[:, None] * along)

    first, second = [], []
    for offset in range(1, int(np.bincount(group).max())):
        i = np.flatnonzero(group[offset:] == group[:-offset])
        first.append(i)
        second.append(i + offset)
    one, other = np.concatenate(first), np.concatenate(second)
    cosine = np.einsum("kd,kd->k", side[one], side[other])  # -1: flat, 1: folded back
    disagree = forward[one] == forward[other]
    possible = np.flatnonzero(~disagree | (cosine < 0))
    patch = patches[half_edges // 3]
    apart = patch[one] != patch[other]
    order = possible[np.lexsort((cosine[possible], disagree[possible], apart[possible]))]
    chosen = _greedy(one[order], other[order], len(half_edges))
    return half_edges[one[order[chosen]]], half_edges[other[order[chosen]]]


def _greedy(one: Ints, other: Ints, count: int) -> Ints:
    """Choose pairs, given best first, so that none of `count` members is in two: indices of the chosen."""
    left, chosen = np.arange(len(one)), []
    while len(left):
        best = group_smallest(np.concatenate([one[left], other[left]]), np.tile(left, 2), count, len(one))
        mutual = left[(best[one[left]] == left) & (best[other[left]] == left)]
        chosen.append(mutual)
        taken = marked(np.concatenate([one[mutual], other[mutual]]), count)
        left = left[~(taken[one[left]] | taken[other[left]])]
    return np.concatenate(chosen) if chosen else left


def _counting_order(keys: Ints, count: int) -> Ints:
    """Stable order that sorts keys (k,) from 0 to count - 1: the transposition of a sparse matrix."""
    k = len(keys)
    rows = csr_array((np.ones(k, np.int8), keys.astype(np.int32), np.arange(k + 1, dtype=np.int32)), shape=(k, count))
    return rows.tocsc().indices.astype(np.int64)
