# SPDX-License-Identifier: GPL-3.0-or-later
"""Adjacent vertices of a mesh: the adjacency matrix, and means over neighbours."""

from __future__ import annotations

import numpy as np
from scipy.sparse import coo_array, csr_array

from ...runtime.arrays import Floats
from ..triangle_mesh import TriangleMesh


def vertex_adjacency(mesh: TriangleMesh) -> csr_array:
    """Return the matrix (n, n) of a mesh with n vertices that is one where an edge joins them, and else zero."""
    n, (a, b) = mesh.vertex_count, mesh.edges.T
    ends = (np.concatenate([a, b]), np.concatenate([b, a]))
    return csr_array(coo_array((np.ones(2 * len(a)), ends), shape=(n, n)))


def neighbour_means(mesh: TriangleMesh, values: Floats) -> Floats:
    """Mean of values per vertex (n,) over each vertex and its neighbours."""
    (first, second), n = mesh.edges.T, mesh.vertex_count
    sums = values + np.bincount(first, values[second], n) + np.bincount(second, values[first], n)
    return sums / (1 + np.bincount(first, minlength=n) + np.bincount(second, minlength=n))
