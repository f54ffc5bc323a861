# SPDX-License-Identifier: GPL-3.0-or-later
# mypy: disable-error-code="valid-type"
"""Carry actions, or the pose of the moment, from one armature to others."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, cast

import bpy

from ....engine import MotionSettings
from ...common.errors import ObjectError
from ...common.translated_text import translated
from ...jobs.job import job_options
from ...jobs.motion_job import MotionJob, MotionPlan
from ...properties.motion_properties import MotionOptions, motion_of
from ...properties.panel_state import state_of
from ...scene.motion.action_curves import actions_of, bone_curves, named_action, played_action
from ...scene.motion.nla_strips import strip_actions
from ...scene.motion.rigged_body import rig_of
from .motion_operator import MotionOperator

if TYPE_CHECKING:
    from bpy.stub_internal.rna_enums import OperatorReturnItems

    from ...jobs.motion_job import CarriedMotion

__all__ = ["HIERMATCH_OT_retarget_action", "HIERMATCH_OT_retarget_pose"]

_props: Any = bpy.props  # whose functions Blender's stubs declare to return nothing


class _Carrier(MotionOperator):
    """What both have in common."""

    def _report(self, context: bpy.types.Context, carried: list[CarriedMotion]) -> None:
        """Say what was done for each target, and what is to be known."""
        self._remember_pairs(context, [one.paired for one in carried if one.paired is not None])
        notes = list(dict.fromkeys(note for one in carried for note in one.notes))
        for note in notes:
            self.report({"WARNING"}, translated(note))
        said = []
        for one in carried:
            if one.actions:
                names = ", ".join(one.actions)
                said.append(f'"{one.target}" has the new action "{names}"')
            else:
                said.append(f'"{one.target}" was posed')
        for text in said:
            self.report({"INFO"}, translated(text))
        motion_of(context).report = "\n".join([*said, *notes])


class HIERMATCH_OT_retarget_action(MotionOptions, _Carrier, bpy.types.Operator):
    """Carry actions over."""

    bl_idname = "hiermatch.retarget_action"
    bl_label = "Retarget Action"
    bl_description = (
        "Carry actions of the source's armature to others, whatever their bones are called, how many there are, and "
        "how they rest. Bones are paired first if that has not been done"
    )
    bl_options = {"REGISTER", "UNDO"}

    action: bpy.props.StringProperty(
        name="Action",
        description="Name of the action to carry over; if empty, those that Actions says",
        options={"SKIP_SAVE"},
    )
    several: bpy.props.CollectionProperty(
        name="Several Actions",
        description="Names of several actions to carry over",
        type=bpy.types.OperatorFileListElement,
        options={"HIDDEN", "SKIP_SAVE"},
    )
    actions: bpy.props.EnumProperty(
        name="Actions",
        description="Which actions of the source are carried over",
        items=[
            ("ACTIVE", "Active", "The one that the source plays"),
            ("ALL", "All", "All actions of the file that move bones of the source"),
        ],
        default="ACTIVE",
    )
    strips: bpy.props.BoolProperty(
        name="NLA Strips",
        description="Carry the actions of the source's NLA strips over as well, and copy the strips",
    )
    assign: bpy.props.BoolProperty(
        name="Play", description="Let the target play the new action, if it is one only", default=True
    )

    def _start(self, context: bpy.types.Context) -> MotionJob:
        """Read all objects."""
        source, targets = self._rigs(context)
        names = tuple(self._names(rig_of(source)))
        render = cast("bpy.types.Scene", context.scene).render
        settings = MotionSettings(
            feet=self.keep_feet,
            hands=self.keep_hands,
            stride=self.stride,
            in_place=self.in_place,
            rate=render.fps / render.fps_base,
        )
        plan = MotionPlan(names, settings, self.keying, self.tolerance, assign=self.assign, strips=self.strips)
        return MotionJob(context, source, targets, plan, job_options(state_of(context)))

    def _finish(self, context: bpy.types.Context, job: MotionJob) -> set[OperatorReturnItems]:
        """Write, remember and report."""
        self._report(context, job.finish(context))
        return {"FINISHED"}

    def _names(self, rig: bpy.types.Object) -> list[str]:
        """Names of the actions to carry over.

        Raises
        ------
        ObjectError
            If there is none, or one does not move the rig.
        """
        names = [item.name for item in self.several] or ([self.action] if self.action else [])
        for name in names:
            if not any(True for _ in bone_curves(named_action(name), rig)):
                raise ObjectError(f'The action "{name}" moves no bone of "{rig.name}". Choose one that does.')
        if not names and self.actions == "ALL":
            names = [action.name for action in actions_of(rig)]
        if not names and self.actions == "ACTIVE":
            played = played_action(rig)
            names = [played.name] if played is not None and any(True for _ in bone_curves(played, rig)) else []
        if self.strips:
            known = {action.name for action in actions_of(rig)}
            names = list(dict.fromkeys([*names, *(name for name in strip_actions(rig) if name in known)]))
        if not names:
            raise ObjectError(f'"{rig.name}" has no action that moves its bones. Give it one, or name an action.')
        return names


class HIERMATCH_OT_retarget_pose(_Carrier, bpy.types.Operator):
    """Carry the pose of the moment over."""

    bl_idname = "hiermatch.retarget_pose"
    bl_label = "Retarget Pose"
    bl_description = "Pose other armatures as the source's stands now. Bones are paired first if that has not been done"
    bl_options = {"REGISTER", "UNDO"}

    keep_hands: bpy.props.BoolProperty(
        name="Keep Hands on Body",
        description="Where a hand touches the body or the other hand in the source, bend the target's arm so that it "
        "does so too",
    )

    def _start(self, context: bpy.types.Context) -> MotionJob:
        """Read all objects."""
        source, targets = self._rigs(context)
        plan = MotionPlan((), MotionSettings(hands=self.keep_hands))
        return MotionJob(context, source, targets, plan, job_options(state_of(context)))

    def _finish(self, context: bpy.types.Context, job: MotionJob) -> set[OperatorReturnItems]:
        """Write, remember and report."""
        self._report(context, job.finish(context))
        return {"FINISHED"}
