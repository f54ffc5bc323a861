# SPDX-License-Identifier: GPL-3.0-or-later
"""Sentences in panels."""

from __future__ import annotations

import textwrap
from typing import TYPE_CHECKING, Any, Final, cast
from unicodedata import east_asian_width

from ..common.phrases import counted
from ..common.translated_text import translated

if TYPE_CHECKING:
    import bpy

_PIXELS_PER_LETTER = 6.5
"""Width of a letter in a sentence at normal interface scale: a line of twenty fits, whichever they are."""

_PIXELS_BESIDE = 72
"""What is beside a sentence at that scale: the strip of tabs, the margins of the panel and of a box, and the icon."""

_LEAST_LETTERS = 8
"""In a line, of however narrow a sidebar: half of what the narrowest holds that can be dragged."""

_NEVER_FIRST: Final = "、。，．：；！？）」』”’・ー々ぁぃぅぇぉっゃゅょァィゥェォッャュョ"
"""What no line of Japanese or Chinese starts with."""


def draw_label(layout: bpy.types.UILayout, text: str, icon: str = "NONE") -> None:
    """Draw a name, in the language of the interface and in our sense of it: Blender's catalog has others first."""
    cast("Any", layout).label(text=translated(text), icon=icon, translate=False)


def draw_text(layout: bpy.types.UILayout, context: bpy.types.Context, text: str, icon: str) -> None:
    """Draw a sentence, in the language of the interface, over as many lines as the width of the sidebar asks for."""
    column: Any = layout.column()
    column.scale_y = 0.8
    for number, line in enumerate(wrap_text(translated(text), letters_across(context))):
        column.label(text=line, icon="BLANK1" if number else icon, translate=False)


def draw_notes(layout: bpy.types.UILayout, context: bpy.types.Context, name: str, notes: list[str]) -> None:
    """Draw what should be known, to unfold: of a messy scan that is much, and few need it."""
    if not notes:
        return
    header, body = cast("Any", layout).panel(name, default_closed=True)
    header.label(text=translated(counted(len(notes), "note")), translate=False)
    if body is not None:
        column = body.column()
        for note in notes:
            draw_text(column, context, note, "INFO")


def letters_across(context: bpy.types.Context) -> int:
    """Return how many letters of a sentence stand in a line of the sidebar."""
    region, preferences = cast("Any", context.region), cast("Any", context.preferences)
    width = region.width / preferences.system.ui_scale - _PIXELS_BESIDE
    return max(_LEAST_LETTERS, int(width / _PIXELS_PER_LETTER))


def shortened(text: str, letters: int) -> str:
    """Shorten a name that is too long in its middle: the end is what tells left from right.

    Parameters
    ----------
    text : str
        The name.
    letters : int
        How many letters there is room for.

    Returns
    -------
    str
        The name, or its beginning and its end.
    """
    if len(text) <= letters:
        return text
    start = (letters - 1) // 2
    return f"{text[:start]}…{text[len(text) - (letters - 1 - start) :]}"


def wrap_text(text: str, width: int) -> list[str]:
    """Break a sentence into lines: at spaces, and in Japanese and Chinese between any two letters.

    Parameters
    ----------
    text : str
        The sentence.
    width : int
        Letters in a line; those of Japanese and Chinese count twice.

    Returns
    -------
    list of str
        The lines.  A line may be wider by the punctuation that must not start the next one.
    """
    if not any(_columns(letter) == 2 for letter in text):
        return textwrap.wrap(text, width)
    lines = [""]
    for piece in _pieces(text):
        filled = sum(map(_columns, lines[-1] + piece.rstrip()))
        if lines[-1] and filled > width and piece not in _NEVER_FIRST:
            lines.append("")
        lines[-1] += piece
    return [line.strip() for line in lines]


def _columns(letter: str) -> int:
    """Return how many usual letters are as wide as one."""
    return 2 if east_asian_width(letter) in "WF" else 1


def _pieces(text: str) -> list[str]:
    """Take a text apart where a line may end: after spaces, and around wide letters."""
    pieces = [""]
    for letter in text:
        wide = _columns(letter) == 2
        if pieces[-1] and (wide or pieces[-1].endswith(" ") or _columns(pieces[-1][-1]) == 2):
            pieces.append("")
        pieces[-1] += letter
    return pieces
