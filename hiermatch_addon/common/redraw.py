# SPDX-License-Identifier: GPL-3.0-or-later
"""Redrawing of sidebars and views whose content has changed by itself."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Iterator

    import bpy


def redraw_sidebars(manager: bpy.types.WindowManager) -> None:
    """Ask for the sidebars of the 3D viewports, which hold the panels, to be drawn again, and for nothing else."""
    for area in _views(manager):
        for region in area.regions:
            if region.type == "UI":
                region.tag_redraw()


def redraw_views(manager: bpy.types.WindowManager) -> None:
    """Ask for the 3D viewports to be drawn again, with their sidebars."""
    for area in _views(manager):
        area.tag_redraw()


def _views(manager: bpy.types.WindowManager) -> Iterator[bpy.types.Area]:
    for window in manager.windows:
        yield from (area for area in window.screen.areas if area.type == "VIEW_3D")
