# SPDX-License-Identifier: GPL-3.0-or-later
"""Find the left-right map of shapes whose true one is known, and measure its error.

    python -m tests.benchmarks.symmetry --data FOLDER [--shapes cat0,dog0] [--points 64] [--dense]
    python -m tests.benchmarks.symmetry                        generated bodies instead

FOLDER holds .off files and beside them a folder `corres` with NAME.vts and NAME.sym.vts, whose i-th lines name a point
and its mirror image (the layout of the remeshed TOSCA and FAUST collections).

The error of a point is the geodesic distance from its true mirror image to the one found, over the square root of the
area; a point whose image is not known takes that of the nearest vertex that has one.  Printed are also the asymmetry of
the map found and of the true one, the runner-up among the other symmetries, and how many of the vertices whose image is
known lie on the other side of the axis than their image.  With --dense follow mean, 95th percentile and maximum of the
errors of `symmetry_map`, rounded to vertices, at 200 vertices spread over the shape.
"""

import argparse
import time
from pathlib import Path

import numpy as np
from scipy.spatial import cKDTree

from engine.geometry.geodesics import GeodesicSolver
from engine.geometry.sampling import farthest_point_sampling
from engine.hierarchical.settings import MatchSettings
from engine.matching import symmetry_map
from engine.matching.symmetry import find_symmetry
from engine.mesh.triangle_mesh import TriangleMesh
from tests.benchmarks.common import known, read_off
from tests.bodies import mirrored_body
from tests.shapes import creature


def known_images(path, mesh):
    """For each vertex its mirror image, that of the nearest vertex that has one."""
    _, nearest = cKDTree(mesh.vertices[known(path)]).query(mesh.vertices)
    return known(path, ".sym")[nearest]


def measure(mesh, truth, points):
    """Errors of the points, the result, the asymmetry of the truth and the seconds."""
    start = time.perf_counter()
    result = find_symmetry(mesh, MatchSettings(points=points))
    seconds = time.perf_counter() - start
    solver, size = GeodesicSolver(mesh), np.sqrt(mesh.area)
    chosen, found = result.source_points.nearest_vertices, result.target_points.nearest_vertices
    rows, true_rows = (
        np.concatenate([block for _, block in solver.distances_in_blocks(v)]) / size for v in (chosen, truth[chosen])
    )
    errors = true_rows[np.arange(len(chosen)), found]
    change = rows[:, chosen] - true_rows[:, truth[chosen]]
    asymmetry = np.sqrt(np.square(change).sum() / (len(chosen) * (len(chosen) - 1)))
    return errors, result, asymmetry, seconds


def report_dense(mesh, truth):
    """Print a line on the map of all vertices, and return its mean error."""
    start = time.perf_counter()
    found = symmetry_map(mesh)
    seconds = time.perf_counter() - start
    solver = GeodesicSolver(mesh)
    chosen = farthest_point_sampling(solver.graph, min(200, mesh.vertex_count), 0)
    images = found.source_to_target.nearest_vertices[chosen]
    rows = np.concatenate([block for _, block in solver.distances_in_blocks(truth[chosen])])
    errors = rows[np.arange(len(chosen)), images] / np.sqrt(mesh.area)
    margin = "none" if found.quality.margin is None else f"{found.quality.margin:.2f}"
    print(
        f"{'all vertices':>14s} error mean {errors.mean():.4f} 95 % {np.percentile(errors, 95):.4f} "
        f"worst {errors.max():.4f}   margin {margin}   confidence {found.quality.confidence:.2f}   {seconds:5.1f} s",
        flush=True,
    )
    return errors.mean()


def report(name, mesh, truth, points, dense):
    """Print a line, or two, and return what goes into the mean."""
    errors, result, true_asymmetry, seconds = measure(mesh, truth, points)
    opposite = (result.sides * result.sides[truth] < 0)[truth != np.arange(len(truth))].mean()
    other = f"{result.alternatives[0].asymmetry:.3f}" if result.alternatives else "none"
    print(
        f"{name:14s} error mean {errors.mean():.4f} worst {errors.max():.4f}   asymmetry {result.asymmetry:.4f} "
        f"(true map {true_asymmetry:.4f}, next {other})   orientation {result.orientation:+.2f}   "
        f"twice {result.involution:.3f}   opposite sides {opposite:.1%}   {seconds:5.1f} s",
        flush=True,
    )
    everywhere = report_dense(mesh, truth) if dense else np.nan
    return errors.mean(), errors.max(), result.asymmetry, seconds, everywhere


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--data", type=Path, help="folder with the shapes")
    parser.add_argument("--shapes", help="names of shapes, separated by commas (default all)")
    parser.add_argument("--points", type=int, default=64)
    parser.add_argument("--dense", action="store_true", help="also the map of all vertices")
    options = parser.parse_args()
    print(f"{options.points} points; errors and asymmetry x sqrt(area)")
    rows = []
    if options.data is None:
        for pose in (0.0, 0.5, 1.0):
            vertices, triangles, rest = mirrored_body(pose, seed=1)
            _, truth = cKDTree(rest).query(rest * [1, -1, 1])
            rows.append(report(f"body {pose}", TriangleMesh(vertices, triangles), truth, options.points, options.dense))
        for pose in (0.0, 1.0):
            vertices, triangles, _ = creature(pose)
            result = find_symmetry(TriangleMesh(vertices, triangles), MatchSettings(points=options.points))
            print(f"creature {pose}, not symmetric: asymmetry {result.asymmetry:.4f}")
    else:
        chosen = options.shapes.split(",") if options.shapes else None
        for path in sorted(options.data.rglob("*.off")):
            if chosen is None or path.stem in chosen:
                mesh = TriangleMesh(*read_off(path))
                rows.append(report(path.stem, mesh, known_images(path, mesh), options.points, options.dense))
    mean, worst, asymmetry, seconds, everywhere = np.array(rows).T
    print(
        f"mean of {len(rows)}: error {mean.mean():.4f}, above 0.1 in {(mean > 0.1).sum()}, median worst point "
        f"{np.median(worst):.4f}, asymmetry {asymmetry.mean():.4f}, {seconds.mean():.1f} s"
    )
    if options.dense:
        print(f"all vertices: error {everywhere.mean():.4f}, above 0.03 in {(everywhere > 0.03).sum()}")


if __name__ == "__main__":
    main()
