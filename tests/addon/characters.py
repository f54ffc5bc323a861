# SPDX-License-Identifier: GPL-3.0-or-later
"""People of two meshes with an armature each, of any rig, and a match of them that takes no time."""

from __future__ import annotations

from dataclasses import replace
from functools import cache

import bpy
import numpy as np
from hiermatch.engine import MatchQuality, Progress, SurfaceMap
from hiermatch.hiermatch_addon.jobs import match_job, transfer_job
from mathutils import Matrix

from tests.addon.rigs import add_mesh, add_weights
from tests.addon.scenes import made_up_result
from tests.people import HANGING, at_rest_in, coarse_rig, fine_rig, person, renamed


@cache
def someone():
    """The person of all tests."""
    return person(resolution=20, fingers=False)


RIGS = {
    "plain": lambda body: body.rig,
    "renamed": lambda body: renamed(body.rig),
    "fine": fine_rig,
    "coarse": coarse_rig,
}


def add_person(name, rig="plain", *, hanging=False, rolls=0.0, matrix=None, mode="QUATERNION"):
    """Add the person: its armature, a mesh for its body and one for its head; and what it was made of.

    `hanging` gives it another rest pose, `rolls` turns the axes of its bones.
    """
    body = at_rest_in(someone(), HANGING if hanging else {})
    made = RIGS[rig](body)
    armature = add_skeleton(name, made, rolls)
    above = someone().mesh.vertices[:, 2] > 1.5
    head = above[body.mesh.triangles].all(axis=1)
    for part, chosen in (("Body", ~head), ("Head", head)):
        used, triangles = np.unique(body.mesh.triangles[chosen], return_inverse=True)
        obj = add_mesh(f"{name} {part}", body.mesh.vertices[used], triangles.reshape(-1, 3))
        add_weights(obj, made.weights[used], made.names)
        obj.modifiers.new("Armature", "ARMATURE").object = armature
        obj.parent = armature
    if matrix is not None:
        armature.matrix_world = matrix
    for bone in armature.pose.bones:
        bone.rotation_mode = mode
    bpy.context.view_layer.update()
    return armature, made


def add_skeleton(name, rig, rolls=0.0):
    """Add an armature with the bones of a rig; those that move nothing do not deform."""
    data = bpy.data.armatures.new(name)
    obj = bpy.data.objects.new(name, data)
    bpy.context.scene.collection.objects.link(obj)
    bpy.context.view_layer.objects.active = obj
    bpy.ops.object.mode_set(mode="EDIT")
    moving = np.asarray(abs(rig.weights).sum(axis=0)).ravel() > 0
    for number in rig.skeleton.order:
        bone = data.edit_bones.new(rig.names[number])
        bone.head, bone.tail = rig.skeleton.heads[number], rig.skeleton.tails[number]
        bone.roll, bone.use_deform = rolls * (1 + number % 5), bool(moving[number])
        if rig.skeleton.parents[number] >= 0:
            bone.parent = data.edit_bones[rig.names[rig.skeleton.parents[number]]]
    bpy.ops.object.mode_set(mode="OBJECT")
    bpy.context.view_layer.objects.active = None
    return obj


def match_at_once(monkeypatch, confidence=0.9):
    """Let bodies whose vertices are numbered alike be matched by these."""
    quality = MatchQuality(1.0, 0.05, 1.0, 0.0, None, confidence, "The shapes correspond closely.", 1.0, None, 0.0)

    def steps(source, target, *_arguments, **_names):
        yield Progress(0.5, "Matching")
        maps = {"source_to_target": SurfaceMap.identity(target), "target_to_source": SurfaceMap.identity(source)}
        return replace(made_up_result(source, target), quality=quality, **maps)

    monkeypatch.setattr(match_job, "match_steps", steps)
    fit = transfer_job.fit_rig_steps
    monkeypatch.setattr(
        transfer_job, "fit_rig_steps", lambda *bodies, **names: fit(*bodies, **names | {"refine": False})
    )


def posed_vertices(armature):
    """Where the vertices of all meshes that an armature moves are now, in the world, head after body."""
    graph = bpy.context.evaluated_depsgraph_get()
    found = []
    for part in ("Body", "Head"):
        obj = bpy.data.objects[f"{armature.name} {part}"].evaluated_get(graph)
        found += [obj.matrix_world @ vertex.co for vertex in obj.data.vertices]
    return np.array(found)


def add_action(armature, name="Wave", angles=None, frames=(1, 11, 21), way=(0.0, 0.3, 0.1), *, hips="hips"):
    """Give an armature an action: at each frame random turns of some bones, and a way of the hips."""
    random = np.random.default_rng(5)
    armature.animation_data_clear()
    bones = angles or ["upper_arm.L", "forearm.L", "thigh.R", "shin.R", "spine1", "neck"]
    for number, frame in enumerate(frames):
        for bone in (armature.pose.bones[bone] for bone in bones):
            bone.rotation_mode = "QUATERNION"
            bone.rotation_quaternion = Matrix.Rotation(
                random.uniform(-0.7, 0.7), 3, random.normal(size=3)
            ).to_quaternion()
            bone.keyframe_insert("rotation_quaternion", frame=frame)
        armature.pose.bones[hips].location = number * np.array(way)
        armature.pose.bones[hips].keyframe_insert("location", frame=frame)
    action = armature.animation_data.action
    action.name = name
    return action
