# SPDX-License-Identifier: GPL-3.0-or-later
"""How far a job is, in the panel that it was started from."""

from __future__ import annotations

from typing import TYPE_CHECKING, cast

from .access import progress_of, window_manager_of
from .panel_text import draw_text
from .running import running_panel
from .translated_text import translated

if TYPE_CHECKING:
    import bpy

__all__ = ["draw_progress"]


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
        layout.progress(text=translated(progress.label), factor=cast("float", progress.fraction))
        layout.operator("hiermatch.cancel", icon="CANCEL")
        return True
    if place:
        draw_text(layout, context, "HierMatch is at work. Wait for it, or cancel it", "TIME")
    return False
