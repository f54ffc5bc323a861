# SPDX-License-Identifier: GPL-3.0-or-later
"""Make a match better around landmarks."""

from __future__ import annotations

from typing import TYPE_CHECKING, cast

import bpy

from ..common.errors import ObjectError
from ..common.translated_text import translated
from ..jobs.job_operator import JobOperator
from ..jobs.refining import RefineJob
from ..properties.freshness import show_match
from ..properties.panel_state import state_of
from ..properties.steering_lists import check_steered, common_match

if TYPE_CHECKING:
    from bpy.stub_internal.rna_enums import OperatorReturnItems

_FAR = 0.25
"""A landmark that is so far, in sqrt(area), from where the map had taken it calls for another map."""


class HIERMATCH_OT_refine(JobOperator, bpy.types.Operator):
    """Make a match better around landmarks."""

    bl_idname = "hiermatch.refine"
    bl_label = "Refine"
    bl_description = (
        "Make the match better around landmarks and locked points, in a fraction of the time of a match. What is wrong "
        "altogether, such as a leg on another leg, has to be matched again"
    )

    doing = "Refining"
    cancelled = "It was cancelled. The match is as it was"

    def _start(self, context: bpy.types.Context) -> RefineJob:
        """Read both objects."""
        state = state_of(context)
        if not state.use_landmarks:
            raise ObjectError("Use Landmarks is off, so there is nothing to refine around. Turn it on under Options.")
        scene = cast("bpy.types.Scene", context.scene)
        halves = common_match(scene)
        if halves is None:
            check_steered(scene)
            raise ObjectError("There is no match to refine. Pick two meshes as Source and Target, and match them.")
        return RefineJob(context, halves, (state.exclude_source, state.exclude_target))

    def _finish(self, context: bpy.types.Context, job: RefineJob) -> set[OperatorReturnItems]:
        """Write, remember and report."""
        stored = job.finish()
        show_match(context, stored, job.names, job.prefix, job.seconds)
        if job.moved > _FAR:
            self.report(
                {"WARNING"},
                translated("A landmark is far from where the map had taken it. If the result is wrong, match again."),
            )
        self.report(
            {"INFO"}, translated(f"Refined the match in {job.seconds:.1f} s. {state_of(context).summary.verdict}")
        )
        return {"FINISHED"}
