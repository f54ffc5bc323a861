# SPDX-License-Identifier: GPL-3.0-or-later
"""A mesh taken apart into clean surfaces, and the way back to it."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from ..mesh.closest_points import ClosestPoints, facing
from ..mesh.reflection import reflected_mesh
from ..mesh.surface_points import SurfacePoints
from ..mesh.triangle_mesh import TriangleMesh
from ..runtime.arrays import Bools, Floats, Ints, marked
from .body_pieces import body_pieces
from .cleaning_notes import CleaningCounts


@dataclass(frozen=True, eq=False)
class SurfacePart:
    """A part of a mesh as an oriented manifold that hangs together.

    Attributes
    ----------
    mesh : TriangleMesh
        The part; every vertex has a triangle.
    original_vertices : (n,) array of int
        For each vertex, a vertex of the original mesh that it stands for; -1 for the centre of a filled hole.
    original_triangles : (m,) array of int
        For each triangle, the one of the original mesh; -1 in a filled hole.
    turned : (m,) array of bool
        Triangles whose last two corners are exchanged against the original.
    """

    mesh: TriangleMesh
    original_vertices: Ints
    original_triangles: Ints
    turned: Bools

    def to_original(self, triangles: Ints, barycentric: Floats) -> tuple[Ints, Floats]:
        """Name points of the part as points of the original mesh.

        Parameters
        ----------
        triangles : (k,) array of int
            Triangles of the part.
        barycentric : (k, 3) array of float
            Barycentric coordinates there.

        Returns
        -------
        triangles : (k,) array of int
            Triangles of the original mesh.
        barycentric : (k, 3) array of float
            Barycentric coordinates there, in the order of the corners of the original.  Points in filled holes are
            moved to the nearest point around the hole that the original has.
        """
        filled = np.flatnonzero(self.original_triangles[triangles] < 0)
        if len(filled):
            triangles, barycentric = triangles.copy(), barycentric.copy()
            triangles[filled], barycentric[filled] = self._beside_holes(triangles[filled], barycentric[filled])
        turned = self.turned[triangles]
        if turned.any():
            barycentric = np.where(turned[:, None], barycentric[:, [0, 2, 1]], barycentric)
        return self.original_triangles[triangles], barycentric

    def reflected(self) -> SurfacePart:
        """Return the part as it is seen in a mirror; vertices and triangles keep their numbers."""
        # As the triangles of the original turn as well, those that were turned against them still are.
        return replace(self, mesh=reflected_mesh(self.mesh))

    def _beside_holes(self, triangles: Ints, barycentric: Floats) -> tuple[Ints, Floats]:
        """Move points in filled holes to the nearest of the triangles around holes."""
        corners, kept = self.mesh.triangles, self.original_triangles >= 0
        at_hole = marked(corners[~kept], self.mesh.vertex_count)
        around = kept & at_hole[corners].any(axis=1)
        if not self.mesh.triangle_areas[around].any():
            around = kept
        points = np.einsum("kc,kcd->kd", barycentric, self.mesh.vertices[corners[triangles]])
        found = ClosestPoints(self.mesh.made_of(around)[0]).nearest(points)
        return np.flatnonzero(around)[found.triangles], found.barycentric


@dataclass(frozen=True, eq=False)
class StandIn(SurfacePart):
    """A surface around several pieces of a mesh, which stands for all of them.

    Attributes
    ----------
    original_vertices, original_triangles : array of int
        For each vertex and triangle, the nearest vertex and triangle of the original mesh.
    place_triangles, place_barycentric : (v,) array of int, (v, 3) array of float
        For each vertex of the original mesh, its place on the surface.
    shown : TriangleMesh
        The pieces.
    shown_triangles : (s,) array of int
        For each triangle of these, the one of the original mesh.
    shown_turned : (s,) array of bool
        Which of them have their last two corners exchanged against the original.
    """

    place_triangles: Ints
    place_barycentric: Floats
    shown: TriangleMesh
    shown_triangles: Ints
    shown_turned: Bools

    @cached_property
    def shown_search(self) -> ClosestPoints:
        """Search on the pieces."""
        return ClosestPoints(self.shown)

    def to_original(self, triangles: Ints, barycentric: Floats) -> tuple[Ints, Floats]:
        """Name the points of the original mesh that are closest to points of the surface and look to the same side."""
        points = np.einsum("kc,kcd->kd", barycentric, self.mesh.vertices[self.mesh.triangles[triangles]])
        size = float(np.sqrt(self.mesh.area))
        found = facing(self.shown_search, points, self.mesh.triangle_normals[triangles], size)
        turned, barycentric = self.shown_turned[found.triangles], found.barycentric
        barycentric = np.where(turned[:, None], barycentric[:, [0, 2, 1]], barycentric)
        return self.shown_triangles[found.triangles], barycentric

    def places(self, vertices: Ints) -> SurfacePoints:
        """Places of vertices (k,) of the original mesh on the surface."""
        triangles, barycentric = self.place_triangles[vertices], self.place_barycentric[vertices]
        return SurfacePoints.from_barycentric(self.mesh, triangles, barycentric)

    def images_of(self, vertices: Ints, starts: Ints, found: SurfacePoints, mesh: TriangleMesh) -> tuple[Ints, Floats]:
        """Say where a map of the surface to a mesh takes the places of vertices (k,), searched from vertices there."""
        images = ClosestPoints(mesh).walk(self.places(vertices).interpolate(found.positions), starts)
        return images.triangles, images.barycentric

    def reflected(self) -> StandIn:
        """Return the surface as it is seen in a mirror; vertices and triangles keep their numbers."""
        return replace(
            self,
            mesh=reflected_mesh(self.mesh),
            place_barycentric=self.place_barycentric[:, [0, 2, 1]],
            shown=reflected_mesh(self.shown),
        )


@dataclass(frozen=True, eq=False)
class CleanSurface:
    """A mesh as a set of oriented manifolds.

    Attributes
    ----------
    original : TriangleMesh
        The mesh as it was.
    pieces : tuple of SurfacePart
        The parts: first the main one, which is matched, and then the others, the largest by area first.
    vertex_parts : (n,) array of int
        For each vertex of the original mesh, its part; -1 if it is in none: a loose vertex, or one of parts that are
        too many and too small to be listed.
    vertex_images : (n,) array of int
        For each vertex of the original mesh, its vertex in that part, or -1.  Welded vertices share one.
    notes : tuple of str
        A sentence for each thing that was done and that the owner of the mesh may want to know.
    counts : CleaningCounts
        What was done, in numbers.
    """

    original: TriangleMesh
    pieces: tuple[SurfacePart, ...]
    vertex_parts: Ints
    vertex_images: Ints
    notes: tuple[str, ...]
    counts: CleaningCounts

    @property
    def main(self) -> SurfacePart:
        """The main part, with its way back."""
        return self.pieces[0]

    @property
    def stand_in(self) -> StandIn | None:
        """The main part, if it is a surface around several pieces that stands for them."""
        return self.main if isinstance(self.main, StandIn) else None

    @property
    def mesh(self) -> TriangleMesh:
        """The main part: manifold, oriented, every vertex with a triangle."""
        return self.pieces[0].mesh

    @cached_property
    def of_body(self) -> Bools:
        """Which pieces are the body, (p,): the main one and limbs, see `body_pieces`."""
        return body_pieces([piece.mesh for piece in self.pieces])

    @property
    def limbs(self) -> Bools:
        """Which vertices of the original mesh, (n,), are on pieces that the main one lacks as a body."""
        return self.of_body[self.vertex_parts] & (self.vertex_parts > 0)

    def images_of(self, vertices: Ints, found: SurfacePoints, mesh: TriangleMesh) -> tuple[Ints, Floats]:
        """Say where a map of the main part takes vertices of the original mesh.

        Parameters
        ----------
        vertices : (k,) array of int
            Vertices of the original mesh on the main part.
        found : SurfacePoints
            For each vertex of the main part, a point of another mesh.
        mesh : TriangleMesh
            That mesh.

        Returns
        -------
        triangles : (k,) array of int
            Triangles of that mesh.
        barycentric : (k, 3) array of float
            Barycentric coordinates there.
        """
        own = self.vertex_images[vertices]
        if self.stand_in is not None:
            return self.stand_in.images_of(vertices, found.nearest_vertices[own], found, mesh)
        return found.triangles[own], found.barycentric[own]
