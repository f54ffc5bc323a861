# SPDX-License-Identifier: GPL-3.0-or-later
"""Connected components: of anything joined in pairs, and of triangles across paired half-edges."""

from __future__ import annotations

import numpy as np
from scipy.sparse import coo_array, csr_array
from scipy.sparse.csgraph import connected_components

from ...runtime.arrays import Ints


def joined_components(count: int, first: Ints, second: Ints) -> Ints:
    """Find the components of nodes that are joined in pairs, (p,) each: the number of that of each node, (count,)."""
    graph = coo_array((np.ones(len(first), bool), (first, second)), shape=(count, count))
    return connected_components(graph, directed=False)[1].astype(np.int64)


def vertex_components(triangles: Ints, count: int) -> Ints:
    """Find the components of vertices that triangles (m, 3) join: the number of that of each, (count,)."""
    return joined_components(count, triangles[:, :2].ravel(), triangles[:, 1:].ravel())


def triangle_components(twins: Ints) -> Ints:
    """Find the components of triangles that hang together across paired half-edges.

    Parameters
    ----------
    twins : (3m,) array of int
        Twin of each half-edge, -1 at the boundary.

    Returns
    -------
    (m,) array of int
        The component of each triangle.
    """
    return symmetric_components(neighbour_graph(triangle_neighbours(twins)))


def triangle_neighbours(twins: Ints) -> Ints:
    """Return the triangle across each side of each triangle, (m, 3); at a boundary the triangle itself."""
    return (np.where(twins >= 0, twins, np.arange(len(twins))) // 3).reshape(-1, 3)


def neighbour_graph(neighbours: Ints) -> csr_array:
    """Make a graph of the neighbours (k, 3) of k nodes."""
    k = len(neighbours)
    return csr_array((np.ones(3 * k, np.int8), neighbours.ravel(), 3 * np.arange(k + 1)), shape=(k, k))


def symmetric_components(graph: csr_array) -> Ints:
    """Find the connected components of a symmetric graph of k nodes: the number of that of each, (k,)."""
    # They are its strong components, too, which are found without a transposed copy of the graph.
    return connected_components(graph, directed=True, connection="strong")[1].astype(np.int64)
