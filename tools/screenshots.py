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
from window_events import play

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
    play(walk(names, Camera(folder, arguments[2:])))


main(sys.argv[sys.argv.index("--") + 1 :] if "--" in sys.argv else [])
