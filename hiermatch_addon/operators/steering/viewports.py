# SPDX-License-Identifier: GPL-3.0-or-later
"""The 3D viewport under the mouse, but for what lies over it: sidebars, headers and the widgets that turn the view."""

from __future__ import annotations

from dataclasses import dataclass
from math import hypot
from typing import TYPE_CHECKING, Any, Final, cast

if TYPE_CHECKING:
    from collections.abc import Iterable

    import bpy

_OFFSET: Final = 10
"""How far the ball of axes is from the corner of a viewport, in pixels; this and the next are Blender's own."""

_ICON, _ICON_STEP, _ICONS = 28, 30, 5
"""Size of an icon below the ball, from one to the next, and how many there are at most."""

_MARGIN: Final = 4
"""So far beside a widget it counts as under the mouse, too."""


@dataclass(frozen=True)
class Viewport:
    """A 3D viewport.

    Attributes
    ----------
    region : bpy.types.Region
        Where it is drawn.
    space : bpy.types.SpaceView3D
        What it shows.
    view : bpy.types.RegionView3D
        From where.
    """

    region: bpy.types.Region
    space: bpy.types.SpaceView3D
    view: Any


def viewport_at(context: bpy.types.Context, x: int, y: int) -> Viewport | None:
    """Find the 3D viewport at a place of the window, unless something lies over it there."""
    screen = context.screen
    for area in screen.areas if screen else ():
        inside = [region for region in area.regions if _covers(region, x, y)]
        if area.type == "VIEW_3D" and inside and all(region.type == "WINDOW" for region in inside):
            space = cast("bpy.types.SpaceView3D", area.spaces.active)
            view = space.region_3d if len(inside) == 1 else None
            if view is None or _on_widgets(context, space, _corner(area.regions, inside[0]), (x, y)):
                return None
            return Viewport(inside[0], space, inside[0].data or view)
    return None


def is_in_viewport(context: bpy.types.Context, x: int, y: int) -> bool:
    """Tell whether a place of the window is in a 3D viewport, or on what lies over one."""
    screen = context.screen
    return any(area.type == "VIEW_3D" and _covers(area, x, y) for area in (screen.areas if screen else ()))


def _covers(region: bpy.types.Region | bpy.types.Area, x: int, y: int) -> bool:
    return region.x <= x < region.x + region.width and region.y <= y < region.y + region.height and region.width > 1


def _corner(regions: Iterable[bpy.types.Region], viewport: bpy.types.Region) -> tuple[int, int]:
    """Return the upper right corner of what is seen of a viewport beside its sidebar and below its headers."""
    right, top = viewport.x + viewport.width, viewport.y + viewport.height
    for region in regions:
        if region.width <= 1 or region.height <= 1:
            continue
        if region.type == "UI" and region.alignment == "RIGHT":
            right = min(right, region.x)
        if region.type in ("HEADER", "TOOL_HEADER") and region.alignment == "TOP":
            top = min(top, region.y)
    return right, top


def _on_widgets(
    context: bpy.types.Context, space: bpy.types.SpaceView3D, corner: tuple[int, int], mouse: tuple[int, int]
) -> bool:
    """Tell whether the mouse is on the ball of axes in the corner of a viewport, or on the icons below it."""
    if not (space.show_gizmo and space.show_gizmo_navigate):
        return False
    preferences: Any = context.preferences
    scale = preferences.system.ui_scale
    size = preferences.view.gizmo_size_navigate_v3d
    left, down = ((edge - place) / scale for edge, place in zip(corner, mouse, strict=True))
    middle = size / 2 + _OFFSET
    if hypot(left - middle, down - middle) <= size / 2 + _MARGIN:
        return True
    lowest = 2.1 * middle + _ICON_STEP * (_ICONS - 1)
    return abs(left - 0.75 * _ICON_STEP) <= _ICON / 2 + _MARGIN and 0 <= down <= lowest + _ICON / 2 + _MARGIN
