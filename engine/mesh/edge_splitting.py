# SPDX-License-Identifier: GPL-3.0-or-later
"""More vertices for a coarse mesh: edges are split in the middle, the surface stays where it is."""

from __future__ import annotations

import numpy as np

from ..runtime.arrays import Ints
from .triangle_mesh import TriangleMesh

_PIECES = (
    ((0, 1, 2),),
    ((0, 3, 2), (3, 1, 2)),
    ((3, 1, 4), (0, 3, 4), (0, 4, 2)),
    ((0, 3, 5), (3, 1, 4), (5, 4, 2), (3, 4, 5)),
    ((3, 1, 4), (0, 3, 2), (3, 4, 2)),
)
"""The triangles into which one is cut of which no, one, two or three edges are split, and of two along the other
diagonal: 0 to 2 are its corners, 3 to 5 the middles of the edges that follow each."""

_OTHER_WAY = 4

_EQUAL = 1e-6
"""Relative difference up to which edges are taken to be equally long."""


def split_longest_edges(mesh: TriangleMesh, count: int) -> tuple[TriangleMesh, Ints]:
    """Split the longest edges of a mesh in the middle.

    Parameters
    ----------
    mesh : TriangleMesh
        A mesh of n vertices.
    count : int
        About how many edges to split, each once: more where others are as long as the shortest of these, so that
        nothing depends on how vertices are numbered.

    Returns
    -------
    mesh : TriangleMesh
        The same surface: first come the vertices of the mesh, then the middles of edges.
    ends : (k, 2) array of int
        Vertices at the ends of the edges that were split, in the order of the vertices added.
    """
    n = mesh.vertex_count
    lengths = mesh.edge_lengths
    count = min(max(count, 0), len(lengths))
    least = np.partition(lengths, -count)[-count] * (1 - _EQUAL) if count else np.inf
    chosen = np.flatnonzero(lengths >= least)
    ends = mesh.edges[chosen]
    vertices = np.concatenate([mesh.vertices, mesh.vertices[ends].mean(axis=1)])
    added = np.full(len(mesh.edges), -1)
    added[chosen] = n + np.arange(len(chosen))
    following = np.roll(mesh.triangles, -1, axis=1)
    keys = np.minimum(mesh.triangles, following) * n + np.maximum(mesh.triangles, following)
    middles = added[np.searchsorted(mesh.edges @ [n, 1], keys)]  # of the edge from each corner to the next, (m, 3)
    split = middles >= 0
    number = split.sum(axis=1)
    # Each triangle begins at a corner such that its first edge is the one that is split, or its first two.
    first = np.where(number == 1, split.argmax(axis=1), np.where(number == 2, (split.argmin(axis=1) + 1) % 3, 0))
    order = (first[:, None] + np.arange(3)) % 3
    names = np.concatenate([np.take_along_axis(each, order, axis=1) for each in (mesh.triangles, middles)], axis=1)
    # Beside the corner between two edges that are split lies a quadrilateral: its shorter diagonal becomes an edge.
    one, other = (np.linalg.norm(vertices[names[:, a]] - vertices[names[:, b]], axis=1) for a, b in ((0, 4), (3, 2)))
    way = np.where((number == 2) & (one * (1 - _EQUAL) > other), _OTHER_WAY, number)
    triangles = [names[way == number][:, piece] for number, pieces in enumerate(_PIECES) for piece in pieces]
    return TriangleMesh(vertices, np.concatenate(triangles)), ends
