# SPDX-License-Identifier: GPL-3.0-or-later
"""Blender's window for the scripts that take pictures: what is shown in it, and how to get at its pixels."""

from __future__ import annotations

import subprocess
from typing import TYPE_CHECKING, Any

import bpy
import numpy as np
from mathutils import Vector

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

_ROOM = 1.25
"""How much farther away than filling the view the cats are seen."""

_ASIDE = 0.09
"""How far they stand left of the middle, where the sidebar covers nothing, in units of that distance."""


def view() -> dict[str, Any]:
    """Return what an operator of the 3D viewport needs in its context."""
    window = bpy.context.window_manager.windows[0]
    area = next(area for area in window.screen.areas if area.type == "VIEW_3D")
    region = next(region for region in area.regions if region.type == "WINDOW")
    return {"window": window, "area": area, "region": region, "space_data": area.spaces.active}


def set_scene(*, rigged: bool = False) -> None:
    """Put the demo pair into an empty scene and look at it."""
    with bpy.context.temp_override(**view()):
        for thing in list(bpy.data.objects):
            bpy.data.objects.remove(thing)
        bpy.ops.hiermatch.add_demo_pair(rigged=rigged)
        space = view()["space_data"]
        space.show_region_ui = True
        space.shading.color_type = "VERTEX"
        overlay = space.overlay
        overlay.show_floor = overlay.show_axis_x = overlay.show_axis_y = overlay.show_cursor = False
        overlay.show_object_origins = overlay.show_outline_selected = False
        bpy.ops.view3d.view_selected()
        eye = space.region_3d
        eye.view_distance *= _ROOM
        eye.view_location += eye.view_rotation @ Vector((_ASIDE * eye.view_distance, 0, 0))


def choose_tab() -> None:
    """Bring the sidebar's tab to the front."""
    sidebar = next(region for region in view()["area"].regions if region.type == "UI")
    sidebar.active_panel_category = "HierMatch"


def scroll_sidebar() -> None:
    """Scroll the sidebar to its end."""
    place = view()
    place["region"] = next(region for region in place["area"].regions if region.type == "UI")
    with bpy.context.temp_override(**place):
        for _ in range(40):
            bpy.ops.view2d.scroll_down()


def picture(path: Path, command: list[str]) -> Callable[[], None]:
    """Return a step that takes a picture of the window, or of the screen by a command."""

    def take() -> None:
        path.unlink(missing_ok=True)
        if command:
            subprocess.run([*command, str(path)], check=True)
        else:
            with bpy.context.temp_override(**view()):
                bpy.ops.screen.screenshot(filepath=str(path))
        image = bpy.data.images.load(str(path))
        pixels = np.empty(len(image.pixels), np.float32)
        image.pixels.foreach_get(pixels)
        bpy.data.images.remove(image)
        if np.ptp(pixels.reshape(-1, 4)[:, :3]) == 0:
            raise OSError(f"{path} is blank: this screen cannot be read. Name a COMMAND that takes pictures of it.")
        print(path, flush=True)

    return take
