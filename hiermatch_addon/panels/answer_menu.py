# SPDX-License-Identifier: GPL-3.0-or-later
"""The choice between the answers of a match: a button for the mirrored one, or a menu where there are more."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import bpy

from ...engine import MIRRORED
from ..common.access import layout_of, window_manager_of
from ..common.translated_text import translated
from ..jobs.running import is_running
from ..properties.panel_state import state_of
from .progress_bar import draw_starter

if TYPE_CHECKING:
    from ..properties.properties import HIERMATCH_PG_summary


class HIERMATCH_MT_answers(bpy.types.Menu):
    """Write another answer of the match, without matching again."""

    bl_label = "Answers"
    bl_idname = "HIERMATCH_MT_answers"

    def draw(self, context: bpy.types.Context) -> None:
        """Draw a row for each answer."""
        layout: Any = layout_of(self)
        summary = state_of(context).summary
        for number, name in enumerate(summary.answers.splitlines()):
            icon = "RADIOBUT_ON" if number == summary.answer else "RADIOBUT_OFF"
            chosen = layout.operator("hiermatch.flip", text=_label(name), icon=icon, translate=False)
            chosen.alternative = number


def draw_answers(layout: bpy.types.UILayout, context: bpy.types.Context, summary: HIERMATCH_PG_summary) -> None:
    """Draw what chooses between the answers, if there are several."""
    names = summary.answers.splitlines()
    if len(names) < 2:
        return
    if names[1:] == [MIRRORED]:
        draw_starter(layout, context, "hiermatch.flip", "Use Mirrored Match", "MOD_MIRROR", depress=summary.answer > 0)
        return
    row: Any = layout.row()
    row.enabled = not is_running(window_manager_of(context))
    row.menu(HIERMATCH_MT_answers.bl_idname, text=_label(names[summary.answer]), translate=False)


def _label(name: str) -> str:
    """Write the name of an answer at the beginning of a line."""
    said = translated(name)
    return said[:1].upper() + said[1:]
