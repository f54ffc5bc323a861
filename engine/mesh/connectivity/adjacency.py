# SPDX-License-Identifier: GPL-3.0-or-later
"""Adjacent vertices of a mesh: adjacency, lengths of the edges, and means over neighbours."""

from __future__ import annotations

import numpy as np
from scipy.sparse import coo_array, csr_array

from ...runtime.arrays import Floats
from ..triangle_mesh import TriangleMesh


def vertex_adjacency(mesh: TriangleMesh) -> csr_array:
    """Return the matrix (n, n) of a mesh with n vertices that is one where an edge joins them, and else zero."""
    return _between_vertices(mesh, np.ones(len(mesh.edges)))


def edge_graph(mesh: TriangleMesh) -> csr_array:
    """Return the matrix (n, n) of a mesh with n vertices that has the length of each edge, in both directions."""
    return _between_vertices(mesh, mesh.edge_lengths)


def _between_vertices(mesh: TriangleMesh, values: Floats) -> csr_array:
    """Return the symmetric matrix (n, n) with a value for each edge, (e,)."""
    n, (a, b) = mesh.vertex_count, mesh.edges.T
    ends = (np.concatenate([a, b]), np.concatenate([b, a]))
    return csr_array(coo_array((np.tile(values, 2), ends), shape=(n, n)))


def neighbour_means(mesh: TriangleMesh, values: Floats) -> Floats:
    """Mean of values per vertex (n,) over each vertex and its neighbours."""
    (first, second), n = mesh.edges.T, mesh.vertex_count
    sums = values + np.bincount(first, values[second], n) + np.bincount(second, values[first], n)
    return sums / (1 + np.bincount(first, minlength=n) + np.bincount(second, minlength=n))
