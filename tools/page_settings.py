# SPDX-License-Identifier: GPL-3.0-or-later
"""The pictures of docs/settings.md.

    advanced.jpg  the settings of a match, those of Output and Advanced unfolded
    presets.jpg   the menu of presets

`tools/screenshots.py` takes them.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import bpy
from camera import Box, sidebar
from screen import fold, set_scene, show_panels, view

if TYPE_CHECKING:
    from collections.abc import Iterator

    from camera import Camera


def pictures(camera: Camera) -> Iterator[float | None]:
    """Unfold everything, then open the menu of presets."""
    set_scene()
    fold("hiermatch_regions", "hiermatch_output", "hiermatch_advanced")
    show_panels("HierMatch")
    yield None
    camera.save("advanced", [[camera.panel()]])
    fold()
    yield None
    place = view()
    box = sidebar()
    x, y = box.right - 40, box.top - 20
    place["window"].event_simulate(type="MOUSEMOVE", value="NOTHING", x=x, y=y)
    yield None
    place["region"] = next(region for region in place["area"].regions if region.type == "UI")
    with bpy.context.temp_override(**place):
        bpy.ops.wm.call_panel(name="HIERMATCH_PT_presets", keep_open=True)
    yield None
    camera.take("presets", Box(box.left - 120, box.top - 420, box.right, box.top))
    place["window"].event_simulate(type="ESC", value="PRESS", x=x, y=y)
    yield None
