# SPDX-License-Identifier: GPL-3.0-or-later
"""Carry landmarks to the other side."""

from __future__ import annotations

from typing import TYPE_CHECKING, cast

import bpy

from ...common.phrases import counted
from ...common.translated_text import translated
from ...jobs.job_operator import JobOperator
from ...jobs.landmark_mirroring import MirrorJob
from ...properties.steering_lists import sync_lists
from .landmark_operator import pick_pair, steerable_pair

if TYPE_CHECKING:
    from bpy.stub_internal.rna_enums import OperatorReturnItems


class HIERMATCH_OT_mirror_landmarks(JobOperator, bpy.types.Operator):
    """Carry landmarks to the other side."""

    bl_idname = "hiermatch.mirror_landmarks"
    bl_label = "Mirror Landmarks"
    bl_description = (
        "Add a landmark on the other side for each that is on one side, by the symmetry of each mesh; the meshes may "
        "be in any pose"
    )

    doing = "Mirroring landmarks"
    cancelled = "It was cancelled. No landmark was added"

    def _start(self, context: bpy.types.Context) -> MirrorJob:
        """Read both objects."""
        source, target = steerable_pair(context)
        job = MirrorJob(context, source, target)
        pick_pair(context, source, target)
        return job

    def _finish(self, context: bpy.types.Context, job: MirrorJob) -> set[OperatorReturnItems]:
        """Add the landmarks and report."""
        added = job.finish()
        sync_lists(cast("bpy.types.Scene", context.scene))
        if job.left_out:
            self.report(
                {"WARNING"},
                translated(
                    f"{job.left_out} landmarks were left out: the two meshes were mirrored in different ways there, by "
                    "their match"
                ),
            )
        for note in job.notes if added else ():
            self.report({"WARNING"}, translated(note))
        if added or job.left_out:
            self.report({"INFO"}, translated(f"Added {counted(len(added), 'landmark')} on the other side"))
        else:
            said = "Nothing to mirror: all landmarks lie in the middle, or have one on the other side already"
            self.report({"INFO"}, translated(said))
        return {"FINISHED"}
