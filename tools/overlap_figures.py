# SPDX-License-Identifier: GPL-3.0-or-later
"""Pictures of what two parts of the demo cats share, for docs/overlap.md.

    python tools/overlap_figures.py [--output docs/images] [--samples N] [--only half,bust,refused]

    overlap-half.jpg      a cat without its rear, and one without head and forepaws
    overlap-bust.jpg      the bust of a cat, and all of one
    overlap-refused.jpg   the front of a cat, and the rear of one

What has a counterpart is blue.  Prints what the panel says to it.  Needs the bpy module.
"""

from __future__ import annotations

import argparse
import tempfile
from pathlib import Path

import bpy
from demo_picture import paint, render, set_stage
from manual_scenes import leave
from source_extension import ROOT, registered_extension

_PARTS = {
    "half": ((-10.0, 0.35), (-0.5, 10.0)),
    "bust": ((-10.0, -0.2), (-10.0, 10.0)),
    "refused": ((-10.0, 0.0), (0.1, 10.0)),
}
"""From where to where source and target go on the Y axis of the rest pose, in which the cats look to -Y."""

_VIEW = (35.0, 14.0)
_WIDTH, _HEIGHT = 640, 360


def picture_of(path: Path, parts: tuple[tuple[float, float], tuple[float, float]], samples: int) -> None:
    """Match what is left of two cats, and render what they share."""
    bpy.ops.wm.read_homefile(use_empty=True)
    bpy.ops.hiermatch.add_demo_pair()
    state = bpy.context.scene.hiermatch
    cats = state.source, state.target
    for cat, part in zip(cats, parts, strict=True):
        leave(cat, *part)
    bpy.ops.hiermatch.match()
    print(f"confidence {state.summary.confidence:.2f}; {state.summary.verdict}", flush=True)
    bpy.ops.hiermatch.show(view="OVERLAP")
    for cat in cats:
        paint(cat, cat.data.attributes.active_color_name)
    set_stage(list(cats), _VIEW, _WIDTH, _HEIGHT)
    with tempfile.TemporaryDirectory() as folder:
        made = Path(folder) / "overlap.png"
        render(made, samples)
        image = bpy.data.images.load(str(made))
        settings = bpy.context.scene.render.image_settings
        settings.file_format, settings.quality = "JPEG", 88
        image.save_render(str(path), scene=bpy.context.scene)
    print(path, flush=True)


def main() -> None:
    """Render the picture."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--output", type=Path, default=ROOT / "docs" / "images")
    parser.add_argument("--samples", type=int, default=16, help="samples of each pixel (default %(default)s)")
    parser.add_argument("--only", default=",".join(_PARTS), help="which of them (default %(default)s)")
    options = parser.parse_args()
    options.output.mkdir(parents=True, exist_ok=True)
    registered_extension()
    for name in options.only.split(","):
        picture_of(options.output.resolve() / f"overlap-{name}.jpg", _PARTS[name], options.samples)


if __name__ == "__main__":
    main()
