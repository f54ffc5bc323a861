# SPDX-License-Identifier: GPL-3.0-or-later
# mypy: disable-error-code="valid-type"
"""Match two objects."""

from __future__ import annotations

from typing import TYPE_CHECKING, cast

import bpy

from ...engine import HierMatchError
from ..access import layout_of, progress_of, state_of, view_layer_of, window_manager_of
from ..freshness import refresh
from ..job import JobOptions, MatchJob
from ..pair import find_pair
from ..properties import OUTPUT_NAMES, MatchOptions, match_settings
from ..redraw import redraw_panels
from ..running import can_start
from ..setting_groups import APART, shown_groups
from ..summary import remember

if TYPE_CHECKING:
    from bpy.stub_internal.rna_enums import OperatorReturnItems


__all__ = ["HIERMATCH_OT_match"]

_SLICE = 0.05
"""Seconds of work between two events, so that the window stays responsive."""

_PAUSE = 0.01
"""Seconds between the timer's events."""


class HIERMATCH_OT_match(MatchOptions, bpy.types.Operator):
    """Find corresponding points of two meshes, whatever their pose, and write them on both."""

    bl_idname = "hiermatch.match"
    bl_label = "Match"
    bl_description = (
        "Find corresponding points of two meshes, whatever their pose, and write them on both as vertex groups and "
        "colors"
    )
    bl_options = {"REGISTER", "UNDO"}

    source: bpy.props.StringProperty(
        name="Source",
        description="Name of the object whose points are matched; if empty, the one picked in the panel or else the "
        "active object",
    )
    target: bpy.props.StringProperty(
        name="Target",
        description="Name of the object on which the corresponding points are sought; if empty, the one picked in the "
        "panel or else the other selected mesh",
    )

    _job: MatchJob
    _timer: bpy.types.Timer
    _workspace: str

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        """Allow it in Object Mode, when no other match is running and there are two meshes."""
        if not can_start(cls, context):
            return False
        if sum(obj.type == "MESH" for obj in view_layer_of(context).objects) < 2:
            cls.poll_message_set("Two mesh objects are needed")
            return False
        return True

    def execute(self, context: bpy.types.Context) -> set[OperatorReturnItems]:
        """Match without a pause."""
        manager = window_manager_of(context)
        manager.progress_begin(0, 100)
        try:
            job = self._start(context)
            try:
                while not job.advance(view_layer_of(context), _SLICE):
                    manager.progress_update(min(99, int(100 * job.progress.fraction)))  # 100 breaks the cursor
                return self._finish(context, job)
            finally:
                job.close()
        except HierMatchError as error:
            self.report({"ERROR"}, str(error))
            return {"CANCELLED"}
        finally:
            manager.progress_end()

    def invoke(self, context: bpy.types.Context, _event: bpy.types.Event) -> set[OperatorReturnItems]:
        """Match in slices, while the window stays alive."""
        try:
            self._job = self._start(context)
        except HierMatchError as error:
            self.report({"ERROR"}, str(error))
            return {"CANCELLED"}
        progress = progress_of(context)
        progress.cancel, progress.fraction, progress.label = False, 0.0, self._job.progress.label
        self._timer = window_manager_of(context).event_timer_add(_PAUSE, window=context.window)
        self._workspace = context.workspace.name if context.workspace else ""
        window_manager_of(context).modal_handler_add(self)
        return {"RUNNING_MODAL"}

    def modal(self, context: bpy.types.Context, event: bpy.types.Event) -> set[OperatorReturnItems]:
        """Do one slice of work at each of the timer's events."""
        if event.type == "ESC" or progress_of(context).cancel:
            self.cancel(context)
            self.report({"INFO"}, "The match was cancelled. Nothing was written")
            return {"CANCELLED"}
        if event.type != "TIMER":
            return {"PASS_THROUGH"}
        try:
            if not self._job.advance(view_layer_of(context), _SLICE):
                self._show_progress(context)
                return {"PASS_THROUGH"}
            finished = self._finish(context, self._job)
        except HierMatchError as error:
            self.cancel(context)
            self.report({"ERROR"}, str(error))
            return {"CANCELLED"}
        except BaseException:
            self.cancel(context)
            raise
        self.cancel(context)
        return finished

    def cancel(self, context: bpy.types.Context) -> None:
        """End the modal run; Blender itself calls this when it loads a file or closes the window."""
        self._job.close()
        window_manager_of(context).event_timer_remove(self._timer)
        workspace = bpy.data.workspaces.get(self._workspace)
        if workspace is not None:
            workspace.status_text_set(None)
        redraw_panels(window_manager_of(context))

    def draw(self, _context: bpy.types.Context) -> None:
        """Show the options in the Adjust Last Operation panel."""
        layout = layout_of(self)
        layout.use_property_split = True
        settings = [name for _, names in shown_groups(self) for name in names]
        for name in ("source", "target", *APART, *settings, *OUTPUT_NAMES):
            layout.prop(self, name)

    def _start(self, context: bpy.types.Context) -> MatchJob:
        """Read both objects."""
        options = JobOptions(
            settings=match_settings(self),
            use_modifiers=self.use_modifiers,
            use_mirrored=self.use_mirrored,
            prefix=self.prefix,
            vertex_groups=self.write_vertex_groups,
            match_colors=self.write_colors,
            distortion=self.write_distortion,
            confidence=self.write_confidence,
        )
        state = state_of(context)
        source, target = find_pair(context, (self.source, self.target), (state.source, state.target))
        job = MatchJob(context, source, target, options)
        # So that Adjust Last Operation repeats the match of the same two, whatever is selected by then.
        self.source, self.target = source.name, target.name
        return job

    def _finish(self, context: bpy.types.Context, job: MatchJob) -> set[OperatorReturnItems]:
        """Write, remember and report."""
        outcome = job.finish(view_layer_of(context))
        remember(
            state_of(context).summary, outcome.stored, (outcome.source, outcome.target), self.prefix, outcome.seconds
        )
        refresh(cast("bpy.types.Scene", context.scene))
        for note in outcome.stored.notes:
            self.report({"WARNING"}, note)
        points, seconds = len(outcome.result.source_points), outcome.seconds
        pair = f'"{outcome.source}" and "{outcome.target}"'
        said = [f"Matched {points} points of {pair} in {seconds:.1f} s", state_of(context).summary.verdict]
        self.report({"INFO"}, ". ".join(filter(None, said)))
        return {"FINISHED"}

    def _show_progress(self, context: bpy.types.Context) -> None:
        """Show how far the match is, in the panel and the status bar."""
        now, shown = self._job.progress, progress_of(context)
        shown.fraction, shown.label = now.fraction, now.label
        workspace = bpy.data.workspaces.get(self._workspace)
        if workspace is not None:
            workspace.status_text_set(f"Matching: {now.label}, {now.fraction:.0%}    Esc: cancel")
        redraw_panels(window_manager_of(context))
