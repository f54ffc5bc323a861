# SPDX-License-Identifier: GPL-3.0-or-later
"""Adjacent vertices of a mesh: adjacency, lengths of the edges, and means over neighbours."""

from __future__ import annotations

import numpy as np
from scipy.sparse import coo_array, csr_array, diags_array, eye_array

from ...runtime.arrays import Floats, Ints
from ..triangle_mesh import TriangleMesh


def vertex_adjacency(mesh: TriangleMesh) -> csr_array:
    """Return the matrix (n, n) of a mesh with n vertices that is one where an edge joins them, and else zero."""
    return pair_matrix(mesh.edges, np.ones(len(mesh.edges)), mesh.vertex_count)


def edge_graph(mesh: TriangleMesh) -> csr_array:
    """Return the matrix (n, n) of a mesh with n vertices that has the length of each edge, in both directions."""
    return pair_matrix(mesh.edges, mesh.edge_lengths, mesh.vertex_count)


def pair_matrix(pairs: Ints, values: Floats, count: int) -> csr_array:
    """Return the symmetric matrix (count, count) with a value (k,) for each of some pairs of indices, (k, 2)."""
    ends = np.concatenate([pairs, pairs[:, ::-1]]).T
    return csr_array(coo_array((np.tile(values, 2), ends), shape=(count, count)))


def averaging(neighbours: csr_array) -> csr_array:
    """Make of ones between neighbours, (n, n), the matrix that mixes each by half with the mean of its neighbours."""
    degrees = np.maximum(neighbours.sum(axis=1), 1)
    return csr_array(eye_array(len(degrees)) / 2 + diags_array(0.5 / degrees) @ neighbours)


def edge_means(mesh: TriangleMesh, values: Floats) -> Floats:
    """Mean of values per edge (e,) over the edges at each vertex, (n,); zero where there are none."""
    ends, n = mesh.edges.ravel(), mesh.vertex_count
    return np.bincount(ends, np.repeat(values, 2), n) / np.maximum(np.bincount(ends, minlength=n), 1)


def neighbour_means(mesh: TriangleMesh, values: Floats) -> Floats:
    """Mean of values per vertex (n,) over each vertex and its neighbours."""
    (first, second), n = mesh.edges.T, mesh.vertex_count
    sums = values + np.bincount(first, values[second], n) + np.bincount(second, values[first], n)
    return sums / (1 + np.bincount(first, minlength=n) + np.bincount(second, minlength=n))
