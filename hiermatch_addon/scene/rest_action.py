# SPDX-License-Identifier: GPL-3.0-or-later
"""A pose of an armature as an action that is kept, but not played."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, cast

import bpy
from mathutils import Matrix

from .armatures import armature_of
from .motion.action_curves import MADE_FOR, TRANSFORMS, assign_action, lent_action, rotation_channel

if TYPE_CHECKING:
    from collections.abc import Mapping

    import numpy as np
    from numpy.typing import NDArray

__all__ = ["AS_IT_WAS", "keep_pose", "kept_pose", "pose_bases", "was_kept"]

_MARKER = "hiermatch_rest"
"""Custom property of the actions that were made here: the name of the armature they were made for."""

_KIND = "hiermatch_pose"
"""Custom property of theirs: which pose of the armature it is, empty for the rest pose of a posed target."""

_KEPT = "hiermatch_kept"
"""With a kind behind it custom property of armature objects for which such a pose was kept: the action."""

AS_IT_WAS = "as it was"
"""Kind of the pose in which a target looks as it did before it was brought to another rest pose."""


def pose_bases(armature: bpy.types.Object, matrices: Mapping[str, NDArray[np.float64]]) -> dict[str, Matrix]:
    """Find the transforms of pose bones that move them as wanted.

    Parameters
    ----------
    armature : bpy.types.Object
        The armature object.
    matrices : mapping from str to (4, 4) array of float
        For each bone how it is to move in world space from its rest.

    Returns
    -------
    dict
        For each bone its transform against its parent, as Blender stores it; what constraints add is not asked.
    """
    world = armature.matrix_world
    into = world.inverted_safe()
    bones = [bone for bone in armature_of(armature).bones if bone.name in matrices]
    posed = {bone.name: into @ Matrix(matrices[bone.name].tolist()) @ world @ bone.matrix_local for bone in bones}
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


def kept_pose(armature: bpy.types.Object, kind: str = "") -> bpy.types.Action | None:
    """Find the pose of a kind that was kept for an armature, also if that was renamed since."""
    kept = cast("Any", armature).get(_property(kind))
    if kept is not None:
        return kept
    for action in bpy.data.actions:
        found: Any = action
        if found.get(_MARKER) == armature.name and found.get(_KIND, "") == kind:
            return action
    return None


def was_kept(armature: bpy.types.Object, kind: str = "") -> bool:
    """Tell whether a pose of a kind was kept for an armature, also if the action is gone by now."""
    return _property(kind) in cast("Any", armature) or kept_pose(armature, kind) is not None


def keep_pose(
    armature: bpy.types.Object, name: str, bases: Mapping[str, Matrix], *, show: bool, kind: str = ""
) -> bpy.types.Action:
    """Keep a pose as an action of one frame, with a fake user; one that was made before is replaced.

    Parameters
    ----------
    armature : bpy.types.Object
        The armature object.
    name : str
        Name of the action.
    bases : mapping
        The transforms of its bones, from `pose_bases`.
    show : bool
        Whether the armature takes the pose; else it stays as it is, with the action that it has.
    kind : str
        Which pose it is: one of the same kind is replaced.

    Returns
    -------
    bpy.types.Action
        The action.
    """
    old = kept_pose(armature, kind)
    if old is not None:
        bpy.data.actions.remove(old)  # another one of that name is the user's own
    action: Any = bpy.data.actions.new(name)
    action.use_fake_user = True
    action[_MARKER] = action[MADE_FOR] = armature.name
    action[_KIND] = kind
    cast("Any", armature)[_property(kind)] = action
    pose = cast("bpy.types.Pose", armature.pose)
    with lent_action(armature) as animation:
        animation.action = action
        for bone_name, basis in bases.items():
            bone = pose.bones[bone_name]
            stood = {channel: list(getattr(bone, channel)) for channel in TRANSFORMS}
            bone.matrix_basis = basis
            for channel in ("location", rotation_channel(bone.rotation_mode), "scale"):
                bone.keyframe_insert(channel, frame=1, group=bone_name)
            if not show:
                for channel, value in stood.items():
                    setattr(bone, channel, value)
    if show and animation.action is None:
        assign_action(armature, action)
    return action


def _property(kind: str) -> str:
    """Return the custom property of an armature object that leads to the pose of a kind."""
    return f"{_KEPT} {kind}".strip()
