# SPDX-License-Identifier: GPL-3.0-or-later
"""An action that bends the joints of a rig one after another, to see how a mesh follows."""

from __future__ import annotations

import json
import math
from typing import TYPE_CHECKING, Any, Final, cast

import bpy
from mathutils import Matrix

from ..armatures import armature_of, bone_of, moving_armatures
from ..deform_layer import read_weights
from .pose_state import bring_back, is_aside, put_aside

if TYPE_CHECKING:
    from collections.abc import Iterable

__all__ = ["begin_exercise", "bending_bones", "end_exercise", "is_exercising"]

_WHY: Final = "test poses"

_SCENE: Final = "hiermatch_test_poses"
"""Custom property of the armature: what was changed on the scene, as a JSON text."""

_ACTION: Final = "hiermatch_test_action"
"""Custom property of the armature: the action, as a pointer that follows renaming."""

_ANGLE: Final = math.radians(45.0)
"""By how much each joint is bent: enough to see a bad weight, and within what most joints can do."""

_BEAT: Final = 5
"""Frames from one pose to the next."""

_ROTATIONS: Final = {"QUATERNION": "rotation_quaternion", "AXIS_ANGLE": "rotation_axis_angle"}


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
    pose = cast("bpy.types.Pose", armature.pose)
    turns = (None, Matrix.Rotation(_ANGLE, 4, "X"), Matrix.Rotation(_ANGLE, 4, "Z"), None)
    frame, markers = 1, []
    for name in bones:
        bone = pose.bones[name]
        channel = _ROTATIONS.get(bone.rotation_mode, "rotation_euler")
        for number, turn in enumerate(turns):
            bone.matrix_basis = turn or Matrix()
            bone.keyframe_insert(channel, frame=frame + number * _BEAT, group=name)
        marker = scene.timeline_markers.new(name, frame=frame + _BEAT)
        markers.append(marker.name)
        frame += (len(turns) - 1) * _BEAT
    owner: Any = armature
    owner[_SCENE] = json.dumps(
        {
            "markers": markers,
            "range": [scene.frame_start, scene.frame_end],
            "frame": scene.frame_current,
        }
    )
    owner[_ACTION] = action
    scene.frame_start, scene.frame_end = 1, frame
    scene.frame_set(1)
    return frame


def end_exercise(scene: bpy.types.Scene, armature: bpy.types.Object) -> None:
    """Take the test poses away, and bring back what was before."""
    owner: Any = armature
    state = json.loads(owner.get(_SCENE, "{}"))
    bring_back(armature)
    if state:
        action = owner.get(_ACTION)
        if _ACTION in owner:
            del owner[_ACTION]
        if action is not None:
            bpy.data.actions.remove(action)
        ours = set(state["markers"])
        for marker in [marker for marker in scene.timeline_markers if marker.name in ours]:
            scene.timeline_markers.remove(marker)
        scene.frame_start, scene.frame_end = state["range"]
        scene.frame_set(state["frame"])
        del owner[_SCENE]
