# SPDX-License-Identifier: GPL-3.0-or-later
"""Use the extension in a real Blender window as a person does, and take a picture after each step.

    blender --factory-startup --enable-event-simulate --window-geometry 0 0 1600 1000 \
        --python tools/walkthrough.py -- FOLDER [COMMAND ...]

Any Blender from 4.3 on with NumPy and SciPy will do; the extension is loaded from this source tree.  The operators run
as they do when their buttons are pressed, in slices between which the window is drawn and events arrive; keys are
pressed by simulated events.  After each step it is checked what became of it; the first that failed ends Blender with
an error.  Writes into FOLDER

    01-demo.png          the demo pair, the standing cat rigged
    02-progress.png      while it is matched
    03-cancelled.png     after Esc: nothing was written
    04-matched.png       matched, after all
    05-flipped.png       the mirrored answer
    06-landmark.png      the first answer again, with a landmark; the matched points are drawn
    07-refined.png       refined around it
    08-undone.png        undone, twice
    09-reopened.png      saved, and opened again
    10-retargeted.png    retargeted, and posed with the new rig

Blender cannot read its own pixels on some screens, virtual ones above all: see `screenshots.py` for COMMAND.
"""

from __future__ import annotations

import sys
import time
from pathlib import Path
from typing import TYPE_CHECKING, Any

import bpy

ROOT = Path(__file__).resolve().parent.parent
sys.path.insert(0, str(ROOT / "tools"))

from screen import choose_tab, picture, scroll_sidebar, set_scene, view  # noqa: E402 - no script's folder is on the path
from source_extension import load_extension  # noqa: E402
from window_events import check, key, play, press, running, until  # noqa: E402

if TYPE_CHECKING:
    from collections.abc import Callable


def state() -> Any:  # noqa: ANN401 - a property group
    """Return the panel's state."""
    return bpy.context.scene.hiermatch


def walk(folder: Path, command: list[str]) -> Any:  # noqa: ANN401 - a generator of pauses
    """Go through all steps; wherever it yields, the window is drawn."""

    def look(name: str) -> None:
        picture(folder / f"{name}.png", command)()

    yield from cancel_a_match(look)
    yield from match_and_flip(look)
    yield from steer(look)
    yield from reopen_and_retarget(look, folder / "walkthrough.blend")


def cancel_a_match(look: Callable[[str], None]) -> Any:  # noqa: ANN401 - a generator of pauses
    """Add the demo pair, match it, and press Esc."""
    progress = bpy.context.window_manager.hiermatch
    set_scene(rigged=True)
    bpy.ops.ed.undo_push(message="Demo")
    yield  # the sidebar must have been drawn to have tabs
    choose_tab()
    yield
    look("01-demo")

    press(bpy.ops.hiermatch.match)
    yield from until(lambda: progress.fraction > 0.3, "The first third of the match")
    look("02-progress")
    key("ESC")
    pressed = time.monotonic()
    yield from until(lambda: not running(), "Cancelling")
    print(f"cancelled after {time.monotonic() - pressed:.2f} s", flush=True)
    check(not state().target.vertex_groups, "Esc left something on the target")
    look("03-cancelled")


def match_and_flip(look: Callable[[str], None]) -> Any:  # noqa: ANN401 - a generator of pauses
    """Match it after all, and exchange the two answers twice."""
    press(bpy.ops.hiermatch.match)
    yield from until(lambda: not running(), "The match")
    check(state().summary.points == state().points, "The match was not finished")
    look("04-matched")

    press(bpy.ops.hiermatch.flip)
    yield from until(lambda: not running(), "Flipping")
    check(state().summary.answer == 1, "The mirrored answer was not written")
    look("05-flipped")
    press(bpy.ops.hiermatch.flip)
    yield from until(lambda: not running(), "Flipping back")
    check(state().summary.answer == 0, "The first answer was not written again")


def steer(look: Callable[[str], None]) -> Any:  # noqa: ANN401 - a generator of pauses
    """Add a landmark, refine around it, and undo both."""
    tips = [min(obj.data.vertices, key=lambda v: v.co.y).index for obj in (state().source, state().target)]
    nose = nearest_on_target(tips[0])
    press(bpy.ops.hiermatch.add_landmark, source_vertex=tips[0], target_vertex=nose)
    steering = bpy.context.scene.hiermatch_steering
    check(len(steering.landmarks) == 1, "The landmark is not in the list")
    steering.show_overlay = True
    yield
    look("06-landmark")
    steering.show_overlay = False
    press(bpy.ops.hiermatch.refine)
    yield from until(lambda: not running(), "Refining")
    look("07-refined")

    for _ in range(2):
        with bpy.context.temp_override(**view()):
            bpy.ops.ed.undo()
        yield
    check(state().target is not None, "Undo took too much back")
    look("08-undone")


def reopen_and_retarget(look: Callable[[str], None], path: Path) -> Any:  # noqa: ANN401 - a generator of pauses
    """Save, open the file again, and retarget."""
    target = state().target.name
    bpy.ops.wm.save_as_mainfile(filepath=str(path))
    bpy.ops.wm.open_mainfile(filepath=str(path))
    yield
    check(state().summary.points, "The match was lost with the file")
    check("HM Map Weights" in bpy.data.objects[target].data.attributes, "The map was lost with the file")
    choose_tab()
    yield
    look("09-reopened")

    press(bpy.ops.hiermatch.retarget)
    yield from until(lambda: not running(), "Retargeting")
    walking = state().target
    armature = next((m.object for m in walking.modifiers if m.type == "ARMATURE"), None)
    check(armature is not None, "The target got no rig")
    for name, turn in {"upper_arm.L": -1.0, "forearm.L": 0.9, "neck": -0.5, "tail.1": -0.8}.items():
        bone = armature.pose.bones[name]
        bone.rotation_mode = "XYZ"
        bone.rotation_euler = (turn, 0.0, 0.0)
    scroll_sidebar()
    yield
    look("10-retargeted")


def nearest_on_target(vertex: int) -> int:
    """Return the vertex of the target that the map takes for one of the source."""
    attributes = state().source.data.attributes
    corners = [attributes[f"HM Map Vertex {number}"].data[vertex].value for number in (1, 2, 3)]
    weights = list(attributes["HM Map Weights"].data[vertex].vector)
    return corners[weights.index(max(weights))]


def main(arguments: list[str]) -> None:
    """Let Blender's own timer do one step after the other."""
    if not arguments:
        sys.exit("Name a folder for the pictures.")
    folder = Path(arguments[0]).resolve()
    folder.mkdir(parents=True, exist_ok=True)
    bpy.context.preferences.view.show_splash = False
    load_extension().register()
    play(walk(folder, arguments[1:]))


main(sys.argv[sys.argv.index("--") + 1 :] if "--" in sys.argv else [])
