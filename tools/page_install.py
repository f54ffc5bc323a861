# SPDX-License-Identifier: GPL-3.0-or-later
"""The picture of docs/install.md.

    install.jpg  where Blender's preferences have Install from Disk

`tools/screenshots.py` takes them.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import bpy
from camera import Box
from screen import large_view

if TYPE_CHECKING:
    from collections.abc import Iterator

    from camera import Camera

_MENU = 125
"""How far left of the upper right corner of the preferences the menu opens."""


def pictures(camera: Camera) -> Iterator[float | None]:
    """Make the viewport an editor of preferences, open its menu, and go back."""
    window = bpy.context.window_manager.windows[0]
    area = next(area for area in window.screen.areas if area.type == "VIEW_3D")
    area.type = "PREFERENCES"
    bpy.context.preferences.active_section = "EXTENSIONS"
    yield None
    regions = {region.type: region for region in area.regions}
    right, top = area.x + area.width, area.y + area.height
    x, y = right - _MENU, top - regions["HEADER"].height - 40
    window.event_simulate(type="MOUSEMOVE", value="NOTHING", x=x, y=y)
    yield None
    with bpy.context.temp_override(window=window, area=area, region=regions["WINDOW"]):
        bpy.ops.wm.call_menu(name="USERPREF_MT_extensions_settings")
    yield None
    sections = Box(area.x, top - 420, area.x + 180, top)
    camera.take("install", sections, Box(right - 640, top - 420, right, top))
    window.event_simulate(type="ESC", value="PRESS", x=x, y=y)
    yield None
    area.type = "VIEW_3D"
    large_view()
    yield None
