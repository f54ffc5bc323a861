# SPDX-License-Identifier: GPL-3.0-or-later
"""Bindings of modifiers, such as Surface Deform: what they have learnt of a mesh holds for no other one."""

from __future__ import annotations

from contextlib import contextmanager
from typing import TYPE_CHECKING, Any, cast

import bpy

from ..common.access import view_layer_of
from .armatures import armature_of, find_armature
from .character import parts_of

if TYPE_CHECKING:
    from collections.abc import Iterator

    from .character import Side

_BINDING = {
    "SURFACE_DEFORM": ("is_bound", "surfacedeform_bind"),
    "CORRECTIVE_SMOOTH": ("is_bind", "correctivesmooth_bind"),
}
"""For each type of modifier the member that says whether it is bound, and the operator that binds it, or takes that
back.  Laplacian Deform is none of them, as Blender 5.0.1 crashes when a script unbinds one."""


def bind_again(context: bpy.types.Context, obj: bpy.types.Object, body: Side) -> list[str]:
    """Bind modifiers of an object again that were bound to another mesh, to a body as it rests.

    Parameters
    ----------
    context : bpy.types.Context
        Where they are.
    obj : bpy.types.Object
        The object; its modifiers point to the body already.
    body : bpy.types.Object or Character
        The body.

    Returns
    -------
    list of str
        Names of the modifiers that could not be bound.
    """
    bound = [one for one in obj.modifiers if one.type in _BINDING and getattr(one, _BINDING[one.type][0])]
    if not bound:
        return []
    with _at_rest(context, body), context.temp_override(object=obj, active_object=obj):
        for modifier in bound:
            member, operator = _BINDING[modifier.type]
            for _ in range(2):  # the first time it is unbound
                getattr(bpy.ops.object, operator)(modifier=modifier.name)
                if getattr(modifier, member):
                    break
    return [modifier.name for modifier in bound if not getattr(modifier, _BINDING[modifier.type][0])]


@contextmanager
def _at_rest(context: bpy.types.Context, body: Side) -> Iterator[None]:
    """Show a body without pose and shape keys, and put both back."""
    armature = find_armature(body)
    rigs: list[Any] = [] if armature is None else [armature_of(armature)]
    parts: list[Any] = [part for part in parts_of(body) if cast("Any", part.data).shape_keys is not None]
    stood = [rig.pose_position for rig in rigs]
    shown = [(part.show_only_shape_key, part.active_shape_key_index) for part in parts]
    try:
        for rig in rigs:
            rig.pose_position = "REST"
        for part in parts:
            part.show_only_shape_key, part.active_shape_key_index = True, 0
        view_layer_of(context).update()
        yield
    finally:
        for rig, position in zip(rigs, stood, strict=True):
            rig.pose_position = position
        for part, (only, index) in zip(parts, shown, strict=True):
            part.show_only_shape_key, part.active_shape_key_index = only, index
        view_layer_of(context).update()
