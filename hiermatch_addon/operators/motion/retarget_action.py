# SPDX-License-Identifier: GPL-3.0-or-later
# mypy: disable-error-code="valid-type"
"""Carry actions, or the pose of the moment, from one armature to others."""

from __future__ import annotations

from typing import TYPE_CHECKING, cast

import bpy

from ....engine import MotionSettings
from ...scene.motion.rigs import rig_of
from ...transfers.motion.motion_job import MotionJob
from ...transfers.options.motion import MotionOptions, MotionPlan, motion_plan
from .motion_operator import MotionOperator

if TYPE_CHECKING:
    from ...jobs.transfer_job import TransferOptions
    from ...scene.character import Side


class HIERMATCH_OT_retarget_action(MotionOptions, MotionOperator, bpy.types.Operator):
    """Carry actions over."""

    bl_idname = "hiermatch.retarget_action"
    bl_label = "Retarget Action"
    bl_description = (
        "Carry actions of the source's armature to others, whatever their bones are called, how many there are, and "
        "how they rest. Bones are paired first if that has not been done"
    )

    def _make_job(
        self, context: bpy.types.Context, source: Side, targets: list[Side], options: TransferOptions
    ) -> MotionJob:
        plan = motion_plan(cast("bpy.types.Scene", context.scene), self, rig_of(source))
        return MotionJob(context, source, targets, plan, options)


class HIERMATCH_OT_retarget_pose(MotionOperator, bpy.types.Operator):
    """Carry the pose of the moment over."""

    bl_idname = "hiermatch.retarget_pose"
    bl_label = "Retarget Pose"
    bl_description = "Pose other armatures as the source's stands now. Bones are paired first if that has not been done"

    keep_hands: bpy.props.BoolProperty(
        name="Hands on Body",
        description="Where a hand touches the body or the other hand in the source, bend the target's arm so that it "
        "does so too",
    )

    def _make_job(
        self, context: bpy.types.Context, source: Side, targets: list[Side], options: TransferOptions
    ) -> MotionJob:
        plan = MotionPlan((), MotionSettings(hands=self.keep_hands))
        return MotionJob(context, source, targets, plan, options)
