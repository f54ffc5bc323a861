# SPDX-License-Identifier: GPL-3.0-or-later
"""The skeleton of the demo cat: its bones, how they move its skin, and its two poses."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Final

import bpy
import numpy as np
from mathutils import Euler
from scipy.sparse import coo_array, diags_array
from scipy.sparse.linalg import splu

from ..scene.armatures import pose_of

if TYPE_CHECKING:
    from collections.abc import Mapping

    from numpy.typing import NDArray

Point = tuple[float, float, float]

Pose = dict[str, tuple[float, float, float]]
"""Degrees by which bones turn about the X, Y and Z axes of the rest pose, after their parents have turned."""


@dataclass(frozen=True)
class Bone:
    """A bone in the rest pose.

    Attributes
    ----------
    name, parent : str
        Names of the bone and of the one it hangs on, if any.
    head, tail : (x, y, z)
        Where it begins and ends.
    radius : float
        How thick the body is around it: a place of the skin belongs to the bone that is nearest in units of this.
    blend : float
        How far its hold on the skin fades into its neighbours'.
    """

    name: str
    parent: str | None
    head: Point
    tail: Point
    radius: float
    blend: float


def _chain(parent: str | None, points: list[Point], bones: list[tuple[str, float, float]]) -> list[Bone]:
    """Make bones that follow each other: names, radii and blends between points."""
    chain = []
    for (name, radius, blend), head, tail in zip(bones, points[:-1], points[1:], strict=True):
        chain.append(Bone(name, parent, head, tail, radius, blend))
        parent = name
    return chain


def _legs(side: str, sign: float) -> list[Bone]:
    """Make the legs of one side, ``L`` (sign 1) or ``R`` (sign -1)."""
    foreleg = [(0.125, -0.44, 0.76), (0.145, -0.36, 0.49), (0.132, -0.39, 0.19), (0.13, -0.42, 0.06)]
    hind_leg = [(0.13, 0.41, 0.74), (0.16, 0.33, 0.49), (0.142, 0.53, 0.21), (0.135, 0.49, 0.06)]
    fore_names = [(f"upper_arm.{side}", 0.12, 0.15), (f"forearm.{side}", 0.07, 0.07), (f"wrist.{side}", 0.06, 0.05)]
    hind_names = [(f"thigh.{side}", 0.16, 0.14), (f"shin.{side}", 0.075, 0.06), (f"hock.{side}", 0.06, 0.05)]
    foreleg.append((0.13, -0.60, 0.04))
    hind_leg.append((0.135, 0.31, 0.04))
    fore_names.append((f"forepaw.{side}", 0.06, 0.04))
    hind_names.append((f"hind_paw.{side}", 0.06, 0.04))
    mirrored = [[(sign * x, y, z) for x, y, z in points] for points in (foreleg, hind_leg)]
    return [*_chain("chest", mirrored[0], fore_names), *_chain("hips", mirrored[1], hind_names)]


BONES: Final[tuple[Bone, ...]] = (
    Bone("hips", None, (0, 0.36, 0.77), (0, 0.60, 0.80), 0.20, 0.14),
    *_chain(
        "hips",
        [(0, 0.36, 0.77), (0, 0.12, 0.75), (0, -0.12, 0.745), (0, -0.44, 0.80), (0, -0.72, 1.09), (0, -1.02, 1.21)],
        [
            ("loin", 0.20, 0.16),
            ("ribs", 0.21, 0.16),
            ("chest", 0.21, 0.14),
            ("neck", 0.17, 0.11),
            ("head", 0.21, 0.07),
        ],
    ),
    *_chain(
        "hips",
        [(0, 0.60, 0.85), (0, 0.82, 0.80), (0, 1.04, 0.75), (0, 1.27, 0.73), (0, 1.50, 0.745), (0, 1.75, 0.80)],
        [(f"tail.{i}", 0.06 if i > 1 else 0.075, 0.09) for i in range(1, 6)],
    ),
    *_legs("L", 1.0),
    *_legs("R", -1.0),
)

# Positive X turns a nose down, a leg back and a tail up; positive Z turns to the cat's left.
STANDING: Final[Pose] = {
    "neck": (4, 0, 8),
    "head": (2, 5, 16),
    "tail.1": (-22, 0, 8),
    "tail.2": (-20, 0, 10),
    "tail.3": (6, 0, 12),
    "tail.4": (26, 0, 12),
    "tail.5": (30, 0, 8),
    "upper_arm.L": (-6, 0, 0),
    "forearm.L": (-5, 0, 0),
    "wrist.L": (13, 0, 0),
    "forepaw.L": (-2, 0, 0),
    "upper_arm.R": (2, 0, 0),
    "forearm.R": (2, 0, 0),
    "wrist.R": (-3, 0, 0),
    "thigh.L": (8, 0, 0),
    "shin.L": (-5, 0, 0),
    "hock.L": (-5, 0, 0),
    "hind_paw.L": (3, 0, 0),
    "thigh.R": (-8, 0, 0),
    "shin.R": (3, 0, 0),
    "hock.R": (3, 0, 0),
    "hind_paw.R": (2, 0, 0),
}

WALKING: Final[Pose] = {
    "hips": (-1, 0, 7),
    "loin": (1, 0, 5),
    "ribs": (1, 0, 6),
    "chest": (2, 0, 5),
    "neck": (10, 0, 14),
    "head": (-8, 8, 22),
    "tail.1": (34, 0, -8),
    "tail.2": (32, 0, -8),
    "tail.3": (14, 0, -6),
    "tail.4": (-18, 0, 4),
    "tail.5": (-28, 0, 8),
    "upper_arm.L": (-24, 0, 0),
    "forearm.L": (-36, 0, 0),
    "wrist.L": (60, 0, 0),
    "forepaw.L": (14, 0, 0),
    "upper_arm.R": (22, 0, 0),
    "forearm.R": (-3, 0, 0),
    "wrist.R": (-27, 0, 0),
    "forepaw.R": (6, 0, 0),
    "thigh.L": (23, 0, 0),
    "shin.L": (-2, 0, 0),
    "hock.L": (-27, 0, 0),
    "hind_paw.L": (17, 0, 0),
    "thigh.R": (-34, 0, 0),
    "shin.R": (19, 0, 0),
    "hock.R": (9, 0, 0),
    "hind_paw.R": (7, 0, 0),
}


def build_armature(name: str, scene: bpy.types.Scene) -> bpy.types.Object:
    """Build the armature in a scene.

    Parameters
    ----------
    name : str
        Name of the new object and armature; the caller removes both in the end.
    scene : bpy.types.Scene
        Where the armature is made, in the first view layer.

    Returns
    -------
    bpy.types.Object
        The armature object, in the rest pose.
    """
    bones = bpy.data.armatures.new(name)
    armature = bpy.data.objects.new(name, bones)
    scene.collection.objects.link(armature)
    layer = scene.view_layers[0]
    layer.objects.active = armature
    # Bones can be made in Edit Mode only.
    with bpy.context.temp_override(scene=scene, view_layer=layer, active_object=armature, object=armature):
        bpy.ops.object.mode_set(mode="EDIT")
        for bone in BONES:
            edit_bone = bones.edit_bones.new(bone.name)
            edit_bone.head, edit_bone.tail = bone.head, bone.tail
            if bone.parent:
                edit_bone.parent = bones.edit_bones[bone.parent]
        bpy.ops.object.mode_set(mode="OBJECT")
    return armature


def set_pose(armature: bpy.types.Object, pose: Mapping[str, tuple[float, float, float]]) -> None:
    """Turn the bones of an armature; bones that the pose does not name return to rest."""
    for pose_bone in pose_of(armature).bones:
        degrees = pose.get(pose_bone.name, (0.0, 0.0, 0.0))
        turn = Euler(np.radians(degrees).tolist()).to_matrix()
        rest = pose_bone.bone.matrix_local.to_3x3()
        pose_bone.matrix_basis = (rest.inverted() @ turn @ rest).to_4x4()


def bone_weights(vertices: NDArray[np.float64], edges: NDArray[np.int64]) -> NDArray[np.float64]:
    """Compute how far each bone moves each vertex of the rest surface.

    Every vertex first belongs to its nearest bone; then the weights diffuse along the surface, farther where the body
    is thicker.

    Parameters
    ----------
    vertices : (n, 3) array of float
        Positions in the rest pose.
    edges : (e, 2) array of int
        The edges of the surface, of similar lengths.

    Returns
    -------
    (n, len(BONES)) array of float
        Weights, not negative and summing to one at each vertex.
    """
    distances = np.stack([_distance_to_segment(vertices, bone.head, bone.tail) / bone.radius for bone in BONES], axis=1)
    nearest = distances.argmin(axis=1)
    n = len(vertices)
    adjacency = coo_array((np.ones(len(edges)), edges.T), shape=(n, n)).tocsr()
    adjacency = adjacency + adjacency.T
    degree = adjacency.sum(axis=1)
    laplacian = diags_array(np.ones(n)) - diags_array(1 / degree) @ adjacency
    spacing = float(np.linalg.norm(vertices[edges[:, 0]] - vertices[edges[:, 1]], axis=1).mean())
    weights = np.eye(len(BONES))[nearest]
    blends = np.array([bone.blend for bone in BONES])[nearest]
    # Implicit Euler steps of the heat equation; several, so that the weights are smooth where bones meet.
    steps = 3
    reach = diags_array(2 * (blends / spacing) ** 2 / steps)
    factor = splu((diags_array(np.ones(n)) + reach @ laplacian).tocsc())
    for _ in range(steps):
        weights = factor.solve(weights)
    weights = np.maximum(weights, 0)
    return weights / weights.sum(axis=1, keepdims=True)


def _distance_to_segment(points: NDArray[np.float64], head: Point, tail: Point) -> NDArray[np.float64]:
    """Measure the distance of points (n, 3) to a line segment, (n,)."""
    start, along = np.array(head), np.subtract(tail, head)
    t = np.clip((points - start) @ along / (along @ along), 0, 1)
    return np.linalg.norm(points - start - t[:, None] * along, axis=1)
