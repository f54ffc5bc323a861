# SPDX-License-Identifier: GPL-3.0-or-later
"""Pictures of parts of Blender's window: captured, cut out, put together, captioned and saved small."""

from __future__ import annotations

import tempfile
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

import blf
import bpy
import numpy as np
from bpy_extras.view3d_utils import location_3d_to_region_2d
from screen import capture, view

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Pixels = NDArray[np.float32]
    """Colours (height, width, 4), the lowest row first, as Blender keeps them."""

__all__ = ["Box", "Camera", "Caption", "place_of", "seen", "sidebar", "viewport"]

_GAP = 6
"""Pixels between two pictures on a sheet."""

_MARGIN, _TABS = 12, 48
"""Pixels left and right of what is drawn into the sidebar, the names of its tabs among them."""

_QUALITY = 84
"""Of a JPEG: letters of the interface are still sharp, and pictures small."""

_ROOM = 0.05
"""What is left free around objects, in parts of their width."""


class Box(NamedTuple):
    """A part of a window in pixels, from its lower left corner."""

    left: int
    bottom: int
    right: int
    top: int


def viewport() -> Box:
    """Return where the 3D viewport is, without its header and what lies over it at the right."""
    regions = {region.type: region for region in view()["area"].regions if region.width > 1}
    left, bottom, right, top = _box(regions["WINDOW"])
    if "UI" in regions:
        right = regions["UI"].x
    return Box(
        left, bottom, right, min([top, *(regions[name].y for name in ("HEADER", "TOOL_HEADER") if name in regions)])
    )


def sidebar() -> Box:
    """Return where the sidebar is, with the names of its tabs."""
    return _box(next(region for region in view()["area"].regions if region.type == "UI"))


def place_of(position: Any) -> tuple[int, int]:  # noqa: ANN401 - three numbers, of whatever type
    """Return the pixel of the window in which a place of the world is seen."""
    place = view()
    region = place["region"]
    x, y = location_3d_to_region_2d(region, place["space_data"].region_3d, position)
    return round(region.x + x), round(region.y + y)


def seen(objects: list[bpy.types.Object], height: int = 0) -> Box:
    """Return the part of the viewport in which objects are seen, and as much around them as the height asks for."""
    depsgraph = bpy.context.evaluated_depsgraph_get()
    shown = [obj.evaluated_get(depsgraph) for obj in objects]
    places = np.array(
        [place_of(obj.matrix_world @ vertex.co) for obj in shown for vertex in list(obj.data.vertices)[::7]]
    )
    low, high = places.min(axis=0), places.max(axis=0)
    room = round(_ROOM * float(high[0] - low[0]))
    (left, bottom), (right, top) = (int(number) for number in low - room), (int(number) for number in high + room)
    missing = max(height - (top - bottom), 0)
    box = viewport()
    top = min(top + missing // 2, box.top)
    bottom = max(min(bottom - missing // 2, top - height), box.bottom)
    return Box(max(left, box.left), bottom, min(right, box.right), top)


class Caption:
    """A line of text over the upper left of a part of the viewport, until it is taken away."""

    _handle: Any = None

    def show(self, text: str, box: Box) -> None:
        """Write a text into a box that will be cut out."""
        self.hide()
        region = view()["region"]

        def draw() -> None:
            blf.size(0, 20.0)
            blf.color(0, 1.0, 1.0, 1.0, 1.0)
            blf.position(0, box.left - region.x + 12, box.top - region.y - 28, 0)
            blf.draw(0, text)

        self._handle = bpy.types.SpaceView3D.draw_handler_add(draw, (), "WINDOW", "POST_PIXEL")
        view()["area"].tag_redraw()

    def hide(self) -> None:
        """Take it away."""
        if self._handle is not None:
            bpy.types.SpaceView3D.draw_handler_remove(self._handle, "WINDOW")
            self._handle = None


class Camera:
    """Takes pictures of the first window, and saves them in a folder.

    Parameters
    ----------
    folder : Path
        Where they are saved.
    command : list of str
        What takes a picture of the screen and is given the file to write; if empty, Blender reads its own window.
    """

    def __init__(self, folder: Path, command: list[str]) -> None:
        self._folder = folder
        self._command = command

    def take(self, name: str, *boxes: Box) -> None:
        """Save parts of the window as they are now, side by side."""
        self.save(name, [[self.look(box) for box in boxes]])

    def look(self, box: Box) -> Pixels:
        """Return a part of the window as it is now."""
        whole = self._window()
        return np.array(whole[box.bottom : box.top, box.left : box.right])

    def panel(self) -> Pixels:
        """Return the sidebar as it is now, as far down as there is something in it."""
        pixels = self.look(sidebar())
        inside = pixels[:, _MARGIN:-_TABS, :3]
        filled = np.flatnonzero(np.ptp(inside, axis=1).max(axis=1) > 0)
        return pixels[max(int(filled[filled > _GAP].min()) - 2 * _GAP, 0) :]

    def take_with_panel(self, name: str, objects: list[bpy.types.Object]) -> None:
        """Save some objects and the sidebar as they are now, side by side."""
        panel = self.panel()
        self.save(name, [[self.look(seen(objects, len(panel))), panel]])

    def save_beside(self, name: str, rows: list[list[Pixels]], panel: Pixels) -> None:
        """Save pictures on a sheet, row by row, with the sidebar beside them."""
        column = _stacked([_stacked(row, axis=1) for row in rows[::-1]], axis=0)
        self.save(name, [[column, panel]])

    def save(self, name: str, rows: list[list[Pixels]]) -> None:
        """Save pictures on a sheet, row by row, as `name`.jpg."""
        sheet = _stacked([_stacked(row, axis=1) for row in rows[::-1]], axis=0)
        height, width = sheet.shape[:2]
        image = bpy.data.images.new(name, width, height)
        image.pixels.foreach_set(np.ascontiguousarray(sheet, np.float32).ravel())
        path = self._folder / f"{name}.jpg"
        image.file_format = "JPEG"
        image.save(filepath=str(path), quality=_QUALITY)
        bpy.data.images.remove(image)
        print(f"{path}  {width} x {height}  {path.stat().st_size / 1000:.0f} kB", flush=True)

    def _window(self) -> Pixels:
        with tempfile.TemporaryDirectory() as folder:
            return capture(Path(folder) / "window.png", self._command)


def _box(thing: Any) -> Box:  # noqa: ANN401 - an area or a region
    return Box(thing.x, thing.y, thing.x + thing.width, thing.y + thing.height)


def _stacked(pictures: list[Pixels], *, axis: int) -> Pixels:
    """Put pictures beside each other, or the next above the last, on white paper; shorter ones hang from the top."""
    across = max(picture.shape[1 - axis] for picture in pictures)
    parts = []
    for number, picture in enumerate(pictures):
        missing = across - picture.shape[1 - axis]
        before = [(missing, 0), (0, 0)] if axis == 1 else [(0, 0), (0, missing)]
        padding = [*before, (0, 0)]
        parts.append(np.pad(picture, padding, constant_values=1.0))
        if number + 1 < len(pictures):
            gap = (across, _GAP, 4) if axis == 1 else (_GAP, across, 4)
            parts.append(np.ones(gap, np.float32))
    return np.concatenate(parts, axis=axis)
