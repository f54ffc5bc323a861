# SPDX-License-Identifier: GPL-3.0-or-later
"""A mesh as it looked before it got a rig and shape keys, for a while."""

from __future__ import annotations

import json
from typing import TYPE_CHECKING, Any, Final, cast

from ...common.access import mesh_of
from ..armatures import moving_armatures
from ..binding import is_made
from ..character import parts_of
from ..rest_action import kept_pose
from .pose_state import bring_back, is_aside, put_aside

if TYPE_CHECKING:
    import bpy

    from ..character import Side

__all__ = ["is_before", "show_after", "show_before"]

_STATE: Final = "hiermatch_before"
"""Custom property of the object: what is hidden of it, as a JSON text."""

_WHY: Final = "before and after"


def is_before(side: Side) -> bool:
    """Tell whether a part of a side is shown as it was before."""
    return any(_STATE in cast("Any", part) for part in parts_of(side))


def show_before(side: Side, source: Side | None) -> bool:
    """Show a side without the rig that was made for it, and without the shape keys that the source has as well.

    Returns
    -------
    bool
        Whether there was anything to hide.
    """
    carried = set() if source is None else {key.name for part in parts_of(source) for key in _keys(part)}
    posed = [armature for armature in moving_armatures(side) if is_made(armature) and kept_pose(armature)]
    for armature in posed:  # without the rig they would be seen at rest, which is not how they stood
        put_aside(armature, _WHY)
        cast("Any", armature.animation_data).action = kept_pose(armature)
    hidden = [_hide(part, carried, posed) for part in parts_of(side)]  # all of them, not the first only
    return any(hidden)


def _hide(obj: bpy.types.Object, carried: set[str], posed: list[bpy.types.Object]) -> bool:
    """Hide what one part has got; return whether there was anything."""
    modifiers = [
        one
        for one in obj.modifiers
        if one.type == "ARMATURE" and one.show_viewport and (rig := cast("Any", one).object) is not None
        if is_made(rig) and rig not in posed
    ]
    keys = [key for key in _keys(obj) if not key.mute and key.name in carried]
    if not (modifiers or keys or any(armature in posed for armature in moving_armatures(obj))):
        return False
    for modifier in modifiers:
        modifier.show_viewport = False
    for key in keys:
        key.mute = True
    state = {"modifiers": [modifier.name for modifier in modifiers], "keys": [key.name for key in keys]}
    cast("Any", obj)[_STATE] = json.dumps(state)
    return True


def show_after(side: Side) -> None:
    """Undo `show_before`; what is gone since is passed over."""
    for obj in parts_of(side):
        owner: Any = obj
        state = json.loads(owner.get(_STATE, "{}"))
        for name in state.get("modifiers", ()):
            if name in obj.modifiers:
                obj.modifiers[name].show_viewport = True
        for key in (key for key in _keys(obj) if key.name in state.get("keys", ())):
            key.mute = False
        if state:
            del owner[_STATE]
    for armature in (one for one in moving_armatures(side) if is_aside(one, _WHY)):
        bring_back(armature)


def _keys(obj: bpy.types.Object) -> list[bpy.types.ShapeKey]:
    """Return the shape keys of a mesh object but for the one that the others are relative to."""
    found = mesh_of(obj).shape_keys if obj.type == "MESH" else None
    return [] if found is None else [key for key in found.key_blocks if key != found.reference_key]
