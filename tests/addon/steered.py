# SPDX-License-Identifier: GPL-3.0-or-later
"""A small rig whose deforming bones follow controls."""

from __future__ import annotations

import bpy

DEFORMING = [f"d{number}" for number in range(6)]
TURNING = {name: name.replace("d", "c") for name in DEFORMING}
"""Bone -> the control that turns it."""


def chains(*names):
    """Two limbs of bones "d0" to "d5", each turned by a free control, "c0" to "c2" and "c3" to "c5"."""
    data = bpy.data.armatures.new("Rig")
    rig = bpy.data.objects.new("Rig", data)
    bpy.context.scene.collection.objects.link(rig)
    bpy.context.view_layer.objects.active = rig
    bpy.ops.object.mode_set(mode="EDIT")
    for kind in "cd":
        for number in range(6):
            bone = data.edit_bones.new(f"{kind}{number}")
            bone.head, bone.tail = (number // 3, 0, number % 3), (number // 3, 0, number % 3 + 1)
            bone.parent = data.edit_bones[f"{kind}{number - 1}"] if kind == "c" and number % 3 else None
            bone.use_inherit_rotation = bone.name not in names
    bpy.ops.object.mode_set(mode="OBJECT")
    bpy.context.view_layer.objects.active = None
    for number in range(6):
        follows = rig.pose.bones[f"d{number}"].constraints.new("COPY_TRANSFORMS")
        follows.target, follows.subtarget = rig, f"c{number}"
    return rig
