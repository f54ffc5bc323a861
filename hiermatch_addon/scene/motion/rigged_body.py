# SPDX-License-Identifier: GPL-3.0-or-later
"""An armature and the meshes that it moves, as one body; and how an armature stands in the world."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from scipy.sparse import csr_array, vstack

from ....engine import BonePairing, Skeleton, TriangleMesh
from ...common.errors import ObjectError
from ..armatures import armature_of, find_armature, read_rig, read_skeleton
from ..mesh_io import read_mesh
from ..pair import named_object

if TYPE_CHECKING:
    from collections.abc import Sequence

    import bpy
    from numpy.typing import NDArray

__all__ = [
    "RiggedBody",
    "armature_named",
    "bound_meshes",
    "check_armature",
    "in_own_spaces",
    "object_rotation",
    "own_skeleton",
    "read_body",
    "rest_matrices",
    "rig_of",
]


@dataclass(frozen=True, eq=False)
class RiggedBody:
    """A body with its rig, in world space and at rest.

    Attributes
    ----------
    mesh : TriangleMesh
        All meshes together, n vertices.
    names : (b,) tuple of str
        Names of the bones.
    skeleton : Skeleton
        The bones.
    weights : (n, b) csr_array of float
        How much each bone moves each vertex; empty where no bone does.
    """

    mesh: TriangleMesh
    names: tuple[str, ...]
    skeleton: Skeleton
    weights: csr_array


def rig_of(obj: bpy.types.Object) -> bpy.types.Object:
    """Return the armature object that is meant by itself or by a mesh that it moves.

    Raises
    ------
    ObjectError
        If there is none.
    """
    if obj.type == "ARMATURE":
        return obj
    armature = find_armature(obj) if obj.type == "MESH" else None
    if armature is None:
        raise ObjectError(f'"{obj.name}" has no armature. Choose an armature, or a mesh with an Armature modifier.')
    return armature


def armature_named(name: str) -> bpy.types.Object:
    """Return the armature that is meant by the name of itself or of a mesh that it moves."""
    return rig_of(named_object(name))


def check_armature(armature: bpy.types.Object, *, written: bool) -> None:
    """Make sure that an armature can be read, and keys or poses of it can be written.

    Raises
    ------
    ObjectError
        If not; the message says why and what to do.
    """
    if armature.mode == "EDIT":
        raise ObjectError(f'The armature "{armature.name}" is in Edit Mode. Switch to Object Mode first.')
    if not len(armature_of(armature).bones):
        raise ObjectError(f'The armature "{armature.name}" has no bones.')
    matrix = np.array(armature.matrix_world, np.float64)[:3, :3]
    if abs(np.linalg.det(matrix)) <= np.finfo(float).tiny:
        raise ObjectError(f'The armature "{armature.name}" has a scale of zero. Set its scale first.')
    if written and armature.library is not None:
        raise ObjectError(
            f'The armature "{armature.name}" is linked from another file and cannot be animated here. Make it local '
            "first (Object > Relations > Make Local)."
        )
    if written and armature.override_library is not None:
        raise ObjectError(
            f'The armature "{armature.name}" is a library override and cannot be written to. Make it local first '
            "(Object > Relations > Make Local)."
        )


def bound_meshes(context: bpy.types.Context, obj: bpy.types.Object) -> list[bpy.types.Object]:
    """Return the mesh itself, or all meshes in the view layer that an armature moves, the largest first.

    Raises
    ------
    ObjectError
        If there is none.
    """
    if obj.type == "MESH":
        return [obj]
    found = [
        other
        for other in context.view_layer.objects  # type: ignore[union-attr]
        if other.type == "MESH" and find_armature(other) == obj and len(other.data.polygons)  # type: ignore[union-attr]
    ]
    if not found:
        raise ObjectError(
            f'The armature "{obj.name}" moves no mesh in this view layer. Bones are paired by the surface that they '
            "move: bind a mesh to it first."
        )
    return sorted(found, key=lambda other: -len(other.data.vertices))  # type: ignore[union-attr]


def read_body(context: bpy.types.Context, meshes: Sequence[bpy.types.Object]) -> RiggedBody:
    """Read meshes that one armature moves as one body, without their modifiers.

    Raises
    ------
    HierMatchError
        If a mesh is no surface.
    """
    armature = rig_of(meshes[0])
    bones = armature_of(armature).bones
    depsgraph = context.evaluated_depsgraph_get()
    vertices, triangles, weights, count = [], [], [], 0
    for obj in meshes:
        mesh, rig = read_mesh(obj, depsgraph, use_modifiers=False), read_rig(obj)
        vertices.append(mesh.vertices)
        triangles.append(mesh.triangles + count)
        count += mesh.vertex_count
        weights.append(csr_array((mesh.vertex_count, len(bones))) if rig is None else rig.weights)
    whole = TriangleMesh(np.concatenate(vertices), np.concatenate(triangles))
    names = tuple(bone.name for bone in bones)
    return RiggedBody(whole, names, read_skeleton(armature), csr_array(vstack(weights, format="csr")))


def object_rotation(armature: bpy.types.Object) -> NDArray[np.float64]:
    """Return how an object is turned in the world, (3, 3), without its scale."""
    return np.array(armature.matrix_world.to_quaternion().to_matrix(), np.float64)


def rest_matrices(armature: bpy.types.Object) -> NDArray[np.float64]:
    """Return axes and head of each bone at rest, in the armature's own space, (b, 4, 4)."""
    return np.array([bone.matrix_local for bone in armature_of(armature).bones], np.float64).reshape(-1, 4, 4)


def own_skeleton(armature: bpy.types.Object) -> Skeleton:
    """Read the bones at rest in the armature's own space."""
    bones = armature_of(armature).bones
    numbers = {bone.name: number for number, bone in enumerate(bones)}
    parents = np.array([-1 if bone.parent is None else numbers[bone.parent.name] for bone in bones], np.int64)
    heads, tails = (
        np.array([getattr(bone, end) for bone in bones], np.float64) for end in ("head_local", "tail_local")
    )
    return Skeleton(parents, heads.reshape(-1, 3), tails.reshape(-1, 3))


def in_own_spaces(pairing: BonePairing, source: bpy.types.Object, target: bpy.types.Object) -> BonePairing:
    """Bring pairs that were found in the world into the armatures' own spaces, where they hold wherever these stand."""
    turns = object_rotation(source), object_rotation(target)
    inverse = np.linalg.inv(np.array(target.matrix_world, np.float64))
    return BonePairing(
        pairing.sources,
        pairing.targets,
        pairing.scores,
        turns[1].T @ pairing.rotations @ turns[0],
        pairing.places @ inverse[:3, :3].T + inverse[:3, 3],
        turns[1].T @ pairing.upright @ turns[0],
    )
