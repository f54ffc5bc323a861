# SPDX-License-Identifier: GPL-3.0-or-later
"""Keys for a pose that was set while Blender's Auto Keying is on, as Blender's own operators set them."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, cast

import bpy

from ..armatures import pose_of
from .action_curves import every_curve, played_action, rotation_channel

if TYPE_CHECKING:
    from collections.abc import Iterable


def key_automatically(
    scene: bpy.types.Scene,
    armature: bpy.types.Object,
    bones: Iterable[str],
    placed: Iterable[str],
    switches: Iterable[tuple[str, str]] = (),
) -> bool:
    """Set keys for bones at the frame of the moment if Auto Keying is on, as its settings and the preferences say.

    Parameters
    ----------
    scene : bpy.types.Scene
        Whose settings count.
    armature : bpy.types.Object
        Whose bones.
    bones : iterable of str
        Those that were turned.
    placed : iterable of str
        Those that were moved.
    switches : iterable of tuple of str
        Bones with names of their properties that were set; as in Blender, only those get keys that have some.

    Returns
    -------
    bool
        False if there should be keys, and the action that is played cannot have any as it is another file's.
    """
    tools: Any = scene.tool_settings
    if not tools.use_keyframe_insert_auto:
        return True
    action = played_action(armature)
    if action is not None and not action.is_editable:
        return False
    pose, options = pose_of(armature).bones, _options(tools)
    keying_set = scene.keying_sets_all.active if tools.use_keyframe_insert_keyingset else None
    wanted = [(name, rotation_channel(pose[name].rotation_mode)) for name in bones]
    wanted += [(name, "location") for name in placed]
    keyed = set() if action is None else {curve.data_path for curve in every_curve(action)}
    properties = [(bone, f'["{bpy.utils.escape_identifier(name)}"]') for bone, name in switches]
    wanted += [(bone, channel) for bone, channel in properties if _path(bone, channel) in keyed]
    if keying_set is not None and keying_set.bl_idname == "Available":
        options.add("INSERTKEY_AVAILABLE")
    if action is None and options & {"INSERTKEY_AVAILABLE", "INSERTKEY_REPLACE"}:
        return True  # there is nothing to which they could be added
    for name, channel in wanted:
        if keying_set is None or _holds(keying_set, armature, name, channel):
            pose[name].keyframe_insert(channel, group=name, options=cast("Any", options), keytype=tools.keyframe_type)
    return True


def _options(tools: Any) -> set[str]:  # noqa: ANN401 - settings that some versions lack
    """Return how keys are inserted."""
    preferences: Any = bpy.context.preferences
    said = {
        "INSERTKEY_REPLACE": tools.auto_keying_mode == "REPLACE_KEYS",
        "INSERTKEY_CYCLE_AWARE": tools.use_keyframe_cycle_aware,
        "INSERTKEY_AVAILABLE": preferences.edit.use_keyframe_insert_available,
        "INSERTKEY_NEEDED": preferences.edit.use_auto_keyframe_insert_needed,
    }
    return {option for option, wanted in said.items() if wanted}


def _holds(keying_set: Any, armature: bpy.types.Object, bone: str, channel: str) -> bool:  # noqa: ANN401 - as above
    """Tell whether a keying set, one of Blender's own or the user's, holds a channel of a bone."""
    if keying_set.is_path_absolute:
        return any(path.id == armature and path.data_path == _path(bone, channel) for path in keying_set.paths)
    name = keying_set.bl_idname.rpartition("_")[2]
    everything = name in {"Available", "WholeCharacter", "WholeCharacterSelected"}
    kind = "Loc" if channel == "location" else "Rot"
    return everything or (channel[0] != "[" and "Delta" not in name and kind in name)


def _path(bone: str, channel: str) -> str:
    """Return the path of a channel of a bone, or of a property of it, which is in brackets."""
    return f'pose.bones["{bpy.utils.escape_identifier(bone)}"]' + (channel if channel[0] == "[" else f".{channel}")
