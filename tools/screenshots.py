# SPDX-License-Identifier: GPL-3.0-or-later
"""Take the documentation's pictures of the panel in a real Blender window.

    blender --factory-startup --window-geometry 0 0 1600 1000 --python tools/screenshots.py -- [FOLDER [COMMAND ...]]

Any Blender from 4.3 on with NumPy and SciPy will do; the extension is loaded from this source tree.  Writes into
build/screenshots (or FOLDER), and ends Blender with an error if a step failed:

    before.png      the demo pair, before a match
    panel.png       after it, with the colors of the match; docs/images/panel.png is a copy of it
    distortion.png  the colors that show the distortion of the match
    confidence.png  the colors that show how far it can be trusted
    flipped.png     the mirrored match
    stale.png       a mesh was edited since
    advanced.png    all sections of the panel open
    retarget.png    a rigged cat has lent its rig to the other one, which has been posed with it

Blender cannot read its own pixels on some screens, virtual ones above all.  There, name a COMMAND that takes a picture
of the screen and is given the file to write.  The picture in the documentation was taken with
`import -window root -crop 1320x760+0+29 +repage -resize 75% +dither -colors 192 -depth 8 -strip`,
which leaves the viewport.
"""

from __future__ import annotations

import importlib
import sys
import traceback
from pathlib import Path
from typing import TYPE_CHECKING, Any

import bpy

ROOT = Path(__file__).resolve().parent.parent
sys.path.insert(0, str(ROOT / "tools"))

from screen import choose_tab, picture, scroll_sidebar, set_scene, view  # noqa: E402 - no script's folder is on the path
from source_extension import PACKAGE, load_extension  # noqa: E402

if TYPE_CHECKING:
    from collections.abc import Callable

_PAUSE = 1.5
"""Seconds between two steps: enough for a window to be drawn, in software too."""


class OpenLayout:
    """A layout whose collapsible sections start open; everything else is the layout's own."""

    def __init__(self, layout: bpy.types.UILayout) -> None:
        object.__setattr__(self, "layout", layout)

    def __getattr__(self, name: str) -> Any:  # noqa: ANN401 - whatever the layout has
        return getattr(self.layout, name)

    def __setattr__(self, name: str, value: object) -> None:
        setattr(self.layout, name, value)

    def panel(self, name: str, **_names: bool) -> Any:  # noqa: ANN401 - a pair of layouts or None
        """Open a section; under another name, because Blender remembers which were closed."""
        return self.layout.panel(f"{name}_open", default_closed=False)


def match() -> None:
    """Match the pair, without a pause."""
    with bpy.context.temp_override(**view()):
        bpy.ops.hiermatch.match()


def flip() -> None:
    """Write the mirrored match."""
    with bpy.context.temp_override(**view()):
        bpy.ops.hiermatch.flip()


def show_colors(name: str) -> Callable[[], None]:
    """Return a step that shows a color attribute of the match on both meshes."""

    def show() -> None:
        state = bpy.context.scene.hiermatch
        for obj in (state.source, state.target):
            obj.data.attributes.active_color_name = f"{state.prefix} {name}"
            obj.data.update()

    return show


def edit() -> None:
    """Move a vertex, as editing does."""
    mesh = bpy.context.scene.hiermatch.source.data
    mesh.vertices[0].co *= 1.01
    mesh.update()


def open_sections() -> None:
    """Draw the panel with its sections open from now on."""
    panels = importlib.import_module(f"{PACKAGE}.hiermatch_addon.panels")
    own = panels.layout_of
    panels.layout_of = lambda owner: OpenLayout(own(owner))
    view()["area"].tag_redraw()


def retarget() -> None:
    """Let the walking cat have the rig of the standing one, and lift a leg and its head with it."""
    set_scene(rigged=True)
    with bpy.context.temp_override(**view()):
        bpy.ops.hiermatch.retarget()
        view()["space_data"].shading.color_type = "MATERIAL"
        target = bpy.context.scene.hiermatch.target
        armature = next(modifier.object for modifier in target.modifiers if modifier.type == "ARMATURE")
        for name, turn in {"upper_arm.L": -1.0, "forearm.L": 0.9, "neck": -0.5, "tail.1": -0.8}.items():
            bone = armature.pose.bones[name]
            bone.rotation_mode = "XYZ"
            bone.rotation_euler = (turn, 0.0, 0.0)
        bpy.context.view_layer.update()


def main(arguments: list[str]) -> None:
    """Let Blender's own timer do one step after the other, so that the window is drawn in between."""
    folder = (Path(arguments[0]) if arguments else ROOT / "build" / "screenshots").resolve()
    folder.mkdir(parents=True, exist_ok=True)
    command = arguments[1:]
    bpy.context.preferences.view.show_splash = False
    load_extension().register()
    steps = iter(
        [
            set_scene,
            choose_tab,
            picture(folder / "before.png", command),
            match,
            picture(folder / "panel.png", command),
            show_colors("Distortion"),
            picture(folder / "distortion.png", command),
            show_colors("Confidence"),
            picture(folder / "confidence.png", command),
            show_colors("Match"),
            flip,
            picture(folder / "flipped.png", command),
            flip,
            edit,
            picture(folder / "stale.png", command),
            retarget,
            scroll_sidebar,
            picture(folder / "retarget.png", command),
            set_scene,
            open_sections,
            picture(folder / "advanced.png", command),
        ]
    )

    def advance() -> float | None:
        step = next(steps, None)
        if step is None:
            bpy.ops.wm.quit_blender()
            return None
        try:
            step()
        except Exception:  # noqa: BLE001 - whatever it is, nobody sits before this window
            traceback.print_exc()
            sys.exit(1)
        return _PAUSE

    bpy.app.timers.register(advance, first_interval=_PAUSE)


main(sys.argv[sys.argv.index("--") + 1 :] if "--" in sys.argv else [])
