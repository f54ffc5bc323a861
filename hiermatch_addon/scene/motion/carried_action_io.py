# SPDX-License-Identifier: GPL-3.0-or-later
"""Actions that were made for rigs: from which action of another one, if any, and whether they were edited since."""

from __future__ import annotations

import hashlib
from contextlib import contextmanager
from typing import TYPE_CHECKING, Any, Final, cast

import bpy
import numpy as np

from ...common.long_names import LONGEST_ID, shortened
from ..plain_settings import written_settings
from .action_curves import MADE_FOR, every_curve, playing

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Sequence

_MODEL: Final = "hiermatch_carried"
"""Custom property of actions that were made from those of other rigs: the name of that action.

Of the pose in which a rig looks as the source does at rest it is empty.
"""

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
    return bool(cast("Any", action).get(_MODEL))


def mark_carried(action: bpy.types.Action, model: bpy.types.Action | None) -> None:
    """Say that an action is now as it was made from another one, or, without one, as the rest pose."""
    mine: Any = action
    mine[_MODEL], mine[_NAMED], mine[_STATE] = _name(model), action.name, _state(action)


def carried_before(armature: bpy.types.Object, model: bpy.types.Action | None) -> bpy.types.Action | None:
    """Find the action that was made for an armature from another action, or as its rest pose, and nothing else uses.

    One that was renamed is the user's own.  A rig that was renamed since is marked with its former name, or still plays
    what was made for it.
    """
    played, former = playing(armature), cast("Any", armature).get(MADE_FOR)
    for action in bpy.data.actions:
        mine: Any = action
        owner = mine.get(MADE_FOR, "")
        was_own = owner not in bpy.data.objects and (owner == former or action.name in played)
        is_own = owner == armature.name or was_own
        found = is_own and mine.get(_MODEL) == _name(model)
        if found and mine.get(_NAMED) == action.name and action.library is None and not users_beside(action, armature):
            return action
    return None


def to_be_replaced(
    armature: bpy.types.Object, model: bpy.types.Action | None
) -> tuple[bpy.types.Action | None, list[str]]:
    """Find the action that was made before, as `carried_before`, unless it was edited: that one is put aside.

    Returns
    -------
    action : bpy.types.Action or None
        The one to make anew in its place.
    notes : list of str
        What is to be said.
    """
    before = carried_before(armature, model)
    if before is None or not was_edited(before):
        return before, []
    name = before.name
    return None, [f'"{name}" was edited since it had been made. The edited one is kept as "{put_aside(before)}".']


def users_beside(action: bpy.types.Action, armature: bpy.types.Object) -> list[str]:
    """Return the names of what uses an action beside an armature."""
    users = cast("Any", bpy.data).user_map(subset=[action])[action]
    return sorted(user.name for user in users if user != armature)


def was_edited(action: bpy.types.Action) -> bool:
    """Tell whether an action was edited since it was made."""
    return cast("Any", action)[_STATE] != _state(action)


@contextmanager
def still_as_made(actions: Iterable[bpy.types.Action]) -> Iterator[None]:
    """Do not take for an edit what is done meanwhile to actions, such as naming the bones that they move anew."""
    unedited = [action for action in actions if _STATE in cast("Any", action) and not was_edited(action)]
    yield
    for action in unedited:
        cast("Any", action)[_STATE] = _state(action)


def put_aside(action: bpy.types.Action) -> str:
    """Keep an action that another one replaces under another name, with all that plays it; return that."""
    mine: Any = action
    for mark in (_NAMED, _STATE):
        del mine[mark]
    action.name = shortened(action.name, LONGEST_ID, " (edited)")
    return action.name


def _name(model: bpy.types.Action | None) -> str:
    """Return what an action says that it was made from."""
    return "" if model is None else model.name


def _state(action: bpy.types.Action) -> str:
    """Describe all keys, curves and settings of an action; one slot on one strip is what Blender 4.4 makes of none."""
    digest = hashlib.blake2b(digest_size=16)
    layers: Sequence[Any] = getattr(action, "layers", ())
    parts = [len(layer.strips) for layer in layers], len(getattr(action, "slots", ()))
    settings = [getattr(action, name) for name in _RANGE if action.use_frame_range or name == "use_frame_range"]
    markers = [(marker.name, marker.frame) for marker in action.pose_markers]
    digest.update(f"{parts if parts != ([1], 1) else ([], 0)} {settings} {markers}\0".encode())
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
