# SPDX-License-Identifier: GPL-3.0-or-later
"""Meshes of quads and other polygons, with UVs at their corners."""

from __future__ import annotations

import numpy as np

from engine import ClosestPoints, SurfaceMap, TriangleMesh
from engine.mesh.polygons import Polygons
from engine.runtime.arrays import ranges


def from_faces(starts, corner_vertices):
    """Make polygons of faces alone: number their edges, and cut each into triangles that fan out from its first corner.

    Parameters
    ----------
    starts : (f + 1,) array of int
        First corner of each face, and at the end the number of corners, l.
    corner_vertices : (l,) array of int
        The vertex of each corner.
    """
    sizes = np.diff(starts)
    following = np.arange(1, len(corner_vertices) + 1)
    following[np.asarray(starts[1:]) - 1] = starts[:-1]
    sides = np.sort(np.stack([corner_vertices, corner_vertices[following]], axis=1), axis=1)
    count = int(corner_vertices.max(initial=0)) + 1
    keys, corner_edges = np.unique(sides[:, 0] * count + sides[:, 1], return_inverse=True)
    face = np.repeat(np.arange(len(sizes)), sizes - 2)
    step = ranges(np.zeros_like(sizes), sizes - 2)
    first = np.asarray(starts)[face]
    triangles = np.stack([first, first + step + 1, first + step + 2], axis=1)
    edges = np.stack(np.divmod(keys, count), axis=1)
    return Polygons(starts, corner_vertices, edges, corner_edges.ravel(), triangles)


def quads(faces):
    """Polygons of faces with four vertices, (f, 4)."""
    return from_faces(4 * np.arange(len(faces) + 1), np.ravel(faces))


def polygons(faces):
    """Polygons of faces as lists of vertices."""
    return from_faces(np.append(0, np.cumsum([len(face) for face in faces])), np.concatenate(faces))


def triangulated(vertices, faces):
    """Mesh of the triangles that polygons are cut into."""
    return TriangleMesh(vertices, faces.corner_vertices[faces.triangle_corners])


def grid(columns, rows):
    """Unit square of columns x rows quads: vertices, polygons, and for each corner its x and y."""
    x, y = (axis.ravel() for axis in np.meshgrid(np.linspace(0, 1, columns + 1), np.linspace(0, 1, rows + 1)))
    faces = quads(_cells(columns, rows, columns + 1))
    vertices = np.stack([x, y, 0 * x], axis=1)
    return vertices, faces, vertices[faces.corner_vertices, :2]


def tube(around, along, turn=0.0, height=2.0):
    """Side of a cylinder, of around x along quads, and UVs in the unit square with a seam at the angle `turn`.

    Both are turned together: the same place has other UVs if the turn is another.
    """
    angle, z = np.meshgrid(2 * np.pi * np.arange(around) / around + turn, np.linspace(0, height, along + 1))
    vertices = np.stack([np.cos(angle), np.sin(angle), z], axis=-1).reshape(-1, 3)
    columns, rows = np.meshgrid(np.arange(around), np.arange(along))
    flat = _cells(around, along, around + 1)
    u, v = flat % (around + 1) / around, flat // (around + 1) / along
    next_column = (columns + 1) % around
    faces = np.stack(
        [
            columns + around * rows,
            next_column + around * rows,
            next_column + around * (rows + 1),
            columns + around * (rows + 1),
        ],
        axis=-1,
    ).reshape(-1, 4)
    return vertices, quads(faces), np.stack([u.ravel(), v.ravel()], axis=1)


def closest_map(domain_vertices, image):
    """Map of each vertex to the closest point of a mesh."""
    found = ClosestPoints(image).nearest(domain_vertices)
    return SurfaceMap.from_barycentric(image, found.triangles, found.barycentric)


def _cells(columns, rows, width):
    """Corners (f, 4) of the cells of a grid whose points are numbered row by row, `width` in each."""
    x, y = (axis.ravel() for axis in np.meshgrid(np.arange(columns), np.arange(rows)))
    first = x + width * y
    return np.stack([first, first + 1, first + width + 1, first + width], axis=1)
