# SPDX-License-Identifier: GPL-3.0-or-later
"""Triangle meshes: validation at the door, and the geometry that everything else reads."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any, ClassVar

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..runtime.arrays import Bools, Floats, Ints, group_smallest, numbered, unit_vectors
from ..runtime.errors import MeshError
from .connectivity.components import joined_components

_FARTHEST = 1e75
"""Coordinate, in any unit, up to which the squares of areas are numbers: their fourth powers are below 1e308."""


@dataclass(frozen=True, eq=False)
class TriangleMesh:
    """A surface made of triangles.

    The arrays are copied, converted and made read-only, so that whatever is computed from them stays true.

    Parameters
    ----------
    vertices : (n, 3) array_like of float
        Positions.
    triangles : (m, 3) array_like of int
        Corners of each triangle, indices into `vertices`, counter-clockwise seen from outside.

    Raises
    ------
    MeshError
        If the arrays do not describe a surface; the message names the fault.

    Notes
    -----
    Triangles of zero area, open boundaries, edges with more than two triangles, several components and vertices
    without a triangle are allowed: real meshes have them.
    """

    vertices: Floats
    triangles: Ints
    is_sent_once: ClassVar[bool] = True
    """See `parallel_map.shared_steps`."""

    def __post_init__(self) -> None:
        vertices = _as_vertices(self.vertices)
        triangles = _as_triangles(self.triangles, len(vertices))
        object.__setattr__(self, "vertices", vertices)
        object.__setattr__(self, "triangles", triangles)
        if not self.area > 0:
            raise MeshError(
                "Every triangle of the mesh has zero area: the mesh has no surface. "
                "Check its scale and whether its vertices all lie on one line or in one point."
            )

    def __repr__(self) -> str:
        return f"<TriangleMesh: {self.vertex_count} vertices, {self.triangle_count} triangles>"

    def __getstate__(self) -> dict[str, Any]:
        """Leave out what is computed of it when that is asked for."""
        return {"vertices": self.vertices, "triangles": self.triangles}

    def __setstate__(self, state: dict[str, Any]) -> None:
        """Make the arrays read-only, which copies of them are not."""
        for name, array in state.items():
            object.__setattr__(self, name, _read_only(array))

    @classmethod
    def concatenated(cls, meshes: Sequence[TriangleMesh]) -> TriangleMesh:
        """Put several meshes into one, as components of it in this order; a single one is returned as it is."""
        if len(meshes) == 1:
            return meshes[0]
        firsts = np.cumsum([0, *(mesh.vertex_count for mesh in meshes[:-1])])
        triangles = [mesh.triangles + first for mesh, first in zip(meshes, firsts, strict=True)]
        return cls(np.concatenate([mesh.vertices for mesh in meshes]), np.concatenate(triangles))

    @property
    def vertex_count(self) -> int:
        """Number of vertices, n."""
        return len(self.vertices)

    @property
    def triangle_count(self) -> int:
        """Number of triangles, m."""
        return len(self.triangles)

    @cached_property
    def _area_vectors(self) -> Floats:
        """Triangle normals times area, (m, 3)."""
        return _area_vectors(self.vertices, self.triangles)

    @cached_property
    def triangle_areas(self) -> Floats:
        """Area of each triangle, (m,)."""
        return _read_only(np.linalg.norm(self._area_vectors, axis=1))

    @cached_property
    def area(self) -> float:
        """Area of the whole surface."""
        return float(self.triangle_areas.sum())

    @cached_property
    def triangle_normals(self) -> Floats:
        """Unit normal of each triangle, (m, 3); zero for a triangle without area."""
        return _read_only(unit_vectors(self._area_vectors))

    @cached_property
    def vertex_areas(self) -> Floats:
        """A third of the area of the triangles around each vertex, (n,); they sum to `area`."""
        return _read_only(self.sum_at_vertices(self.triangle_areas / 3))

    @cached_property
    def vertex_normals(self) -> Floats:
        """Unit normal at each vertex, weighted by triangle area, (n, 3); zero at a vertex without a triangle."""
        sums = np.stack([self.sum_at_vertices(component) for component in self._area_vectors.T], axis=1)
        return _read_only(unit_vectors(sums))

    def sum_at_vertices(self, values: Floats) -> Floats:
        """Sum a value per triangle, (m,), over the triangles around each vertex, (n,)."""
        sums: NDArray[Any] = np.bincount(self.triangles.ravel(), np.repeat(values, 3), self.vertex_count)
        return sums

    @cached_property
    def _edge_table(self) -> tuple[Ints, Ints]:
        """Edges (e, 2), each once with its smaller index first, and how many triangles each has (e,)."""
        a, b = self.triangles.ravel(), np.roll(self.triangles, -1, axis=1).ravel()
        # One integer per edge: far faster to sort than rows.
        keys, counts = np.unique(np.minimum(a, b) * self.vertex_count + np.maximum(a, b), return_counts=True)
        return _read_only(np.stack(np.divmod(keys, self.vertex_count), axis=1)), counts

    @property
    def edges(self) -> Ints:
        """Each edge once, smaller vertex index first, (e, 2)."""
        return self._edge_table[0]

    @cached_property
    def edge_lengths(self) -> Floats:
        """Length of each of `edges`, (e,)."""
        a, b = self.edges.T
        return _read_only(np.linalg.norm(self.vertices[a] - self.vertices[b], axis=1))

    @cached_property
    def boundary_edges(self) -> Ints:
        """The edges with exactly one triangle, (b, 2)."""
        edges, counts = self._edge_table
        return edges[counts == 1]

    @cached_property
    def border_lengths(self) -> Floats:
        """Length of the closed curve that each of `boundary_edges` belongs to, (b,); those that meet count as one."""
        tails, heads = self.boundary_edges.T
        borders = joined_components(self.vertex_count, tails, heads)[tails]
        lengths = np.linalg.norm(self.vertices[tails] - self.vertices[heads], axis=1)
        return _read_only(np.bincount(borders, lengths)[borders])

    @cached_property
    def is_closed(self) -> bool:
        """Whether every edge has exactly two triangles."""
        return bool((self._edge_table[1] == 2).all())

    @cached_property
    def component_labels(self) -> Ints:
        """Number of the edge-connected component of each vertex, (n,); the largest by area is 0, and so on down.

        Vertices without a triangle are components of their own, at the end.
        """
        n = self.vertex_count
        labels = joined_components(n, *self.edges.T)
        areas = np.bincount(labels, self.vertex_areas)
        # Ties by the first vertex, so that the numbering never depends on how the graph search walks.
        first = group_smallest(labels, np.arange(n), len(areas), n)
        return numbered(np.lexsort((first, -areas)), len(areas))[labels]

    def parts_of(self, chosen: Bools) -> Ints:
        """Find the connected parts of chosen vertices (n,): the number of that of each, (n,); all others are alone."""
        return joined_components(self.vertex_count, *self.edges[chosen[self.edges].all(axis=1)].T)

    @property
    def component_count(self) -> int:
        """Number of edge-connected components, vertices without a triangle included."""
        return int(self.component_labels.max()) + 1

    def submesh(self, keep: Bools) -> tuple[TriangleMesh, Ints, Ints]:
        """Return the part of the mesh on some of its vertices.

        Parameters
        ----------
        keep : (n,) array of bool
            Which vertices to keep; a triangle stays if all three of its corners do.

        Returns
        -------
        mesh : TriangleMesh
            The part.
        vertices : (n',) array of int
            For each vertex of the part, its index in this mesh.
        triangles : (m',) array of int
            For each triangle of the part, its index in this mesh.

        Raises
        ------
        MeshError
            If no triangle is left.
        """
        vertices = np.flatnonzero(keep)
        triangles = np.flatnonzero(keep[self.triangles].all(axis=1))
        renumber = np.cumsum(keep) - 1
        return TriangleMesh(self.vertices[vertices], renumber[self.triangles[triangles]]), vertices, triangles

    def made_of(self, triangles: Bools | Ints) -> tuple[TriangleMesh, Ints]:
        """Return a mesh of some triangles, given by number or as truth values, and its vertices' numbers here, (k,)."""
        vertices, corners = np.unique(self.triangles[triangles], return_inverse=True)
        return TriangleMesh(self.vertices[vertices], corners.reshape(-1, 3)), vertices


def check_mesh(mesh: object, name: str = "surface") -> None:
    """Raise an error if what should be a mesh is not: its vertices, say, or None.

    Parameters
    ----------
    mesh : object
        What was given for it.
    name : str
        What the error calls it.

    Raises
    ------
    MeshError
        If it is none.
    """
    if not isinstance(mesh, TriangleMesh):
        raise MeshError(
            f"The {name} is of the type {type(mesh).__name__}. Make a mesh of its vertices and triangles first: "
            "TriangleMesh(vertices, triangles)."
        )


def triangle_areas(vertices: Floats, triangles: Ints) -> Floats:
    """Area of each of some triangles (m, 3) of vertices (n, 3): (m,)."""
    return np.linalg.norm(_area_vectors(vertices, triangles), axis=1)


def _area_vectors(vertices: Floats, triangles: Ints) -> Floats:
    """Return the normals of triangles (m, 3) of vertices (n, 3) times their areas, (m, 3)."""
    a, b, c = (vertices[corner] for corner in triangles.T)
    return np.cross(b - a, c - a) / 2


def _read_only(array: NDArray[Any]) -> NDArray[Any]:
    array.flags.writeable = False
    return array


def _as_vertices(vertices: ArrayLike) -> Floats:
    if isinstance(vertices, np.ndarray) and np.iscomplexobj(vertices):
        raise MeshError("The vertex positions should be real numbers, but are complex ones.")
    try:
        array = np.array(vertices, dtype=np.float64)
    except (TypeError, ValueError) as error:
        raise MeshError(f"The vertex positions are not an (n, 3) array of numbers: {error}.") from error
    if array.ndim != 2 or array.shape[1] != 3:
        raise MeshError(f"The vertex positions should have the shape (n, 3), but have {array.shape}.")
    if not len(array):
        raise MeshError("The mesh has no vertices.")
    bad = ~np.isfinite(array).all(axis=1)
    if bad.any():
        raise MeshError(
            f"{bad.sum()} of {len(array)} vertices have a position that is not a finite number, "
            f"vertex {np.flatnonzero(bad)[0]} first. Delete these vertices or repair them."
        )
    far = (np.abs(array) > _FARTHEST).any(axis=1)
    if far.any():
        raise MeshError(
            f"{far.sum()} of {len(array)} vertices are too far away for areas to be computed, "
            f"vertex {np.flatnonzero(far)[0]} first, at {np.abs(array).max():.0e}. "
            "Delete these vertices or repair them."
        )
    return _read_only(array)


def _as_triangles(triangles: ArrayLike, vertex_count: int) -> Ints:
    try:
        array = np.array(triangles)
    except ValueError as error:
        raise MeshError(f"The triangles are not an (m, 3) array of vertex indices: {error}.") from error
    if array.size == 0:
        raise MeshError("The mesh has no faces. A surface is needed, not only vertices or edges.")
    if array.ndim != 2 or array.shape[1] != 3:
        raise MeshError(f"The triangles should have the shape (m, 3), but have {array.shape}.")
    if not np.issubdtype(array.dtype, np.integer):
        raise MeshError(f"The triangles should be vertex indices (integers), but are of type {array.dtype}.")
    array = array.astype(np.int64)
    bad = ((array < 0) | (array >= vertex_count)).any(axis=1)
    if bad.any():
        first = np.flatnonzero(bad)[0]
        raise MeshError(
            f"Triangle {first} has the corners {array[first].tolist()}, "
            f"but the vertices are numbered 0 to {vertex_count - 1}."
        )
    repeated = (array == np.roll(array, 1, axis=1)).any(axis=1)
    if repeated.any():
        first = np.flatnonzero(repeated)[0]
        raise MeshError(
            f"Triangle {first} is degenerate: it uses a vertex twice ({array[first].tolist()}). "
            "Remove such faces (in Blender: Mesh > Clean Up > Degenerate Dissolve)."
        )
    return _read_only(array)
