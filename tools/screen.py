# SPDX-License-Identifier: GPL-3.0-or-later
"""Blender's window for the scripts that take pictures: what is shown in it, and how to get at its pixels."""

from __future__ import annotations

import importlib
import subprocess
from typing import TYPE_CHECKING, Any

import bpy
import numpy as np
from mathutils import Vector
from source_extension import PACKAGE, load_extension

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

_ROOM = 1.25
"""How much farther away than filling the view the cats are seen."""

_ASIDE = 0.09
"""How far they stand left of the middle, where the sidebar covers nothing, in units of that distance."""

_PANELS = ("match_panels", "retarget_panels")
"""Modules whose panels have collapsible sections."""

_shown: set[str] = set()
"""Labels of the panels that are drawn."""


class FoldedLayout:
    """A layout whose collapsible sections are open or closed as wanted; everything else is the layout's own."""

    def __init__(self, layout: bpy.types.UILayout, opened: tuple[str, ...]) -> None:
        object.__setattr__(self, "layout", layout)
        object.__setattr__(self, "opened", opened)

    def __getattr__(self, name: str) -> Any:  # noqa: ANN401 - whatever the layout has
        return getattr(self.layout, name)

    def __setattr__(self, name: str, value: object) -> None:
        setattr(self.layout, name, value)

    def panel(self, name: str, **_names: bool) -> Any:  # noqa: ANN401 - a pair of layouts or None
        """Begin a section; under another name when it is open, because Blender remembers which are."""
        is_open = name in self.opened
        return self.layout.panel(f"{name}_{'open' if is_open else 'closed'}", default_closed=not is_open)


def register_unfolded() -> None:
    """Register the extension with all its panels open, of which `show_panels` says which are there."""
    load_extension()
    registration: Any = importlib.import_module(f"{PACKAGE}.hiermatch_addon.registration")
    for cls in registration.CLASSES:
        if getattr(cls, "bl_category", "") == "HierMatch":
            cls.bl_options = set()
            cls.poll = classmethod(lambda cls, _context: cls.bl_label in _shown)
    registration.register()


def show_panels(*labels: str) -> None:
    """Have the sidebar show some panels, by their labels, and no others."""
    _shown.clear()
    _shown.update(labels)
    view()["area"].tag_redraw()


def fold(*opened: str, package: str = PACKAGE) -> None:
    """Draw the panels with these sections open, and all others closed; `package` is what the extension is called."""
    for name in _PANELS:
        panels: Any = importlib.import_module(f"{package}.hiermatch_addon.panels.{name}")
        own = getattr(panels, "own_layout_of", panels.layout_of)
        panels.own_layout_of = own
        panels.layout_of = lambda owner, own=own: FoldedLayout(own(owner), opened)
    view()["area"].tag_redraw()


def view() -> dict[str, Any]:
    """Return what an operator of the 3D viewport needs in its context."""
    window = bpy.context.window_manager.windows[0]
    area = next(area for area in window.screen.areas if area.type == "VIEW_3D")
    region = next(region for region in area.regions if region.type == "WINDOW")
    return {
        "window": window,
        "screen": window.screen,
        "area": area,
        "region": region,
        "space_data": area.spaces.active,
    }


def set_scene(*, rigged: bool = False) -> None:
    """Put the demo pair into an empty scene and look at it."""
    with bpy.context.temp_override(**view()):
        for thing in list(bpy.data.objects):
            bpy.data.objects.remove(thing)
        bpy.ops.hiermatch.add_demo_pair(rigged=rigged)
        bpy.context.scene.hiermatch.summary.points = 0  # what the panel tells was about others
        space = view()["space_data"]
        space.show_region_ui = True
        space.shading.color_type = "VERTEX"
        overlay = space.overlay
        overlay.show_floor = overlay.show_axis_x = overlay.show_axis_y = overlay.show_cursor = False
        overlay.show_object_origins = overlay.show_outline_selected = False
        look_at_selected()


def look_at_selected() -> None:
    """Turn the view to what is selected, left of the sidebar."""
    with bpy.context.temp_override(**view()):
        bpy.ops.view3d.view_selected()
    eye = view()["space_data"].region_3d
    eye.view_distance *= _ROOM
    eye.view_location += eye.view_rotation @ Vector((_ASIDE * eye.view_distance, 0, 0))


def large_view() -> None:
    """Let the viewport fill the window, with the sidebar and nothing else beside the meshes."""
    if len(view()["screen"].areas) > 1:
        with bpy.context.temp_override(**view()):
            bpy.ops.screen.screen_full_area()
    space = view()["space_data"]
    space.show_region_ui = True
    space.show_region_toolbar = space.show_region_tool_header = space.show_gizmo = False
    space.overlay.show_text = False


def choose_tab() -> None:
    """Bring the sidebar's tab to the front."""
    sidebar = next(region for region in view()["area"].regions if region.type == "UI")
    sidebar.active_panel_category = "HierMatch"


def scroll_sidebar(steps: int = 40) -> None:
    """Scroll the sidebar down, or up if `steps` is negative; without a number to its end."""
    place = view()
    place["region"] = next(region for region in place["area"].regions if region.type == "UI")
    with bpy.context.temp_override(**place):
        for _ in range(abs(steps)):
            (bpy.ops.view2d.scroll_down if steps > 0 else bpy.ops.view2d.scroll_up)()


def picture(path: Path, command: list[str]) -> Callable[[], None]:
    """Return a step that takes a picture of the window, or of the screen by a command."""

    def take() -> None:
        path.unlink(missing_ok=True)
        capture(path, command)
        print(path, flush=True)

    return take


def capture(path: Path, command: list[str]) -> Any:  # noqa: ANN401 - an array (height, width, 4), the lowest row first
    """Save a picture of the window, or of the screen by a command, and return its colours.

    Raises
    ------
    OSError
        If the screen cannot be read.
    """
    if command:
        subprocess.run([*command, str(path)], check=True)
    else:
        with bpy.context.temp_override(**view()):
            bpy.ops.screen.screenshot(filepath=str(path))
    image = bpy.data.images.load(str(path))
    width, height = image.size
    pixels = np.empty(4 * width * height, np.float32)
    image.pixels.foreach_get(pixels)
    bpy.data.images.remove(image)
    if np.ptp(pixels.reshape(-1, 4)[:, :3]) == 0:
        raise OSError(f"{path} is blank: this screen cannot be read. Name a COMMAND that takes pictures of it.")
    return pixels.reshape(height, width, 4)
