# SPDX-License-Identifier: GPL-3.0-or-later
"""Long work as an operator: beside Blender or in slices with a timer in the window, without a pause in scripts."""

from __future__ import annotations

import time
from contextlib import nullcontext
from typing import TYPE_CHECKING, Any, Protocol

import bpy

from ...engine import HierMatchError
from ..common.access import window_manager_of
from ..common.redraw import redraw_sidebars, redraw_views
from ..common.translated_text import translated
from ..properties.panel_state import progress_of
from .running import Startable
from .shown_preview import show_preview

if TYPE_CHECKING:
    from contextlib import AbstractContextManager

    from bpy.stub_internal.rna_enums import OperatorReturnItems

    from ...engine import Preview, Progress

_SLICE = 0.05
"""Seconds of work between two events, so that the window stays responsive."""

_LONGEST_SLICE = 0.1
"""The same where drawing the window takes longer than that: half of the time should be work."""

_REDRAW = 0.2
"""Least time between two drawings of the progress."""

_PAUSE = 0.01
"""Seconds between the timer's events."""


class Job(Protocol):
    """Work that goes on step by step and writes nothing until it is finished."""

    progress: Progress
    preview: Preview | None

    def work_beside(self) -> None:
        """Let the engine compute in another process, where there can be one."""

    def advance(self, seconds: float) -> bool:
        """Work for about so long, but for one step at least; return whether everything is computed."""

    def close(self) -> None:
        """Drop the work."""


class JobOperator(Startable):
    """What operators that do a job have in common; to be inherited from before `bpy.types.Operator`.

    Attributes
    ----------
    doing : str
        What the status bar says while it runs.
    cancelled : str
        What is reported when it was cancelled.
    panel : str
        Identifier of the panel that shows how far it is.
    """

    doing: str
    cancelled: str
    panel = "HIERMATCH_PT_match"

    _job: Job
    _timer: bpy.types.Timer
    _workspace: str
    _scene = ""  # name of the scene in which it began
    _worked = 0.0  # when the last slice of work ended
    _drawn = 0.0  # when the progress was drawn last

    def _start(self, context: bpy.types.Context) -> Job:
        """Read what is needed and make the job."""
        raise NotImplementedError

    def _finish(self, context: bpy.types.Context, job: Any) -> set[OperatorReturnItems]:  # noqa: ANN401 - what `_start` made
        """Write, remember and report."""
        raise NotImplementedError

    def execute(self, context: bpy.types.Context) -> set[OperatorReturnItems]:
        """Do the job without a pause."""
        manager = window_manager_of(context)
        manager.progress_begin(0, 100)
        try:
            job = self._start(context)
            try:
                while not job.advance(_SLICE):
                    manager.progress_update(min(99, int(100 * job.progress.fraction)))  # 100 breaks the cursor
                return self._finish(context, job)
            finally:
                job.close()
        except HierMatchError as error:
            self.report({"ERROR"}, translated(str(error)))
            return {"CANCELLED"}
        finally:
            manager.progress_end()

    def invoke(self, context: bpy.types.Context, _event: bpy.types.Event) -> set[OperatorReturnItems]:
        """Do the job beside Blender, or in slices, while the window stays alive."""
        try:
            self._job = self._start(context)
            self._job.work_beside()
        except HierMatchError as error:
            self.report({"ERROR"}, translated(str(error)))
            return {"CANCELLED"}
        progress = progress_of(context)
        progress.cancel, progress.fraction, progress.label = False, 0.0, self._job.progress.label
        self._timer = window_manager_of(context).event_timer_add(_PAUSE, window=context.window)
        self._workspace = context.workspace.name if context.workspace else ""
        self._scene = context.scene.name if context.scene else ""
        window_manager_of(context).modal_handler_add(self)
        return {"RUNNING_MODAL"}

    def modal(self, context: bpy.types.Context, event: bpy.types.Event) -> set[OperatorReturnItems]:
        """Do one slice of work at each of the timer's events."""
        # Whoever began later, such as a grab or a menu, takes the press of Esc, but its release gets here all the same.
        escaped = event.type == "ESC" and event.value == "PRESS" and not event.is_repeat
        if escaped or progress_of(context).cancel:
            self.cancel(context)
            self.report({"INFO"}, translated(self.cancelled))
            return {"CANCELLED"}
        if event.type != "TIMER":
            return {"PASS_THROUGH"}
        elsewhere = time.perf_counter() - self._worked
        try:
            if not self._job.advance(min(max(_SLICE, elsewhere), _LONGEST_SLICE)):
                self._show_progress(context)
                self._worked = time.perf_counter()
                return {"PASS_THROUGH"}
            with _shown(context, self._scene):
                finished = self._finish(context, self._job)
        except HierMatchError as error:
            self.cancel(context)
            self.report({"ERROR"}, translated(str(error)))
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
        show_preview(None)
        redraw_views(window_manager_of(context))

    def _show_progress(self, context: bpy.types.Context) -> None:
        """Show how far the job is, in the panel and the status bar."""
        now, shown = self._job.progress, progress_of(context)
        shown.fraction, shown.label = now.fraction, now.label
        if show_preview(self._job.preview):
            redraw_views(window_manager_of(context))
        if time.perf_counter() - self._drawn < _REDRAW:
            return
        self._drawn = time.perf_counter()
        workspace = bpy.data.workspaces.get(self._workspace)
        if workspace is not None:
            said = f"{self.doing}: {now.label}, {now.fraction:.0%}    Esc: cancel"
            workspace.status_text_set(translated(said))
        redraw_sidebars(window_manager_of(context))


def _shown(context: bpy.types.Context, name: str) -> AbstractContextManager[object]:
    """Work in a scene, whichever the window shows by now, if there still is one of that name."""
    scene = bpy.data.scenes.get(name)
    if scene is None or scene == context.scene:
        return nullcontext()
    return context.temp_override(scene=scene, view_layer=scene.view_layers[0])
