# SPDX-License-Identifier: GPL-3.0-or-later
"""The vertex groups that are carried, and those of them that move bones."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, cast

from ..common.errors import NothingToCarryError, ObjectError
from ..scene.armatures import armature_of, bone_of, find_armature
from ..scene.character import parts_of
from ..storage.written_names import written_names

if TYPE_CHECKING:
    import bpy

    from ..scene.character import Side

__all__ = ["chosen_groups", "deforming_bones", "group_names", "locked_groups"]


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


def _selected_bones(armature: bpy.types.Object) -> set[str]:
    """Return the names of the selected bones: the bones themselves know until Blender 4.5, their poses from 5.0 on."""
    pose = cast("bpy.types.Pose", armature.pose)
    bones: list[Any] = list(pose.bones)
    return {bone.name for bone in bones if (bone.select if hasattr(bone, "select") else bone.bone.select)}
