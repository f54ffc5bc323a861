# SPDX-License-Identifier: GPL-3.0-or-later
"""Small cells of a surface, many times fewer than its vertices, and the graph that joins them."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import csr_array

from ...mesh.connectivity.adjacency import pair_matrix
from ...mesh.connectivity.components import joined_components
from ...mesh.triangle_mesh import TriangleMesh
from ...runtime.arrays import Bools, Floats, Ints, group_smallest, group_sums, marked, numbered

_LEAST_LENGTH = 1e-9  # of sqrt(area): an edge of length zero is no edge for a sparse graph
_ASIDE = (1e-5, 3e-5, 2e-5)  # of sqrt(area): any direction that edges of a mesh are unlikely to have


@dataclass(frozen=True, eq=False)
class SurfaceCells:
    """A surface whose vertices are gathered in cells.

    Whatever is asked of larger regions made of whole cells (where three of them meet, whether one is a disc) can be
    answered from the cells alone, without the mesh.

    Attributes
    ----------
    labels : (n,) array of int
        The cell of each vertex of the mesh.
    positions : (c, 3) array of float
        Mean position of the vertices of each cell.
    normals : (c, 3) array of float
        Mean normal of the vertices of each cell, at most one long.
    areas : (c,) array of float
        Sum of the vertices' areas.
    at_boundary : (c,) array of bool
        Whether a vertex of the cell is at an open boundary.
    characteristics : (c,) array of int
        Vertices minus edges plus triangles inside each cell: its Euler characteristic.
    pairs : (p, 2) array of int
        The cells that an edge of the mesh joins, each pair once, the smaller first.
    pair_characteristics : (p,) array of int
        By how much the Euler characteristic of two cells together differs from their sum.
    triples : (t, 3) array of int
        The cells of each triangle that has its corners in three different ones, in its orientation.
    unit : float
        sqrt(area) of the surface.
    """

    labels: Ints
    positions: Floats
    normals: Floats
    areas: Floats
    at_boundary: Bools
    characteristics: Ints
    pairs: Ints
    pair_characteristics: Ints
    triples: Ints
    unit: float

    @property
    def count(self) -> int:
        """Number of cells, c."""
        return len(self.positions)

    @classmethod
    def build(cls, mesh: TriangleMesh, labels: Ints) -> SurfaceCells:
        """Gather the vertices of a mesh by labels (n,), numbered from 0, every number used, each cell connected."""
        count = int(labels.max()) + 1
        sizes = np.bincount(labels, minlength=count)
        vectors = mesh.vertices, mesh.vertex_normals
        positions, normals = (group_sums(labels, values, count) / sizes[:, None] for values in vectors)
        areas: NDArray[Any] = np.bincount(labels, mesh.vertex_areas, count)
        at_boundary = marked(labels[mesh.boundary_edges], count)

        low, high = np.sort(labels[mesh.edges], axis=1).T
        inside = low == high
        characteristics = sizes - np.bincount(low[inside], minlength=count)
        edge_keys, edge_counts = np.unique(low[~inside] * count + high[~inside], return_counts=True)

        low, middle, high = np.sort(labels[mesh.triangles], axis=1).T
        characteristics += np.bincount(low[low == high], minlength=count)
        in_two = (low != high) & ((low == middle) | (middle == high))
        pair_of_triangle = np.searchsorted(edge_keys, low[in_two] * count + high[in_two])
        triangles_of_pair = np.bincount(pair_of_triangle, minlength=len(edge_keys))
        in_three = (low != middle) & (middle != high)
        pairs, triples = np.stack(np.divmod(edge_keys, count), axis=1), labels[mesh.triangles[in_three]]
        own = labels, positions, normals, areas, at_boundary, characteristics
        return cls(*own, pairs, triangles_of_pair - edge_counts, triples, float(np.sqrt(mesh.area)))

    @cached_property
    def graph(self) -> csr_array:
        """Distances between the centres of neighbouring cells, (c, c), symmetric."""
        a, b = self.pairs.T
        lengths = np.linalg.norm(self.positions[a] - self.positions[b], axis=1) + _LEAST_LENGTH * self.unit
        return pair_matrix(self.pairs, lengths, self.count)

    def dissolved(self, mesh: TriangleMesh, cells: Bools) -> SurfaceCells:
        """Return the cells of the same mesh with some (c,) replaced by one cell for each of their vertices."""
        labels = np.where(cells[self.labels], self.count + np.arange(len(self.labels)), self.labels)
        return SurfaceCells.build(mesh, np.unique(labels, return_inverse=True)[1].reshape(-1))

    def nearest_vertices(self, vertices: Floats) -> Ints:
        """Find the vertex of each cell nearest to its centre, (c,), by the positions of all vertices, (n, 3)."""
        # A little aside, as two vertices are equally far from their mean.
        offsets = vertices - (self.positions + self.unit * np.array(_ASIDE))[self.labels]
        return nearest_members(self.labels, np.einsum("nd,nd->n", offsets, offsets), self.count)


def nearest_members(groups: Ints, distances: Floats, count: int) -> Ints:
    """For each of `count` groups, the member with the least distance: the first of several; -1 for an empty group."""
    least = group_smallest(groups, distances, count)
    candidates = np.flatnonzero(distances == least[groups])[::-1]
    nearest = np.full(count, -1)
    nearest[groups[candidates]] = candidates  # the last written, the first in order, stays
    return nearest


def grid_labels(mesh: TriangleMesh, size: float) -> Ints:
    """Gather the vertices that lie in the same cube of a grid and hang together there.

    Parameters
    ----------
    mesh : TriangleMesh
        The surface.
    size : float
        Side of the cubes, a length.

    Returns
    -------
    (n,) array of int
        Label of each vertex.  Labels are numbered by place in space, whatever the order of the vertices.  Sheets of
        the surface that pass through the same cube have different labels, so that fingers that touch stay apart.
    """
    cubes = np.floor((mesh.vertices - mesh.vertices.min(axis=0)) / size).astype(np.int64)
    _, ny, nz = cubes.max(axis=0) + 1
    keys = (cubes[:, 0] * ny + cubes[:, 1]) * nz + cubes[:, 2]
    a, b = mesh.edges.T
    inside = keys[a] == keys[b]
    labels = joined_components(mesh.vertex_count, a[inside], b[inside])
    # Number them by cube, then by place in it.
    sizes = np.bincount(labels)
    count = len(sizes)
    means = [np.bincount(labels, column, count) / sizes for column in mesh.vertices.T]
    cube = np.empty(count, np.int64)
    cube[labels] = keys
    return numbered(np.lexsort((*means[::-1], cube)), count)[labels]
