# SPDX-License-Identifier: GPL-3.0-or-later
"""Prepared surfaces: the main part of a mesh, cleaned and not too dense, and the way back to the mesh."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from scipy.spatial import cKDTree

from ..mesh.closest_points import ClosestPoints
from ..mesh.reflection import reflected_mesh, reflected_points, reflected_positions
from ..mesh.surface_points import SurfacePoints
from ..mesh.triangle_mesh import TriangleMesh, check_mesh
from ..repair.clean_surface import CleanSurface
from ..repair.cleaning import clean
from ..runtime.arrays import Bools, Floats, Ints, marked
from ..runtime.errors import MatchError
from ..runtime.progress import Progress, Steps, within
from .proxy import MATCHED, Proxy, proxy_steps

_BESIDE = 1.5
"""How far what was left out is from where it was cut off, at most, in spacings of the vertices: they are beside each
other."""


@dataclass(frozen=True, eq=False)
class PreparedSurface:
    """A mesh, and the coarse clean surface that is matched in its place.

    Attributes
    ----------
    original : TriangleMesh
        The mesh as it was given.
    kept_triangles : (m',) array of int
        Its triangles that take part: all but those of excluded vertices.
    cleaned : CleanSurface
        The mesh of these triangles and all vertices, taken apart into manifolds.
    proxy : Proxy
        What stands for the main part.
    wanted : int
        About how many vertices what is matched should have.
    is_reflected : bool
        Whether it is the reflection of the mesh that was given.
    """

    original: TriangleMesh
    kept_triangles: Ints
    cleaned: CleanSurface
    proxy: Proxy
    wanted: int
    is_reflected: bool = False

    def reflected(self) -> PreparedSurface:
        """Reflect the surface in a plane; vertices and triangles keep their numbers."""
        original, cleaned, proxy = reflected_mesh(self.original), self.cleaned, self.proxy
        pieces = tuple(piece.reflected() for piece in cleaned.pieces)
        coarse = pieces[0].mesh if proxy.mesh is cleaned.mesh else reflected_mesh(proxy.mesh)
        return replace(
            self,
            original=original,
            cleaned=replace(cleaned, original=original, pieces=pieces),
            proxy=replace(proxy, mesh=coarse, points=reflected_points(coarse, proxy.points)),
            is_reflected=not self.is_reflected,
        )

    def of_same(self, original: TriangleMesh) -> PreparedSurface:
        """Take a mesh for the original that has the same arrays: only one of the two is kept then."""
        old, cleaned, proxy = self.original, self.cleaned, self.proxy
        pieces = tuple(replace(piece, mesh=original) if piece.mesh is old else piece for piece in cleaned.pieces)
        return replace(
            self,
            original=original,
            cleaned=replace(cleaned, original=original if cleaned.original is old else cleaned.original, pieces=pieces),
            proxy=replace(proxy, mesh=original) if proxy.mesh is old else proxy,
        )

    def as_given(self, positions: Floats) -> Floats:
        """Find where points of the surface (k, 3) are on the mesh that was given, (k, 3), if this is its reflection."""
        return reflected_positions(positions) if self.is_reflected else positions

    @property
    def mesh(self) -> TriangleMesh:
        """The surface that is matched, k vertices."""
        return self.proxy.mesh

    @property
    def is_whole(self) -> bool:
        """Whether the mesh is matched as it is."""
        return self.mesh.vertex_count == self.original.vertex_count and not self.cleaned.notes

    @cached_property
    def dense_search(self) -> ClosestPoints:
        """Search on the main part in full resolution."""
        return ClosestPoints(self.cleaned.mesh)

    @cached_property
    def vertices(self) -> Ints:
        """For each vertex of the surface that is matched, a vertex of the original: itself or the nearest, (k,)."""
        own = self.cleaned.main.original_vertices
        added = np.flatnonzero(own < 0)  # centres of holes
        if len(added):
            own = own.copy()
            ring = self.cleaned.mesh.edges
            for first, second in (ring.T, ring.T[::-1]):
                beside = np.isin(first, added) & (self.cleaned.main.original_vertices[second] >= 0)
                own[first[beside]] = self.cleaned.main.original_vertices[second[beside]]
        return own[self.proxy.vertices]

    def cut_border(self, mesh: TriangleMesh) -> Bools:
        """Tell where a mesh that stands for the main part ends because something was left out there, (k,)."""
        border = marked(mesh.boundary_edges, mesh.vertex_count)
        left_out = np.delete(self.original.triangles, self.kept_triangles, axis=0)
        if not len(left_out):
            return np.zeros_like(border)
        beside = cKDTree(self.original.vertices[np.unique(left_out)]).query(mesh.vertices)[0]
        return border & (beside < _BESIDE * np.sqrt(mesh.area / mesh.vertex_count))

    def on_original(self, points: SurfacePoints) -> SurfacePoints:
        """Place points of the surface that is matched on the original mesh."""
        triangles, barycentric = points.triangles, points.barycentric
        if not self.proxy.is_identity:
            found = self.dense_search.walk(points.positions, self.proxy.vertices[points.nearest_vertices])
            triangles, barycentric = found.triangles, found.barycentric
        triangles, barycentric = self.cleaned.main.to_original(triangles, barycentric)
        return SurfacePoints.from_barycentric(self.original, self.kept_triangles[triangles], barycentric)

    def on_mesh(self, points: SurfacePoints) -> SurfacePoints:
        """Place points of the original mesh on the surface that is matched.

        Raises
        ------
        MatchError
            If a point does not lie on the main part of the mesh.
        """
        starts = self.mesh_vertices(points.nearest_vertices)
        return ClosestPoints(self.mesh).walk(points.positions, starts).on(self.mesh)

    def mesh_vertices(self, vertices: Ints) -> Ints:
        """Find the vertex of the surface that is matched that is nearest to each of some original ones (k,).

        Raises
        ------
        MatchError
            If a vertex does not lie on the main part of the mesh.
        """
        if (self.cleaned.vertex_parts[vertices] != 0).any():
            raise MatchError(
                "Some points do not lie on the main part of the mesh, which is the one that is matched. "
                "Choose points on that part."
            )
        dense = self.cleaned.vertex_images[vertices]
        return dense if self.proxy.is_identity else self.proxy.points.nearest_vertices[dense]

    def spread(self, values: Floats, outside: float) -> Floats:
        """Carry functions on the surface that is matched to the vertices of the original mesh.

        Parameters
        ----------
        values : (..., k) array of float
            Values at the vertices of the surface that is matched.
        outside : float
            Value at vertices that are not on the main part.

        Returns
        -------
        (..., n) array of float
            Values at the vertices of the original mesh.
        """
        if not self.proxy.is_identity:
            points = self.proxy.points
            values = np.asarray(sum(points.barycentric[:, i] * values[..., points.corners[:, i]] for i in range(3)))
        whole = np.full((*values.shape[:-1], self.original.vertex_count), outside, np.float64)
        main = self.cleaned.vertex_parts == 0
        whole[..., main] = values[..., self.cleaned.vertex_images[main]]
        return whole


def prepared_steps(
    mesh: TriangleMesh, name: str = "mesh", proxy_vertices: int = MATCHED, excluded: Bools | None = None
) -> Steps[PreparedSurface]:
    """Clean a mesh, and make a proxy of its main part where it is dense.

    Parameters
    ----------
    mesh : TriangleMesh
        Any mesh.
    name : str
        What notes call it.
    proxy_vertices : int
        About how many vertices the surface that is matched should have, see `proxy_steps`.
    excluded : (n,) array of bool, optional
        Vertices to leave out, with all their triangles.

    Raises
    ------
    MatchError
        If all triangles are excluded, or the mask does not fit the mesh.
    MeshError
        If it is no mesh.
    """
    check_mesh(mesh, name)
    yield Progress(0.0, "Cleaning")
    kept = np.arange(mesh.triangle_count)
    part, left_out = mesh, np.zeros(mesh.vertex_count, bool)
    if excluded is not None:
        excluded = np.asarray(excluded, bool)
        if excluded.shape != (mesh.vertex_count,):
            raise MatchError(
                f"The vertices to leave out of the {name} should be given by {mesh.vertex_count} values, one for each "
                f"vertex, not by an array of the shape {excluded.shape}."
            )
        hit = excluded[mesh.triangles].any(axis=1)
        kept = np.flatnonzero(~hit)
        left_out[mesh.triangles[hit]] = True
        if not mesh.triangle_areas[kept].any():
            raise MatchError(f"Nothing of the {name} is left to match: all of its faces are left out.")
        part = TriangleMesh(mesh.vertices, mesh.triangles[kept]) if len(kept) < mesh.triangle_count else mesh
    cleaned = clean(part, name, left_out)
    proxy = yield from within(proxy_steps(cleaned.mesh, proxy_vertices), 0.3, 1.0, "Simplifying")
    return PreparedSurface(mesh, kept, cleaned, proxy, proxy_vertices)
