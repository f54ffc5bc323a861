# SPDX-License-Identifier: GPL-3.0-or-later
"""The question of a running job, with a button for each answer."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Final

from ..common.translated_text import translated
from ..jobs.verdict import ANSWERS
from .panel_text import wrap_text

if TYPE_CHECKING:
    from collections.abc import Iterable

    import bpy

_ICONS: Final = {"LANDMARKS": "EYEDROPPER", "WRITE": "CHECKMARK", "CANCEL": "CANCEL"}


def draw_question(layout: bpy.types.UILayout, lines: Iterable[str], width: int) -> None:
    """Draw sentences, wrapped to so many letters, and the answers below."""
    column: Any = layout.column()
    for sentence in lines:
        text = column.column()
        text.scale_y = 0.8
        for number, line in enumerate(wrap_text(translated(sentence), width)):
            text.label(text=line, icon="BLANK1" if number else "ERROR", translate=False)
    for answer, name, _ in ANSWERS:
        column.operator("hiermatch.answer", text=name, icon=_ICONS[answer]).answer = answer
