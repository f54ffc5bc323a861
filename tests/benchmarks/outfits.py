# SPDX-License-Identifier: GPL-3.0-or-later
"""Fit outfits to other bodies in Blender, and print the scores beside those of other ways.

    python -m tests.benchmarks.outfits --scenes FOLDER --scorer FILE [--only O1,O3] [--garments]

FOLDER holds scenes, each as a .blend with the meshes BodyA and BodyB and what BodyA wears, bound to its armature and
called A_ and its name, and as an .npz with the truth, which only the scorer reads; and beside the scorer
PEERS-outfits.md, the table of the scores of others.

What is scored is what `hiermatch.wear` makes with its default options, the match included.  The columns are those of
the scorer (see its --help): lengths are in % of the body's height, and 0 is the best everywhere.
"""

import sys
import tempfile
import time
from pathlib import Path

import bpy
import numpy as np

from tests.benchmarks.retarget_scenes import weights_of
from tests.benchmarks.scored_scenes import chosen_scenes, rows_of, scene_parser, scored
from tools.source_extension import registered_extension

OURS = "hiermatch"
PEERS = ("manual_shrink", "shrinkwrap", "rbf_engine", "rbf_push", "proto_engine", "proto_true")


def in_world(obj):
    """Vertices of an object in the world, (n, 3)."""
    points = np.empty(3 * len(obj.data.vertices), np.float32)
    obj.data.vertices.foreach_get("co", points)
    matrix = np.array(obj.matrix_world)
    return points.reshape(-1, 3) @ matrix[:3, :3].T + matrix[:3, 3]


def fit(path):
    """Fit all that BodyA wears to BodyB: positions and weights of each garment by its name."""
    bpy.ops.wm.open_mainfile(filepath=str(path))
    start = time.process_time()
    done = bpy.ops.hiermatch.wear(source="BodyA", target="BodyB")
    seconds = time.process_time() - start
    made = [obj for obj in bpy.data.objects if obj.get("hiermatch_body") == "BodyB" and obj.type == "MESH"]
    report = bpy.context.scene.hiermatch_retarget.report
    print(f"{path.stem}: {done}, {len(made)} items, {seconds:.1f} s of processor time")
    for line in (*report.notes.splitlines(), *report.remarks.splitlines()):
        print(f"  {line}")
    bones = sorted({group.name for obj in made for group in obj.vertex_groups})
    result = {"bones": np.array(bones)}
    for obj in made:
        name = obj["hiermatch_item"].removeprefix("A_")
        result[name], result[f"{name}_weights"] = in_world(obj), weights_of(obj, bones)
    return result


def means(rows, name):
    """The row of the means of rows of the scorer, under the name of who made them."""
    numbers = np.array([[float(cell) if cell != "-" else np.nan for cell in row.split()[1:]] for row in rows])
    cells = (f"{value:8.3f}" if np.isfinite(value) else f"{'-':>8s}" for value in numbers.mean(axis=0))
    return f"{'mean/' + name:34s}" + "".join(cells)


def main():
    parser = scene_parser(__doc__)
    parser.add_argument("--garments", action="store_true", help="print a row for each garment as well")
    options = parser.parse_args()
    registered_extension()
    rows = {name: [] for name in (OURS, *PEERS)}
    with tempfile.TemporaryDirectory() as folder:
        for path in chosen_scenes(options, ".blend"):
            answer = Path(folder, f"{OURS}.npz")
            np.savez(answer, **fit(path))
            more = ["--per-garment"] if options.garments else []
            heading, row, *garments = scored(options.scorer, path.with_suffix(".npz"), answer, *more)
            theirs = rows_of(options.scorer, "PEERS-outfits.md", path.stem, PEERS)
            for name, line in {OURS: row, **theirs}.items():
                rows[name].append(line)
            print("\n".join([heading, row, *garments, *theirs.values()]))
            sys.stdout.flush()
    # Of the scenes that were run, and of who has figures for all of them.
    print("\n".join(["", *(means(all_, name) for name, all_ in rows.items() if all_ and len(all_) == len(rows[OURS]))]))


if __name__ == "__main__":
    main()
