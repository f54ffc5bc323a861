# SPDX-License-Identifier: GPL-3.0-or-later
"""The interface in other languages.

Blender looks up the labels and tooltips that it draws by itself, and the fixed sentences of reports.  Where a text is
put together, `panel_text.translated` is asked for its parts.  A text that is missing stays English.
"""

from __future__ import annotations

from typing import Final

import bpy

from . import ja_JP, zh_HANS

__all__ = ["CONTEXT", "LANGUAGES", "register_translations", "unregister_translations"]

LANGUAGES: Final = {"ja_JP": ja_JP.MESSAGES, "zh_HANS": zh_HANS.MESSAGES}
"""For each of Blender's names of a language the translation of each English text."""

CONTEXT: Final = "HierMatch"
"""Context of names that mean something else in Blender: its own "Metric" is the metric system."""

_CONTEXTS: Final = ("*", "Operator", CONTEXT)
"""Blender looks for the names of operators, and for the texts of their buttons, in a context of their own."""

_EXTENSION: Final = __name__.partition(".hiermatch_addon.")[0]
"""The package of the extension, by which Blender knows whose translations these are."""


def register_translations() -> None:
    """Make the translations known to Blender."""
    bpy.app.translations.register(
        _EXTENSION,
        {
            language: {(context, text): said for text, said in messages.items() for context in _CONTEXTS}
            for language, messages in LANGUAGES.items()
        },
    )


def unregister_translations() -> None:
    """Undo `register_translations`."""
    bpy.app.translations.unregister(_EXTENSION)
