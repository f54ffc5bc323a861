# SPDX-License-Identifier: GPL-3.0-or-later
"""Values at the corners of faces and at points, such as colours and normals, carried from one mesh to another."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ...geometry.procrustes import least_turns
from ...mesh.connectivity.welded_parts import WeldedParts
from ...mesh.polygons import Polygons
from ...mesh.surface_map import SurfaceMap
from ...mesh.triangle_mesh import TriangleMesh
from ...runtime.arrays import Floats, Ints, group_largest, unit_vectors
from ...runtime.errors import MeshError
from .charts import cut_into_sheets
from .deformation_gradients import surface_frames
from .face_correspondence import FacePlaces

_SAME = 1e-3
"""Values that differ by less than this part of their range are the same; a byte has steps four times as large."""

_SAME_DIRECTION = 0.02
"""Unit vectors that differ by less are the same: one degree."""

_CANCELLED = 1e-6
"""Length up to which a sum of unit vectors counts as none: they cancelled out."""


_TURN_RADIUS = 0.01
"""Over what distance the turn of a deformed surface is averaged for normals, in sqrt(area): as `wrapping` does."""


def carry_corner_values(values: ArrayLike, source: Polygons, places: FacePlaces) -> NDArray[Any]:
    """Carry values at the corners of the source's faces to those of the target's.

    Where the values jump from face to face, they jump on the target as well: a face takes all of its corners from the
    side of the edge where its centre lies.

    Parameters
    ----------
    values : (l_x, ...) array_like
        For each corner of the source, a number, a vector, or anything else.
    source : Polygons
        Faces of the source, cut as the image of `places` is.
    places : FacePlaces
        Where the faces of the target lie on the source.

    Returns
    -------
    (l_y, ...) array
        For each corner of the target; interpolated if the values are real numbers, else that of the nearest corner.
    """
    array = np.asarray(values)
    flat = array.reshape(len(array), -1)
    if np.issubdtype(array.dtype, np.inexact):
        tolerance = _SAME * float(np.ptp(flat, axis=0).max(initial=0.0)) if len(flat) else 0.0
        return _interpolated(flat.astype(np.float64), source, places, tolerance).reshape(-1, *array.shape[1:])
    _, code = np.unique(flat, axis=0, return_inverse=True)
    sheets = cut_into_sheets(places.image, source, code.reshape(-1, 1).astype(np.float64), 0.5)
    found = places.on_sheets(sheets)
    return array[source.triangle_corners[found.triangles, found.barycentric.argmax(axis=1)]]


def carry_point_values(values: ArrayLike, target_to_source: SurfaceMap) -> NDArray[Any]:
    """Carry values at the vertices of the source, (n_x, ...), to those of the target, (n_y, ...).

    As `SurfaceMap.transfer` does; but truth values are interpolated too, and true from one half on, so that the border
    between them does not follow the edges of the source.
    """
    array = np.asarray(values)
    if array.dtype == bool:
        return np.asarray(target_to_source.transfer(array.astype(np.float64)) >= 0.5)
    return target_to_source.transfer(array)


def carry_point_marks(values: Floats, source_to_target: SurfaceMap) -> Floats:
    """Carry numbers that mark single vertices of the source, (n_x,), such as creases, to single ones of the target.

    Each goes to the vertex nearest to its place; of several that meet there the largest counts.  All others are zero.
    """
    marked = np.flatnonzero(values)
    images = source_to_target.nearest_vertices[marked]
    return group_largest(images, values[marked], source_to_target.image_vertex_count)


def carry_normals(
    normals: Floats, source: Polygons, places: FacePlaces, target: TriangleMesh, rotations: Floats
) -> Floats:
    """Carry normals at the corners of faces that differ from those of the surface.

    What is carried is how they deviate from the smooth normals of the source: where they do not, the target gets its
    own smooth normals.

    Parameters
    ----------
    normals : (l_x, 3) array of float
        Unit normals at the corners of the source.
    source : Polygons
        Faces of the source, cut as the image of `places` is.
    places : FacePlaces
        Where the faces of the target lie on the source.
    target : TriangleMesh
        The target.
    rotations : (n_y, 3, 3) array of float
        How directions on the source, around the image of each vertex of the target, have to turn.

    Returns
    -------
    (l_y, 3) array of float
        Unit normals at the corners of the target.

    Raises
    ------
    MeshError
        If there is not one normal for each corner.
    """
    if normals.shape != (source.corner_count, 3):
        raise MeshError(f"There should be one normal for each of {source.corner_count} corners, not {normals.shape}.")
    carried = _interpolated(np.asarray(normals, np.float64), source, places, _SAME_DIRECTION)
    vertices, smooth = places.polygons.corner_vertices, places.map.transfer(places.image.vertex_normals)
    result = _turned(carried, vertices, rotations, smooth, target.vertex_normals)
    # Where normals cancel out there is none; the target's own is as good as any.
    return np.where(result.any(axis=1, keepdims=True), result, target.vertex_normals[vertices])


def turned_normals(normals: Floats, corner_vertices: Ints, mesh: TriangleMesh, positions: Floats) -> Floats:
    """Turn normals at the corners of faces as a deformation turns the surface.

    As in `carry_normals`, what is kept is how they deviate from the smooth normals.  At seams that the mesh was cut
    open at, both sides turn alike: what was shaded as one surface still is.

    Parameters
    ----------
    normals : (l, 3) array of float
        Unit normals at the corners.
    corner_vertices : (l,) array of int
        The vertex of each corner.
    mesh : TriangleMesh
        The surface.
    positions : (n, 3) array of float
        Its vertices when deformed.

    Returns
    -------
    (l, 3) array of float
        Unit normals of the deformed surface.

    Raises
    ------
    MeshError
        If there is not one normal for each corner.
    """
    if normals.shape != (len(corner_vertices), 3):
        raise MeshError(f"There should be one normal for each of {len(corner_vertices)} corners, not {normals.shape}.")
    parts = WeldedParts.of(mesh)
    welded = parts.means @ positions
    rotations = surface_frames(parts.closed, welded, radius=_TURN_RADIUS).rotations
    now = TriangleMesh(welded, parts.triangles).vertex_normals
    return _turned(normals, parts.welded[corner_vertices], rotations, parts.closed.vertex_normals, now)


def _turned(normals: Floats, vertices: Ints, rotations: Floats, smooth: Floats, now: Floats) -> Floats:
    """Turn normals at corners, (l, 3), with those of their vertices, (l,), by rotations (n, 3, 3) and then further.

    The least turn takes smooth normals (n, 3), which the rotations alone turn nearly so, to those of the surface now.
    """
    turned = np.einsum("nij,nj->ni", rotations, smooth)
    whole = least_turns(unit_vectors(turned, _CANCELLED), now) @ rotations
    return unit_vectors(np.einsum("lij,lj->li", whole[vertices], normals), _CANCELLED)


def _interpolated(values: Floats, source: Polygons, places: FacePlaces, tolerance: float) -> Floats:
    """Carry real values (l_x, d), interpolated on the sheets on which they are continuous."""
    sheets = cut_into_sheets(places.image, source, values, tolerance)
    found = places.on_sheets(sheets)
    return sheets.at(found.triangles, found.barycentric)
