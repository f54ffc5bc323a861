# SPDX-License-Identifier: GPL-3.0-or-later
"""Match parts of bodies with parts of others, and say how good the maps are where both show the same.

    python -m tests.benchmarks.overlap_pairs --data FOLDER [--pairs 40] [--seed 0]

FOLDER holds shapes/NAME.npz, each with vertices V (n, 3) and triangles F (m, 3), and maps/A__B.npz, each with p (n,):
for each vertex of A its vertex of B, or -1 if B does not show it (the collections PARTIALSMAL and PFARM in this
layout).  A row holds

    true overlap       share of the vertices of either that the other shows; further to the right, of the area
    there, back        mean error of source_to_target, and of target_to_source, on the true overlap
    IoU                what has a partner against what truly has one: their intersection over their union, mean of both
    conf., coverage    what the match says of itself: result.quality.confidence, .source_coverage and .coverage
    seconds            from two meshes to both maps

Errors are geodesic distances (potpourri3d's heat method) at 300 random places, over the square root of the area of the
part that they are measured on, times 100.  A pair is right if both are below 8.
"""

import argparse
import time
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import potpourri3d
from scipy.spatial import cKDTree

from engine import HierMatchError, TriangleMesh, match

RIGHT = 8.0
PLACES = 300
NEAR = 2.0
"""Lengths of an edge between images of the source's vertices and what else of the target is in the overlap, about."""

STRATA = 0.0, 0.2, 0.35, 0.55, 1.01


@dataclass
class Row:
    """What is measured on one pair: the errors, the overlap found, what the match says of itself, and the time."""

    names: tuple
    shares: tuple
    areas: tuple
    errors: tuple = (np.inf, np.inf)
    iou: float = 0.0
    confidence: float = 0.0
    coverage: tuple = (0.0, 0.0)
    seconds: float = float("nan")
    problem: str = ""

    @property
    def is_right(self):
        return max(self.errors) < RIGHT

    def __str__(self):
        wrong = self.problem or ("" if self.is_right else "WRONG")
        numbers = (*self.shares, *self.errors, self.iou, self.confidence)
        numbers += *self.areas, *self.coverage, self.seconds
        layout = "{:6.2f} {:5.2f} {:8.2f} {:7.2f} {:6.2f} {:6.2f} {:6.2f} {:5.2f} {:6.2f} {:5.2f} {:8.1f}"
        return f"{' -> '.join(self.names):36s} {layout.format(*numbers)}  {wrong}"


def measure(folder, names):
    """Match one pair and score it."""
    meshes = [TriangleMesh(*(np.load(folder / "shapes" / f"{name}.npz")[key] for key in "VF")) for name in names]
    partners = np.load(folder / "maps" / f"{'__'.join(names)}.npz")["p"].astype(int)
    rows = np.flatnonzero(partners >= 0)
    ends = rows, partners[rows]
    spacing = np.sqrt(meshes[1].area / meshes[1].triangle_count)
    images = cKDTree(meshes[1].vertices[ends[1]])
    true = partners >= 0, images.query(meshes[1].vertices)[0] < NEAR * spacing
    areas = (float(mesh.vertex_areas @ each / mesh.area) for mesh, each in zip(meshes, true, strict=True))
    row = Row(names, tuple(float(each.mean()) for each in true), tuple(areas))
    start = time.perf_counter()
    try:
        result = match(*meshes)
    except HierMatchError as error:
        row.problem = str(error)
        return row
    row.seconds = time.perf_counter() - start
    maps = result.source_to_target, result.target_to_source
    row.errors = tuple(
        mean_error(image, found.nearest_vertices[own], other)
        for found, image, own, other in zip(maps, meshes[::-1], ends, ends[::-1], strict=True)
    )
    shared = [(each.has_partner & one, each.has_partner | one) for each, one in zip(maps, true, strict=True)]
    row.iou = float(np.mean([both.sum() / max(either.sum(), 1) for both, either in shared]))
    quality = result.quality
    row.confidence, row.coverage = quality.confidence, (quality.source_coverage, quality.coverage)
    return row


def mean_error(mesh, images, truth):
    """Mean distance on a mesh between images (k,) and the true ones, over the root of its area, times 100."""
    chosen = np.random.default_rng(0).permutation(len(images))[:PLACES]
    solver = potpourri3d.MeshHeatMethodDistanceSolver(mesh.vertices, mesh.triangles)
    lengths = [solver.compute_distance(int(truth[one]))[images[one]] for one in chosen]
    return float(np.mean(lengths) / np.sqrt(mesh.area) * 100)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--data", type=Path, required=True, help="folder with shapes and maps")
    parser.add_argument("--pairs", type=int, default=40, help="random pairs (default %(default)s)")
    parser.add_argument("--seed", type=int, default=0, help="of the choice of pairs (default %(default)s)")
    options = parser.parse_args()
    known = [tuple(path.stem.split("__")) for path in sorted((options.data / "maps").iterdir())]
    chosen = np.random.default_rng(options.seed).permutation(len(known))[: options.pairs]
    titles = "true overlap    there    back    IoU  conf.  its area   coverage    seconds"
    print(f"{'errors x 100 / sqrt(area)':36s} {titles}")
    rows = []
    for number in chosen:
        rows.append(measure(options.data, known[number]))
        print(rows[-1], flush=True)
    print()
    for low, high in zip((*STRATA[:-1], STRATA[0]), (*STRATA[1:], STRATA[-1]), strict=True):
        some = [row for row in rows if low <= np.mean(row.shares) < high]
        if some:
            worse, iou = (np.array(each) for each in zip(*((max(row.errors), row.iou) for row in some), strict=True))
            right = f"{sum(row.is_right for row in some):3d} of {len(some):3d} right"
            name = f"true overlap {low:.2f} to {high:.2f}"
            print(f"{name:28s} {right}, median error {np.median(worse):5.1f}, IoU {iou.mean():.2f}")
    sure = [row for row in rows if row.confidence >= 0.5]
    print(f"with a confidence of 0.5 or more: {sum(row.is_right for row in sure)} of {len(sure)} right")
    beyond = [np.subtract(row.coverage, row.areas).max() for row in rows]
    print(f"coverage is beyond the area of the true overlap by {max(beyond):.2f} at most")
    print(f"seconds: median {np.nanmedian([row.seconds for row in rows]):.1f}")


if __name__ == "__main__":
    main()
