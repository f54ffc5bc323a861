# SPDX-License-Identifier: GPL-3.0-or-later
"""Match real shapes with the operator in Blender, and measure the error against their known correspondence.

    python -m tests.benchmarks.real_pairs --data FOLDER [--pairs cat0:cat1,dog0:dog5] [--points 64] [--setup a]
        [--sparse]
    python -m tests.benchmarks.real_pairs                        the demo pair instead

FOLDER holds .off files and beside them a folder `corres` with NAME.vts and NAME.sym.vts: line i of two shapes names the
same place, in the latter file its mirror image (the layout of the remeshed TOSCA and FAUST collections).

The error of a point is the geodesic distance on the target (potpourri3d's heat method) from its true image to its
match, over the square root of the target's area; a source point without a known image takes that of the nearest vertex
that has one.  Printed are mean and worst for the match that was written, against the true correspondence and against
the mirrored one, and the same for the engine's other answer.
"""

import argparse
import time
from pathlib import Path

import bpy
import numpy as np
import potpourri3d
from scipy.spatial import cKDTree

from tests.benchmarks.common import known, read_off
from tools.source_extension import registered_extension

registered_extension()

from hiermatch.engine.hierarchical.settings import SETUPS  # noqa: E402

from tools import demo_truth  # noqa: E402

PAIRS = "cat0:cat1,dog0:dog5,michael0:michael3"


def add_object(path):
    """Import an .off file as a Blender object."""
    vertices, triangles = read_off(path)
    mesh = bpy.data.meshes.new(path.stem)
    mesh.from_pydata(vertices.tolist(), [], triangles.tolist())
    thing = bpy.data.objects.new(path.stem, mesh)
    bpy.context.scene.collection.objects.link(thing)
    return thing, vertices, triangles


def matched_vertices(thing):
    """Read the matched points back from the vertex groups, each as its heaviest vertex."""
    places = demo_truth.written_places(thing, "HM")
    return np.take_along_axis(places.corners, places.weights.argmax(axis=1)[:, None], axis=1)[:, 0]


def errors(truth, matched, solver, size):
    return np.array([solver.compute_distance(int(m))[t] for t, m in zip(truth, matched, strict=True)]) / size


def measure(path_x, path_y, options):
    bpy.ops.wm.read_homefile(use_empty=True)
    thing_x, vertices_x, _ = add_object(path_x)
    thing_y, vertices_y, triangles_y = add_object(path_y)
    nearest = cKDTree(vertices_x[known(path_x)])
    solver = potpourri3d.MeshHeatMethodDistanceSolver(vertices_y, triangles_y)
    corners = vertices_y[triangles_y]
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    size = np.sqrt(np.linalg.norm(normals, axis=1).sum() / 2)
    rows = []
    for alternative in (0, 1):
        start = time.perf_counter()
        bpy.ops.hiermatch.match(source=thing_x.name, target=thing_y.name, alternative=alternative, **options)
        seconds = time.perf_counter() - start
        _, places = nearest.query(vertices_x[matched_vertices(thing_x)])
        found = matched_vertices(thing_y)
        true = errors(known(path_y)[places], found, solver, size)
        mirror = errors(known(path_y, ".sym")[places], found, solver, size)
        rows.append((true, mirror, seconds))
    return rows


def measure_demo(options):
    bpy.ops.wm.read_homefile(use_empty=True)
    bpy.ops.hiermatch.add_demo_pair()
    state = bpy.context.scene.hiermatch
    rows = []
    for alternative in (0, 1):
        start = time.perf_counter()
        bpy.ops.hiermatch.match(source=state.source.name, target=state.target.name, alternative=alternative, **options)
        seconds = time.perf_counter() - start
        depsgraph = bpy.context.evaluated_depsgraph_get()
        rows.append((*demo_truth.match_errors(state.source, state.target, depsgraph), seconds))
    return rows


def report(name, rows):
    """Print a line, and return what goes into the mean."""
    (true, mirror, seconds), (other_true, other_mirror, _) = rows
    best = true if true.mean() <= mirror.mean() else mirror
    side = "true" if best is true else "MIRRORED"
    other = min((other_true, other_mirror), key=np.mean)
    other_side = "mirrored" if other is other_mirror else "TRUE"
    print(
        f"{name:34s} written: {side:8s} mean {best.mean():.4f} worst {best.max():.4f}"
        f"   other answer: {other_side:8s} mean {other.mean():.4f} worst {other.max():.4f}   {seconds:5.1f} s",
        flush=True,
    )
    return true.mean(), best.mean(), best.max(), seconds


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--data", type=Path, help="folder with the shapes")
    parser.add_argument("--pairs", default=PAIRS, help=f"source:target, separated by commas (default {PAIRS})")
    parser.add_argument("--points", type=int, default=64)
    parser.add_argument("--setup", choices=list(SETUPS), default="a", help="setup of the paper's figure 2 (default a)")
    parser.add_argument("--sparse", action="store_true", help="match the sparse points alone, without the dense map")
    options = parser.parse_args()
    choices = {name: word.upper() for name, word in SETUPS[options.setup][1].items()}
    choices |= {"points": options.points, "dense": not options.sparse}
    print(f"{options.points} points; {SETUPS[options.setup][0]}; errors x sqrt(area)")
    if options.data is None:
        means = [report("demo pair", measure_demo(choices))]
    else:
        paths = {path.stem: path for path in sorted(options.data.rglob("*.off"))}
        pairs = [pair.split(":") for pair in options.pairs.split(",")]
        means = [report(f"{x} -> {y}", measure(paths[x], paths[y], choices)) for x, y in pairs]
    true, best, worst, seconds = np.array(means).T
    print(
        f"mean of {len(means)}: against the truth {true.mean():.4f}, up to symmetry {best.mean():.4f}, "
        f"worst point {worst.max():.4f}, {seconds.mean():.1f} s"
    )


if __name__ == "__main__":
    main()
