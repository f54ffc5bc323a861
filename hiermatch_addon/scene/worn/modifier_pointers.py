# SPDX-License-Identifier: GPL-3.0-or-later
"""Objects that modifiers of a fitted copy point to, such as the body, and how far these modifiers reach."""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING, Any

import bpy

from ..armatures import moving_armatures
from ..character import parts_of

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

    from mathutils import Matrix

    from ..character import Side

_SIZES = {"SOLIDIFY": ("thickness",), "BEVEL": ("width",), "DISPLACE": ("strength",)}
"""For each type of modifier the members that are lengths."""


def point_to(
    copy: bpy.types.Object, item: bpy.types.Object, places: Mapping[bpy.types.ID, bpy.types.ID], growth: float
) -> None:
    """Let modifiers of an item's copy point to what belongs to the other body, and sizes grow.

    A hook does to the copy what it does to the item, wherever both stand.
    """
    for modifier, own in zip(copy.modifiers, item.modifiers, strict=True):
        changed: Any = modifier
        for put, value in _pointed_to(modifier):
            if value in places:
                put(places[value])
        for member in _SIZES.get(modifier.type, ()):
            setattr(changed, member, growth * getattr(changed, member))
        hook: Any = own
        if modifier.type == "HOOK" and hook.object is not None:
            moved = item.matrix_world.inverted_safe() @ _hook_place(own) @ hook.matrix_inverse
            changed.matrix_inverse = _hook_place(modifier).inverted_safe() @ copy.matrix_world @ moved


def used_beside(copy: bpy.types.Object, body: Side) -> list[tuple[Callable[[Any], None], bpy.types.Object]]:
    """Return what modifiers of a copy use that is not the body's, each with what lets them use something else.

    Hooks do not count: they do the same wherever they stand.
    """
    own = {copy, *parts_of(body), *(rig for part in parts_of(body) for rig in moving_armatures(part))}
    found = [one for modifier in copy.modifiers if modifier.type != "HOOK" for one in _pointed_to(modifier)]
    return [(put, value) for put, value in found if isinstance(value, bpy.types.Object) and value not in own]


def node_inputs(modifier: bpy.types.Modifier) -> dict[str, tuple[Callable[[Any], None], Any]]:
    """Return what geometry nodes are given, by the identifiers of their inputs, each with what changes it."""
    holder: Any = modifier
    if modifier.type != "NODES" or holder.node_group is None:
        return {}
    items = [one for one in holder.node_group.interface.items_tree if one.item_type == "SOCKET"]
    names = [one.identifier for one in items if one.in_out == "INPUT"]
    if hasattr(holder, "properties"):  # from Blender 5.2 on
        sockets: dict[str, Any] = {name: getattr(holder.properties.inputs, name, None) for name in names}
        return {
            name: (partial(setattr, one, "value"), one.value) for name, one in sockets.items() if hasattr(one, "value")
        }
    return {name: (partial(holder.__setitem__, name), holder[name]) for name in names if name in holder}


def _hook_place(modifier: bpy.types.Modifier) -> Matrix:
    """Return where the object of a hook stands, or its bone."""
    hook: Any = modifier
    bone = hook.object.pose.bones.get(hook.subtarget) if hook.object.pose is not None else None
    place: Matrix = hook.object.matrix_world if bone is None else hook.object.matrix_world @ bone.matrix
    return place


def _pointed_to(modifier: bpy.types.Modifier) -> list[tuple[Callable[[Any], None], bpy.types.ID]]:
    """Return what a modifier points to, each with what lets it point to something else."""
    holder: Any = modifier
    names = [prop.identifier for prop in holder.bl_rna.properties if prop.type == "POINTER" and not prop.is_readonly]
    found: list[tuple[Callable[[Any], None], Any]] = [*node_inputs(modifier).values()]
    found += [(partial(setattr, holder, name), getattr(holder, name)) for name in names]
    return [(put, value) for put, value in found if isinstance(value, bpy.types.ID)]
