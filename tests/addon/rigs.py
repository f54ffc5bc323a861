# SPDX-License-Identifier: GPL-3.0-or-later
"""Creatures with an armature, poses of them, and the true way from one to another."""

from __future__ import annotations

import bmesh
import bpy
import numpy as np
from hiermatch.engine import FittedRig, SurfaceMap
from hiermatch.engine.retarget.rig.bone_fit import fit_bones
from hiermatch.hiermatch_addon.jobs.transfer import Passage
from hiermatch.hiermatch_addon.scene.armatures import find_armature, read_rig
from hiermatch.hiermatch_addon.scene.mesh_io import read_mesh
from hiermatch.hiermatch_addon.storage.vertex_maps import MapPair
from mathutils import Matrix

from tests.shapes import creature
from tests.skeletons import CONTROLS, CREATURE_BONES, creature_weights

POSE = {
    "neck": (0.0, 0.0, 0.5),
    "tail": (-0.9, 0.0, 0.0),
    "upper front.L": (0.5, 0.0, 0.0),
    "lower front.L": (-0.8, 0.0, 0.0),
    "upper front.R": (-0.6, 0.0, 0.2),
    "lower front.R": (0.4, 0.0, 0.0),
    "upper hind.L": (0.6, 0.0, 0.0),
    "lower hind.R": (-0.9, 0.0, 0.0),
}
"""By what angles bones turn about their axes x, y, z in the pose."""


def add_rigged(name="Source", resolution=8, matrix=None):
    """Add the creature with its armature at rest: mesh object and armature object, the one the other's parent.

    `matrix` is the armature's matrix in the world; the creature has its size in the world only without one.
    """
    vertices, triangles, _ = creature(0.0, resolution)
    armature = add_armature(f"{name} Rig")
    obj = add_mesh(name, vertices, triangles)
    add_weights(obj, creature_weights(vertices))
    modifier = obj.modifiers.new("Armature", "ARMATURE")
    modifier.object = armature
    obj.parent = armature
    if matrix is not None:
        armature.matrix_world = matrix
    bpy.context.view_layer.update()
    return obj, armature


def add_armature(name):
    """Add an armature with the creature's bones, of which the controls do not deform."""
    data = bpy.data.armatures.new(name)
    obj = bpy.data.objects.new(name, data)
    bpy.context.scene.collection.objects.link(obj)
    bpy.context.view_layer.objects.active = obj
    bpy.ops.object.mode_set(mode="EDIT")
    for bone, (parent, head, tail) in CREATURE_BONES.items():
        edited = data.edit_bones.new(bone)
        edited.head, edited.tail, edited.use_deform = head, tail, bone not in CONTROLS
        if parent is not None:
            edited.parent = data.edit_bones[parent]
            edited.use_connect = CREATURE_BONES[parent][2] == head
    bpy.ops.object.mode_set(mode="OBJECT")
    bpy.context.view_layer.objects.active = None
    return obj


def pose(armature, part=1.0, angles=None):
    """Turn some bones of an armature."""
    for name, turn in (POSE if angles is None else angles).items():
        bone = armature.pose.bones[name]
        bone.rotation_mode = "XYZ"
        bone.rotation_euler = [part * angle for angle in turn]
    bpy.context.view_layer.update()


def unpose(armature):
    """Put all bones back to rest."""
    for bone in armature.pose.bones:
        bone.matrix_basis.identity()
    bpy.context.view_layer.update()


def add_target(source, name="Target", part=1.0, matrix=None, sizes=None):
    """Add a mesh without a rig: the creature as its armature poses it, moved by a matrix.

    `sizes` gives some bones a scale.  Its vertices are numbered as the source's; the source is at rest afterwards.

    Returns
    -------
    obj : bpy.types.Object
        The new object.
    joints : dict
        For each bone its true head and tail in the world.
    """
    armature = find_armature(source)
    pose(armature, part)
    for bone, size in (sizes or {}).items():
        armature.pose.bones[bone].scale = [size] * 3
    bpy.context.view_layer.update()
    matrix = Matrix.Translation((4, 0, 0)) if matrix is None else matrix
    mesh = read_mesh(source, bpy.context.evaluated_depsgraph_get(), use_modifiers=True)
    into = matrix @ armature.matrix_world
    joints = {bone.name: (np.array(into @ bone.head), np.array(into @ bone.tail)) for bone in armature.pose.bones}
    unpose(armature)
    obj = add_mesh(name, mesh.vertices, mesh.triangles)
    obj.matrix_world = matrix
    bpy.context.view_layer.update()
    return obj, joints


def add_rigged_pair(**options):
    """Add a rigged creature at rest and one without a rig in a pose: source and target, and nothing selected."""
    source, _ = add_rigged()
    target, _ = add_target(source, **options)
    bpy.ops.object.select_all(action="DESELECT")
    bpy.context.view_layer.objects.active = None
    return source, target


def true_passage(source, target):
    """Make the way between two objects whose vertices are numbered alike, with the rig that fits best."""
    depsgraph = bpy.context.evaluated_depsgraph_get()
    meshes = [read_mesh(obj, depsgraph, use_modifiers=False) for obj in (source, target)]
    maps = [SurfaceMap.identity(mesh) for mesh in meshes[::-1]]
    pair, rig = MapPair(*meshes, *maps), read_rig(source)
    if rig is None:
        return Passage(pair)
    fitted = fit_bones(meshes[0].vertices, meshes[1].vertices, meshes[0].vertex_areas, rig.weights, rig.skeleton)
    return Passage(
        pair,
        FittedRig(
            rig.skeleton,
            rig.weights,
            fitted.linear,
            fitted.translations,
            fitted.rotations,
            fitted.scales,
            fitted.posed,
            meshes[1].vertices,
            *maps,
        ),
        rig.names,
    )


def add_mesh(name, vertices, triangles):
    """Add a mesh object."""
    mesh = bpy.data.meshes.new(name)
    mesh.from_pydata(vertices.tolist(), [], triangles.tolist())
    mesh.update()
    obj = bpy.data.objects.new(name, mesh)
    bpy.context.scene.collection.objects.link(obj)
    return obj


def add_weights(obj, weights, names=tuple(CREATURE_BONES), without=CONTROLS):
    """Give an object vertex groups of these names with weights (n, b), but for some."""
    numbers = [number for number, name in enumerate(names) if name not in without]
    groups = [obj.vertex_groups.new(name=names[number]) for number in numbers]
    columns = weights[:, numbers].tocoo()
    for vertex, column, weight in zip(columns.row.tolist(), columns.col.tolist(), columns.data.tolist(), strict=True):
        groups[column].add([vertex], weight, "REPLACE")


def split_up(obj, pieces):
    """Cut a mesh object into objects of some of its faces, which share the positions of vertices along the cuts.

    `pieces` gives for the center of each face (f, 3) the number of its piece.  All else of the object is copied to
    each; it is gone afterwards.

    Returns
    -------
    list of bpy.types.Object
        The pieces, named as the object with a number.
    """
    mesh = obj.data
    numbers = np.asarray(pieces(np.array([polygon.center for polygon in mesh.polygons])))
    made = []
    for number in np.unique(numbers).tolist():
        part = obj.copy()
        part.name, part.data = f"{obj.name} {number}", mesh.copy()
        bpy.context.scene.collection.objects.link(part)
        edited = bmesh.new()
        edited.from_mesh(part.data)
        faces = [face for face, piece in zip(list(edited.faces), numbers.tolist(), strict=True) if piece != number]
        bmesh.ops.delete(edited, geom=faces, context="FACES")
        edited.to_mesh(part.data)
        edited.free()
        made.append(part)
    bpy.data.objects.remove(obj)
    bpy.context.view_layer.update()
    return made
