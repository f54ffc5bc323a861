# SPDX-License-Identifier: GPL-3.0-or-later
"""Shading of the 3D viewports: switched to colors while a match is shown, and back.

Undo takes back what was done to meshes and scenes, but not how viewports are shaded.  So how one was shaded before is
kept on its screen, which Undo leaves alone as well and which is saved in the file; and when Undo has taken back that
anything is shown, the viewports follow.
"""

from __future__ import annotations

import json
from typing import TYPE_CHECKING, Any, Final, cast

import bpy
from bpy.app.handlers import persistent

if TYPE_CHECKING:
    from collections.abc import Iterator

_KEPT: Final = "hiermatch_shading"
"""Custom property of a screen: how its viewports were shaded before, by their places in it, as a JSON text."""

_COLORS: Final = ("SOLID", "VERTEX")
"""Kind of shading and of color in which color attributes are seen."""


def shade_by_colors(space: bpy.types.Space | None) -> None:
    """Let a viewport, if it is one, show color attributes."""
    for screen, place, shading in _viewports():
        if space is not None and space.type == "VIEW_3D" and shading == cast("Any", space).shading:
            kind, shading.type = shading.type, _COLORS[0]
            kept = _kept(screen)
            kept.setdefault(place, [kind, shading.color_type])
            cast("Any", screen)[_KEPT] = json.dumps(kept)
            shading.color_type = _COLORS[1]


def shade_as_before() -> bool:
    """Shade all viewports as before `shade_by_colors`, but for those that the user has shaded in another way since.

    Returns
    -------
    bool
        Whether there was anything to bring back.
    """
    changed = False
    for screen, place, shading in _viewports():
        before = _kept(screen).get(place)
        if before is not None and (shading.type, shading.color_type) == _COLORS:
            kind, shading.color_type = before
            shading.type = kind
            changed = True
    for screen in bpy.data.screens:
        cast("Any", screen).pop(_KEPT, None)
    return changed


def start_following() -> None:
    """Let viewports follow Undo."""
    for handlers in _handlers():
        handlers.append(_on_undo)


def stop_following() -> None:
    """Undo `start_following`."""
    for handlers in _handlers():
        if _on_undo in handlers:  # another add-on may have cleared the list
            handlers.remove(_on_undo)


def _handlers() -> tuple[list[Any], ...]:
    handlers: Any = bpy.app.handlers
    return handlers.undo_post, handlers.redo_post


@persistent  # type: ignore[untyped-decorator]
def _on_undo(*_arguments: object) -> None:
    """Shade the viewports as before if no scene shows anything any more."""
    if not any(cast("Any", scene).hiermatch_steering.before for scene in bpy.data.scenes):
        shade_as_before()


def _kept(screen: bpy.types.Screen) -> dict[str, list[str]]:
    """Return how the viewports of a screen were shaded before, by their places."""
    found: dict[str, list[str]] = json.loads(cast("Any", screen).get(_KEPT, "{}"))
    return found


def _viewports() -> Iterator[tuple[bpy.types.Screen, str, Any]]:
    """Go through the viewports of all screens: the screen, the place in it, and the shading of each."""
    for screen in bpy.data.screens:
        for number, area in enumerate(screen.areas):
            space: Any = area.spaces.active
            if space is not None and space.type == "VIEW_3D":
                yield screen, str(number), space.shading
