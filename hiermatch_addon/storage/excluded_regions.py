# SPDX-License-Identifier: GPL-3.0-or-later
"""Regions of a mesh that a match leaves out, as artists mark them: groups, attributes, materials and face sets."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from ..common.access import mesh_of
from ..common.errors import ObjectError
from ..scene.attribute_io import read_attribute
from ..scene.character import parts_of
from ..scene.deform_layer import read_weights
from ..scene.material_slots import read_materials
from ..scene.mesh_io import corner_vertices, face_corner_counts
from .written_names import written_names

if TYPE_CHECKING:
    import bpy
    from numpy.typing import NDArray

    from ..scene.character import Side

_SHADING = "sharp_face"
"""The attribute of Blender's own that is no region: which faces are shaded flat."""

_FACE_SETS, _FACE_SET = ".sculpt_face_set", "Face Set "
"""The attribute with the number of each face's face set, and what the names of these start with here."""

_HALF = 0.5
"""From which weight on a vertex belongs to a region."""


def region_names(side: Side) -> list[str]:
    """Return what names of regions the parts of a side have."""
    return list(dict.fromkeys(name for part in parts_of(side) for name in _names_of_part(part)))


def _names_of_part(obj: bpy.types.Object) -> list[str]:
    ours = written_names(obj)
    groups = [group.name for group in obj.vertex_groups if group.name not in ours]
    marked = [
        attribute.name
        for attribute in mesh_of(obj).attributes
        if attribute.data_type == "BOOLEAN"
        and attribute.domain in ("POINT", "FACE")
        and attribute.name not in ours
        and attribute.name != _SHADING
        and not attribute.name.startswith(".")
    ]
    materials = [slot.material.name for slot in obj.material_slots if slot.material is not None]
    sets = [f"{_FACE_SET}{number}" for number in np.unique(_face_sets(mesh_of(obj))).tolist()]
    return list(dict.fromkeys([*groups, *marked, *materials, *sets]))


def excluded_vertices(side: Side, name: str) -> NDArray[np.bool_] | None:
    """Find the vertices of a region.

    Parameters
    ----------
    side : bpy.types.Object or Character
        A mesh object, in Object Mode, or several.
    name : str
        Name of a vertex group, whose vertices of at least half the full weight are meant; or else of a boolean
        attribute of vertices or of faces; or else of a material; or else of a face set, such as "Face Set 2".  Of
        faces, those vertices are meant that have no others.  If empty, there is no region.

    Returns
    -------
    (n,) array of bool or None
        Which vertices are in it; None if there is no region.

    Raises
    ------
    ObjectError
        If the object has nothing of that name, or the region is empty or everything.
    """
    if not name:
        return None
    of_parts = [(len(mesh_of(part).vertices), _vertices(part, name)) for part in parts_of(side)]
    if all(inside is None for _, inside in of_parts):
        raise ObjectError(
            f'"{side.name}" has no vertex group, boolean attribute, material or face set called "{name}", which is to '
            "be left out. Choose another one, or empty the field."
        )
    found = np.concatenate([np.zeros(count, bool) if inside is None else inside for count, inside in of_parts])
    if not found.any():
        raise ObjectError(
            f'No vertex of "{side.name}" is in "{name}", which is to be left out. Assign vertices to it, or empty the '
            "field."
        )
    if found.all():
        raise ObjectError(
            f'All of "{side.name}" is in "{name}", which is to be left out, so nothing remains to match. Choose a '
            "smaller region."
        )
    return found


def _vertices(obj: bpy.types.Object, name: str) -> NDArray[np.bool_] | None:
    """Find the vertices of a region of one object; None if it has none of that name."""
    mesh = mesh_of(obj)
    if name in obj.vertex_groups:
        column = read_weights(obj)[:, [obj.vertex_groups[name].index]]
        weights: NDArray[np.float64] = np.asarray(column.todense()).ravel()
        return weights >= _HALF
    attribute = mesh.attributes.get(name)
    if attribute is not None and attribute.data_type == "BOOLEAN" and attribute.domain in ("POINT", "FACE"):
        values = read_attribute(mesh, name).astype(bool)
        return values if attribute.domain == "POINT" else _of_faces(mesh, values)
    materials, slots = read_materials(obj)
    chosen = [number for number, material in enumerate(materials) if material is not None and material.name == name]
    if chosen:
        return _of_faces(mesh, np.isin(slots, chosen))
    sets = _face_sets(mesh)
    meant = [number for number in np.unique(sets).tolist() if f"{_FACE_SET}{number}" == name]
    if meant:
        return _of_faces(mesh, np.isin(sets, meant))
    return None


def _face_sets(mesh: bpy.types.Mesh) -> NDArray[np.int32]:
    """Read the number of each face's face set, (f,); empty if there are none."""
    attribute = mesh.attributes.get(_FACE_SETS)
    if attribute is None or (attribute.data_type, attribute.domain) != ("INT", "FACE"):
        return np.empty(0, np.int32)
    return read_attribute(mesh, _FACE_SETS)


def _of_faces(mesh: bpy.types.Mesh, faces: NDArray[np.bool_]) -> NDArray[np.bool_]:
    """Find the vertices that have faces, all of them among these (f,)."""
    count, vertices = len(mesh.vertices), corner_vertices(mesh)
    chosen = np.repeat(faces, face_corner_counts(mesh))
    inside = np.bincount(vertices[chosen], minlength=count)
    outside = np.bincount(vertices[~chosen], minlength=count)
    return (inside > 0) & (outside == 0)
