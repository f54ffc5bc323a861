# SPDX-License-Identifier: GPL-3.0-or-later
"""Sentences in panels."""

from __future__ import annotations

import textwrap
from typing import TYPE_CHECKING, Any, cast

if TYPE_CHECKING:
    import bpy

__all__ = ["draw_text"]

_PIXELS_PER_LETTER = 7
"""Rough width of a letter at normal interface scale, to wrap sentences."""


def draw_text(layout: bpy.types.UILayout, context: bpy.types.Context, text: str, icon: str) -> None:
    """Draw a sentence over as many lines as the width of the sidebar asks for."""
    region, preferences = cast("Any", context.region), cast("Any", context.preferences)
    width = region.width / (_PIXELS_PER_LETTER * preferences.system.ui_scale)
    column: Any = layout.column()
    column.scale_y = 0.8
    for number, line in enumerate(textwrap.wrap(text, max(16, int(width) - 6))):
        column.label(text=line, icon="BLANK1" if number else icon)
