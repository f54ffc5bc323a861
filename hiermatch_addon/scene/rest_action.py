# SPDX-License-Identifier: GPL-3.0-or-later
"""Poses of an armature as actions: how its body stood, and the one in which it is at rest."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, cast

import numpy as np
from mathutils import Matrix

from .armatures import armature_of, pose_of
from .motion.action_curves import TRANSFORMS, CurveMaker, assign_action, played_action, rotation_channel
from .motion.carried_action_io import mark_carried, to_be_replaced

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    import bpy
    from numpy.typing import NDArray

_KEPT = "hiermatch_kept as it was"
"""Custom property of armature objects: the action in which the target looks as before it got another rest pose."""


def pose_bases(
    armature: bpy.types.Object,
    names: Sequence[str],
    turns: NDArray[np.float64],
    before: NDArray[np.float64],
    after: NDArray[np.float64],
) -> dict[str, Matrix]:
    """Find the transforms of pose bones that turn them from rest, and take their heads elsewhere, in world space.

    Parameters
    ----------
    armature : bpy.types.Object
        The armature object.
    names : sequence of str
        Names of bones; those that the armature lacks are passed over.
    turns : (b, 3, 3) array of float
        How each is to turn.
    before, after : (b, 3) array of float
        Where its head is, and where it is to be.

    Returns
    -------
    dict
        For each bone its transform against its parent, as Blender stores it; what constraints add is not asked.
    """
    world = armature.matrix_world
    into = world.inverted_safe()
    moves = np.tile(np.eye(4), (len(names), 1, 1))
    moves[:, :3, :3] = turns
    moves[:, :3, 3] = after - np.einsum("bij,bj->bi", turns, before)
    matrices = {name: Matrix(move.tolist()) for name, move in zip(names, moves, strict=True)}
    bones = [bone for bone in armature_of(armature).bones if bone.name in matrices]
    posed = {bone.name: into @ matrices[bone.name] @ world @ bone.matrix_local for bone in bones}
    bases = {}
    for bone in bones:
        parent = bone.parent
        above = {}
        if parent is not None:
            above = {
                "parent_matrix": posed.get(parent.name, parent.matrix_local),
                "parent_matrix_local": parent.matrix_local,
            }
        bases[bone.name] = bone.convert_local_to_pose(posed[bone.name], bone.matrix_local, invert=True, **above)
    return bases


def kept_pose(armature: bpy.types.Object) -> bpy.types.Action | None:
    """Find the action in which a target looks as it did before it was brought to another rest pose."""
    return cast("bpy.types.Action | None", cast("Any", armature).get(_KEPT))


def was_kept(armature: bpy.types.Object) -> bool:
    """Tell whether there was such an action, also if it is gone by now."""
    return _KEPT in cast("Any", armature)


def keep_pose(armature: bpy.types.Object, name: str, bases: Mapping[str, Matrix]) -> bpy.types.Action:
    """Keep how a target stood as an action of one frame, with a fake user, under a name; it stays as it is.

    Parameters
    ----------
    armature : bpy.types.Object
        The armature object.
    name : str
        Name of the action.
    bases : mapping
        The transforms of its bones, from `pose_bases`.

    Returns
    -------
    bpy.types.Action
        The action.
    """
    maker = CurveMaker(name, armature)
    _write(maker, armature, bases, show=False)
    cast("Any", armature)[_KEPT] = maker.action
    return maker.action


def make_rest_action(
    armature: bpy.types.Object, bases: Mapping[str, Matrix], *, show: bool
) -> tuple[bpy.types.Action, list[str]]:
    """Make an action of one frame in which a posed target is at rest, with a fake user.

    One that was made before is made anew, so that what plays it plays the new one, unless the user has edited it, or
    made it his own by another name.

    Parameters
    ----------
    armature : bpy.types.Object
        The armature object.
    bases : mapping
        The transforms of its bones, from `pose_bases`.
    show : bool
        Whether the armature takes the pose; else it stays as it is, with the action that it has.

    Returns
    -------
    action : bpy.types.Action
        The action.
    notes : list of str
        What is to be said of the one that was made before.
    """
    before, notes = to_be_replaced(armature, None)
    maker = CurveMaker(before or f"{armature.name} Rest", armature)
    _write(maker, armature, bases, show=show)
    mark_carried(maker.action, None)
    if show and played_action(armature) is None:
        assign_action(armature, maker.action)
    return maker.action, notes


def _write(maker: CurveMaker, armature: bpy.types.Object, bases: Mapping[str, Matrix], *, show: bool) -> None:
    """Write a pose into an action, and leave the armature in it if that is to be shown."""
    bones = pose_of(armature).bones
    for name, basis in bases.items():
        bone = bones[name]
        stood = {channel: list(getattr(bone, channel)) for channel in TRANSFORMS}
        bone.matrix_basis = basis
        for channel in ("location", rotation_channel(bone.rotation_mode), "scale"):
            for index, value in enumerate(getattr(bone, channel)):
                maker.curve(name, channel, index).keyframe_points.insert(1, value)
        if not show:
            for channel, values in stood.items():
                setattr(bone, channel, values)
