# SPDX-License-Identifier: GPL-3.0-or-later
"""The interface in other languages.

Blender looks up the labels and tooltips that it draws by itself, and the fixed sentences of reports.  Where a text is
put together, `panel_text.translated` is asked for its parts.  A text that is missing stays English.
"""

from __future__ import annotations

import inspect
from typing import Any, Final, cast, get_type_hints

import bpy

from .messages import LOCALES, MESSAGES

LANGUAGES: Final = {
    locale: {text: said[number] for text, said in MESSAGES.items()} for number, locale in enumerate(LOCALES)
}
"""For each of Blender's names of a language the translation of each English text."""

CONTEXT: Final = "HierMatch"
"""Context of all our names: in others Blender's own catalog comes first, where "Keys" are volume keys."""

_CONTEXTS: Final = ("*", "Operator", CONTEXT)
"""Blender looks for the names of operators, and for the texts of their buttons, in a context of their own."""

_EXTENSION: Final = __name__.partition(".hiermatch_addon.")[0]
"""The package of the extension, by which Blender knows whose translations these are."""


def use_context(cls: type[Any]) -> None:
    """Let a class that is to be registered have its name, and those of its properties, translated in our context."""
    if issubclass(cls, (bpy.types.Operator, bpy.types.Panel, bpy.types.Menu)):
        cast("Any", cls).bl_translation_context = CONTEXT
    ours = [base for base in cls.__mro__ if base.__module__.startswith(f"{_EXTENSION}.")]
    names = {name for base in ours for name in inspect.get_annotations(base)}
    hints = get_type_hints(cls)  # those with keywords are what Blender makes properties of
    properties = {name: hint for name, hint in hints.items() if name in names and hasattr(hint, "keywords")}
    for definition in properties.values():
        definition.keywords["translation_context"] = CONTEXT
    cls.__annotations__ = {**inspect.get_annotations(cls), **properties}


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
