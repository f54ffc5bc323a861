# SPDX-License-Identifier: GPL-3.0-or-later
"""Plain settings made of Blender's properties, which may be gone while work goes on."""

from __future__ import annotations

from dataclasses import fields
from typing import TYPE_CHECKING, TypeVar

if TYPE_CHECKING:
    from _typeshed import DataclassInstance

    Settings = TypeVar("Settings", bound=DataclassInstance)


def settings_of(kind: type[Settings], options: object, start: str, **others: object) -> Settings:
    """Make settings of options.

    Parameters
    ----------
    kind : type
        A dataclass.
    options : object
        What has the options as attributes: each is called as a field of the settings, after a common start.
    start : str
        That start.
    **others
        Fields whose values are no option of that name.
    """
    names = [field.name for field in fields(kind) if field.name not in others]
    return kind(**{name: getattr(options, start + name) for name in names}, **others)


def names_in(text: str) -> tuple[str, ...]:
    """Return the names that stand in a text, separated by commas, each once."""
    return tuple(dict.fromkeys(name.strip() for name in text.split(",") if name.strip()))
