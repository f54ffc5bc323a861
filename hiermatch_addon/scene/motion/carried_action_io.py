# SPDX-License-Identifier: GPL-3.0-or-later
"""Actions that were carried over: from which action, for which rig, and whether they were edited since."""

from __future__ import annotations

import hashlib
from typing import TYPE_CHECKING, Any, Final, cast

import bpy
import numpy as np

from ...common.long_names import LONGEST_ID, shortened
from ..plain_settings import written_settings
from .action_curves import MADE_FOR, every_curve, playing

if TYPE_CHECKING:
    from collections.abc import Sequence

__all__ = ["carried_before", "mark_carried", "put_aside", "users_beside", "was_carried", "was_edited"]

_MODEL: Final = "hiermatch_carried"
"""Custom property of actions that were made from those of other rigs: the name of that action."""

_NAMED: Final = "hiermatch_carried_name"
"""Custom property of such an action: what it was called when it was made; under another name it is the user's own."""

_STATE: Final = "hiermatch_as_carried"
"""Custom property of such an action: a text that is another one once it was edited."""

_RANGE: Final = ("use_frame_range", "frame_start", "frame_end", "use_cyclic")
"""Settings of an action that are taken over from its model."""

_ENUMS: Final = ("interpolation", "easing", "handle_left_type", "handle_right_type")
"""What each key says of how its curve goes on, beside places."""


def was_carried(action: bpy.types.Action) -> bool:
    """Tell whether an action was made from that of another rig."""
    return _MODEL in cast("Any", action)


def mark_carried(action: bpy.types.Action, model: bpy.types.Action) -> None:
    """Say that an action is now as it was made from another one."""
    mine: Any = action
    mine[_MODEL], mine[_NAMED], mine[_STATE] = model.name, action.name, _state(action)


def carried_before(armature: bpy.types.Object, model: bpy.types.Action) -> bpy.types.Action | None:
    """Find the action that was made for an armature from another action, and that nothing else uses.

    One that was renamed is the user's own.  A rig that was renamed since still plays what was made for it.
    """
    played = playing(armature)
    for action in bpy.data.actions:
        mine: Any = action
        owner = mine.get(MADE_FOR, "")
        is_own = owner == armature.name or (owner not in bpy.data.objects and action.name in played)
        found = is_own and mine.get(_MODEL) == model.name
        if found and mine.get(_NAMED) == action.name and action.library is None and not users_beside(action, armature):
            return action
    return None


def users_beside(action: bpy.types.Action, armature: bpy.types.Object) -> list[str]:
    """Return the names of what uses an action beside an armature."""
    users = cast("Any", bpy.data).user_map(subset=[action])[action]
    return sorted(user.name for user in users if user != armature)


def was_edited(action: bpy.types.Action) -> bool:
    """Tell whether an action was edited since it was carried over."""
    return cast("Any", action)[_STATE] != _state(action)


def put_aside(action: bpy.types.Action) -> str:
    """Keep an action that another one replaces under another name, with all that plays it; return that."""
    mine: Any = action
    for mark in (_NAMED, _STATE):
        del mine[mark]
    action.name = shortened(action.name, LONGEST_ID, " (edited)")
    return action.name


def _state(action: bpy.types.Action) -> str:
    """Describe all keys, curves and settings of an action."""
    digest = hashlib.blake2b(digest_size=16)
    layers: Sequence[Any] = getattr(action, "layers", ())
    strips = [len(layer.strips) for layer in layers]
    slots: Sequence[Any] = getattr(action, "slots", ())
    settings = [getattr(action, name) for name in _RANGE if action.use_frame_range or name == "use_frame_range"]
    markers = [(marker.name, marker.frame) for marker in action.pose_markers]
    digest.update(f"{strips} {len(slots)} {settings} {markers}\0".encode())
    for curve in every_curve(action):
        said = curve.data_path, curve.array_index, curve.mute, curve.extrapolation, len(curve.keyframe_points)
        digest.update(f"{said}\0".encode())
        digest.update(_keys(curve))
        for modifier in curve.modifiers:
            digest.update(f"{modifier.type} {modifier.mute} {written_settings(modifier)}\0".encode())
    return digest.hexdigest()


def _keys(curve: Any) -> bytes:  # noqa: ANN401 - Blender's types differ
    """Describe the keys of a curve."""
    points = curve.keyframe_points
    found = []
    for name in ("co", "handle_left", "handle_right"):
        places = np.empty(2 * len(points), np.float32)
        points.foreach_get(name, places)
        found.append(places.tobytes())
    for name in _ENUMS:
        kinds = np.empty(len(points), np.int32)
        points.foreach_get(name, kinds)
        found.append(kinds.tobytes())
    return b"".join(found)
