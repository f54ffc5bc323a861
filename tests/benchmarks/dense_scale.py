# SPDX-License-Identifier: GPL-3.0-or-later
"""Match two shapes at growing resolution, up to a million vertices: time, memory, and what becomes of the maps.

    python -m tests.benchmarks.dense_scale --data FOLDER [--pair cat0:cat1] [--levels 4,8,16] [--coarse 2000]

FOLDER is described in `known_shapes`.  At each level both shapes have their edges split into so many parts: 4, 8 and 16
make some 80,000, 320,000 and 1,280,000 vertices of 5,000; the surface stays the same.  At last one shape, decimated to
--coarse vertices, is matched with the other at the first level, and the other way round.  Printed are

    seconds   from two meshes to both maps, in a process of its own
    peak      the largest resident memory of that process, and before the match, in megabytes
    helper    the same of the process that took over parts of its work, or `before` if that is more: it starts as a copy
    direct    mean error of source_to_target rounded to the vertices of the shape as it was read (see `known_shapes`);
              the images are first carried back to it, so that every level is measured alike
    inside    the same, not rounded
    ratio     `inside` by that of the shapes as they were read, which come first
    reverse   like `inside`, of target_to_source
    stretch, flipped   root mean squared edge stretch, and share of the area that is turned over, of source_to_target on
              the meshes that were matched, then of target_to_source
"""

import argparse
import multiprocessing
import resource
import sys
import time
from pathlib import Path

from engine import MatchSettings, match
from engine.runtime.worker import close_helpers
from tests.benchmarks.known_shapes import LISTED, KnownShapes, score
from tests.benchmarks.variants import as_is, decimate, subdivide


def peak(of=resource.RUSAGE_SELF):
    """Largest resident memory of this process so far, or of children that have ended, in megabytes."""
    return resource.getrusage(of).ru_maxrss / (1e6 if sys.platform == "darwin" else 1e3)


def peak_of_helpers():
    """End the helpers, and return the largest resident memory of any of them, in megabytes."""
    close_helpers()
    return peak(resource.RUSAGE_CHILDREN)


def resolution(mesh, number):
    """Subdivide a mesh if the number is of parts of an edge, or decimate it if it is minus the number of vertices."""
    if number < 0:
        return decimate(mesh, share=-number / mesh.vertex_count)
    return subdivide(mesh, parts=number) if number > 1 else as_is(mesh)


def measure(task):
    """Match a pair of shapes at the resolutions that two numbers tell, and return what is printed of it."""
    shapes, names, numbers = task
    source, target = (shapes.read(name) for name in names)
    x, y = (resolution(shape.mesh, number) for shape, number in zip((source, target), numbers, strict=True))
    before = peak()
    start = time.perf_counter()
    result = match(x.mesh, y.mesh, MatchSettings(dense=True))
    seconds = time.perf_counter() - start
    after = peak()
    forth, back = result.source_to_target, result.target_to_source
    found = score(source, target, x.images(source.samples, forth, y))
    reverse = score(target, source, y.images(target.samples, back, x))
    return {
        "counts": (x.mesh.vertex_count, y.mesh.vertex_count),
        "seconds": seconds,
        "peak": (after, before, peak_of_helpers()),
        "found": found,
        "reverse": reverse,
        "stretch": (forth.rms_edge_stretch(x.mesh, y.mesh), back.rms_edge_stretch(y.mesh, x.mesh)),
        "flipped": (forth.flipped_faces(x.mesh, y.mesh), back.flipped_faces(y.mesh, x.mesh)),
    }


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--data", type=Path, required=True, help="folder with the shapes")
    parser.add_argument("--pair", default=LISTED.split(",")[0], help="source:target (default the first listed pair)")
    parser.add_argument("--levels", default="4,8,16", help="parts of each edge, separated by commas (default 4,8,16)")
    parser.add_argument("--coarse", type=int, default=2000, help="vertices of the decimated shape; 0: leave it out")
    options = parser.parse_args()
    shapes, names = KnownShapes(options.data), tuple(options.pair.split(":"))
    levels = [int(level) for level in options.levels.split(",") if level]
    numbers = [(1, 1), *((level, level) for level in levels)]
    if options.coarse:
        fine = levels[0] if levels else 1
        numbers += [(-options.coarse, fine), (fine, -options.coarse)]
    print(f"{' -> '.join(names)}; errors x 100 / sqrt(area)")
    print(
        f"{'vertices':>21s} {'seconds':>8s} {'peak':>6s} {'before':>6s} {'helper':>6s} {'direct':>7s} {'inside':>7s} "
        f"{'ratio':>6s} {'reverse':>7s} {'ratio':>6s} {'stretch':>15s} {'flipped':>15s}"
    )
    first = None
    # A new process for each: its peak is of this match alone.
    with multiprocessing.get_context("spawn").Pool(1, maxtasksperchild=1) as pool:
        for row in pool.imap(measure, [(shapes, names, pair) for pair in numbers], chunksize=1):
            found, reverse = row["found"], row["reverse"]
            first = first or (found.inside, reverse.inside)
            print(
                f"{row['counts'][0]:>10d} {row['counts'][1]:>10d} {row['seconds']:8.1f} "
                f"{row['peak'][0]:6.0f} {row['peak'][1]:6.0f} {row['peak'][2]:6.0f} "
                f"{found.direct:7.2f} {found.inside:7.2f} "
                f"{found.inside / first[0]:6.3f} {reverse.inside:7.2f} {reverse.inside / first[1]:6.3f} "
                f"{row['stretch'][0]:7.3f} {row['stretch'][1]:7.3f} {row['flipped'][0]:7.2%} {row['flipped'][1]:7.2%}  "
                f"{found.flip.upper()}",
                flush=True,
            )


if __name__ == "__main__":
    main()
