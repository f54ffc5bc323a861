# SPDX-License-Identifier: GPL-3.0-or-later
"""The vertex groups that are carried, and those of them that move bones."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from scipy.sparse import csr_array, vstack

from ..common.access import mesh_of
from ..common.errors import NothingToCarryError, ObjectError
from ..scene.armatures import armature_of, bone_of, find_armature, pose_of
from ..scene.character import parts_of, vertex_ranges
from ..scene.deform_layer import read_weights, write_weights
from ..storage.written_names import written_names

if TYPE_CHECKING:
    from collections.abc import Sequence

    import bpy
    from numpy.typing import NDArray

    from ..scene.character import Side


def chosen_groups(source: Side, choice: str) -> list[str]:
    """Return the names of the groups to carry, in their order.

    Parameters
    ----------
    source : bpy.types.Object or Character
        The object that has the groups, or the character whose parts have them.
    choice : {"ALL", "DEFORM", "SELECTED", "ACTIVE"}
        All groups, those of bones that deform, those of the bones that are selected, or the active group.  What a match
        wrote is none of them.

    Raises
    ------
    ObjectError
        If there are none such.
    """
    names = group_names(source)
    if not names:
        raise NothingToCarryError(
            f'"{source.name}" has no vertex groups, so there are no weights to carry over. Choose a weighted mesh as '
            "the Source."
        )
    if choice == "ALL":
        return names
    if choice == "ACTIVE":
        active = parts_of(source)[0].vertex_groups.active
        if active is None or active.name not in names:
            raise ObjectError(
                f'The active vertex group of "{source.name}" is one of a match. Select another one in its list of '
                "vertex groups."
            )
        return [active.name]
    armature = find_armature(source)
    if armature is None:
        raise ObjectError(
            f'"{source.name}" has no armature whose bones could tell which vertex groups to carry. Carry All of them, '
            "or add an Armature modifier."
        )
    bones = deforming_bones(source) if choice == "DEFORM" else _selected_bones(armature)
    found = [name for name in names if name in bones]
    if not found:
        if choice == "DEFORM":
            raise ObjectError(
                f'No bone of "{armature.name}" that deforms has a vertex group on "{source.name}". Carry All groups, '
                "or turn Deform on for its bones."
            )
        raise ObjectError(
            f'No bone of "{armature.name}" that is selected has a vertex group on "{source.name}". Carry All groups, '
            "or select others of its bones in Pose Mode."
        )
    return found


def group_names(side: Side) -> list[str]:
    """Return the names of all vertex groups that no match wrote; what hangs on a bone as a whole is in its group."""
    names: dict[str, None] = {}
    for part in parts_of(side):
        own = written_names(part)
        if bone_of(part):
            names[bone_of(part)] = None
        else:
            names |= dict.fromkeys(group.name for group in part.vertex_groups if group.name not in own)
    return list(names)


def deforming_bones(*objects: Side) -> set[str]:
    """Return the names of all bones that deform in the armatures of these objects."""
    armatures = [armature for armature in map(find_armature, objects) if armature is not None]
    return {bone.name for armature in armatures for bone in armature_of(armature).bones if bone.use_deform}


def locked_groups(side: Side) -> set[str]:
    """Return the names of the groups that are locked, on one part at least."""
    return {group.name for part in parts_of(side) for group in part.vertex_groups if group.lock_weight}


def write_groups(side: Side, names: Sequence[str], weights: csr_array, *, every: bool = False) -> None:
    """Write groups (n, g): unless `every` is wanted, on each part those only that have weight there, or are there."""
    for part, own in zip(parts_of(side), vertex_ranges(side), strict=True):
        found = csr_array(weights[own])
        held = np.bincount(found.tocoo().coords[1], minlength=len(names)) > 0
        kept = [number for number, name in enumerate(names) if every or held[number] or name in part.vertex_groups]
        write_weights(part, [names[number] for number in kept], csr_array(found[:, kept]))


def group_columns(side: Side, names: Sequence[str], chosen: NDArray[np.bool_] | None = None) -> csr_array:
    """Read the weights (n, g) of named groups; those that a part lacks, or that are not chosen, are empty there."""
    return csr_array(vstack([_part_columns(part, names, chosen) for part in parts_of(side)], format="csr"))


def _part_columns(obj: bpy.types.Object, names: Sequence[str], chosen: NDArray[np.bool_] | None) -> csr_array:
    if chosen is not None and bone_of(obj):  # a part of the source that is moved by that bone alone
        whole = np.array([name == bone_of(obj) for name in names]) & chosen
        return csr_array(np.tile(whole.astype(float), (len(mesh_of(obj).vertices), 1)))
    weights = read_weights(obj)
    places = np.array([obj.vertex_groups.find(name) for name in names])
    if chosen is not None:
        places[~chosen] = -1
    found = np.flatnonzero(places >= 0)
    picked = weights.tocsc()[:, places[found]].tocoo()
    rows, columns = picked.coords
    return csr_array((picked.data, (rows, found[columns])), shape=(weights.shape[0], len(names)))


def _selected_bones(armature: bpy.types.Object) -> set[str]:
    """Return the names of the selected bones: the bones themselves know until Blender 4.5, their poses from 5.0 on."""
    pose = pose_of(armature)
    bones: list[Any] = list(pose.bones)
    return {bone.name for bone in bones if (bone.select if hasattr(bone, "select") else bone.bone.select)}
