# SPDX-License-Identifier: GPL-3.0-or-later
"""A mesh as it looked before it got a rig, shape keys and clothes, for a while."""

from __future__ import annotations

import json
from typing import TYPE_CHECKING, Any, Final, cast

from ...common.access import mesh_of
from ..armatures import moving_armatures
from ..binding import is_made
from ..character import parts_of
from ..rest_action import kept_pose
from ..worn.fitted_copies import COVERED, ITEM, fitted_to
from .pose_state import bring_back, is_aside, put_aside

if TYPE_CHECKING:
    import bpy

    from ..character import Side

_STATE: Final = "hiermatch_before"
"""Custom property of the object: what is hidden of it, as a JSON text."""

_WHY: Final = "before and after"


def is_before(side: Side) -> bool:
    """Tell whether a part of a side is shown as it was before."""
    return any(_STATE in cast("Any", part) for part in parts_of(side))


def show_before(side: Side, source: Side | None) -> bool:
    """Show a side without the rig that was made for it, the shape keys that the source has as well, and fitted clothes.

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
    clothes = [one for one in _clothes(side) if not one.hide_viewport]
    for copy in clothes:
        copy.hide_viewport = True
        cast("Any", copy)[_STATE] = "{}"
    covered = {COVERED} if clothes else set()
    hidden = [_hide(part, carried, posed, covered) for part in parts_of(side)]  # all of them, not the first only
    return any(hidden)


def _hide(obj: bpy.types.Object, carried: set[str], posed: list[bpy.types.Object], covered: set[str]) -> bool:
    """Hide what one part has got, and what covers it below clothes; return whether there was anything."""
    modifiers = [
        one
        for one in obj.modifiers
        if one.show_viewport and (_is_made_rig(one, posed) or (one.type == "MASK" and one.name in covered))
    ]
    keys = [key for key in _keys(obj) if not key.mute and key.name in carried | covered]
    if not (modifiers or keys or covered or any(armature in posed for armature in moving_armatures(obj))):
        return False
    for modifier in modifiers:
        modifier.show_viewport = False
    for key in keys:
        key.mute = True
    state = {"modifiers": [modifier.name for modifier in modifiers], "keys": [key.name for key in keys]}
    cast("Any", obj)[_STATE] = json.dumps(state)
    return True


def _is_made_rig(modifier: bpy.types.Modifier, posed: list[bpy.types.Object]) -> bool:
    """Tell whether a modifier is the rig that was made, and which is not shown in the pose that it was in instead."""
    rig = cast("Any", modifier).object if modifier.type == "ARMATURE" else None
    return rig is not None and is_made(rig) and rig not in posed


def _clothes(side: Side) -> list[bpy.types.Object]:
    """Return what was fitted to a side, but for copies that were kept aside, and those of other files."""
    return [obj for obj in fitted_to(side) if ITEM in cast("Any", obj) and obj.library is None]


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
    for copy in (one for one in _clothes(side) if _STATE in cast("Any", one)):
        copy.hide_viewport = False
        del cast("Any", copy)[_STATE]
    for armature in (one for one in moving_armatures(side) if is_aside(one, _WHY)):
        bring_back(armature)


def _keys(obj: bpy.types.Object) -> list[bpy.types.ShapeKey]:
    """Return the shape keys of a mesh object but for the one that the others are relative to."""
    found = mesh_of(obj).shape_keys if obj.type == "MESH" else None
    return [] if found is None else [key for key in found.key_blocks if key != found.reference_key]
