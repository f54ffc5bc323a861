# SPDX-License-Identifier: GPL-3.0-or-later
"""Faces with any number of corners, and the triangles that they are cut into: where values per face or corner live."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..runtime.arrays import Floats, Ints
from ..runtime.errors import MeshError
from .triangle_mesh import TriangleMesh, triangle_areas


@dataclass(frozen=True, eq=False)
class Polygons:
    """The faces of a mesh.

    Face i has the corners `starts[i]` to `starts[i + 1] - 1`, counted through all faces; each corner is at one vertex
    and has one edge, which leads to the next corner of its face.

    Attributes
    ----------
    starts : (f + 1,) array of int
        First corner of each face, and at the end the number of corners, l.
    corner_vertices : (l,) array of int
        The vertex of each corner.
    edges : (e, 2) array of int
        The vertices of each edge; an edge may have no face.
    corner_edges : (l,) array of int
        The edge from each corner to the next.
    triangle_corners : (t, 3) array of int
        The corners of each triangle that the faces are cut into.

    Raises
    ------
    MeshError
        If the arrays do not belong together.
    """

    starts: Ints
    corner_vertices: Ints
    edges: Ints
    corner_edges: Ints
    triangle_corners: Ints

    def __post_init__(self) -> None:
        for name in ("starts", "corner_vertices", "edges", "corner_edges", "triangle_corners"):
            array = np.asarray(getattr(self, name))
            if array.size and (array.dtype.kind not in "iu" or array.min() < 0):
                raise MeshError(f"The {name} of faces should be numbers of corners, vertices or edges, from 0 on.")
            object.__setattr__(self, name, array.astype(np.int64, copy=False))
        corners = len(self.corner_vertices)
        if self.starts.ndim != 1 or not len(self.starts) or self.starts[0] != 0 or self.starts[-1] != corners:
            raise MeshError(f"The faces should divide {corners} corners among them, but they do not.")
        if (np.diff(self.starts) < 3).any():
            raise MeshError("A face has fewer than three corners. Repair the mesh.")
        if self.corner_edges.shape != (corners,) or (corners and self.corner_edges.max() >= len(self.edges)):
            raise MeshError(f"Each of {corners} corners should have one of {len(self.edges)} edges.")
        if self.triangle_corners.size and self.triangle_corners.max() >= corners:
            raise MeshError(f"A triangle has a corner beyond the {corners} of the faces.")

    def __repr__(self) -> str:
        return f"<Polygons: {self.face_count} faces, {self.corner_count} corners>"

    @property
    def face_count(self) -> int:
        """Number of faces, f."""
        return len(self.starts) - 1

    @property
    def corner_count(self) -> int:
        """Number of corners, l."""
        return len(self.corner_vertices)

    @cached_property
    def face_sizes(self) -> Ints:
        """Number of corners of each face, (f,)."""
        return np.diff(self.starts)

    @cached_property
    def corner_faces(self) -> Ints:
        """The face of each corner, (l,)."""
        return np.repeat(np.arange(self.face_count), self.face_sizes)

    @cached_property
    def next_corners(self) -> Ints:
        """The corner that follows each corner in its face, (l,)."""
        following = np.arange(1, self.corner_count + 1)
        following[self.starts[1:] - 1] = self.starts[:-1]
        return following

    @cached_property
    def triangle_faces(self) -> Ints:
        """The face of each triangle, (t,)."""
        return self.corner_faces[self.triangle_corners[:, 0]]

    def face_means(self, values: Floats) -> Floats:
        """Mean over the corners of each face, (f, ...), of a value per corner, (l, ...)."""
        sums = np.add.reduceat(values, self.starts[:-1], axis=0) if self.face_count else values[:0]
        return sums / self.face_sizes.reshape(-1, *[1] * (values.ndim - 1))

    def face_areas(self, positions: Floats) -> Floats:
        """Area of each face, (f,), as that of the triangles; `positions` (n, 3) of the vertices."""
        areas = triangle_areas(positions, self.corner_vertices[self.triangle_corners])
        total: NDArray[Any] = np.bincount(self.triangle_faces, areas, self.face_count)
        return total

    @cached_property
    def neighbours(self) -> Ints:
        """Pairs of corners (p, 2) in different faces that have the same edge.

        At an edge of more than two faces each is paired with the next one in the order of the faces.
        """
        order = np.argsort(self.corner_edges, kind="stable")
        same = self.corner_edges[order][1:] == self.corner_edges[order][:-1]
        pairs = np.stack([order[:-1][same], order[1:][same]], axis=1)
        return pairs[self.corner_faces[pairs[:, 0]] != self.corner_faces[pairs[:, 1]]]

    @cached_property
    def meeting_corners(self) -> Ints:
        """For each pair of `neighbours`, the corners that meet at each end of their edge, (p, 2 ends, 2 sides)."""
        one, other = self.neighbours.T
        one_next, other_next = self.next_corners[one], self.next_corners[other]
        opposite = self.corner_vertices[one] == self.corner_vertices[other_next]
        start = np.stack([one, np.where(opposite, other_next, other)], axis=1)
        end = np.stack([one_next, np.where(opposite, other, other_next)], axis=1)
        return np.stack([start, end], axis=1)

    def cut_as(self, mesh: TriangleMesh) -> Polygons:
        """Return the same faces with their triangles in the order, and as far as they are in it, of a triangle mesh.

        The mesh has those triangles, in this order, that use no vertex twice; all of them may be turned around.

        Raises
        ------
        MeshError
            If the mesh has other triangles.
        """
        vertices = self.corner_vertices[self.triangle_corners]
        kept = self.triangle_corners[(vertices != np.roll(vertices, 1, axis=1)).all(axis=1)]
        for corners in (kept, kept[:, ::-1]):
            if np.array_equal(self.corner_vertices[corners], mesh.triangles):
                return replace(self, triangle_corners=corners)
        raise MeshError("The faces of the mesh are not those that the map was made for. Match again.")
