# SPDX-License-Identifier: GPL-3.0-or-later
# mypy: disable-error-code="valid-type"
"""Write another answer of a match."""

from __future__ import annotations

from typing import TYPE_CHECKING, cast

import bpy

from ..common.access import view_layer_of
from ..common.errors import ObjectError
from ..common.translated_text import translated
from ..jobs.flipping import FlipJob
from ..jobs.job_operator import JobOperator
from ..properties.freshness import show_match
from ..properties.panel_state import picked, state_of
from ..properties.summary import is_of_picked
from ..scene.pair import named_side
from ..storage.halves import Half, find_half, find_keyed

if TYPE_CHECKING:
    from bpy.stub_internal.rna_enums import OperatorReturnItems


class HIERMATCH_OT_flip(JobOperator, bpy.types.Operator):
    """Choose between the answers of a match."""

    bl_idname = "hiermatch.flip"
    bl_label = "Use Another Answer"
    bl_description = (
        "Write another answer of the match, such as the one in which left and right are exchanged, without matching "
        "again. The first answer can be brought back"
    )

    object: bpy.props.StringProperty(
        name="Object",
        description="Name of one of the two matched objects; if empty, the match of what is picked in the panel is "
        "meant, or else that of the active object",
        options={"SKIP_SAVE"},
    )
    alternative: bpy.props.IntProperty(
        name="Alternative",
        description="Number of the answer: 0 is the direct one, and -1 the one after that which is written; of two "
        "answers, the other one",
        default=-1,
        min=-1,
        options={"SKIP_SAVE"},
    )
    prefix: bpy.props.StringProperty(
        name="Prefix",
        description="What the names that the match wrote start with; needed only for a named or active object that "
        "carries several matches",
        options={"SKIP_SAVE"},
    )

    doing = "Writing another answer"
    cancelled = "It was cancelled. The match is as it was"

    def _start(self, context: bpy.types.Context) -> FlipJob:
        """Read both objects."""
        return FlipJob(context, self._half(context), self.alternative)

    def _finish(self, context: bpy.types.Context, job: FlipJob) -> set[OperatorReturnItems]:
        """Write, remember and report."""
        stored = job.finish()
        summary = state_of(context).summary
        same = (summary.prefix, summary.key) == (job.prefix, job.key)
        show_match(context, stored, job.names, job.prefix, summary.seconds if same else 0.0)
        source, target = job.names
        self.report({"INFO"}, translated(f'Wrote the {stored.answer.name} match of "{source}" and "{target}"'))
        return {"FINISHED"}

    def _half(self, context: bpy.types.Context) -> Half:
        """Find one side of the match that is meant."""
        state, view_layer = state_of(context), view_layer_of(context)
        summary = state.summary
        if self.object:
            return find_half(named_side(view_layer, self.object), self.prefix)
        of_others = bool(summary.key) and not is_of_picked(cast("bpy.types.Scene", context.scene))
        if summary.key and self.prefix in ("", summary.prefix) and not of_others:
            role = "target" if summary.swapped else "source"
            return find_keyed(view_layer, summary.key, summary.prefix, role, summary.source)
        if view_layer.objects.active is None or (all(picked(state)) and of_others):
            raise ObjectError("There is no match to flip. Match two meshes first, or name one that carries a match.")
        return find_half(view_layer.objects.active, self.prefix)
