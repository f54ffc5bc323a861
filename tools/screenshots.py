# SPDX-License-Identifier: GPL-3.0-or-later
"""Take the pictures of the manual in a real Blender window.

    blender --factory-startup --enable-event-simulate --window-geometry 0 0 1600 1000 \
        --python tools/screenshots.py -- FOLDER PAGE[,PAGE ...] [COMMAND ...]

Any Blender from 4.3 on with NumPy and SciPy will do; the extension is loaded from this source tree.  A PAGE is one of
those in `PAGES`, or `all`; their modules say which pictures they save into FOLDER, with docs/images as the place for
all of them.  Blender ends with an error if a step failed.

Blender cannot read its own pixels on some screens, virtual ones above all.  There, name a COMMAND that takes a picture
of the whole screen and is given the file to write, such as `import -window root` of ImageMagick.
"""

from __future__ import annotations

import sys
import traceback
from pathlib import Path
from typing import TYPE_CHECKING

import bpy

sys.path.insert(0, str(Path(__file__).resolve().parent))

import page_first_match
import page_install
import page_motion
import page_retargeting
import page_scan
import page_settings
import page_steering
import page_symmetry
import page_wear
from camera import Camera
from screen import choose_tab, large_view, register_unfolded, set_scene, show_panels

if TYPE_CHECKING:
    from collections.abc import Iterator

PAGES = {
    "install": page_install.pictures,
    "first-match": page_first_match.pictures,
    "settings": page_settings.pictures,
    "steering": page_steering.pictures,
    "retargeting": page_retargeting.pictures,
    "motion": page_motion.pictures,
    "wear": page_wear.pictures,
    "scan": page_scan.pictures,
    "symmetry": page_symmetry.pictures,
}
"""The pages of the manual that have pictures, in the order in which they are taken."""

_PAUSE = 0.8
"""Seconds between two drawings of the window: enough in software, too."""

_DRAWINGS = 2
"""How often it is drawn between two steps: new sections of panels are measured at first, and seen at last."""


def walk(names: list[str], camera: Camera) -> Iterator[float | None]:
    """Go through the pages; wherever it yields, the window is drawn."""
    set_scene()
    large_view()
    show_panels("HierMatch")
    yield None
    choose_tab()
    yield None
    for name in names:
        yield from PAGES[name](camera)


def main(arguments: list[str]) -> None:
    """Let Blender's own timer do one step after the other, so that the window is drawn in between."""
    if len(arguments) < 2:
        sys.exit("Name a folder for the pictures, and pages: " + ", ".join(["all", *PAGES]))
    folder = Path(arguments[0]).resolve()
    folder.mkdir(parents=True, exist_ok=True)
    names = list(PAGES) if arguments[1] == "all" else arguments[1].split(",")
    bpy.context.preferences.view.show_splash = bpy.context.preferences.view.show_tooltips = False
    register_unfolded()
    steps = walk(names, Camera(folder, arguments[2:]))

    to_draw = 0

    def advance() -> float | None:
        nonlocal to_draw
        if to_draw:
            to_draw -= 1
            bpy.context.window_manager.windows[0].screen.areas[0].tag_redraw()
            return _PAUSE
        try:
            pause = next(steps)
        except StopIteration:
            bpy.ops.wm.quit_blender()
            return None
        except Exception:  # noqa: BLE001 - whatever it is, nobody sits before this window
            traceback.print_exc()
            sys.exit(1)
        if pause is None:
            to_draw, pause = _DRAWINGS, _PAUSE
        return pause

    bpy.app.timers.register(advance, first_interval=_PAUSE, persistent=True)


main(sys.argv[sys.argv.index("--") + 1 :] if "--" in sys.argv else [])
