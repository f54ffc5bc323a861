# SPDX-License-Identifier: GPL-3.0-or-later
"""The pose of an armature, put aside in the file for a while, and brought back as it was."""

from __future__ import annotations

import json
from typing import TYPE_CHECKING, Any, Final, cast

from ..armatures import armature_of, pose_of
from ..motion.action_curves import TRANSFORMS, played_action

if TYPE_CHECKING:
    import bpy

_STATE: Final = "hiermatch_pose_aside"
"""Custom property of the armature: what was put aside, as a JSON text."""

_ACTION: Final = "hiermatch_action_aside"
"""Custom property of the armature: its action, as a pointer that follows renaming."""


def is_aside(armature: bpy.types.Object, why: str) -> bool:
    """Tell whether the pose of an armature was put aside for a purpose."""
    return json.loads(cast("Any", armature).get(_STATE, "{}")).get("why") == why


def own_action(armature: bpy.types.Object) -> bpy.types.Action | None:
    """Return the action that an armature plays, or will play again once its pose is brought back; None for none."""
    owner: Any = armature
    return owner.get(_ACTION) if _STATE in owner else played_action(armature)


def put_aside(armature: bpy.types.Object, why: str) -> None:
    """Remember pose, action and constraints of an armature, and let it stand at rest, played and held by nothing.

    What another purpose put aside before is brought back first.
    """
    bring_back(armature)
    owner: Any = armature
    animation: Any = armature.animation_data or armature.animation_data_create()
    tweaked = animation.use_tweak_mode
    animation.use_tweak_mode = False  # in which the action could not be taken away
    slot = getattr(animation, "action_slot", None)
    bones = pose_of(armature).bones
    held = [(bone.name, one.name) for bone in bones for one in bone.constraints if not one.mute]
    owner[_STATE] = json.dumps(
        {
            "why": why,
            "slot": slot.identifier if slot is not None else "",
            "nla": animation.use_nla,
            "tweaked": tweaked,
            "position": armature_of(armature).pose_position,
            "pose": {bone.name: [list(getattr(bone, channel)) for channel in TRANSFORMS] for bone in bones},
            "held": held,
        }
    )
    if animation.action is not None:
        owner[_ACTION] = animation.action
    animation.action, animation.use_nla = None, False
    armature_of(armature).pose_position = "POSE"
    for bone in bones:
        bone.matrix_basis.identity()
    for holder, name in held:
        bones[holder].constraints[name].mute = True


def bring_back(armature: bpy.types.Object) -> None:
    """Undo `put_aside`; nothing if nothing was.  Bones and constraints that are gone since are passed over."""
    owner: Any = armature
    if _STATE not in owner:
        return
    state = json.loads(owner[_STATE])
    animation: Any = armature.animation_data or armature.animation_data_create()
    animation.action = owner.get(_ACTION)
    if state["slot"] and animation.action is not None and state["slot"] in animation.action.slots:
        animation.action_slot = animation.action.slots[state["slot"]]
    animation.use_nla, owner.data.pose_position = state["nla"], state["position"]
    animation.use_tweak_mode = state.get("tweaked", False)
    bones = pose_of(armature).bones
    for name, values in state["pose"].items():
        if name in bones:
            for channel, value in zip(TRANSFORMS, values, strict=True):
                setattr(bones[name], channel, value)
    for name, constraint in state["held"]:
        if name in bones and constraint in bones[name].constraints:
            bones[name].constraints[constraint].mute = False
    del owner[_STATE]
    if _ACTION in owner:
        del owner[_ACTION]
