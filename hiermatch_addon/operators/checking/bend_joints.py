# SPDX-License-Identifier: GPL-3.0-or-later
# mypy: disable-error-code="valid-type"
"""Bend every joint of a rig in turn."""

from __future__ import annotations

from typing import TYPE_CHECKING, cast

import bpy

from ...common.errors import ObjectError
from ...common.phrases import counted
from ...common.translated_text import translated
from ...jobs.running import Startable
from ...scene.posing.exercise import begin_exercise, bending_bones, end_exercise, is_exercising
from ..reported_errors import reporting_errors
from .rig_operator import meant_armature

if TYPE_CHECKING:
    from bpy.stub_internal.rna_enums import OperatorReturnItems


class HIERMATCH_OT_test_poses(Startable, bpy.types.Operator):
    """Bend every joint of a rig in turn, to see how the mesh follows."""

    bl_idname = "hiermatch.test_poses"
    bl_label = "Test Poses"
    bl_description = (
        "Bend every joint of the target's rig in turn, with a marker for each on the timeline; pressed again, all of "
        "it is taken away"
    )
    modes = ("OBJECT", "POSE", "PAINT_WEIGHT")

    target: bpy.props.StringProperty(
        name="Target",
        description="Name of the mesh or armature; if empty, the one picked in the panel, that of the last retarget, "
        "or else the active object",
        options={"SKIP_SAVE"},
    )
    remove: bpy.props.BoolProperty(
        name="Remove", description="Take test poses away, and make none if there are none", options={"SKIP_SAVE"}
    )

    @reporting_errors
    def execute(self, context: bpy.types.Context) -> set[OperatorReturnItems]:
        """Make them, or take them away."""
        armature = meant_armature(context, self.target)
        if self.remove or is_exercising(armature):
            end_exercise(armature)
            self.report({"INFO"}, translated(f'The test poses of "{armature.name}" are gone'))
            return {"FINISHED"}
        bones = bending_bones(armature)
        if not bones:
            raise ObjectError(f'No bone of "{armature.name}" moves a mesh. Transfer the weights first.')
        last = begin_exercise(cast("bpy.types.Scene", context.scene), armature, bones)
        joints = counted(len(bones), "bone")
        self.report(
            {"INFO"},
            translated(f'"{armature.name}" bends {joints} in {last} frames. Space plays it, the button ends it'),
        )
        return {"FINISHED"}
