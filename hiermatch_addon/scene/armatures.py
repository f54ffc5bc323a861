# SPDX-License-Identifier: GPL-3.0-or-later
"""The rig of an object: which armature moves it, and its bones and weights as arrays."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, cast

import bpy
import numpy as np
from scipy.sparse import csr_array, vstack

from ...engine import Skeleton, row_shares
from ..common.access import mesh_of
from .character import Character, armatures_above, parts_of, successor
from .deform_layer import read_weights

if TYPE_CHECKING:
    from collections.abc import Sequence

    import mathutils
    from numpy.typing import NDArray

    from .character import Side


@dataclass(frozen=True, eq=False)
class SourceRig:
    """The armature that moves an object, in world space and at rest.

    Attributes
    ----------
    armature_name : str
        Name of the armature object.
    names : (b,) tuple of str
        Names of all its bones, in Blender's order.
    skeleton : Skeleton
        Their joints in the rest pose.
    weights : (n, b) csr_array of float
        How much each bone moves each vertex: rows sum to one, or are empty.  Columns of bones that do not deform are
        empty.
    """

    armature_name: str
    names: tuple[str, ...]
    skeleton: Skeleton
    weights: csr_array


def armature_of(obj: bpy.types.Object) -> bpy.types.Armature:
    """Return the armature data of an armature object."""
    return cast("bpy.types.Armature", obj.data)


def pose_of(obj: bpy.types.Object) -> bpy.types.Pose:
    """Return the pose of an armature object."""
    return cast("bpy.types.Pose", obj.pose)


def bone_of(obj: bpy.types.Object) -> str:
    """Return the bone that an object hangs on as a whole, as eyes and props do; empty if it hangs on none.

    Of a bone that does not deform it is the one above it that does, if there is one.
    """
    parent = obj.parent
    if parent is None or parent.type != "ARMATURE" or obj.parent_type != "BONE" or armature_modifier(obj) is not None:
        return ""
    bone = armature_of(parent).bones.get(obj.parent_bone)
    if bone is None:
        return ""
    deforming = [one for one in (bone, *bone.parent_recursive) if one.use_deform]
    return deforming[0].name if deforming else bone.name


def held_by(obj: bpy.types.Object, armature: bpy.types.Object) -> str:
    """Return the deforming bone of an armature that an object hangs on as a whole; empty if there is none."""
    bone = bone_of(obj) if obj.parent == armature else ""
    return bone if bone and armature_of(armature).bones[bone].use_deform else ""


def held_vertices(side: Side) -> NDArray[np.bool_]:
    """Tell which vertices of a side, (n,), are of parts that hang on a bone as a whole."""
    return np.concatenate([np.full(len(mesh_of(part).vertices), bool(bone_of(part))) for part in parts_of(side)])


def without_held(side: Side, weights: csr_array) -> csr_array:
    """Take the weights (n, b) of parts that hang on a bone as a whole away, such as of swords, if others do not."""
    held = held_vertices(side)
    if held.all() or not held.any():
        return weights
    result = csr_array(weights.multiply(~held[:, None]))
    result.eliminate_zeros()
    return result


def armature_modifier(obj: bpy.types.Object) -> bpy.types.ArmatureModifier | None:
    """Find the first Armature modifier of an object that has an armature."""
    for modifier in obj.modifiers:
        if modifier.type == "ARMATURE" and cast("bpy.types.ArmatureModifier", modifier).object is not None:
            return cast("bpy.types.ArmatureModifier", modifier)
    return None


def find_armature(side: Side) -> bpy.types.Object | None:
    """Find the armature that moves a side: what it is called after or has taken the place of that, else its first."""
    called = bpy.data.objects.get(side.name) if isinstance(side, Character) else None
    called = called and successor(called)
    if called is not None and any(called in armatures_above(part) for part in parts_of(side)):
        return called
    return next((found for found in map(_armature_of_part, parts_of(side)) if found is not None), None)


def _armature_of_part(obj: bpy.types.Object) -> bpy.types.Object | None:
    """Find the armature that moves an object: that of its first Armature modifier, or else its parent."""
    modifier = armature_modifier(obj)
    if modifier is not None:
        return modifier.object
    return obj.parent if obj.parent is not None and obj.parent.type == "ARMATURE" else None


def moving_armatures(side: Side) -> list[bpy.types.Object]:
    """Return the armatures of all Armature modifiers of a side that are not switched off altogether, each once."""
    modifiers = [
        modifier
        for obj in parts_of(side)
        for modifier in obj.modifiers
        if modifier.type == "ARMATURE" and (modifier.show_viewport or modifier.show_render)
    ]
    armatures = [cast("bpy.types.ArmatureModifier", modifier).object for modifier in modifiers]
    return list(dict.fromkeys(armature for armature in armatures if armature is not None))


def read_skeleton(armature: bpy.types.Object, space: NDArray[np.float64] | None = None) -> Skeleton:
    """Read the bones of an armature object as they are at rest, in world space, or as a matrix (4, 4) places them.

    Bones of a length that says nothing end where others hang on them.
    """
    bones = armature_of(armature).bones
    numbers = {bone.name: number for number, bone in enumerate(bones)}
    parents = np.array([-1 if bone.parent is None else numbers[bone.parent.name] for bone in bones], np.int64)
    matrix = np.array(armature.matrix_world, np.float64) if space is None else space

    def placed(points: list[mathutils.Vector]) -> NDArray[np.float64]:
        return np.array(points, np.float64).reshape(-1, 3) @ matrix[:3, :3].T + matrix[:3, 3]

    heads, tails = ([getattr(bone, end) for bone in bones] for end in ("head_local", "tail_local"))
    return Skeleton(parents, placed(heads), placed(tails)).with_likely_tails()


def bone_normals(armature: bpy.types.Object) -> NDArray[np.float64]:
    """Read the directions of the local z axes of an armature's bones at rest, in world space, (b, 3)."""
    axes = [bone.matrix_local.to_3x3().col[2] for bone in armature_of(armature).bones]
    return np.array(axes, np.float64) @ np.array(armature.matrix_world.to_3x3(), np.float64).T


def read_rig(side: Side) -> SourceRig | None:
    """Read the rig of a mesh object, or of a character.

    The meshes' own vertices belong to the rest pose, whatever pose the armature is in.  What hangs on a bone as a whole
    is moved by it alone.

    Returns
    -------
    SourceRig or None
        None if no armature moves it, or no vertex has a weight of one of its deforming bones.
    """
    armature = find_armature(side)
    if armature is None:
        return None
    names = tuple(bone.name for bone in armature_of(armature).bones)
    weights = bone_weights(side, armature, names)
    if weights.nnz == 0:
        return None
    return SourceRig(armature.name, names, read_skeleton(armature), weights)


def bone_weights(side: Side, armature: bpy.types.Object, names: Sequence[str]) -> csr_array:
    """Read how much each of some bones of an armature moves each vertex of all parts of a side.

    Returns
    -------
    (n, b) csr_array of float
        Rows sum to one, or are empty.  Columns of bones that do not deform, or do not exist, are empty.
    """
    bones = armature_of(armature).bones
    numbers = {name: number for number, name in enumerate(names) if name in bones and bones[name].use_deform}
    parts = [_part_weights(obj, armature, numbers, names) for obj in parts_of(side)]
    return row_shares(csr_array(vstack(parts, format="csr")))


def _part_weights(
    obj: bpy.types.Object, armature: bpy.types.Object, numbers: dict[str, int], names: Sequence[str]
) -> csr_array:
    """Read how much each bone moves the vertices of an object, (n, b), as its groups say."""
    vertices = len(mesh_of(obj).vertices)
    if obj.parent == armature and bone_of(obj) in names:
        place = list(names).index(bone_of(obj))
        held = (np.arange(vertices), np.full(vertices, place))
        return csr_array((np.ones(vertices), held), shape=(vertices, len(names)))
    groups = [group for group in obj.vertex_groups if group.name in numbers]
    if not groups:
        return csr_array((vertices, len(names)))
    columns = read_weights(obj)[:, [group.index for group in groups]].tocoo()
    places = np.array([numbers[group.name] for group in groups], np.int64)
    return csr_array((columns.data, (columns.row, places[columns.col])), shape=(vertices, len(names)))
