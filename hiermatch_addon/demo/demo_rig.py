# SPDX-License-Identifier: GPL-3.0-or-later
"""The rig of the standing demo cat, with weights, shape keys, a UV map and a material."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Final, cast

import bpy
import numpy as np

from ..common.access import mesh_of, open_collections, view_layer_of
from ..scene.armatures import pose_of
from .demo_skeleton import BONES, STANDING, set_pose

if TYPE_CHECKING:
    from numpy.typing import NDArray

RIG_NAME: Final = "Demo Cat Rig"

LEAST_WEIGHT = 1e-4
"""Of a bone on a vertex; smaller ones are not written."""

_TOGETHER = 1e-4
"""Distance up to which a head is at the parent's tail."""

# The shape keys: the bone around whose middle each moves the skin outwards, over what distance and how far.
_KEYS: Final = {"Well Fed": ("loin", 0.28, 0.09), "Big Nose": ("head", 0.09, 0.05)}


def posed_joints(armature: bpy.types.Object) -> dict[str, tuple[NDArray[np.float64], NDArray[np.float64]]]:
    """Return head and tail of each bone of an armature in its pose, in the armature's space."""
    pose = pose_of(armature)
    return {bone.name: (np.array(bone.head, np.float64), np.array(bone.tail, np.float64)) for bone in pose.bones}


def rig_cat(
    context: bpy.types.Context,
    cat: bpy.types.Object,
    workshop_rig: bpy.types.Object,
    weights: NDArray[np.float64],
    lift: float,
) -> bpy.types.Object:
    """Give the standing cat a rig.

    Parameters
    ----------
    context : bpy.types.Context
        Where the cat is.
    cat : bpy.types.Object
        The cat, whose pose becomes its rest pose.
    workshop_rig : bpy.types.Object
        The armature that it was posed with.
    weights : (n, bones) array of float
        How far each bone moves each vertex.
    lift : float
        How far its feet were lifted onto the ground after that.

    Returns
    -------
    bpy.types.Object
        The armature, which stands where the cat does.
    """
    set_pose(workshop_rig, STANDING)
    layer = next(scene for scene in bpy.data.scenes if workshop_rig.name in scene.objects).view_layers[0]
    layer.update()
    armature = _armature(context, cat, posed_joints(workshop_rig), lift)
    _bind(cat, armature, weights)
    _add_keys(cat, armature)
    _unwrap(cat)
    _paint(cat)
    return armature


def _armature(
    context: bpy.types.Context,
    cat: bpy.types.Object,
    joints: dict[str, tuple[NDArray[np.float64], NDArray[np.float64]]],
    lift: float,
) -> bpy.types.Object:
    """Make the armature, with its joints where the pose has taken them."""
    bones = bpy.data.armatures.new(RIG_NAME)
    armature = bpy.data.objects.new(RIG_NAME, bones)
    open_collections(context, [cast("bpy.types.Collection", context.collection)])[0].objects.link(armature)
    armature.matrix_world = cat.matrix_world.copy()
    bones.display_type = "STICK"
    armature.show_in_front = True
    view_layer = view_layer_of(context)
    view_layer.objects.active = armature
    bpy.ops.object.mode_set(mode="EDIT")
    for bone in BONES:
        edited = bones.edit_bones.new(bone.name)
        head, tail = (place + np.array([0, 0, lift]) for place in joints[bone.name])
        edited.head, edited.tail = head.tolist(), tail.tolist()
        if bone.parent:
            edited.parent = bones.edit_bones[bone.parent]
            edited.use_connect = (edited.parent.tail - edited.head).length < _TOGETHER
    bpy.ops.object.mode_set(mode="OBJECT")
    return armature


def _bind(cat: bpy.types.Object, armature: bpy.types.Object, weights: NDArray[np.float64]) -> None:
    """Let the armature move the cat."""
    for bone, column in zip(BONES, weights.T, strict=True):
        group = cat.vertex_groups.new(name=bone.name)
        for vertex in np.flatnonzero(column > LEAST_WEIGHT).tolist():
            group.add([vertex], column[vertex], "REPLACE")
    modifier = cast("bpy.types.ArmatureModifier", cat.modifiers.new("Armature", "ARMATURE"))
    modifier.object = armature
    place = cat.matrix_world.copy()
    cat.parent = armature
    cat.matrix_world = place


def _add_keys(cat: bpy.types.Object, armature: bpy.types.Object) -> None:
    """Add the shape keys: bumps of the skin around the middles of bones."""
    mesh = mesh_of(cat)
    vertices = np.array([vertex.co for vertex in mesh.vertices])
    normals = np.array([vertex.normal for vertex in mesh.vertices])
    cat.shape_key_add(name="Basis", from_mix=False)
    for name, (bone_name, reach, height) in _KEYS.items():
        bone = cast("bpy.types.Armature", armature.data).bones[bone_name]
        middle = np.array(bone.tail_local if name == "Big Nose" else (bone.head_local + bone.tail_local) / 2)
        bump = height * np.exp(-(np.linalg.norm(vertices - middle, axis=1) ** 2) / (2 * reach**2))
        key = cat.shape_key_add(name=name, from_mix=False)
        key.value = 0.0
        moved = vertices + bump[:, None] * normals
        data: Any = key.data
        data.foreach_set("co", moved.astype(np.float32).ravel())


def _unwrap(cat: bpy.types.Object) -> None:
    """Lay out the left and the right half side by side, as seen from their sides."""
    mesh = mesh_of(cat)
    places = np.array([vertex.co for vertex in mesh.vertices])
    low, size = places.min(axis=0), np.ptp(places, axis=0).max()
    along = (places[:, 1] - low[1]) / size
    upwards = (places[:, 2] - low[2]) / size / 2
    layer = mesh.uv_layers.new(name="UVMap")
    uv = np.empty((len(mesh.loops), 2), np.float32)
    for polygon in mesh.polygons:
        left = sum(places[vertex][0] for vertex in polygon.vertices) > 0
        for loop, vertex in zip(polygon.loop_indices, polygon.vertices, strict=True):
            uv[loop] = along[vertex] if left else 1 - along[vertex], upwards[vertex] + (0.5 if left else 0.0)
    data: Any = layer.data
    data.foreach_set("uv", uv.ravel())


def _paint(cat: bpy.types.Object) -> None:
    """Give the cat a checkered fur, laid out by its UV map."""
    material = bpy.data.materials.new("Demo Cat Fur")
    if bpy.app.version < (5, 0):  # from then on they always do
        material.use_nodes = True
    tree: Any = material.node_tree
    shader = next(node for node in tree.nodes if node.type == "BSDF_PRINCIPLED")
    checker = tree.nodes.new("ShaderNodeTexChecker")
    checker.inputs["Scale"].default_value = 40.0
    checker.inputs["Color1"].default_value = (0.8, 0.45, 0.15, 1)
    checker.inputs["Color2"].default_value = (0.25, 0.12, 0.05, 1)
    coordinates = tree.nodes.new("ShaderNodeUVMap")
    coordinates.uv_map = "UVMap"
    tree.links.new(coordinates.outputs["UV"], checker.inputs["Vector"])
    tree.links.new(checker.outputs["Color"], shader.inputs["Base Color"])
    mesh_of(cat).materials.append(material)
