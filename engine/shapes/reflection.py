# SPDX-License-Identifier: GPL-3.0-or-later
"""Surfaces as they are seen in a mirror: with the same vertices and distances, but with left and right exchanged."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

from ..mesh.surface_points import SurfacePoints
from ..mesh.triangle_mesh import TriangleMesh

if TYPE_CHECKING:
    from .prepared_surface import PreparedSurface

__all__ = ["reflected_mesh", "reflected_points", "reflected_surface"]


def reflected_mesh(mesh: TriangleMesh) -> TriangleMesh:
    """Reflect a mesh; its normals still point outwards, because the last two corners of triangles are exchanged."""
    return TriangleMesh(mesh.vertices * [-1, 1, 1], mesh.triangles[:, [0, 2, 1]])


def reflected_points(reflection: TriangleMesh, points: SurfacePoints) -> SurfacePoints:
    """Name points of a mesh as points of its reflection, or the other way round."""
    return SurfacePoints.from_barycentric(reflection, points.triangles, points.barycentric[:, [0, 2, 1]])


def reflected_surface(surface: PreparedSurface) -> PreparedSurface:
    """Reflect all of a prepared surface; vertices and triangles keep their numbers."""
    original, cleaned, proxy = reflected_mesh(surface.original), surface.cleaned, surface.proxy
    pieces = tuple(piece.reflected() for piece in cleaned.pieces)
    coarse = pieces[0].mesh if proxy.mesh is cleaned.mesh else reflected_mesh(proxy.mesh)
    return replace(
        surface,
        original=original,
        cleaned=replace(cleaned, original=original, pieces=pieces),
        proxy=replace(proxy, mesh=coarse, points=reflected_points(coarse, proxy.points)),
    )
