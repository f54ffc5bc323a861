# SPDX-License-Identifier: GPL-3.0-or-later
"""The picture of docs/motion.md.

    motion.jpg  a rigged cat stretches, and so does the other one, whose rig has other names, axes and rest pose

`tools/screenshots.py` takes it.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import bpy
from camera import Caption, seen
from page_retargeting import retarget
from screen import fold, look_at_selected, set_scene, show_panels, view

if TYPE_CHECKING:
    from collections.abc import Iterator

    from camera import Camera

_STRETCH = {
    1: {},
    13: {"upper_arm.L": -0.9, "upper_arm.R": -0.9, "chest": -0.3, "neck": 0.5, "tail.1": 0.8},
    25: {"upper_arm.L": 0.5, "forearm.L": -0.9, "neck": -0.4, "head": -0.3, "tail.1": -0.6, "tail.2": -0.4},
}
"""For some frames by how much bones are turned about their X axis, in radians."""

_ROLL = 0.7
"""By how much the axes of the other rig are turned, in radians."""


def pictures(camera: Camera) -> Iterator[float | None]:
    """Give the other cat a rig of its own, pair the bones, and carry an action over."""
    set_scene(rigged=True)
    state = bpy.context.scene.hiermatch
    source, target = state.source, state.target
    fold()
    show_panels("Motion")
    retarget()
    _make_its_own(_rig_of(target))
    _animate(_rig_of(source))
    with bpy.context.temp_override(**view()):
        bpy.ops.hiermatch.pair_bones()
        bpy.ops.hiermatch.retarget_action()
    bpy.context.scene.hiermatch_retarget.report.done = ""  # the table is what the picture is about
    space = view()["space_data"]
    space.shading.color_type = "OBJECT"
    source.color, target.color = (0.55, 0.62, 0.75, 1.0), (0.8, 0.66, 0.5, 1.0)
    for rig in (_rig_of(source), _rig_of(target)):
        rig.hide_set(state=True)
    look_at_selected()
    box, caption, looks = None, Caption(), []
    panel = None
    for frame in _STRETCH:
        bpy.context.scene.frame_set(frame)
        yield None
        box = box or seen([source, target])
        panel = camera.panel() if panel is None else panel
        caption.show(f"Frame {frame}", box)
        yield None
        looks.append([camera.look(box)])
    caption.hide()
    camera.save_beside("motion", looks, panel)


def _rig_of(cat: bpy.types.Object) -> bpy.types.Object:
    return next(modifier.object for modifier in cat.modifiers if modifier.type == "ARMATURE")


def _make_its_own(rig: bpy.types.Object) -> None:
    """Give the bones of a rig other names and axes, and the rig no motion."""
    rig.animation_data_clear()
    for number, bone in enumerate(rig.data.bones):
        bone.name = f"Joint {number + 1:02}"
    with bpy.context.temp_override(**view()):
        bpy.context.view_layer.objects.active = rig
        bpy.ops.object.mode_set(mode="EDIT")
        for bone in rig.data.edit_bones:
            bone.roll += _ROLL
        bpy.ops.object.mode_set(mode="OBJECT")


def _animate(rig: bpy.types.Object) -> None:
    """Let a rig stretch."""
    rig.animation_data_clear()
    for frame, turns in _STRETCH.items():
        for name in {name for each in _STRETCH.values() for name in each}:
            bone = rig.pose.bones[name]
            bone.rotation_mode = "XYZ"
            bone.rotation_euler.x = turns.get(name, 0.0)
            bone.keyframe_insert("rotation_euler", frame=frame)
    rig.animation_data.action.name = "Stretch"
