# SPDX-License-Identifier: GPL-3.0-or-later
"""Texts in the language of the interface, also those that were put together from parts.

The code, and the engine that knows nothing of languages, say everything in English.  Where a text reaches the user,
`translated` looks it up.  A sentence with names and numbers in it is found by its pattern: the tables of
`translations` have it with ``{0}``, ``{1}`` and so on in the places of what is filled in.
"""

from __future__ import annotations

import re
from functools import cache, lru_cache
from string import Formatter
from typing import Any

import bpy

from .translations import CONTEXT, LANGUAGES


def translated(text: str) -> str:
    """Return a text in the language of the interface.

    Parameters
    ----------
    text : str
        The text in English.

    Returns
    -------
    str
        Its translation; the text itself if there is none, or none is wanted.  What is filled in is translated, too,
        unless it stands in quotation marks: that is a name.  So are the parts of a list, if all of them are known.
    """
    translations: Any = bpy.app.translations  # whose functions Blender's stubs declare to return nothing
    said = _looked_up(text)
    if said != text or translations.locale not in LANGUAGES:
        return said
    parts = text.split(", ")
    if len(parts) > 1 and all(_is_known(part) for part in parts):
        return "、".join(translated(part) for part in parts)
    template, values = _taken_apart(text)
    said = _looked_up(template)
    if said == template:
        return text
    filled = {name: value if f'"{{{name}}}"' in template else translated(value) for name, value in values}
    return re.sub(r"\{(\w+)\}", lambda field: filled[field[1]], said)


def _looked_up(text: str) -> str:
    """Return what a whole text is in the language of the interface, in our sense of it, else as Blender calls it."""
    translations: Any = bpy.app.translations
    said: str = translations.pgettext_iface(text, CONTEXT)
    return said if said != text else str(translations.pgettext_iface(text))


def _is_known(text: str) -> bool:
    """Tell whether the tables have a text, as it is or as a pattern."""
    return text in next(iter(LANGUAGES.values())) or bool(_taken_apart(text)[1])


@lru_cache(maxsize=1024)
def _taken_apart(text: str) -> tuple[str, tuple[tuple[str, str], ...]]:
    """Find the pattern of a sentence, and what is filled in; the sentence itself and nothing if it has none."""
    for template, pattern in _patterns():
        found = pattern.fullmatch(text)
        if found is not None:
            names = (name.removeprefix("_") for name in found.groupdict())
            return template, tuple(zip(names, found.groups(), strict=True))
    return text, ()


@cache
def _patterns() -> tuple[tuple[str, re.Pattern[str]], ...]:
    """List the sentences with gaps, and what matches them.

    Those that start with a gap come last, since they say least about what they match, else those that say most first.
    """
    patterns = []
    for text in next(iter(LANGUAGES.values())):
        parts = list(Formatter().parse(text))
        if any(name is not None for _, name, _, _ in parts):
            wanted = "".join(re.escape(said) + (f"(?P<_{name}>.+?)" if name else "") for said, name, _, _ in parts)
            letters = sum(len(said) for said, *_ in parts)
            patterns.append(((text.startswith("{"), -letters), text, re.compile(wanted, re.DOTALL)))
    return tuple((text, pattern) for _, text, pattern in sorted(patterns, key=lambda each: each[0]))
