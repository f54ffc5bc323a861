# SPDX-License-Identifier: GPL-3.0-or-later
"""Surfaces as they are seen in a mirror: with the same vertices and distances, but with left and right exchanged."""

from __future__ import annotations

from dataclasses import replace

from ..runtime.arrays import Floats
from .surface_map import SurfaceMap
from .surface_points import SurfacePoints
from .triangle_mesh import TriangleMesh


def reflected_mesh(mesh: TriangleMesh) -> TriangleMesh:
    """Reflect a mesh; its normals still point outwards, because the last two corners of triangles are exchanged."""
    return TriangleMesh(reflected_positions(mesh.vertices), mesh.triangles[:, [0, 2, 1]])


def reflected_positions(positions: Floats) -> Floats:
    """Reflect positions (k, 3) in the plane x = 0."""
    return positions * [-1.0, 1.0, 1.0]


def reflected_points(reflection: TriangleMesh, points: SurfacePoints) -> SurfacePoints:
    """Name points of a mesh as points of its reflection, or the other way round."""
    return SurfacePoints.from_barycentric(reflection, points.triangles, points.barycentric[:, [0, 2, 1]])


def reflected_map(reflection: TriangleMesh, surface_map: SurfaceMap) -> SurfaceMap:
    """Name the images of a map to a mesh as points of its reflection, or the other way round."""
    return replace(surface_map, points=reflected_points(reflection, surface_map.points))
