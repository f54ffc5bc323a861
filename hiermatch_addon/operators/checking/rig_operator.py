# SPDX-License-Identifier: GPL-3.0-or-later
"""Common base of the operators that look at the result of a retarget: the target that is meant."""

from __future__ import annotations

from typing import TYPE_CHECKING

import bpy

from ...common.access import view_layer_of
from ...common.errors import ObjectError
from ...properties.panel_state import picked, state_of
from ...scene.armatures import find_armature
from ...scene.character import side_of, successor
from ...scene.pair import active_side, named_side
from ...transfers.retarget_properties import reported_target

if TYPE_CHECKING:
    from ...scene.character import Side


def meant_target(context: bpy.types.Context, name: str) -> Side:
    """Find what is meant: by name, else picked as the Target, else of the last retarget, else active.

    Raises
    ------
    ObjectError
        If there is none, or it holds no meshes.
    """
    layer = view_layer_of(context)
    chosen = picked(state_of(context))[1]
    if name:
        return named_side(layer, name)
    if chosen is not None:
        return side_of(chosen, layer)
    side = reported_target(context) or active_side(context)
    if side is None:
        raise ObjectError("It is open which character is meant. Pick it as the Target, or make it the active object.")
    return side


def meant_armature(context: bpy.types.Context, name: str) -> bpy.types.Object:
    """Find the armature that is meant: the object itself, or what moves it.

    Raises
    ------
    ObjectError
        If there is none, or it is linked from another file.
    """
    named = bpy.data.objects.get(name)
    if named is not None and named.type == "ARMATURE":
        armature: bpy.types.Object | None = successor(named)
    else:
        side = meant_target(context, name)
        armature = find_armature(side)
        name = side.name
    if armature is None:
        raise ObjectError(f'"{name}" has no armature that could bend it. Retarget it with Rig on first.')
    if armature.library is not None:
        raise ObjectError(f'"{armature.name}" is linked from another file and cannot be posed. Make it local first.')
    return armature
