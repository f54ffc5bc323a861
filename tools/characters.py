# SPDX-License-Identifier: GPL-3.0-or-later
"""Imported characters, and what a person does with them by Blender's own tools: for `character_story.py`."""

from __future__ import annotations

from typing import Any, cast

import bmesh
import bpy
import numpy as np
from mathutils import Quaternion, Vector
from screen import view
from window_events import check

_WISHED = ("walk", "run", "swim", "gallop")
"""What the name of an action to play should contain, the best first."""

_SEAM = 1e-5
"""How far apart the vertices are, in metres, at seams of glTF files."""

_SWINGS = {"upperarm": -0.6, "upperleg": 0.6, "thigh": 0.6}
"""How far the bones with these words in their names swing, in radians, where the source has no action."""

_SIDES = (((".l", "_l", "left"), 1), ((".r", "_r", "right"), -1))
"""How names of bones end on the left and on the right."""


def show_bones(rig: bpy.types.Object) -> None:
    """Draw the bones of one armature, over everything."""
    view()["space_data"].overlay.show_bones = True
    for obj in bpy.data.objects:
        if obj.type == "ARMATURE":
            cast("Any", obj).show_in_front = obj == rig
            obj.hide_set(state=obj != rig)


def separated(obj: bpy.types.Object, materials: list[str]) -> bpy.types.Object:
    """Separate what has some materials from an object, as by P in Edit Mode, and return it."""
    before, slots = set(bpy.data.objects), obj.material_slots.keys()
    missing = set(materials) - set(slots)
    check(not missing, f"{obj.name} has no material {missing}, but {slots}")
    with bpy.context.temp_override(**view()):
        bpy.ops.object.select_all(action="DESELECT")
        obj.select_set(state=True)
        bpy.context.view_layer.objects.active = obj
        bpy.ops.object.mode_set(mode="EDIT")
        bpy.ops.mesh.select_all(action="DESELECT")
        for material in materials:
            obj.active_material_index = slots.index(material)
            bpy.ops.object.material_slot_select()
        bpy.ops.mesh.separate(type="SELECTED")
        bpy.ops.object.mode_set(mode="OBJECT")
    (item,) = set(bpy.data.objects) - before
    item.name = f"{obj.name} {materials[0]}"
    return item


def bind(meshes: list[bpy.types.Object], rig: bpy.types.Object) -> None:
    """Let a rig move meshes in the place of their own, by automatic weights, for which seams have to be merged."""
    with bpy.context.temp_override(**view()):
        bpy.ops.object.select_all(action="DESELECT")
        for mesh in meshes:
            stands = mesh.matrix_world.copy()
            mesh.parent = None
            mesh.matrix_world = stands
            mesh.vertex_groups.clear()
            build = bmesh.new()
            build.from_mesh(mesh.data)
            bmesh.ops.remove_doubles(build, verts=build.verts, dist=_SEAM)
            build.to_mesh(mesh.data)
            build.free()
            for modifier in [one for one in mesh.modifiers if one.type == "ARMATURE"]:
                mesh.modifiers.remove(modifier)
            mesh.select_set(state=True)
        rig.select_set(state=True)
        bpy.context.view_layer.objects.active = rig
        bpy.ops.object.parent_set(type="ARMATURE_AUTO")
        bpy.ops.object.select_all(action="DESELECT")
    bpy.context.view_layer.objects.active = None


def hangs_on(obj: bpy.types.Object, rig: bpy.types.Object) -> bool:
    """Say whether an armature moves a mesh, or carries it as its parent."""
    return rig in armatures_of(obj) or rig == obj.parent


def armatures_of(obj: bpy.types.Object) -> list[bpy.types.Object]:
    """Return what moves a mesh: the armatures of its modifiers that are switched on."""
    return [cast("Any", one).object for one in obj.modifiers if one.type == "ARMATURE" and one.show_viewport]


def extent_of(meshes: list[bpy.types.Object]) -> tuple[float, float]:
    """Return from where to where meshes reach along X."""
    along = [(obj.matrix_world @ Vector(corner)).x for obj in meshes for corner in obj.bound_box]
    return min(along), max(along)


def shape_of(obj: bpy.types.Object, *, shown: bool = False) -> bytes:
    """Return the vertices of a mesh, its own or as they are shown."""
    mesh = cast("Any", obj.evaluated_get(bpy.context.evaluated_depsgraph_get()) if shown else obj).data
    positions = np.empty(3 * len(mesh.vertices), np.float32)
    mesh.vertices.foreach_get("co", positions)
    return positions.tobytes()


def action_of(rig: bpy.types.Object) -> Any:  # noqa: ANN401 - an action, or None
    """Choose an action that a rig has, or that was imported for it: a walk if there is one."""
    animation: Any = rig.animation_data
    if animation is None:
        return None
    strips = [strip.action for track in animation.nla_tracks for strip in track.strips]
    actions = [one for one in [animation.action, *strips] if one is not None]
    for word in _WISHED:
        for action in actions:
            if word in action.name.lower():
                return action
    return actions[0] if actions else None


def swing(rig: bpy.types.Object) -> None:
    """Give a rig that has no action one that swings its arms and legs, as in a walk."""
    bones = cast("Any", rig.pose).bones
    for bone in bones:
        word = next((word for word in _SWINGS if word in bone.name.lower().replace("_", "").replace(" ", "")), None)
        side = next((side for ends, side in _SIDES if bone.name.lower().endswith(ends)), None)
        if word is None or side is None:
            continue
        axis = (rig.matrix_world @ bone.bone.matrix_local).to_3x3().inverted() @ Vector((1.0, 0.0, 0.0))
        bone.rotation_mode = "QUATERNION"
        for number, way in enumerate((1, 0, -1, 0, 1)):
            bone.rotation_quaternion = Quaternion(axis.normalized(), way * side * _SWINGS[word])
            bone.keyframe_insert("rotation_quaternion", frame=1 + 6 * number)
    check(rig.animation_data is not None, "The source has no action, and no bones called as arms or legs")
    cast("Any", rig.animation_data).action.name = "Swing Walk"


def assign(rig: bpy.types.Object, action: Any) -> None:  # noqa: ANN401 - an action
    """Let a rig play an action, as the menu of the Action Editor does."""
    animation: Any = rig.animation_data or rig.animation_data_create()
    animation.action = action
    if getattr(animation, "action_slot", True) is None:
        animation.action_slot = animation.action_suitable_slots[0]


def stop(rig: bpy.types.Object) -> None:
    """Take a rig's actions away, and leave its drivers."""
    animation: Any = rig.animation_data
    if animation is not None:
        animation.action = None
        for track in list(animation.nla_tracks):
            animation.nla_tracks.remove(track)
