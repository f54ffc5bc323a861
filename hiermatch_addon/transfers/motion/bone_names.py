# SPDX-License-Identifier: GPL-3.0-or-later
"""Names of bones by a standard: found for an armature, and given to it, so that all that knows a bone still does."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, cast

import bpy
import numpy as np

from ....engine import humanoid_bones
from ...common.errors import ObjectError
from ...common.phrases import listed
from ...properties.bone_pairs import bone_pairs_of, rows_of
from ...scene.armatures import armature_of, read_skeleton
from ...scene.motion.action_curves import actions_of, bone_curves, renamed_paths
from ...scene.motion.carried_action_io import still_as_made
from ...scene.shape_key_io import keys_of
from .name_tables import NAME_TABLES

if TYPE_CHECKING:
    from collections.abc import Mapping


def names_by_table(armature: bpy.types.Object, known: str, wanted: str) -> dict[str, str]:
    """Find the names that bones of a person's rig have in a standard.

    Parameters
    ----------
    armature : bpy.types.Object
        The armature.
    known : str
        By what it is known what the bones are: "JOINTS", or the standard whose names they have.
    wanted : str
        The standard whose names they are to have.

    Returns
    -------
    dict
        The new name of each bone that the standard has a name for.

    Raises
    ------
    HierMatchError
        If the bones cannot be identified.
    """
    bones = armature_of(armature).bones
    if known == "JOINTS":
        deforming = np.array([bone.use_deform for bone in bones], bool)
        found = humanoid_bones(read_skeleton(armature), deforming, np.array([0.0, 0, 1]))
        what = {role: bones[number].name for role, number in found.items()}
    else:
        what = {role: name for role, name in NAME_TABLES[known].items() if name in bones}
        if not what:
            raise ObjectError(f'No bone of "{armature.name}" has a name of that standard. Choose another one.')
    return {name: NAME_TABLES[wanted][role] for role, name in what.items()}


def names_by_source(scene: bpy.types.Scene, source: bpy.types.Object, armature: bpy.types.Object) -> dict[str, str]:
    """Find the names of the bones of another armature with which bones are paired: for each the best one, used once.

    Raises
    ------
    ObjectError
        If none are paired.
    """
    rows = [row for row in rows_of(scene, source, armature) if row.source and row.target]
    if not rows:
        raise ObjectError(f'No bones of "{source.name}" and "{armature.name}" are paired. Pair their bones first.')
    names: dict[str, str] = {}
    for row in sorted(rows, key=lambda row: -row.score):
        if row.target not in names and row.source not in names.values():
            names[row.target] = row.source
    return names


def rename_bones(scene: bpy.types.Scene, armature: bpy.types.Object, names: Mapping[str, str]) -> int:
    """Rename bones of an armature, the vertex groups that they move, and what actions and pairs of bones call them.

    Parameters
    ----------
    scene : bpy.types.Scene
        With the table of pairs.
    armature : bpy.types.Object
        The armature object.
    names : mapping
        New names of bones.

    Returns
    -------
    int
        How many bones have another name now.

    Raises
    ------
    ObjectError
        If a name is taken, or another armature would no longer be moved; nothing is changed then.
    """
    bones = armature_of(armature).bones
    changed = {old: new for old, new in names.items() if old != new and old in bones}
    _check_free(armature, changed)
    _check_own_actions(armature, changed)
    paths = [wanted for action in actions_of(armature) for wanted in renamed_paths(action, armature, changed)]
    places = _group_names(armature, changed)
    rows = [
        (row, {side: changed.get(getattr(row, side), getattr(row, side)) for side in sides})
        for row in bone_pairs_of(scene)
        for sides in [[side for side in ("source", "target") if getattr(row, f"{side}_rig") == armature]]
        if sides
    ]
    # Blender lets vertex groups, constraints, drivers and what is played follow.  In two steps, so that names may be
    # exchanged.
    passing = {old: f"hiermatch {number}" for number, old in enumerate(changed)}
    with still_as_made(actions_of(armature)):
        for old, between in passing.items():
            bones[old].name = between
        for old, between in passing.items():
            bones[between].name = changed[old]
        for curve, path, group, group_name in paths:
            if curve.data_path != path:
                curve.data_path = path
            if group is not None and group.name != group_name:
                group.name = group_name
    for place, name, new in places:
        setattr(place, name, new)
    for row, sides in rows:
        seen = row.is_seen
        for side, name in sides.items():
            setattr(row, side, name)
        row.name, row.is_seen = row.target, seen  # naming a bone by hand forgets what was seen of another one
    return len(changed)


def _check_free(armature: bpy.types.Object, changed: Mapping[str, str]) -> None:
    """Make sure that nothing else has the new names.

    Raises
    ------
    ObjectError
        If something has.
    """
    bones = armature_of(armature).bones
    taken = [new for new in changed.values() if new in bones and new not in changed]
    if taken:
        raise ObjectError(
            f'"{armature.name}" has other bones that are called {listed(taken)} already. Rename them first.'
        )
    for obj in _moved_by(armature):
        groups = [new for new in changed.values() if new in obj.vertex_groups and new not in bones]
        if groups:
            raise ObjectError(
                f'"{obj.name}" has other vertex groups that are called {listed(groups)} already. Rename them first.'
            )


def _check_own_actions(armature: bpy.types.Object, changed: Mapping[str, str]) -> None:
    """Make sure that no other armature is moved by what Blender lets follow: paths of bones in what this one plays.

    Raises
    ------
    ObjectError
        If one is.
    """
    mine = {each for obj in bpy.data.objects if obj.data == armature.data for each in _plays(obj)}
    for obj in bpy.data.objects:
        if obj.type != "ARMATURE" or obj.data == armature.data:
            continue
        shared = sorted({name for name, _ in mine & _plays(obj)})
        moving = [
            name for name in shared if any(bone in changed for bone, _, _ in bone_curves(bpy.data.actions[name], obj))
        ]
        if moving:
            raise ObjectError(
                f'"{obj.name}" plays {listed(moving)} as well, and would no longer be moved by it. Give '
                f'"{armature.name}" a copy first: press the number beside its name in the Action Editor.'
            )


def _plays(obj: bpy.types.Object) -> set[tuple[str, str]]:
    """Return what an object plays, or has on tracks of the NLA editor: names of actions, and of their slots."""
    animation: Any = obj.animation_data
    players = [] if animation is None else [animation, *(one for track in animation.nla_tracks for one in track.strips)]
    return {
        (one.action.name, getattr(getattr(one, "action_slot", None), "identifier", ""))
        for one in players
        if one.action is not None
    }


def _group_names(armature: bpy.types.Object, changed: Mapping[str, str]) -> list[tuple[Any, str, str]]:
    """List where modifiers and shape keys name vertex groups that will have other names: owner, property, new name."""
    owners: list[Any] = []
    for obj in _moved_by(armature):
        keys = keys_of(obj)
        owners += [*obj.modifiers, *(keys.key_blocks if keys is not None else ())]
    found = []
    for owner in owners:
        for name in (one.identifier for one in owner.bl_rna.properties if "vertex_group" in one.identifier):
            value = getattr(owner, name)
            if isinstance(value, str) and value in changed and not owner.is_property_readonly(name):
                found.append((owner, name, changed[value]))
    return found


def _moved_by(armature: bpy.types.Object) -> list[bpy.types.Object]:
    """Return the mesh objects whose vertex groups may follow the bones of an armature."""
    return [obj for obj in bpy.data.objects if obj.type == "MESH" and armature.data in _armatures_of(obj)]


def _armatures_of(obj: bpy.types.Object) -> list[bpy.types.ID | None]:
    """Return the data of the armatures whose bones Blender lets the groups of an object follow, also if it is off."""
    rigs: list[Any] = [cast("Any", one).object for one in obj.modifiers if one.type == "ARMATURE"]
    rigs += [obj.parent] if obj.parent_type == "ARMATURE" else []
    return [rig.data for rig in rigs if rig is not None]
