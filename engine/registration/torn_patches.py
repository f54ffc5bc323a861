# SPDX-License-Identifier: GPL-3.0-or-later
"""Patches that a map tears off: where surfaces touch, closest points may be on the other one."""

from __future__ import annotations

import numpy as np
from scipy.sparse import csr_array, eye_array
from scipy.sparse.csgraph import dijkstra

from ..mesh.connectivity.adjacency import edge_graph, vertex_adjacency
from ..mesh.connectivity.components import joined_components
from ..mesh.triangle_mesh import TriangleMesh
from ..runtime.arrays import Bools, Floats, Ints
from .untangling import follow_neighbours

_PATCH = 0.02
"""Part of the area below which what a map tears off is taken for an error."""

_STRETCHED = 4.0
"""Times its length, in the scale of the target, to which an edge has to be stretched at least to be torn."""

_SOURCES = 16
"""Vertices from which distances tell how far apart others are at least: the first are tips of limbs."""


class NearVertices:
    """Tells which vertices of a mesh are near to each other along the surface.

    Parameters
    ----------
    mesh : TriangleMesh
        The mesh, of some thousand vertices.
    rings : int
        How many edges they may be apart.
    """

    def __init__(self, mesh: TriangleMesh, rings: int) -> None:
        self._count = mesh.vertex_count
        ring = csr_array(vertex_adjacency(mesh) + eye_array(self._count))
        reach = ring
        for _ in range(rings - 1):
            reach = csr_array(reach @ ring)
        first = np.repeat(np.arange(self._count), np.diff(reach.indptr))
        self._keys = np.sort(first * self._count + reach.indices)

    def pairs(self, first: Ints, second: Ints) -> Bools:
        """Tell for pairs (q,) of vertices whether they are near, (q,)."""
        asked = first * self._count + second
        found = np.searchsorted(self._keys, asked).clip(max=len(self._keys) - 1)
        return self._keys[found] == asked


def with_patches_mended(mesh: TriangleMesh, images: Ints, target: TriangleMesh, near: NearVertices) -> Ints:
    """Give small patches that a map tears off the images of what is around them.

    A hand that rests on a thigh is as near to it in space as the thigh itself.  So a few vertices of the one may be
    matched to the other, and all edges that lead to them are stretched from one to the other, along the surface.

    Parameters
    ----------
    mesh : TriangleMesh
        The surface, n vertices.
    images : (n,) array of int
        Vertex of the target for each of its vertices.
    target : TriangleMesh
        The surface that it is mapped to.
    near : NearVertices
        Vertices of the target that are so near to each other that no edge between them is torn, however short it was.

    Returns
    -------
    (n,) array of int
        The images, those of each patch taken from its nearest neighbours: a place to look from, not a map.
    """
    tail, head = mesh.edges.T
    kept = near.pairs(images[tail], images[head])
    doubtful = np.flatnonzero(~kept)
    if not len(doubtful):
        return images
    lengths = mesh.edge_lengths[doubtful] * np.sqrt(target.area / mesh.area)
    apart = _least_distances(target, images[tail[doubtful]], images[head[doubtful]])
    kept[doubtful] = apart < _STRETCHED * lengths
    parts = joined_components(mesh.vertex_count, tail[kept], head[kept])
    areas = np.bincount(parts, mesh.vertex_areas)
    return follow_neighbours(mesh, images, areas[parts] < _PATCH * mesh.area)


def _least_distances(mesh: TriangleMesh, first: Ints, second: Ints) -> Floats:
    """How far pairs (q,) of vertices are apart along edges at least, (q,): as far as their distances from others."""
    graph = edge_graph(mesh)
    least, nearest = np.zeros(len(first)), np.full(mesh.vertex_count, np.inf)
    source = int(first[0])
    for _ in range(_SOURCES):
        row = dijkstra(graph, directed=False, indices=source)
        least = np.maximum(least, abs(row[first] - row[second]))
        nearest = np.minimum(nearest, row)
        source = int(nearest.argmax())
    return least
