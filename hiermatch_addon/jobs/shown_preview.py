# SPDX-License-Identifier: GPL-3.0-or-later
"""The coarse map of the job that runs in a window, for the viewports to show while the match goes on."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from ...engine import Preview

_shown: list[Preview] = []
"""At most one: only one job runs at a time."""


def preview() -> Preview | None:
    """Return what is to be shown, if anything is."""
    return _shown[0] if _shown else None


def show_preview(found: Preview | None) -> bool:
    """Show another coarse map, or none; return whether that is a change."""
    if found is preview():
        return False
    _shown[:] = [] if found is None else [found]
    return True
