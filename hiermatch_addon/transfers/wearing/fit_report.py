# SPDX-License-Identifier: GPL-3.0-or-later
"""Sentences about fitted items: what was done, and what to check."""

from __future__ import annotations

from typing import TYPE_CHECKING

from ...common.phrases import counted

if TYPE_CHECKING:
    from ....engine import FittedItem

_MOST_THROUGH = 0.003
"""If more of an item is below the skin still, that is told."""

_MENTIONED = 0.01
"""If less of an item was pushed, that is not mentioned."""

_UNSURE, _MOST_UNSURE = 0.35, 0.1
"""Confidence of the map from which on the place of an item is believed; and if more of it is not, that is told."""

_MOST_BARE = 0.1
"""If more of an item has no skin below it any more, that is told."""


def done(name: str, fitted: FittedItem, *, is_body: bool) -> str:
    """Say in a sentence what was done with an item, which may be the surface of the body itself as well."""
    parts = []
    pieces = int(fitted.pieces.max(initial=-1)) + 1
    if pieces:
        parts.append(f"kept the shape of {counted(pieces, 'rigid part')}")
    moved = float((fitted.pushed > 0).mean())
    if is_body:  # it lay nowhere above the skin, and is at it everywhere
        parts.append("laid onto the skin of the other body")
    elif moved > _MENTIONED:
        parts.append(f"pushed {moved:.0%} of it out of what is below")
    return f'"{name}" was fitted: {", ".join(parts)}.' if parts else f'"{name}" was fitted.'


def doubt(name: str, fitted: FittedItem) -> str:
    """Say what to check of an item; empty if there is nothing."""
    parts = []
    if fitted.through > _MOST_THROUGH:
        parts.append(f"what is below still shows through {fitted.through:.1%} of it")
    unsure = float((fitted.confidence < _UNSURE).mean())
    if unsure > _MOST_UNSURE:
        parts.append(f"the match is uncertain below {unsure:.0%} of it")
    bare = float(fitted.bare.mean())
    if bare > _MOST_BARE:
        parts.append(f"the body ends below {bare:.0%} of it")
    return f'"{name}" should be checked: {", ".join(parts)}.' if parts else ""
