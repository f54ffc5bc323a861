# SPDX-License-Identifier: GPL-3.0-or-later
"""Rigify's human metarig, put into a body as by hand: to the joints that the body's own rig has."""

from __future__ import annotations

import sys
from typing import TYPE_CHECKING, Any, cast

import bpy
import numpy as np
from screen import view

if TYPE_CHECKING:
    from types import ModuleType

    from mathutils import Vector

__all__ = ["add_metarig", "generate"]

_AFTER = {
    "hips": "spine",
    "spine": "chest",
    "chest": "upper_chest",
    "upper_chest": "neck",
    "neck": "head",
    "shoulder": "upper_arm",
    "upper_arm": "lower_arm",
    "lower_arm": "hand",
    "upper_leg": "lower_leg",
    "lower_leg": "foot",
    "foot": "toes",
}
"""Where a bone ends: at the head of which other one."""


def add_metarig(rig: bpy.types.Object) -> bpy.types.Object:
    """Add the metarig, and move its bones to the joints of a person's rig; what that lacks goes with its parent."""
    with bpy.context.temp_override(**view()):
        cast("Any", bpy.ops.object).armature_human_metarig_add()
        metarig = bpy.context.view_layer.objects.active
        metarig.matrix_world.identity()
        bpy.ops.object.mode_set(mode="EDIT")
        _move(metarig.data.edit_bones, _joints(rig))
        bpy.ops.object.mode_set(mode="OBJECT")
        bpy.ops.object.select_all(action="DESELECT")
    bpy.context.view_layer.objects.active = None
    return metarig


def generate(metarig: bpy.types.Object) -> bpy.types.Object:
    """Press Generate Rig, and move what it makes to the metarig."""
    before = set(bpy.data.objects)
    bpy.context.view_layer.objects.active = metarig
    with bpy.context.temp_override(**view()):
        cast("Any", bpy.ops.pose).rigify_generate()
    (made,) = (obj for obj in bpy.data.objects if obj not in before and obj.type == "ARMATURE")
    made.matrix_world = metarig.matrix_world.copy()
    metarig.hide_set(state=True)
    bpy.context.view_layer.update()
    return made


def _joints(rig: bpy.types.Object) -> dict[str, tuple[Vector, Vector | None]]:
    """Return where the bones of the metarig belong that a rig has; the second place is None where that is open."""
    bones: Any = rig.data.bones
    found = _engine().humanoid_bones(
        _module("scene.armatures").read_skeleton(rig),
        np.array([bone.use_deform for bone in bones], bool),
        np.array([0.0, 0, 1]),
    )
    heads = {what: rig.matrix_world @ bones[number].head_local for what, number in found.items()}
    names = _module("transfers.motion.name_tables").NAME_TABLES["RIGIFY"]
    joints = {names[what].removeprefix("DEF-"): (head, _end(what, heads)) for what, head in heads.items()}
    if "neck" in heads:  # two bones of the metarig
        middle = (heads["neck"] + heads["head"]) / 2
        joints |= {"spine.004": (heads["neck"], middle), "spine.005": (middle, heads["head"])}
    return joints


def _end(what: str, heads: dict[str, Vector]) -> Vector | None:
    """Return where a bone ends: at the head of the next one that there is."""
    side = next((side for side in ("left_", "right_") if what.startswith(side)), "")
    part = what.removeprefix(side)
    if part[-1:].isdigit():
        return heads.get(f"{side}{part[:-1]}{int(part[-1]) + 1}")
    after = _AFTER.get(part)
    while after is not None and side + after not in heads:
        after = _AFTER.get(after)
    return None if after is None else heads[side + after]


def _move(bones: Any, joints: dict[str, tuple[Vector, Vector | None]]) -> None:  # noqa: ANN401 - Blender's edit bones
    """Move bones to joints, all others with those on which they hang, and keep how they are rolled."""
    rest = {bone.name: (bone.head.copy(), bone.tail.copy(), bone.z_axis.copy()) for bone in bones}
    connected = {bone.name: bone.use_connect for bone in bones}
    for bone in bones:
        bone.use_connect = False
    placed: dict[str, tuple[Vector, Vector]] = {}

    def carried(bone: Any, place: Vector) -> Vector:  # noqa: ANN401 - an edit bone
        while bone is not None and bone.name not in placed:
            bone = bone.parent
        name = bones[0].name if bone is None else bone.name
        (head, tail, _), (new_head, new_tail) = rest[name], placed[name]
        way, new_way = tail - head, new_tail - new_head
        return new_head + new_way.length / way.length * (way.rotation_difference(new_way) @ (place - head))

    for bone in sorted(bones, key=lambda bone: len(bone.parent_recursive)):
        head, tail, axis = rest[bone.name]
        begin, end = joints.get(bone.name, (None, None))
        if begin is None:
            begin, end = carried(bone.parent, head), carried(bone.parent, tail)
        elif end is None:
            end = begin + carried(bone.parent, tail) - carried(bone.parent, head)
        turn = (tail - head).rotation_difference(end - begin)
        placed[bone.name] = begin, end
        bone.head, bone.tail = begin, end
        bone.align_roll(turn @ axis)
    for bone in bones:
        bone.use_connect = connected[bone.name]


def _module(name: str) -> ModuleType:
    """Return a module of the add-on as it is installed."""
    return next(module for key, module in sys.modules.items() if key.endswith(f"hiermatch_addon.{name}"))


def _engine() -> Any:  # noqa: ANN401 - a module
    return next(module for key, module in sys.modules.items() if key.endswith("hiermatch.engine"))
