# SPDX-License-Identifier: GPL-3.0-or-later
"""Clearance of clothes above skin or what is worn below, and the way out of it where they are inside."""

from __future__ import annotations

from copy import copy
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from scipy.sparse import csr_array

from ...mesh.closest_points import ClosestPoints
from ...mesh.connectivity.welded_parts import WeldedParts
from ...mesh.surface_points import interpolation_matrix
from ...mesh.triangle_mesh import TriangleMesh
from ...runtime.arrays import Bools, Floats, Ints, group_sums, marked, unit_vectors

_MOST_PARTS = 6
"""Into how many parts the side of a triangle is divided at most, so that nothing pokes through it unseen."""

_FEW = 0.25
"""Part of the vertices, each as often as it is asked for, up to which only their normals are computed."""

_INSIDE = 0.02
"""Barycentric coordinate from which on a point counts as inside its triangle, whose own normal then tells its sides."""


@dataclass(frozen=True, eq=False)
class Clearance:
    """How far points are from a surface.

    Attributes
    ----------
    distances : (k,) array of float
        Distance to the nearest point of it, negative inside.
    feet : (k, 3) array of float
        The nearest points.
    normals : (k, 3) array of float
        Directions out of the surface there.
    vertices : (k,) array of int
        The nearest of its vertices, of those of the triangle.
    known : (k,) array of bool
        False where the nearest point lies on the rim of a hole, so that there is no inside.
    """

    distances: Floats
    feet: Floats
    normals: Floats
    vertices: Ints
    known: Bools


class Surface:
    """A surface that things lie on.

    Seams at which it was cut open, as files for games are at every sharp edge, are no rims: it is searched with them
    closed.

    Parameters
    ----------
    mesh : TriangleMesh
        The surface.
    search : ClosestPoints, optional
        A search on it, if there is one already.

    Attributes
    ----------
    normals : (n, 3) array of float
        Unit normals of the vertices, weighted by angles: they tell inside from outside.
    rim : (n,) array of bool
        Which vertices lie on the rim of a hole.
    sewn : _Sewn or None
        The same with its seams closed; none if it has none.
    """

    def __init__(self, mesh: TriangleMesh, search: ClosestPoints | None = None) -> None:
        self.mesh = mesh
        self.search = search or ClosestPoints(mesh)
        self.sewn = _Sewn.of(mesh)

    @cached_property
    def rim(self) -> Bools:
        """Which vertices lie on the rim of a hole, (n,)."""
        if self.sewn is not None:
            return self.sewn.surface.rim[self.sewn.parts.welded]
        return marked(self.mesh.boundary_edges, self.mesh.vertex_count)

    @cached_property
    def normals(self) -> Floats:
        """Unit normals of the vertices, weighted by angles, (n, 3)."""
        if self.sewn is not None:
            return self.sewn.surface.normals[self.sewn.parts.welded]
        return _angle_normals(self.mesh)

    def _normals_at(self, corners: Ints) -> Floats:
        """Return the normals of some vertices (k, 3), (k, 3, 3); of few of them no others are computed."""
        if "normals" in self.__dict__ or self.sewn is not None or corners.size > _FEW * self.mesh.vertex_count:
            return self.normals[corners]
        return _angle_normals(self.mesh, np.unique(corners))[corners]

    def moved(self, vertices: Floats) -> Surface:
        """Return the surface with its vertices elsewhere, (n, 3); what depends on the triangles alone is shared."""
        other = copy(self)
        other.mesh, other.search = TriangleMesh(vertices, self.mesh.triangles), self.search.moved(vertices)
        other.__dict__.pop("normals", None)
        if self.sewn is not None:
            other.sewn = replace(self.sewn, surface=self.sewn.surface.moved(self.sewn.parts.means @ vertices))
        return other

    def clearance(self, points: Floats, starts: Ints | None = None) -> Clearance:
        """Measure how far points (k, 3) are from the surface.

        Parameters
        ----------
        points : (k, 3) array of float
            The points.
        starts : (k,) array of int, optional
            A vertex from which to search along the surface, which so never leaves its limb; else all of it counts.
        """
        if self.sewn is not None:
            return self.sewn.clearance(points, starts)
        found = self.search.nearest(points) if starts is None else self.search.walk(points, starts)
        corners, barycentric = self.mesh.triangles[found.triangles], found.barycentric
        feet = found.interpolate(self.mesh.triangles, self.mesh.vertices)
        inside = (barycentric > _INSIDE).all(axis=1)
        blended = unit_vectors(np.einsum("kc,kci->ki", barycentric, self._normals_at(corners)))
        normals = np.where(inside[:, None], self.mesh.triangle_normals[found.triangles], blended)
        away = points - feet
        distances = np.sqrt(found.squared_distances)
        distances = np.where(np.einsum("ki,ki->k", away, normals) < 0, -distances, distances)
        known = ~((barycentric > _INSIDE) <= self.rim[corners]).all(axis=1) | inside
        return Clearance(distances, feet, blended, found.nearest_vertices(self.mesh.triangles), known)


@dataclass(frozen=True, eq=False)
class _Sewn:
    """A surface with its seams closed, and the vertex from which to search there for each of the cut one, (n,)."""

    parts: WeldedParts
    surface: Surface
    starts: Ints

    @classmethod
    def of(cls, mesh: TriangleMesh) -> _Sewn | None:
        """Close the seams of a mesh; none if it has none."""
        parts = WeldedParts.of(mesh)
        if not parts.seams:
            return None
        surface = Surface(parts.closed)
        starts, lost = parts.welded, np.ones(parts.welded_count, bool)
        lost[parts.triangles] = False
        if lost.any():  # what fell together into a point
            nearest = np.arange(parts.welded_count)
            nearest[lost] = surface.search.nearest_vertices(parts.positions[lost])
            starts = nearest[starts]
        return cls(parts, surface, starts)

    def clearance(self, points: Floats, starts: Ints | None) -> Clearance:
        """Measure as the cut one does, in its numbers of vertices."""
        found = self.surface.clearance(points, None if starts is None else self.starts[starts])
        return replace(found, vertices=self.parts.first[found.vertices])


def surface_samples(mesh: TriangleMesh, spacing: float) -> tuple[csr_array, Ints]:
    """Spread points over a surface: its vertices, middles of triangles, and grids in those with sides of two spacings.

    Returns
    -------
    shares : (s, n) csr_array of float
        For each point the shares of the vertices.  The vertices come first.
    triangles : (s - n,) array of int
        The triangle that each of the others lies in.
    """
    n = mesh.vertex_count
    a, b, c = (mesh.vertices[corner] for corner in mesh.triangles.T)
    longest = np.sqrt(np.max([np.square(side).sum(axis=1) for side in (b - a, c - b, a - c)], axis=0))
    parts = np.clip(np.ceil(longest / spacing), 2, _MOST_PARTS).astype(np.int64)
    corners, shares = [np.arange(n)[:, None].repeat(3, axis=1)], [np.tile([1.0, 0.0, 0.0], (n, 1))]
    owners: list[Ints] = []
    for count in np.unique(parts):
        i, j = (grid.ravel() for grid in np.meshgrid(np.arange(count + 1), np.arange(count + 1), indexing="ij"))
        grid = np.stack([i, j, count - i - j], axis=1)
        grid = grid[(grid >= 0).all(axis=1) & (grid < count).all(axis=1)]
        if count == 2:
            grid = np.array([[2 / 3, 2 / 3, 2 / 3]])
        chosen = np.flatnonzero(parts == count)
        owners.append(chosen.repeat(len(grid)))
        corners.append(mesh.triangles[owners[-1]])
        shares.append(np.tile(grid / count, (len(chosen), 1)))
    samples = interpolation_matrix(np.concatenate(shares), np.concatenate(corners), n)
    samples.sum_duplicates()
    return samples, np.concatenate(owners)


def _angle_normals(mesh: TriangleMesh, wanted: Ints | None = None) -> Floats:
    """Find the normals of vertices, weighted by the angles of the triangles, (n, 3), of all or of those wanted."""
    triangles, normals = mesh.triangles, mesh.triangle_normals
    if wanted is not None:
        around = marked(wanted, mesh.vertex_count)[triangles].any(axis=1)
        triangles, normals = triangles[around], normals[around]
    sums = np.zeros((mesh.vertex_count, 3))
    corners = [mesh.vertices[corner] for corner in triangles.T]
    sides = [unit_vectors(corners[(corner + 1) % 3] - corners[corner]) for corner in range(3)]
    for corner in range(3):
        angle = np.arccos((-np.einsum("mi,mi->m", sides[corner], sides[corner - 1])).clip(-1, 1))
        sums += group_sums(triangles[:, corner], angle[:, None] * normals, mesh.vertex_count)
    return unit_vectors(sums)
