# SPDX-License-Identifier: GPL-3.0-or-later
"""The pictures of docs/first-match.md, and of the states that docs/troubleshooting.md names.

    demo-pair.jpg     the demo pair and the panel, before a match
    progress.jpg      the panel while it is matched
    matched.jpg       the pair in the colors of its match, and the panel
    views.jpg         all that Show can show
    exchanged.jpg     the mirrored match, and what the panel says to it
    out-of-date.jpg   what the panel says after an edit

`tools/screenshots.py` takes them.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import bpy
from camera import Caption, seen
from screen import fold, set_scene, show_panels, view
from window_events import key, press, running, until

if TYPE_CHECKING:
    from collections.abc import Iterator

    from camera import Camera

_FAR_ENOUGH = 0.2
"""How far a match is when its progress is shown."""

_VIEWS = (
    ("MATCH", "Match Colors"),
    ("DISTORTION", "Distortion"),
    ("CONFIDENCE", "Confidence"),
    ("REGIONS", "Regions"),
    ("CHECKER", "Checker"),
)


def pictures(camera: Camera) -> Iterator[float | None]:
    """Match the demo pair, look at it in all ways, mirror and edit it."""
    state = bpy.context.scene.hiermatch
    set_scene()
    fold()
    show_panels("HierMatch")
    yield None
    camera.take_with_panel("demo-pair", [state.source, state.target])
    press(bpy.ops.hiermatch.match)
    progress = bpy.context.window_manager.hiermatch
    yield from until(lambda: progress.fraction > _FAR_ENOUGH, "The match")
    camera.save("progress", [[camera.panel()]])
    key("ESC")
    yield from until(lambda: not running(), "Cancelling")
    with bpy.context.temp_override(**view()):
        bpy.ops.hiermatch.match()  # without a pause: where drawing is slow, all of it takes long
    state.summary.seconds = 0.0  # and how long says nothing about other machines: the panel leaves it out then
    show("MATCH")
    yield None
    camera.take_with_panel("matched", [state.source, state.target])
    yield from views(camera)
    show("MATCH")
    with bpy.context.temp_override(**view()):
        bpy.ops.hiermatch.flip()
    yield None
    camera.take_with_panel("exchanged", [state.source, state.target])
    with bpy.context.temp_override(**view()):
        bpy.ops.hiermatch.flip()
    mesh = state.source.data
    mesh.vertices[0].co *= 1.01
    mesh.update()
    yield None
    camera.save("out-of-date", [[camera.panel()]])


def views(camera: Camera) -> Iterator[float | None]:
    """Put one view beside the other."""
    state, caption = bpy.context.scene.hiermatch, Caption()
    box = seen([state.source, state.target])
    looks = []
    for name, text in _VIEWS:
        show(name)
        caption.show(text, box)
        yield None
        looks.append(camera.look(box))
    caption.hide()
    show_panels("HierMatch", "Show")
    yield None
    buttons = camera.panel()
    show_panels("HierMatch")
    camera.save("views", [looks[:2], looks[2:4], [looks[4], buttons[: len(looks[4])]]])


def show(name: str) -> None:
    """Press one of the buttons under Show."""
    with bpy.context.temp_override(**view()):
        bpy.ops.hiermatch.show(view=name)
