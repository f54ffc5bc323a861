# SPDX-License-Identifier: GPL-3.0-or-later
"""Pair the bones of rigs by the surface that they move."""

from __future__ import annotations

from typing import TYPE_CHECKING

import bpy

from ...common.translated_text import translated
from ...jobs.job import job_options
from ...jobs.pairing_job import PairingJob
from ...properties.motion_properties import motion_of
from ...properties.panel_state import state_of
from .motion_operator import MotionOperator

if TYPE_CHECKING:
    from bpy.stub_internal.rna_enums import OperatorReturnItems

__all__ = ["HIERMATCH_OT_pair_bones"]


class HIERMATCH_OT_pair_bones(MotionOperator, bpy.types.Operator):
    """Pair bones."""

    bl_idname = "hiermatch.pair_bones"
    bl_label = "Pair Bones"
    bl_description = (
        "Find out which bones of two rigs belong together by the surface that they move, whatever they are called. "
        "The bodies are matched first if that has not been done"
    )
    bl_options = {"REGISTER", "UNDO"}

    doing = "Pairing bones"

    def _start(self, context: bpy.types.Context) -> PairingJob:
        """Read all objects."""
        source, targets = self._rigs(context)
        return PairingJob(context, source, targets, job_options(state_of(context)))

    def _finish(self, context: bpy.types.Context, job: PairingJob) -> set[OperatorReturnItems]:
        """Write, remember and report."""
        paired = job.finish(context)
        self._remember_pairs(context, paired)
        notes = list(dict.fromkeys(note for one in paired for note in one.notes))
        for note in notes:
            self.report({"WARNING"}, translated(note))
        motion_of(context).report = "\n".join(notes)
        return {"FINISHED"}
