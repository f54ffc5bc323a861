# SPDX-License-Identifier: GPL-3.0-or-later
"""Have the panel drawn again after something that it shows has changed by itself."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    import bpy

__all__ = ["redraw_panels"]


def redraw_panels(manager: bpy.types.WindowManager) -> None:
    """Ask for the 3D viewports, whose sidebars hold the panel, to be drawn again."""
    for window in manager.windows:
        for area in window.screen.areas:
            if area.type == "VIEW_3D":
                area.tag_redraw()
