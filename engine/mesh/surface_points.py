# SPDX-License-Identifier: GPL-3.0-or-later
"""Points on a surface, not necessarily at its vertices."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.sparse import csr_array

from ..runtime.arrays import Floats, Ints
from ..runtime.errors import MeshError
from .triangle_mesh import TriangleMesh


@dataclass(frozen=True, eq=False)
class SurfacePoints:
    """Points on a triangle mesh.

    Attributes
    ----------
    triangles : (k,) array of int
        The triangle in which each point lies.
    barycentric : (k, 3) array of float
        Its barycentric coordinates there: not negative, summing to one.
    corners : (k, 3) array of int
        The vertices of that triangle, in the order of `barycentric`.
    nearest_vertices : (k,) array of int
        The corner with the largest coordinate.
    positions : (k, 3) array of float
        Where the points are.
    """

    triangles: Ints
    barycentric: Floats
    corners: Ints
    nearest_vertices: Ints
    positions: Floats

    def __len__(self) -> int:
        return len(self.triangles)

    def __repr__(self) -> str:
        return f"<SurfacePoints: {len(self)} points>"

    @classmethod
    def from_barycentric(cls, mesh: TriangleMesh, triangles: Ints, barycentric: Floats) -> SurfacePoints:
        """Make points from triangles (k,) and barycentric coordinates (k, 3)."""
        corners = mesh.triangles[triangles]
        nearest = np.take_along_axis(corners, barycentric.argmax(axis=1)[:, None], axis=1)[:, 0]
        positions = np.einsum("kc,kcd->kd", barycentric, mesh.vertices[corners])
        return cls(triangles, barycentric, corners, nearest, positions)

    @classmethod
    def at_vertices(cls, mesh: TriangleMesh, vertices: Ints) -> SurfacePoints:
        """Make points at vertices (k,), each in the first triangle around it.

        Raises
        ------
        MeshError
            If a vertex is in no triangle, or there is none of that number: there is no surface at it.
        """
        vertices = np.asarray(vertices, None if np.size(vertices) else np.int64)
        first_corner = np.full(mesh.vertex_count, -1)
        flat = mesh.triangles.ravel()
        first_corner[flat[::-1]] = np.arange(len(flat))[::-1]
        exists = (vertices >= 0) & (vertices < mesh.vertex_count)
        chosen = np.where(exists, first_corner[np.where(exists, vertices, 0)], -1)
        if (chosen < 0).any():
            loose = vertices[chosen < 0]
            raise MeshError(
                f"Vertex {loose[0]} of the mesh is in no face, so that it is not on the surface. "
                "Delete loose vertices, or choose one that has a face."
            )
        triangles, corner = np.divmod(chosen, 3)
        return cls.from_barycentric(mesh, triangles, np.eye(3)[corner])

    @classmethod
    def from_corners(cls, mesh: TriangleMesh, corners: Ints, barycentric: Floats) -> SurfacePoints:
        """Make points from the vertices of their triangles (k, 3), in any order, and barycentric coordinates (k, 3).

        Raises
        ------
        MeshError
            If the mesh has no such triangle.
        """

        def lower_sides(triangles: Ints) -> Ints:
            """Name the side between the two lowest corners of each triangle by one number."""
            low, middle, _ = np.sort(triangles, axis=1).T
            return low * mesh.vertex_count + middle

        sides = np.unique(lower_sides(mesh.triangles))

        def keys(triangles: Ints) -> Ints:
            """Name each triangle by one number, whatever corner it starts at; -1 if the mesh has no such side."""
            # Sides are numbered: a number made of three vertices has no room in 64 bits beyond two million of these.
            wanted = lower_sides(triangles)
            number = np.searchsorted(sides, wanted).clip(max=len(sides) - 1)
            return np.where(sides[number] == wanted, number * mesh.vertex_count + triangles.max(axis=1), -1)

        known, asked = keys(mesh.triangles), keys(corners)
        order = np.argsort(known, kind="stable")
        triangles = order[np.searchsorted(known[order], asked).clip(max=len(order) - 1)]
        if (known[triangles] != asked).any():
            raise MeshError("The mesh has no triangle at the place of a point: it is not the mesh of these points.")
        place = (mesh.triangles[triangles][:, :, None] == corners[:, None, :]).argmax(axis=2)
        return cls.from_barycentric(mesh, triangles, np.take_along_axis(barycentric, place, axis=1))

    def at(self, rows: Ints) -> SurfacePoints:
        """Take some of the points, by their numbers."""
        places = self.triangles[rows], self.barycentric[rows], self.corners[rows]
        return SurfacePoints(*places, self.nearest_vertices[rows], self.positions[rows])

    def interpolate(self, values: Floats) -> Floats:
        """Evaluate a function given at the vertices, linear inside triangles.

        Parameters
        ----------
        values : (n, ...) array of float
            Values at the vertices of the mesh.

        Returns
        -------
        (k, ...) array of float
            Values at the points.
        """
        return np.einsum("kc,kc...->k...", self.barycentric, at_corners(values, self.corners, self.barycentric))


def at_corners(values: Floats, corners: Ints, weights: Floats) -> Floats:
    """Take values (n, ...) at corners (k, c), or (k,), but nothing where their weights, of that shape, are zero.

    There infinite values and NaN do not matter.
    """
    taken = values[corners]
    if not np.isfinite(taken).all():
        taken[weights == 0] = 0
    return taken


def interpolation_matrix(barycentric: Floats, corners: Ints, count: int) -> csr_array:
    """Make the matrix (k, count) that interpolates values at the vertices of a mesh at points.

    Parameters
    ----------
    barycentric : (k, c) array of float
        Barycentric coordinates of the points, or other weights.
    corners : (k, c) array of int
        The vertices that they belong to.
    count : int
        How many vertices the mesh has.
    """
    starts = np.arange(0, corners.size + 1, corners.shape[1])
    return csr_array((barycentric.ravel(), corners.ravel(), starts), shape=(len(corners), count))
