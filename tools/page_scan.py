# SPDX-License-Identifier: GPL-3.0-or-later
"""The pictures of docs/scan-to-rig.md.

    scan.jpg  a scan with noise and holes beside the rigged cat; with the cat's rig; and posed with it

`tools/screenshots.py` takes them.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import bpy
from camera import Caption, seen
from manual_scenes import to_scan
from page_retargeting import pose, retarget
from screen import fold, set_scene, show_panels, view

if TYPE_CHECKING:
    from collections.abc import Iterator

    from camera import Camera

_ROOM_FOR_TAIL = 110
"""Pixels at the right that the tail needs when it is posed."""


def pictures(camera: Camera) -> Iterator[float | None]:
    """Make the walking cat a scan, and retarget the standing one to it."""
    set_scene(rigged=True)
    state = bpy.context.scene.hiermatch
    to_scan(state.target)
    fold()
    show_panels("Retarget")
    bpy.context.scene.hiermatch_retarget.use_uvs = False  # a scan has a texture of its own
    view()["space_data"].shading.color_type = "MATERIAL"
    cats = [state.source, state.target]
    steps = {
        "The scan": lambda: None,
        "Retargeted": lambda: retarget(use_uvs=False),
        "Posed with its rig": lambda: pose(state.target),
    }
    caption, looks, box = Caption(), [], seen(cats)
    box = box._replace(right=box.right + _ROOM_FOR_TAIL)
    for text, step in steps.items():
        step()
        caption.show(text, box)
        yield None
        looks.append(camera.look(box))
    caption.hide()
    camera.save("scan", [[look] for look in looks])
    camera.save("scan-report", [[camera.panel()]])
