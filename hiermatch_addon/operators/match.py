# SPDX-License-Identifier: GPL-3.0-or-later
# mypy: disable-error-code="valid-type"
"""Match two objects."""

from __future__ import annotations

from typing import TYPE_CHECKING, cast

import bpy

from ..common.access import layout_of, view_layer_of
from ..common.translated_text import translated
from ..jobs.job_operator import JobOperator
from ..jobs.match_job import MatchJob, job_options
from ..properties.freshness import show_match
from ..properties.panel_state import picked, state_of
from ..properties.properties import OUTPUT_NAMES, MatchOptions
from ..properties.setting_groups import APART, shown_groups
from ..properties.summary import pick_named
from ..scene.pair import find_pair, lacking_meshes, left_out_note, name_of, selected_targets
from .pair_operator import NamedPair

if TYPE_CHECKING:
    from bpy.stub_internal.rna_enums import OperatorReturnItems


class HIERMATCH_OT_match(MatchOptions, NamedPair, JobOperator, bpy.types.Operator):
    """Find corresponding points of two meshes, whatever their pose, and write them on both."""

    bl_idname = "hiermatch.match"
    bl_label = "Match"
    bl_description = (
        "Find corresponding points of two meshes, whatever their pose, and write them on both as vertex groups and "
        "colors"
    )

    doing = "Matching"
    cancelled = "The match was cancelled. Nothing was written"

    _named = False  # whether a script says which two
    _left_out = ""  # which parts of the source's own character, as a sentence

    @classmethod
    def _lacking(cls, context: bpy.types.Context) -> str:
        return lacking_meshes(view_layer_of(context))

    def draw(self, _context: bpy.types.Context) -> None:
        """Show the options in the Adjust Last Operation panel."""
        layout = layout_of(self)
        layout.use_property_split = True
        settings = [name for _, names in shown_groups(self) for name in names]
        for name in ("source", "target", *APART, *settings, *OUTPUT_NAMES):
            layout.prop(self, name)

    def _start(self, context: bpy.types.Context) -> MatchJob:
        """Read both objects."""
        state = state_of(context)
        self._named = bool(self.source and self.target)
        source, target = find_pair(context, (self.source, self.target), picked(state))
        parts = [] if self.target or picked(state)[1] else selected_targets(context, source)[1]
        self._left_out = left_out_note(source, parts) if parts else ""
        job = MatchJob(context, source, target, job_options(self))
        # So that Adjust Last Operation repeats the match of the same two, whatever is selected by then.
        layer = view_layer_of(context)
        self.source, self.target = name_of(layer, source), name_of(layer, target)
        return job

    def _finish(self, context: bpy.types.Context, job: MatchJob) -> set[OperatorReturnItems]:
        """Write, remember and report."""
        outcome = job.finish()
        if self._named:
            pick_named(cast("bpy.types.Scene", context.scene), self.source, self.target)
        show_match(context, outcome.stored, outcome.stored.names, self.prefix, outcome.seconds)
        if self._left_out:
            self.report({"INFO"}, translated(self._left_out))
        for note in outcome.stored.notes:
            self.report({"WARNING"}, translated(note))
        points, seconds = len(outcome.result.source_points), outcome.seconds
        both = '"{}" and "{}"'.format(*outcome.stored.names)
        verdict = state_of(context).summary.verdict
        if verdict:
            said = translated(f"Matched {points} points of {both} in {seconds:.1f} s. {verdict}")
        else:
            said = translated(f"Matched {points} points of {both} in {seconds:.1f} s")
        self.report({"INFO"}, said)
        return {"FINISHED"}
