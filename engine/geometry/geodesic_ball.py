# SPDX-License-Identifier: GPL-3.0-or-later
"""Geodesic balls: the part of a surface near one of its vertices."""

from __future__ import annotations

import numpy as np
from scipy.sparse import coo_array, csr_array
from scipy.sparse.csgraph import dijkstra

from ..mesh.triangle_mesh import TriangleMesh
from ..runtime.arrays import TINY, Floats, Ints


def vicinity(mesh: TriangleMesh, vertex: int, radius: float) -> tuple[Ints, Floats]:
    """Find the vertices near to one, by the lengths of paths along edges.

    Parameters
    ----------
    mesh : TriangleMesh
        The surface.
    vertex : int
        From where.
    radius : float
        How far.

    Returns
    -------
    vertices : (q,) array of int
        The vertices at most so far away, itself included.
    distances : (q,) array of float
        How far each is.
    """
    # No path is shorter than the straight line, so only what is in a ball is looked at.
    offsets = mesh.vertices - mesh.vertices[vertex]
    inside = np.einsum("nd,nd->n", offsets, offsets) <= radius**2
    members = np.flatnonzero(inside)
    edges = np.flatnonzero(inside[mesh.edges].all(axis=1))
    # A length of zero would be no edge.
    lengths = np.maximum(mesh.edge_lengths[edges], TINY)
    ends = np.searchsorted(members, mesh.edges[edges])
    graph = csr_array(coo_array((lengths, ends.T), shape=(len(members), len(members))))
    distances = dijkstra(graph, directed=False, indices=int(np.searchsorted(members, vertex)), limit=radius)
    near = np.isfinite(distances)
    return members[near], distances[near]


def distances_to_others(points: Floats) -> Floats:
    """Distance from each of some points (k, 3) to the nearest other one, (k,): inf for a single one."""
    distances = np.linalg.norm(points[:, None] - points, axis=2)
    np.fill_diagonal(distances, np.inf)
    return distances.min(axis=1)
