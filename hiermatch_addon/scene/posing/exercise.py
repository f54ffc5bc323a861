# SPDX-License-Identifier: GPL-3.0-or-later
"""An action that bends the joints of a rig one after another, to see how a mesh follows."""

from __future__ import annotations

import json
import math
from typing import TYPE_CHECKING, Any, Final, cast
from uuid import uuid4

import bpy
from mathutils import Matrix

from ..armatures import armature_of, bone_of, moving_armatures, pose_of
from ..deform_layer import read_weights
from ..motion.action_curves import rotation_channel
from .pose_state import bring_back, is_aside, put_aside

if TYPE_CHECKING:
    from collections.abc import Iterable

_WHY: Final = "test poses"

_STATE: Final = "hiermatch_test_poses"
"""Custom property, a JSON text: of an armature a number, which its copies have, and its markers, of a scene its frames
before, of both what joins them."""

_ACTION: Final = "hiermatch_test_action"
"""Custom property of the armature: the action, as a pointer that follows renaming."""

_ANGLE: Final = math.radians(45.0)
"""By how much each joint is bent: enough to see a bad weight, and within what most joints can do."""

_BEAT: Final = 5
"""Frames from one pose to the next."""


def bending_bones(armature: bpy.types.Object) -> list[str]:
    """Return the deforming bones of an armature that move a mesh in the file, parents before their children."""
    groups = {
        name
        for obj in bpy.data.objects
        if obj.type == "MESH" and armature in (*moving_armatures(obj), obj.parent)
        for name in (*_weighted_groups(obj), bone_of(obj))
    }
    found: list[str] = []
    waiting = [bone for bone in armature_of(armature).bones if bone.parent is None][::-1]
    while waiting:
        bone = waiting.pop()
        if bone.use_deform and bone.name in groups:
            found.append(bone.name)
        waiting += sorted(bone.children, key=lambda child: child.name, reverse=True)
    return found


def _weighted_groups(obj: bpy.types.Object) -> list[str]:
    """Return the names of the vertex groups in which a vertex has weight: importers make them for all bones."""
    if not obj.vertex_groups:
        return []
    weights = read_weights(obj)
    return [group.name for group in obj.vertex_groups if weights[:, [group.index]].count_nonzero()]


def is_exercising(armature: bpy.types.Object) -> bool:
    """Tell whether an armature plays its test poses."""
    return is_aside(armature, _WHY)


def begin_exercise(scene: bpy.types.Scene, armature: bpy.types.Object, bones: Iterable[str]) -> int:
    """Let bones be bent in turn, forth about their local x axis and then about z, with a marker for each.

    Returns
    -------
    int
        The last frame.
    """
    put_aside(armature, _WHY)
    action: Any = bpy.data.actions.new(f"{armature.name} Test Poses")
    cast("Any", armature.animation_data).action = action
    pose = pose_of(armature)
    turns = (None, Matrix.Rotation(_ANGLE, 4, "X"), Matrix.Rotation(_ANGLE, 4, "Z"), None)
    frame, markers = 1, []
    for name in bones:
        bone = pose.bones[name]
        channel = rotation_channel(bone.rotation_mode)
        for number, turn in enumerate(turns):
            bone.matrix_basis = turn or Matrix()
            bone.keyframe_insert(channel, frame=frame + number * _BEAT, group=name)
        marker = scene.timeline_markers.new(name, frame=frame + _BEAT)
        markers.append((marker.name, marker.frame))
        frame += (len(turns) - 1) * _BEAT
    owner: Any = armature
    owner[_STATE] = json.dumps({"rig": uuid4().hex, "scene": _lend(scene, frame), "markers": markers})
    owner[_ACTION] = action
    scene.frame_set(1)
    return frame


def end_exercise(armature: bpy.types.Object) -> None:
    """Take the test poses away, and bring back what was before, in whatever scene they were begun.

    So it is with copies of the armature that were made meanwhile.
    """
    bring_back(armature)
    state = _state_of(armature)
    if not state:
        return
    for copy in [obj for obj in bpy.data.objects if _state_of(obj) == state]:
        owner: Any = copy
        bring_back(copy)
        action = owner.get(_ACTION)
        if action is not None:
            bpy.data.actions.remove(action)
        for name in (_STATE, _ACTION):
            if name in owner:
                del owner[name]
    for scene in bpy.data.scenes:
        if _state_of(scene).get("scene") == state["scene"]:
            _give_back(scene, state["markers"])


def _lend(scene: bpy.types.Scene, last: int) -> str:
    """Let a scene play the frames up to the last one of a rig; return by what its state is known, kept on the scene.

    Markers cannot be marked as ours, nor can the rig point to the scene: who links the rig would link that as well.
    """
    state = _state_of(scene)
    if state:  # other rigs play there, too
        last = max(last, scene.frame_end)
    else:
        state = {
            "scene": uuid4().hex,
            "range": [scene.frame_start, scene.frame_end],
            "preview": scene.use_preview_range,
            "frame": scene.frame_current,
        }
        cast("Any", scene)[_STATE] = json.dumps(state)
    scene.frame_start, scene.frame_end, scene.use_preview_range = 1, last, False
    return state["scene"]


def _give_back(scene: bpy.types.Scene, markers: list[list[Any]]) -> None:
    """Take the markers of a rig away, and if it was the last one that plays there, bring back the scene's frames."""
    for ours in markers:
        same = [marker for marker in scene.timeline_markers if [marker.name, marker.frame] == ours]
        if same:
            scene.timeline_markers.remove(same[-1])  # the one before is the user's own, or another rig's
    state = _state_of(scene)
    if any(_state_of(obj).get("scene") == state["scene"] for obj in bpy.data.objects):
        return
    scene.frame_start, scene.frame_end = state["range"]
    scene.use_preview_range = state["preview"]
    scene.frame_set(state["frame"])
    del cast("Any", scene)[_STATE]


def _state_of(owner: bpy.types.Object | bpy.types.Scene) -> dict[str, Any]:
    """Return what is kept on a scene or an armature while test poses are there."""
    return json.loads(cast("Any", owner).get(_STATE, "{}"))
