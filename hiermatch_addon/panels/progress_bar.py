# SPDX-License-Identifier: GPL-3.0-or-later
"""The progress bar of a job, in the panel that it was started from, and the buttons that start one."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, cast

from ..common.access import window_manager_of
from ..common.translated_text import translated
from ..jobs.running import is_running, running_panel
from ..properties.panel_state import progress_of
from ..transfers.retarget_properties import copy_named, retarget_of
from .panel_text import draw_label, draw_text, letters_across
from .question import draw_question

if TYPE_CHECKING:
    from collections.abc import Iterable

    import bpy


def draw_progress(layout: bpy.types.UILayout, context: bpy.types.Context, panel: str) -> bool:
    """Draw the bar and the button that cancels, or in other panels why their buttons wait.

    Parameters
    ----------
    layout : bpy.types.UILayout
        Where to draw.
    context : bpy.types.Context
        The panel's context.
    panel : str
        Identifier of the panel.

    Returns
    -------
    bool
        Whether the bar stands here, in place of the button that started the job.
    """
    place = running_panel(window_manager_of(context))
    if place == panel:
        progress = progress_of(context)
        if progress.question:
            draw_question(layout.box(), progress.question.splitlines(), letters_across(context))
            return True
        layout.progress(text=translated(progress.label), factor=cast("float", progress.fraction))
        layout.operator("hiermatch.cancel", icon="CANCEL")
        return True
    if place:
        draw_text(layout, context, "HierMatch is at work. Wait for it, or cancel it", "TIME")
    return False


def draw_starter(
    layout: bpy.types.UILayout,
    context: bpy.types.Context,
    operator: str,
    text: str,
    icon: str,
    *,
    options: Iterable[str] = (),
    **how: bool,
) -> None:
    """Draw a button that starts a job; while one runs, its name in its place.

    Blender draws a button that is under the mouse as it was before, until the mouse moves: it would stay disabled after
    the job that it has started.

    Parameters
    ----------
    layout : bpy.types.UILayout
        Where to draw.
    context : bpy.types.Context
        The panel's context.
    operator, text, icon : str
        Identifier of the operator, and what stands on the button.
    options : iterable of str
        Names of the options of retargeting that it takes over from the panels.
    **how : bool
        How else to draw the button, such as `depress`.
    """
    place: Any = layout
    if is_running(window_manager_of(context)):
        waiting = place.row()
        waiting.enabled = False  # a label that is not is drawn as bright as a button
        draw_label(waiting, text, icon)
        return
    button = place.operator(operator, text=text, icon=icon, **how)
    copy_named(retarget_of(context), button, options)
