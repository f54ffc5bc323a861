# SPDX-License-Identifier: GPL-3.0-or-later
"""A mesh with the seams closed at which it was cut open, and its parts: what hangs together then."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy.sparse import csr_array

from ...runtime.arrays import Bools, Floats, Ints, group_extents
from ..triangle_mesh import TriangleMesh
from .components import vertex_components
from .halfedges import group_half_edges
from .vertex_welding import weld_boundaries

_SMALL = 0.1
"""Size of the largest part that counts as small, in units of the root of the area of the whole surface."""


@dataclass(frozen=True, eq=False)
class WeldedParts:
    """Which vertices of a mesh are one, at seams where it was cut open, and which hang together.

    Attributes
    ----------
    mesh : TriangleMesh
        The mesh.
    welded : (n,) array of int
        The welded vertex, 0 to w - 1, that each vertex belongs to.
    triangles : (k, 3) array of int
        Triangles of welded vertices; those that fell together are left out.
    labels : (w,) array of int
        The part that each welded vertex belongs to.
    """

    mesh: TriangleMesh
    welded: Ints
    triangles: Ints
    labels: Ints

    @classmethod
    def of(cls, mesh: TriangleMesh) -> WeldedParts:
        """Weld a mesh along its seams and find its parts."""
        groups = group_half_edges(mesh.triangles, mesh.vertex_count)
        _, welded = np.unique(weld_boundaries(mesh.vertices, mesh.triangles, groups), return_inverse=True)
        welded = welded.ravel()
        triangles = welded[mesh.triangles]
        triangles = triangles[(triangles != np.roll(triangles, 1, axis=1)).all(axis=1)]
        labels = vertex_components(triangles, int(welded.max()) + 1)
        return cls(mesh, welded, triangles, labels)

    @property
    def welded_count(self) -> int:
        """Number of welded vertices, w."""
        return len(self.labels)

    @property
    def seams(self) -> bool:
        """Whether vertices were welded at all."""
        return self.welded_count < len(self.welded)

    @cached_property
    def closed(self) -> TriangleMesh:
        """The mesh of the welded vertices."""
        return TriangleMesh(self.positions, self.triangles)

    @property
    def edges(self) -> Ints:
        """Each edge between welded vertices once, smaller index first, (e, 2)."""
        return self.closed.edges

    @property
    def part_count(self) -> int:
        """Number of parts, p."""
        return int(self.labels.max()) + 1

    @property
    def vertex_labels(self) -> Ints:
        """The part that each vertex belongs to, (n,)."""
        return self.labels[self.welded]

    @cached_property
    def first(self) -> Ints:
        """The first vertex that each welded one is made of, (w,)."""
        return np.unique(self.welded, return_index=True)[1]

    @cached_property
    def positions(self) -> Floats:
        """Where the welded vertices are, (w, 3)."""
        return self.means @ self.mesh.vertices

    @cached_property
    def sizes(self) -> Floats:
        """Length of the longest side of each part's bounding box, (p,)."""
        return group_extents(self.vertex_labels, self.mesh.vertices, self.part_count)

    @cached_property
    def small(self) -> Bools:
        """Say of each part whether it is small beside the whole, (p,): an eye, a button, a tooth; not a trouser leg."""
        return self.sizes <= _SMALL * np.sqrt(self.mesh.area)

    def best_of(self, values: Floats) -> Ints:
        """Return, for each welded vertex, that of the vertices it is made of which has the largest value (n,): (w,)."""
        order = np.lexsort((-values, self.welded))
        return order[np.searchsorted(self.welded[order], np.arange(self.welded_count))]

    @cached_property
    def means(self) -> csr_array:
        """The matrix (w, n) that averages values over all vertices that each welded one is made of."""
        return self.mean_over(np.ones(self.mesh.vertex_count, bool))

    def mean_over(self, chosen: Bools) -> csr_array:
        """Return the matrix (w, n) that averages values over the chosen vertices (n,) that each welded one is made of.

        Rows of welded vertices of which none is chosen are empty.
        """
        vertices = np.flatnonzero(chosen)
        home = self.welded[vertices]
        shares = 1 / np.bincount(home, minlength=self.welded_count)[home]
        return csr_array((shares, (home, vertices)), shape=(self.welded_count, len(self.welded)))
