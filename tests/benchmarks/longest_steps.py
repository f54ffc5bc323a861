# SPDX-License-Identifier: GPL-3.0-or-later
"""How long the steps of a match are: what a person waits for a window that is drawn between two of them.

    python -m tests.benchmarks.longest_steps --data FOLDER [--pairs cat0:cat1,8_gorilla_01:8_man_01] [--parts 4]

FOLDER is described in `known_shapes`; with --parts every edge is split into so many parts, and 4 make some 80,000
vertices of 5,000.  A step ends where `match_steps` yields, so it is named by that place: the innermost generator, in
the module in which it is.  Of each place are printed the share of all time, the number of steps, and the longest.

All times are those of the process, in seconds.  Other programs make a step longer but never shorter, and steps are
the same in every run: so each is the shortest of several runs.
"""

import argparse
import os
import time
from pathlib import Path

os.environ["HIERMATCH_PROCESSES"] = "1"  # with helpers no two runs have the same steps

import numpy as np

from engine import TriangleMesh, match_steps
from tests.benchmarks.known_shapes import KnownShapes
from tests.benchmarks.variants import subdivide

PAIRS = "cat0:cat1,tr_reg_000:tr_reg_004,8_gorilla_01:8_man_01"


def place(steps):
    """Name the innermost of nested generators that are waiting at a yield."""
    while True:
        inner = steps.gi_yieldfrom
        if inner is None and steps.gi_code.co_name == "within":
            inner = steps.gi_frame.f_locals["steps"]
        if inner is None:
            return f"{Path(steps.gi_code.co_filename).stem}.{steps.gi_code.co_name}"
        steps = inner


def measured(source, target):
    """Match two meshes from cold: the place and the time of each step."""
    x, y = (TriangleMesh(mesh.vertices, mesh.triangles) for mesh in (source, target))  # which keep nothing computed
    steps = match_steps(x, y)
    places, seconds = [], []
    while True:
        start = time.process_time()
        try:
            next(steps)
        except StopIteration:
            return places, np.array(seconds)
        seconds.append(time.process_time() - start)
        places.append(place(steps))


def table(places, seconds, rows):
    """Print the time of all steps, and the places with the longest."""
    print(f"{'':48s} {'share':>6s} {'steps':>6s} {'total':>7s} {'longest':>7s}")
    print(f"{'all':48s} {1:6.1%} {len(seconds):6d} {seconds.sum():7.2f} {seconds.max():7.3f}")
    names, number = np.unique(places, return_inverse=True)
    totals, longest = np.bincount(number, seconds), np.zeros(len(names))
    np.maximum.at(longest, number, seconds)
    counts = np.bincount(number)
    for i in np.argsort(-longest)[:rows]:
        share = totals[i] / seconds.sum()
        print(f"{names[i]:48s} {share:6.1%} {counts[i]:6d} {totals[i]:7.2f} {longest[i]:7.3f}")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--data", type=Path, required=True, help="folder with the shapes")
    parser.add_argument("--pairs", default=PAIRS, help=f"source:target, separated by commas (default: {PAIRS})")
    parser.add_argument("--parts", type=int, default=1, help="into which edges are split (default: not)")
    parser.add_argument("--runs", type=int, default=3, help="of which the shortest times count (default 3)")
    parser.add_argument("--rows", type=int, default=12, help="how many places are printed (default 12)")
    options = parser.parse_args()
    shapes = KnownShapes(options.data)
    for pair in options.pairs.split(","):
        meshes = [shapes.read(name).mesh for name in pair.split(":")]
        if options.parts > 1:
            meshes = [subdivide(mesh, parts=options.parts).mesh for mesh in meshes]
        runs = [measured(*meshes) for _ in range(options.runs)]
        seconds = np.min([seconds for _, seconds in runs], axis=0)
        print(f"\n{pair}, {meshes[0].vertex_count} and {meshes[1].vertex_count} vertices")
        table(runs[0][0], seconds, options.rows)


if __name__ == "__main__":
    main()
