# SPDX-License-Identifier: GPL-3.0-or-later
"""The pictures of docs/retargeting.md.

    retarget.jpg  a rigged cat has lent its rig to the other one, which has been posed with it
    morph.jpg     the standing cat on its way to the walking one

`tools/screenshots.py` takes them.
"""

from __future__ import annotations

import time
from typing import TYPE_CHECKING

import bpy
from camera import Caption, seen
from screen import fold, set_scene, show_panels, view

if TYPE_CHECKING:
    from collections.abc import Iterator

    from camera import Camera

_TURNS = {"upper_arm.L": -1.0, "forearm.L": 0.9, "neck": -0.5, "tail.1": -0.8}
"""By how much some bones are turned about their X axis, in radians, to show that the rig works."""


def pictures(camera: Camera) -> Iterator[float | None]:
    """Retarget the demo pair, pose it, and wrap one cat onto the other."""
    set_scene(rigged=True)
    state = bpy.context.scene.hiermatch
    fold()
    show_panels("Retarget")
    retarget()
    view()["space_data"].shading.color_type = "MATERIAL"
    pose(state.target)
    yield None
    camera.take_with_panel("retarget", [state.source, state.target])
    yield from morph(camera)


def morph(camera: Camera) -> Iterator[float | None]:
    """Move the slider of a wrap."""
    set_scene()
    state = bpy.context.scene.hiermatch
    with bpy.context.temp_override(**view()):
        bpy.ops.hiermatch.match()
        bpy.ops.hiermatch.wrap()
        bpy.ops.hiermatch.show(view="CHECKER")
    state.target.hide_set(state=True)
    keys = state.source.data.shape_keys.key_blocks
    caption, looks = Caption(), []
    for value in (0.0, 0.5, 1.0):
        keys[-1].value = value
        yield None
        box = seen([state.source])
        caption.show(f"{value:g}", box)
        yield None
        looks.append(camera.look(box))
    caption.hide()
    state.target.hide_set(state=False)
    camera.save("morph", [looks])


def retarget(**options: object) -> None:
    """Press Retarget; the panel then tells the processor's time, not that of a machine with other things to do."""
    start = time.process_time()
    with bpy.context.temp_override(**view()):
        bpy.ops.hiermatch.retarget(**options)
    bpy.context.scene.hiermatch_retarget.report.seconds = time.process_time() - start


def pose(cat: bpy.types.Object) -> None:
    """Turn some bones of the rig of a cat."""
    armature = next(modifier.object for modifier in cat.modifiers if modifier.type == "ARMATURE")
    for name, turn in _TURNS.items():
        bone = armature.pose.bones[name]
        bone.rotation_mode = "XYZ"
        bone.rotation_euler = (turn, 0.0, 0.0)
    bpy.context.view_layer.update()
