# SPDX-License-Identifier: GPL-3.0-or-later
"""Which two objects to match, and whether they can be matched."""

from __future__ import annotations

from typing import TYPE_CHECKING

import bpy
import numpy as np

from ..common.access import mesh_of, view_layer_of
from ..common.errors import ObjectError
from ..common.phrases import listed

if TYPE_CHECKING:
    from collections.abc import Sequence

__all__ = [
    "check_object",
    "check_pair",
    "check_writable",
    "find_pair",
    "left_out_note",
    "named_object",
    "selected_meshes",
    "selected_targets",
]


def find_pair(
    context: bpy.types.Context,
    names: tuple[str, str] = ("", ""),
    picked: tuple[bpy.types.Object | None, bpy.types.Object | None] = (None, None),
) -> tuple[bpy.types.Object, bpy.types.Object]:
    """Find source and target: by name, else as picked, else as selected (the active object is the source).

    What is only selected is no target if the source's rig moves it.

    Raises
    ------
    ObjectError
        If a name is unknown, or the selection leaves open which two are meant.
    """
    source, target = (named_object(name) if name else pick for name, pick in zip(names, picked, strict=True))
    active = view_layer_of(context).objects.active
    if source is None and active is not None and active.select_get() and active != target:
        source = active
    if source is None:
        source = _only(selected_meshes(context, without=target), "Source")
    if target is None:
        target = _only(selected_targets(context, source)[0], "Target")
    return source, target


def named_object(name: str) -> bpy.types.Object:
    """Return the object of that name.

    Raises
    ------
    ObjectError
        If there is none.
    """
    obj = bpy.data.objects.get(name)
    if obj is None:
        raise ObjectError(f'There is no object called "{name}".')
    return obj


def selected_meshes(context: bpy.types.Context, without: bpy.types.Object | None = None) -> list[bpy.types.Object]:
    """Return the selected mesh objects except for one."""
    return [obj for obj in view_layer_of(context).objects.selected if obj.type == "MESH" and obj != without]


def selected_targets(
    context: bpy.types.Context, source: bpy.types.Object
) -> tuple[list[bpy.types.Object], list[bpy.types.Object]]:
    """Return the selected meshes that may be targets, and those that are parts of the source's own character.

    The latter hang on the armature that moves the source, as clothes, hair and eyes do.

    Raises
    ------
    ObjectError
        If there are parts only.
    """
    targets: list[bpy.types.Object] = []
    parts: list[bpy.types.Object] = []
    rig = _armatures(source)
    for obj in selected_meshes(context, without=source):
        (targets if rig.isdisjoint(_armatures(obj)) else parts).append(obj)
    if parts and not targets:
        raise ObjectError(
            f'All that is selected beside "{source.name}" is moved by the same rig: {_names(parts)}. Select a mesh of '
            "another character, or pick the part as the Target in the panel if it is meant."
        )
    return targets, parts


def left_out_note(source: bpy.types.Object, parts: Sequence[bpy.types.Object]) -> str:
    """Say that selected parts of the source's own character were left out."""
    return f'What the rig of "{source.name}" moves as well was left alone: {_names(parts)}.'


def _names(objects: Sequence[bpy.types.Object]) -> str:
    return listed(sorted(obj.name for obj in objects))


def _armatures(obj: bpy.types.Object) -> set[bpy.types.Object]:
    """Return the armatures that move an object, by modifiers or as what it hangs on, and those that move the latter."""
    found: set[bpy.types.Object] = set()
    link: bpy.types.Object | None = obj
    while link is not None:
        armatures = [getattr(modifier, "object", None) for modifier in link.modifiers if modifier.type == "ARMATURE"]
        found.update(armature for armature in (link, *armatures) if armature and armature.type == "ARMATURE")
        link = link.parent
    return found


def _only(candidates: Sequence[bpy.types.Object], role: str) -> bpy.types.Object:
    """Return the only candidate for a role."""
    if len(candidates) != 1:
        found = "no other mesh is selected" if not candidates else f"{len(candidates)} other meshes are selected"
        raise ObjectError(
            f"It is open which mesh is the {role}: {found}. "
            "Select exactly two meshes (the active one is the Source), or pick Source and Target in the panel."
        )
    return candidates[0]


def check_pair(view_layer: bpy.types.ViewLayer, source: bpy.types.Object, target: bpy.types.Object) -> None:
    """Make sure that two objects can be matched and written to.

    Raises
    ------
    ObjectError
        If one of them, or both together, cannot; the message says why and what to do.
    """
    if source == target:
        raise ObjectError(f'Source and Target are both "{source.name}". Choose two different objects.')
    for obj in (source, target):
        check_object(view_layer, obj)
    if source.data == target.data:
        raise ObjectError(
            f'"{source.name}" and "{target.name}" share the same mesh data. Give one of them its own first '
            "(Object > Relations > Make Single User > Object & Data)."
        )


def check_object(view_layer: bpy.types.ViewLayer, obj: bpy.types.Object) -> None:
    """Make sure that an object can be read and written to.

    Raises
    ------
    ObjectError
        If it cannot.
    """
    if obj.type != "MESH":
        raise ObjectError(
            f'"{obj.name}" is not a mesh but of type {obj.type.title()}. Choose a mesh object, or convert it '
            "(Object > Convert > Mesh)."
        )
    check_writable(obj)
    if view_layer.objects.get(obj.name) != obj:
        raise ObjectError(
            f'"{obj.name}" is not in the view layer "{view_layer.name}". Link it to the scene, or enable its '
            "collection in the Outliner."
        )
    if not obj.visible_get(view_layer=view_layer):
        raise ObjectError(f'"{obj.name}" is hidden. Show it first (Object > Show/Hide, or the eye in the Outliner).')
    if obj.mode != "OBJECT":
        raise ObjectError(f'"{obj.name}" is in {_title(obj.mode)} Mode. Switch to Object Mode first.')
    if not len(mesh_of(obj).polygons):
        raise ObjectError(f'"{obj.name}" has no faces. A surface is needed, not only vertices or edges.')
    scale = np.linalg.norm(np.array(obj.matrix_world)[:3, :3], axis=0)
    flat = [axis for axis, length in zip("XYZ", scale, strict=True) if not length > 0]
    if flat:
        raise ObjectError(f'"{obj.name}" has a scale of zero on {" and ".join(flat)}. Set its scale to 1 (Alt+S).')


def check_writable(obj: bpy.types.Object) -> None:
    """Make sure that a mesh object is this file's own.

    Raises
    ------
    ObjectError
        If it or its mesh is linked from another file.
    """
    mesh = mesh_of(obj)
    library = obj.library or mesh.library
    if library is not None:
        raise ObjectError(
            f'"{obj.name}" is linked from "{library.name}" and cannot be written to. Make object and data local '
            "first (Object > Relations > Make Local)."
        )
    if obj.override_library is not None or mesh.override_library is not None:
        raise ObjectError(
            f'"{obj.name}" is a library override and cannot be written to. Make object and data local first '
            "(Object > Relations > Make Local)."
        )


def _title(mode: str) -> str:
    return mode.replace("_", " ").title()
