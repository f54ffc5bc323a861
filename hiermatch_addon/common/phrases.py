# SPDX-License-Identifier: GPL-3.0-or-later
"""Parts of sentences: numbers of things, and names.  They are whole, so that they can be translated."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

if TYPE_CHECKING:
    from collections.abc import Sequence

_THINGS: Final = {
    "action": ("1 action", "{0} actions"),
    "attribute": ("1 attribute", "{0} attributes"),
    "bone": ("1 bone", "{0} bones"),
    "color attribute": ("1 color attribute", "{0} color attributes"),
    "driver": ("1 driver", "{0} drivers"),
    "item": ("1 item", "{0} items"),
    "landmark": ("1 landmark", "{0} landmarks"),
    "line": ("1 line", "{0} lines"),
    "material": ("1 material", "{0} materials"),
    "note": ("1 note", "{0} notes"),
    "paired bone": ("1 paired bone", "{0} paired bones"),
    "rigid part": ("1 rigid part", "{0} rigid parts"),
    "shape key": ("1 shape key", "{0} shape keys"),
    "UV map": ("1 UV map", "{0} UV maps"),
    "vertex": ("1 vertex", "{0} vertices"),
    "vertex group": ("1 vertex group", "{0} vertex groups"),
}
"""How one and several things are written."""

_SHOWN: Final = 3
"""Number of names that are written out."""


def counted(count: int, thing: str) -> str:
    """Write how many there are of something.

    Parameters
    ----------
    count : int
        The number.
    thing : str
        What one of them is called, such as 'shape key'.
    """
    one, many = _THINGS[thing]
    return one if count == 1 else many.format(count)


def listed(names: Sequence[str]) -> str:
    """Write names out, or the first of many."""
    shown, more = ", ".join(f'"{name}"' for name in names[:_SHOWN]), len(names) - _SHOWN
    return f"{shown} and {more} more" if more > 0 else shown


def not_ours(owner: str, kind: str, name: str) -> str:
    """Say that something, such as "an attribute" of an object, has a name that is needed."""
    return f'"{owner}" already has {kind} called "{name}" that HierMatch did not write. Rename it.'
