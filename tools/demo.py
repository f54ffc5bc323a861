# SPDX-License-Identifier: GPL-3.0-or-later
"""The demo: add a pair of cats in Blender, match them, compare with the truth, and render a picture.

    python tools/demo.py [--output FOLDER] [--points N] [--width PIXELS] [--samples N]

Writes demo.blend and demo.png into build/demo (or FOLDER) and prints a short table.  Needs the bpy module; runs the
extension from this source tree, installed nowhere.
"""

from __future__ import annotations

import argparse
import importlib
import sys
import time
from pathlib import Path
from typing import TYPE_CHECKING, Any

import bpy
import numpy as np
from demo_picture import add_beads, paint, render, set_stage
from source_extension import PACKAGE, ROOT, registered_extension

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence


# Where the camera stands (degrees from the front of the scene to the left of the cats, and up), how much white is mixed
# into the cats so that the beads stand out, how dark the beads are, and their radius over the source's height.
_VIEW = (45.0, 16.0)
_WHITENED = 0.22
_BEAD_SHADE = 0.7
_BEAD_RADIUS = 0.02

# A match whose mean error is larger (x sqrt of the area) has not found the correspondence: the mean of chance is 0.4.
_ACCEPTED_ERROR = 0.12


class DemoError(Exception):
    """The demo did not come to its end; the message says why."""


class Display:
    """Tells on the terminal what is being done."""

    def __init__(self) -> None:
        self._start = time.perf_counter()
        self._shown = -1
        self._live = sys.stdout.isatty()

    def stage(self, text: str) -> None:
        """Announce the next stage."""
        self._shown = -1
        print(f"[{time.perf_counter() - self._start:5.1f} s] {text}", flush=True)

    def progress(self, fraction: float, label: str) -> None:
        """Show how far a stage is: on one line of a terminal, else every tenth part on its own."""
        percent = int(100 * fraction)
        if self._live:
            done = percent // 4
            end = "\n" if percent >= 100 else ""
            print(f"\r          {'#' * done}{'.' * (25 - done)} {percent:3d}%  {label:<40.40}", end=end, flush=True)
        elif percent // 10 > self._shown:
            self._shown = percent // 10
            print(f"          {percent:3d}%  {label}", flush=True)


def module(name: str) -> Any:  # noqa: ANN401 - the type of a module has none of its names
    """Return a module of the registered extension."""
    return importlib.import_module(f"{PACKAGE}.{name}")


def watch_matches(show: Callable[[float, str], None]) -> list[Any]:
    """Make the match operator report its progress, and return the list that gets the outcome of each match.

    Outside of a window the operator works without a pause and returns nothing but its status, so the job that it
    drives is replaced by one that tells.
    """
    outcomes: list[Any] = []
    match_job = module("hiermatch_addon.jobs.match_job")

    class WatchedJob(match_job.MatchJob):
        def advance(self, *arguments: Any) -> bool:  # noqa: ANN401
            finished = super().advance(*arguments)
            show(self.progress.fraction, self.progress.label)
            return finished

        def finish(self, *arguments: Any) -> Any:  # noqa: ANN401
            outcomes.append(super().finish(*arguments))
            return outcomes[-1]

    module("hiermatch_addon.operators.match").MatchJob = WatchedJob
    return outcomes


def match_pair(points: int, display: Display) -> tuple[bpy.types.Object, bpy.types.Object, Any]:
    """Add the demo pair and match it, both with the operators; return source, target and the outcome."""
    outcomes = watch_matches(display.progress)
    display.stage("Building the two cats")
    bpy.ops.hiermatch.add_demo_pair()
    state = bpy.context.scene.hiermatch
    source, target = state.source, state.target
    sizes = [
        f"{cat.name}: {len(cat.data.vertices)} vertices, {len(cat.data.polygons)} faces" for cat in (source, target)
    ]
    display.stage(f"Matching {points} points ({'; '.join(sizes)})")
    bpy.ops.hiermatch.match(source=source.name, target=target.name, points=points)
    if not outcomes:
        raise DemoError("The match operator ended without a match.")
    return source, target, outcomes[-1]


def take_picture(source: bpy.types.Object, target: bpy.types.Object, path: Path, width: int, samples: int) -> None:
    """Paint the match, set the stage and render it."""
    truth = importlib.import_module("demo_truth")
    for cat in (source, target):
        paint(cat, "HM Match", whitened=_WHITENED)
    places = truth.written_places(source, "HM")
    colors = np.empty(4 * len(source.data.vertices), np.float32)
    source.data.attributes["HM Match"].data.foreach_get("color", colors)
    shades = places.interpolate(colors.reshape(-1, 4).astype(float)) * [_BEAD_SHADE, _BEAD_SHADE, _BEAD_SHADE, 1]
    for cat in (source, target):
        beads = truth.written_places(cat, "HM").interpolate(_world_vertices(cat))
        add_beads(f"{cat.name} Points", beads, shades, _BEAD_RADIUS * cat.dimensions.length / 2)
    set_stage([source, target], _VIEW, width, width * 9 // 16)
    render(path, samples)
    if not path.is_file():
        raise DemoError(f"Blender rendered, but did not write {path}.")


def _world_vertices(thing: bpy.types.Object) -> np.ndarray[Any, Any]:
    """Return the vertices of an object in the world, (n, 3)."""
    flat = np.empty(3 * len(thing.data.vertices), np.float32)
    thing.data.vertices.foreach_get("co", flat)
    matrix = np.array(thing.matrix_world)
    return flat.reshape(-1, 3) @ matrix[:3, :3].T + matrix[:3, 3]


def table(outcome: Any, direct: np.ndarray[Any, Any], mirrored: np.ndarray[Any, Any]) -> str:  # noqa: ANN401
    """Write what came out, in a few lines."""
    result = outcome.result
    coarse = result.coarse
    size = f"{len(coarse.source_vertices)} points, {coarse.candidates} candidates, {coarse.nodes} nodes"
    proof = "proven optimal" if coarse.proven else f"not proven: {coarse.cost:.3f}, at least {coarse.lower_bound:.3f}"
    rows = [
        ("Points matched", f"{len(result.source_points)}"),
        ("Distortion", f"{result.distortion:.3f} (linear {result.linear:.3f}, quadratic {result.quadratic:.3f})"),
        ("Coarse match", f"{proof} ({size})"),
        ("Error, mean", f"{direct.mean():.3f} x sqrt(area)"),
        ("Error, worst", f"{direct.max():.3f} x sqrt(area)"),
        ("Against the mirrored truth", f"mean {mirrored.mean():.3f}, worst {mirrored.max():.3f}"),
        *((f"Seconds, {stage}", f"{seconds:.2f}") for stage, seconds in result.seconds.items()),
        ("Seconds, all of the operator", f"{outcome.seconds:.2f}"),
    ]
    width = max(len(name) for name, _ in rows)
    return "\n".join(f"  {name:<{width}}  {value}" for name, value in rows)


def run_demo(output: Path, points: int, width: int, samples: int) -> None:
    """Run all of the demo.

    Raises
    ------
    DemoError, RuntimeError, OSError
        If a step failed.
    """
    output.mkdir(parents=True, exist_ok=True)
    blend, picture = output / "demo.blend", output / "demo.png"
    for old in (blend, picture):
        old.unlink(missing_ok=True)
    display = Display()
    bpy.ops.wm.read_factory_settings(use_empty=True)
    registered_extension()
    source, target, outcome = match_pair(points, display)
    display.stage("Measuring against the truth")
    depsgraph = bpy.context.evaluated_depsgraph_get()
    direct, mirrored = importlib.import_module("demo_truth").match_errors(source, target, depsgraph)
    display.stage(f"Rendering {width} x {width * 9 // 16} pixels")
    take_picture(source, target, picture, width, samples)
    bpy.ops.wm.save_as_mainfile(filepath=str(blend), check_existing=False)
    display.stage("Done")
    print(f"\n{table(outcome, direct, mirrored)}\n\n  {blend}\n  {picture}\n", flush=True)
    if direct.mean() > _ACCEPTED_ERROR:
        which = "left and right were exchanged" if mirrored.mean() <= _ACCEPTED_ERROR else "it is wrong"
        raise DemoError(f"The match does not agree with the truth: {which}.")


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the demo from the command line and return the exit code."""
    parser = argparse.ArgumentParser(description="Match a demo pair in Blender and render a picture of it.")
    parser.add_argument("--output", type=Path, default=ROOT / "build" / "demo", help="folder for the results")
    parser.add_argument("--points", type=int, default=64, help="how many points to match (default: 64)")
    parser.add_argument("--width", type=int, default=1600, help="width of the picture in pixels (default: 1600)")
    parser.add_argument("--samples", type=int, default=12, help="samples per pixel (default: 12)")
    options = parser.parse_args(arguments)
    try:
        run_demo(options.output, options.points, options.width, options.samples)
    except (DemoError, RuntimeError, OSError) as error:
        print(f"The demo failed. {str(error).strip()}", file=sys.stderr)
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
