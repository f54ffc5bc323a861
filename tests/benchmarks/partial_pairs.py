# SPDX-License-Identifier: GPL-3.0-or-later
"""Match whole shapes with parts of others, cut off by a plane, and say how good the maps are.

    python -m tests.benchmarks.partial_pairs --data FOLDER [--pairs 20] [--seed 1] [--kept 0.9,0.7,0.5]
                                          [--source-kept 1] [--jobs 2]

FOLDER and the error of a map are described in `known_shapes`.  Of each pair of poses the target is cut by a plane of
random direction, so that the largest part on one side of it has the given share of its area; the rest is removed.  The
source can be cut by another such plane; then only places that both parts still have are compared.  A row holds

    to part, of part   mean error of source_to_target at places that the part still has, and of target_to_source
    lost               share of those places where the latter is more than 20 away
    conf., coverage    what the match says of itself: result.quality.confidence and .coverage
    seconds            from two meshes to both maps

Errors are geodesic distances on the whole shapes, over the square root of their area, times 100.
"""

import argparse
import time
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components

from engine import HierMatchError, MatchSettings, TriangleMesh, match
from tests.benchmarks.common import each_in_its_process
from tests.benchmarks.known_shapes import LOST, KnownShapes

OTHER_PLANE = 1000
"""What is added to the seed of the plane that cuts the target for that of the source."""

WRONG = 0.05
"""Share of places from which on a map with so many that are lost is counted as wrong."""


@dataclass(frozen=True, eq=False)
class Part:
    """What a plane leaves of a mesh, and the vertices of the whole that its vertices are, (n,)."""

    mesh: TriangleMesh
    vertices: np.ndarray


def cut_off(mesh, share, seed):
    """Cut a mesh by planes of random direction until the largest part on one side has `share` of the area."""
    random = np.random.default_rng(seed)
    areas = mesh.triangle_areas
    for _ in range(1000):
        normal = random.standard_normal(3)
        heights = (mesh.vertices @ normal)[mesh.triangles].max(axis=1)
        order = np.argsort(heights)
        # What is on one side may be in several parts: then more has to be on that side.
        for more in np.linspace(0, 1 - share, 8)[:-1]:
            count = np.searchsorted(np.cumsum(areas[order]), (share + more) * mesh.area)
            kept = largest_part(mesh, order[:count])
            if abs(areas[kept].sum() / mesh.area - share) < 0.02:
                vertices, triangles = np.unique(mesh.triangles[kept], return_inverse=True)
                return Part(TriangleMesh(mesh.vertices[vertices], triangles.reshape(-1, 3)), vertices)
    message = "No plane cuts off a part of that size."
    raise ValueError(message)


def largest_part(mesh, triangles):
    """Those of some triangles (m,) that belong to their largest connected part."""
    a, b, c = mesh.triangles[triangles].T
    n = mesh.vertex_count
    graph = coo_array((np.ones(2 * len(a)), (np.append(a, b), np.append(b, c))), shape=(n, n))
    labels = connected_components(graph, directed=False)[1][a]
    return triangles[labels == np.bincount(labels, mesh.triangle_areas[triangles]).argmax()]


@dataclass
class Row:
    """What is measured on one pair."""

    source: str
    target: str
    kept: float
    to_part: float = float("nan")
    of_part: float = float("nan")
    lost: float = float("nan")
    confidence: float = float("nan")
    coverage: float = float("nan")
    seconds: float = float("nan")
    problem: str = ""
    source_kept: float = 1.0

    def __str__(self):
        part = "" if self.source_kept == 1 else f"{self.source_kept:.0%} of "
        name = f"{part}{self.source} -> {self.kept:.0%} of {self.target}"
        wrong = self.problem or ("WRONG" if self.lost > WRONG else "")
        numbers = f"{self.to_part:8.2f} {self.of_part:8.2f} {self.lost:7.1%} {self.confidence:7.2f}"
        return f"{name:44s} {numbers} {self.coverage:9.2f} {self.seconds:8.1f}  {wrong}"


def measure(task):
    """Match one pair and score it."""
    shapes, names, kept, source_kept, seed = task
    source, target = (shapes.read(name) for name in names)
    row = Row(*names, kept, source_kept=source_kept)
    part = cut_off(target.mesh, kept, seed)
    own = Part(source.mesh, np.arange(source.mesh.vertex_count))
    if source_kept < 1:
        own = cut_off(source.mesh, source_kept, seed + OTHER_PLANE)
    here, there = numbers(own, source), numbers(part, target)
    left = (here >= 0) & (there >= 0)
    if not left.any():
        row.problem = "the parts have nothing in common"
        return row
    start = time.perf_counter()
    try:
        result = match(own.mesh, part.mesh, MatchSettings(dense=True))
    except HierMatchError as error:
        row.problem = str(error)
        return row
    row.seconds = time.perf_counter() - start
    images = part.vertices[result.source_to_target.nearest_vertices[here]]
    row.to_part = target.vertex_errors(images)[left].mean()
    errors = source.vertex_errors(own.vertices[result.target_to_source.nearest_vertices[there]])[left]
    row.of_part, row.lost = errors.mean(), (errors > LOST).mean()
    row.confidence, row.coverage = result.quality.confidence, result.quality.coverage
    return row


def numbers(part, shape):
    """Number, in a part of a shape, of each of the shape's samples; -1 for those that were cut off."""
    found = np.full(shape.mesh.vertex_count, -1)
    found[part.vertices] = np.arange(len(part.vertices))
    return found[shape.samples]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--data", type=Path, required=True, help="folder with the shapes")
    parser.add_argument("--pairs", type=int, default=20, help="random pairs for each share (default %(default)s)")
    parser.add_argument("--seed", type=int, default=1, help="of pairs and planes (default %(default)s)")
    parser.add_argument("--kept", default="0.9,0.7,0.5", help="shares of the area to keep (default %(default)s)")
    parser.add_argument("--source-kept", type=float, default=1.0, help="the same of the source (default all)")
    parser.add_argument("--jobs", type=int, default=1, help="pairs matched at the same time (default %(default)s)")
    options = parser.parse_args()
    shapes = KnownShapes(options.data)
    shares = [float(share) for share in options.kept.split(",")]
    pairs = shapes.random_pairs(options.pairs, options.seed)
    tasks = [
        (shapes, pair, share, options.source_kept, options.seed + i) for share in shares for i, pair in enumerate(pairs)
    ]
    print(f"{'errors x 100 / sqrt(area)':44s}  to part  of part    lost   conf.  coverage  seconds")
    rows = []
    for row in each_in_its_process(measure, tasks, options.jobs):
        rows.append(row)
        print(row, flush=True)
    print()
    for share in shares:
        part = [row for row in rows if row.kept == share and not row.problem]
        to_part, of_part, seconds = np.mean([(row.to_part, row.of_part, row.seconds) for row in part], axis=0)
        wrong = f"{sum(row.lost > WRONG for row in part)} wrong"
        label = f"MEAN of {len(part)} pairs, {share:.0%} kept"
        print(f"{label:44s} {to_part:8.2f} {of_part:8.2f} {seconds:34.1f}  {wrong}")


if __name__ == "__main__":
    main()
