# SPDX-License-Identifier: GPL-3.0-or-later
"""Landmarks as a mesh keeps them: an attribute of its vertices, read and written in Object Mode and in Edit Mode.

An attribute goes where its vertex goes: through renaming, saving and undoing like any data of the mesh, and through
edits that number the vertices anew.  But a cut through an edge gives the new vertex the mean of what its ends have.  So
what is kept is not a number but the vector (number, number squared, 1 if it is off): points of a parabola, of which no
mean lies on it again.  Of copies of a vertex, the first one counts.
"""

from __future__ import annotations

from contextlib import contextmanager
from typing import TYPE_CHECKING, Any

import bmesh
import bpy
import numpy as np

from ..common.access import mesh_of
from ..common.errors import ObjectError
from ..common.phrases import not_ours
from ..scene.attribute_io import add_values, read_values

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator

    from numpy.typing import NDArray

    from .landmarks import Mark

LANDMARKS = "HM Landmark"
"""Name of the attribute."""

_LARGEST = 4096
"""No number of a landmark is larger: the square of a larger one is no exact number of single precision."""


def check_layer(obj: bpy.types.Object) -> None:
    """Make sure that nothing else has the name of the attribute.

    Raises
    ------
    ObjectError
        If a vertex group or another kind of attribute has it.
    """
    found: Any = mesh_of(obj).attributes.get(LANDMARKS)
    if LANDMARKS in obj.vertex_groups:
        raise ObjectError(not_ours(obj.name, "a vertex group", LANDMARKS))
    if found is not None and (found.data_type, found.domain) != ("FLOAT_VECTOR", "POINT"):
        raise ObjectError(not_ours(obj.name, "an attribute", LANDMARKS))


def has_landmarks(mesh: bpy.types.Mesh) -> bool:
    """Return whether a mesh, in Object Mode, has the attribute."""
    return LANDMARKS in mesh.attributes


def read_marks(obj: bpy.types.Object) -> dict[int, Mark]:
    """Return the vertex of each landmark of a mesh, positive, and whether it is on, by their numbers."""
    return _read(mesh_of(obj))


def numbers_in_file() -> set[int]:
    """Return the numbers of the landmarks of all meshes."""
    return {number for mesh in bpy.data.meshes for number in _read(mesh)}


def _read(mesh: bpy.types.Mesh) -> dict[int, Mark]:
    if mesh.is_editmode:
        with _edited(mesh) as edited:
            layer = edited.verts.layers.float_vector.get(LANDMARKS)
            values = None if layer is None else np.array([vertex[layer] for vertex in edited.verts], np.float32)
    else:
        values = read_values(mesh, LANDMARKS, "FLOAT_VECTOR")
    return {} if values is None else _marks(values)


def write_marks(obj: bpy.types.Object, marks: dict[int, Mark]) -> None:
    """Let these be the landmarks of a mesh; without any, the attribute goes."""
    mesh = mesh_of(obj)
    if mesh.is_editmode:
        _write_edited(mesh, marks)
        return
    attributes: Any = mesh.attributes
    active = attributes.active.name if attributes.active else ""
    if LANDMARKS in attributes:
        attributes.remove(attributes[LANDMARKS])
    if marks:
        values = np.zeros((len(mesh.vertices), 3), np.float32)
        for number, (vertex, use) in marks.items():
            values[vertex] = _value(number, use=use)
        add_values(mesh, LANDMARKS, values)
    if active in attributes:
        attributes.active = attributes[active]
    mesh.update()


def selected_vertices(obj: bpy.types.Object) -> list[int]:
    """Return the selected vertices of a mesh in Edit Mode."""
    with _edited(mesh_of(obj)) as edited:
        return [number for number, vertex in enumerate(edited.verts) if vertex.select and not vertex.hide]


def select_vertices(obj: bpy.types.Object, vertices: Iterable[int]) -> None:
    """Select some vertices of a mesh and nothing else of it; in Object Mode, they will be selected in Edit Mode."""
    mesh, chosen = mesh_of(obj), list(vertices)
    if mesh.is_editmode:
        with _edited(mesh) as edited:
            for element in (*edited.faces, *edited.edges, *edited.verts):
                element.select = False
            edited.select_history.clear()
            edited.select_mode = {"VERT"}
            edited.verts.ensure_lookup_table()
            for vertex in chosen:
                edited.verts[vertex].hide_set(False)  # noqa: FBT003 - Blender's own
                edited.verts[vertex].select = True
                edited.select_history.add(edited.verts[vertex])
        bmesh.update_edit_mesh(mesh, loop_triangles=False, destructive=False)
        return
    for parts in (mesh.polygons, mesh.edges, mesh.vertices):
        found: Any = parts
        flags = np.zeros(len(found), bool)
        if found == mesh.vertices:
            flags[chosen] = True
        found.foreach_set("select", flags)
    mesh.update()


@contextmanager
def _edited(mesh: bpy.types.Mesh) -> Iterator[Any]:
    """Lend the mesh that is edited; it is Blender's own and is not to be freed."""
    yield bmesh.from_edit_mesh(mesh)


def _write_edited(mesh: bpy.types.Mesh, marks: dict[int, Mark]) -> None:
    with _edited(mesh) as edited:
        layers = edited.verts.layers.float_vector
        layer = layers.get(LANDMARKS)
        if layer is not None and not marks:
            layers.remove(layer)
        if marks:
            layer = layers.new(LANDMARKS) if layer is None else layer
            for vertex in edited.verts:
                vertex[layer] = (0.0, 0.0, 0.0)
            edited.verts.ensure_lookup_table()
            for number, (index, use) in marks.items():
                edited.verts[index][layer] = _value(number, use=use)
    bmesh.update_edit_mesh(mesh, loop_triangles=False, destructive=False)


def _value(number: int, *, use: bool) -> tuple[float, float, float]:
    return float(number), float(number * number), 0.0 if use else 1.0


def _marks(values: NDArray[np.float32]) -> dict[int, Mark]:
    """Find the landmarks among the values (n, 3)."""
    numbers, squares, off = values.astype(np.float64).T
    proper = (numbers >= 1) & (numbers <= _LARGEST) & (numbers == np.floor(numbers)) & (squares == numbers**2)
    marks: dict[int, Mark] = {}
    for vertex in np.flatnonzero(proper & ((off == 0) | (off == 1))).tolist():
        marks.setdefault(int(numbers[vertex]), (vertex, bool(off[vertex] == 0)))
    return dict(sorted(marks.items()))
