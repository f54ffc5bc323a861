# SPDX-License-Identifier: GPL-3.0-or-later
"""Objects that modifiers of a fitted copy point to, such as the body, and how far these modifiers reach."""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING, Any

import bpy

from ..armatures import moving_armatures
from ..character import parts_of
from .fitted_copies import made_copy

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

    from mathutils import Matrix

    from ..character import Side

__all__ = ["left_behind", "point_to"]

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


def left_behind(copy: bpy.types.Object, body: Side) -> list[str]:
    """Let modifiers of a copy point to copies of other items; return the names of what else is not the body's.

    Hooks do not count: they do the same wherever they stand.
    """
    own = {copy, *parts_of(body), *(rig for part in parts_of(body) for rig in moving_armatures(part))}
    kept = []
    for modifier in copy.modifiers:
        for put, value in _pointed_to(modifier) if modifier.type != "HOOK" else ():
            if not isinstance(value, bpy.types.Object) or value in own:
                continue
            other = made_copy(value, body)
            if other is not None:
                put(other)
            else:
                kept.append(value.name)
    return list(dict.fromkeys(kept))


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
    found = [(partial(setattr, holder, name), getattr(holder, name)) for name in names]
    if modifier.type == "NODES":
        if hasattr(holder, "properties"):  # from Blender 5.2 on
            inputs = holder.properties.inputs
            sockets = [getattr(inputs, prop.identifier) for prop in inputs.bl_rna.properties if prop.type == "POINTER"]
            found += [(partial(setattr, one, "value"), getattr(one, "value", None)) for one in sockets]
        else:
            found += [(partial(holder.__setitem__, name), value) for name, value in holder.items()]
    return [(put, value) for put, value in found if isinstance(value, bpy.types.ID)]
