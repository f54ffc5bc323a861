# SPDX-License-Identifier: GPL-3.0-or-later
"""Attributes of any type and domain, faces and their materials, as arrays from and to Blender's meshes."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from ...engine import Polygons
from ..common.access import mesh_of
from .mesh_io import corner_vertices, face_corner_counts, vertex_positions

if TYPE_CHECKING:
    import bpy
    from numpy.typing import NDArray

_TYPES: dict[str, tuple[str, type[np.generic], int]] = {
    "FLOAT": ("value", np.float32, 1),
    "FLOAT2": ("vector", np.float32, 2),
    "FLOAT_VECTOR": ("vector", np.float32, 3),
    "FLOAT4": ("vector", np.float32, 4),
    "FLOAT_COLOR": ("color", np.float32, 4),
    "BYTE_COLOR": ("color", np.float32, 4),
    "QUATERNION": ("value", np.float32, 4),
    "FLOAT4X4": ("value", np.float32, 16),
    "INT": ("value", np.int32, 1),
    "INT8": ("value", np.int32, 1),
    "INT16_2D": ("value", np.int32, 2),
    "INT32_2D": ("value", np.int32, 2),
    "BOOLEAN": ("value", np.bool_, 1),
    "STRING": ("value", np.bytes_, 1),
}
"""For each type of attribute: what its values are called, the type of their numbers, and how many there are."""

_BLENDED = frozenset({"FLOAT", "FLOAT2", "FLOAT_VECTOR", "FLOAT4", "FLOAT_COLOR", "BYTE_COLOR"})
"""Types whose values have a mean; those of turns and transforms have none that is one of them."""


@dataclass(frozen=True)
class AttributeLayout:
    """What an attribute is.

    Attributes
    ----------
    name : str
        Its name.
    kind : str
        Blender's name for its type, such as FLOAT_COLOR.
    domain : str
        What has the values: POINT, EDGE, FACE or CORNER.
    """

    name: str
    kind: str
    domain: str


def attribute_layouts(mesh: bpy.types.Mesh) -> dict[str, AttributeLayout]:
    """Return what attributes a mesh has, by their names, without those that Blender keeps to itself."""
    found: Any = mesh.attributes
    return {
        attribute.name: AttributeLayout(attribute.name, attribute.data_type, attribute.domain)
        for attribute in found
        if not (attribute.is_internal or attribute.is_required or attribute.name.startswith("."))
    }


def is_known(kind: str) -> bool:
    """Tell whether attributes of a type can be read and written."""
    return kind in _TYPES


def is_free(obj: bpy.types.Object, layout: AttributeLayout) -> bool:
    """Tell whether an attribute can be written on a mesh object: nothing else there has its name."""
    present = attribute_layouts(mesh_of(obj)).get(layout.name, layout)
    return present == layout and layout.name not in obj.vertex_groups


def is_blended(kind: str) -> bool:
    """Tell whether values of a type can be interpolated."""
    return kind in _BLENDED


def read_attribute(mesh: bpy.types.Mesh, name: str) -> NDArray[Any]:
    """Read an attribute of a known type: values (k,), or (k, d) if each has several numbers."""
    attributes: Any = mesh.attributes
    attribute = attributes[name]
    member, number, width = _TYPES[attribute.data_type]
    if number is np.bytes_:  # for which Blender has no bulk access
        return np.array([getattr(element, member) for element in attribute.data], np.bytes_)
    values = np.empty(len(attribute.data) * width, number)
    attribute.data.foreach_get(member, values)
    return values if width == 1 else values.reshape(-1, width)


def read_values(mesh: bpy.types.Mesh, name: str, kind: str) -> NDArray[Any] | None:
    """Read an attribute of a known type per vertex, (n,) or (n, d); None if there is none such."""
    attribute: Any = mesh.attributes.get(name)
    alike = attribute is not None and (attribute.data_type, attribute.domain) == (kind, "POINT")
    return read_attribute(mesh, name) if alike else None


def missing_attribute(mesh: bpy.types.Mesh, layout: AttributeLayout) -> NDArray[Any]:
    """Return what stands for an attribute that a mesh lacks: white as a color, else zeros."""
    held: Any = {"POINT": mesh.vertices, "EDGE": mesh.edges, "FACE": mesh.polygons, "CORNER": mesh.loops}[layout.domain]
    _, number, width = _TYPES[layout.kind]
    shape = (len(held),) if width == 1 else (len(held), width)
    return np.ones(shape, number) if layout.kind in ("FLOAT_COLOR", "BYTE_COLOR") else np.zeros(shape, number)


def write_attribute(mesh: bpy.types.Mesh, layout: AttributeLayout, values: NDArray[Any]) -> None:
    """Write an attribute, which is added if there is none of that name; if there is, it must be of the same layout."""
    attributes: Any = mesh.attributes
    member, number, _ = _TYPES[layout.kind]
    if layout.name not in attributes:
        attributes.new(layout.name, layout.kind, layout.domain)
    # Looked up anew: whatever was found before an attribute is added may have moved in memory.
    data = attributes[layout.name].data
    if number is np.bytes_:
        for element, value in zip(data, values.tolist(), strict=True):
            setattr(element, member, value)
        return
    data.foreach_set(member, np.ascontiguousarray(values, number).ravel())


def add_values(mesh: bpy.types.Mesh, name: str, values: NDArray[Any]) -> None:
    """Add an attribute with a whole number (n,), a number (n,) or a vector (n, 3) per vertex."""
    kind = "FLOAT_VECTOR" if values.ndim == 2 else "INT" if np.issubdtype(values.dtype, np.integer) else "FLOAT"
    write_attribute(mesh, AttributeLayout(name, kind, "POINT"), values)


def read_polygons(mesh: bpy.types.Mesh) -> Polygons:
    """Read the faces of a mesh, its edges, and the triangles that Blender draws."""
    corner_edges = np.empty(len(mesh.loops), np.int32)
    mesh.loops.foreach_get("edge_index", corner_edges)
    edges = np.empty(2 * len(mesh.edges), np.int32)
    mesh.edges.foreach_get("vertices", edges)
    mesh.calc_loop_triangles()
    triangles = np.empty(3 * len(mesh.loop_triangles), np.int32)
    mesh.loop_triangles.foreach_get("loops", triangles)
    starts = np.append(0, np.cumsum(face_corner_counts(mesh), dtype=np.int64))
    numbers = (corner_vertices(mesh), edges.reshape(-1, 2), corner_edges, triangles.reshape(-1, 3))
    return Polygons(starts, *(array.astype(np.int64) for array in numbers))


def read_face_materials(mesh: bpy.types.Mesh) -> NDArray[np.int64]:
    """Read the number of each face's material slot, (f,)."""
    slots = np.empty(len(mesh.polygons), np.int32)
    mesh.polygons.foreach_get("material_index", slots)
    return slots.astype(np.int64)


def write_face_materials(mesh: bpy.types.Mesh, slots: NDArray[np.int64]) -> None:
    """Write the number of each face's material slot, (f,)."""
    mesh.polygons.foreach_set("material_index", np.ascontiguousarray(slots, np.int32))


def read_seams(mesh: bpy.types.Mesh) -> NDArray[np.bool_]:
    """Read which edges are marked as seams, (e,)."""
    seams = np.empty(len(mesh.edges), np.bool_)
    mesh.edges.foreach_get("use_seam", seams)
    return seams


def write_seams(mesh: bpy.types.Mesh, seams: NDArray[np.bool_]) -> None:
    """Mark edges (e,) as seams, and no others."""
    mesh.edges.foreach_set("use_seam", np.ascontiguousarray(seams, np.bool_))


def read_corner_normals(mesh: bpy.types.Mesh, matrix: NDArray[np.float64] | None = None) -> NDArray[np.float64]:
    """Read the normals with which the corners of faces are shaded, (l, 3).

    They are in the mesh's own space, or, with a matrix (3, 3) that takes directions from there, in the other one:
    normals turn by the inverse transpose of what positions turn by.
    """
    normals = np.empty(3 * len(mesh.loops), np.float32)
    corners: Any = mesh.corner_normals
    corners.foreach_get("vector", normals)
    own = normals.reshape(-1, 3).astype(np.float64)
    return own if matrix is None else _unit(own @ np.linalg.inv(matrix))


def write_corner_normals(
    mesh: bpy.types.Mesh,
    normals: NDArray[np.float64],
    matrix: NDArray[np.float64] | None = None,
    positions: NDArray[np.float64] | None = None,
) -> None:
    """Set custom normals, (l, 3); Blender marks edges as sharp where those on one side differ from the other's.

    Parameters
    ----------
    mesh : bpy.types.Mesh
        Whose.
    normals : (l, 3) array of float
        The normals.
    matrix : (3, 3) array of float, optional
        What takes directions from the mesh's own space to that of the normals.
    positions : (n, 3) array of float, optional
        With which vertices the surface has these normals, such as those of a shape key; else the mesh's own.  Blender
        keeps normals relative to the surface.
    """
    own: Any = mesh
    rest = vertex_positions(mesh).ravel()
    if positions is not None:
        mesh.vertices.foreach_set("co", np.ascontiguousarray(positions, np.float32).ravel())
        mesh.update()
    own.normals_split_custom_set((normals if matrix is None else _unit(normals @ matrix)).tolist())
    if positions is not None:
        mesh.vertices.foreach_set("co", rest)
        mesh.update()


def _unit(vectors: NDArray[np.float64]) -> NDArray[np.float64]:
    """Scale vectors (k, 3) to length one, leaving zero vectors alone."""
    lengths = np.linalg.norm(vectors, axis=1, keepdims=True)
    return np.divide(vectors, lengths, out=np.zeros_like(vectors), where=lengths > 0)
