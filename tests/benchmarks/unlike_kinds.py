# SPDX-License-Identifier: GPL-3.0-or-later
"""Match shapes of different kinds, such as cats and dogs, and measure how far each map is from what most of them say.

    python -m tests.benchmarks.unlike_kinds --data FOLDER [--kinds cat:dog,tr_reg:8] [--pairs 12] [--seed 1]

FOLDER is described in `known_shapes`.  Of two kinds no true correspondence is known, but of the shapes of one kind it
is: so every map from a shape of the one kind to a shape of the other says, for all of them, which place corresponds to
which.  At each of 150 places the image that is nearest in the mean to those under all maps is taken for the true one.
This is so if most maps are right, and if they do not all err alike; the mean over all pairs says how far they agree.

A row holds the mean distance from there, over the square root of the area, times 100; the share of places that are
more than 20 away, such as a leg taken for a tail; what the match says of itself; and its time.
"""

import argparse
import time
from pathlib import Path

import numpy as np
import potpourri3d
from scipy.spatial import cKDTree

from engine import MatchSettings, match
from tests.benchmarks.known_shapes import LOST, KnownShapes

KINDS = "tr_reg:michael,tr_reg:8,michael:8,cat:dog,dog:cat,cat:wolf,dog:wolf"
PLACES = 150
WRONG = 0.05
"""Share of places from which on a map with so many that are lost is counted as wrong."""


def drawn_pairs(shapes, first, second, count, seed):
    """Random pairs (source, target) of shapes of two kinds, without repetition."""
    pairs = [(a, b) for a in shapes.of_kind(first) for b in shapes.of_kind(second)]
    return [pairs[i] for i in np.random.default_rng(seed).permutation(len(pairs))[:count]]


def place_images(source, target, chosen, found):
    """Numbers of the places of the target nearest to the images of chosen places of the source, (k,)."""
    images = target.mesh.vertices[found.nearest_vertices[source.places[chosen]]]
    return cKDTree(target.mesh.vertices[target.places]).query(images)[1]


def deviations(images, reference):
    """Distance x 100 of each image (p, k), numbers of places, from the most central one of its column, (p, k)."""
    solver = potpourri3d.MeshHeatMethodDistanceSolver(reference.mesh.vertices, reference.mesh.triangles)
    vertices, numbers = np.unique(reference.places[images], return_inverse=True)
    numbers = numbers.reshape(images.shape)
    rows = np.stack([solver.compute_distance(int(vertex))[vertices] for vertex in vertices])
    rows = 50 * (rows + rows.T) / np.sqrt(reference.mesh.area)
    found = np.empty(images.shape)
    for column, here in zip(found.T, numbers.T, strict=True):
        block = rows[np.ix_(here, here)]
        column[:] = block[:, block.sum(axis=0).argmin()]
    return found


def measure(shapes, first, second, count, seed):
    """Match pairs of two kinds, and print how far their maps are from each other."""
    images, said = [], []
    chosen = None
    pairs = drawn_pairs(shapes, first, second, count, seed)
    for names in pairs:
        source, target = (shapes.read(name) for name in names)
        if chosen is None:
            chosen = np.random.default_rng(0).permutation(len(source.places))[:PLACES]
        start = time.perf_counter()
        result = match(source.mesh, target.mesh, MatchSettings(dense=True))
        seconds = time.perf_counter() - start
        images.append(place_images(source, target, chosen, result.source_to_target))
        said.append((result.quality.margin, result.quality.confidence, seconds))
    errors = deviations(np.array(images), shapes.read(pairs[0][1]))
    lost = (errors > LOST).mean(axis=1)
    print(f"{first} -> {second}".ljust(44), "   mean    lost  margin   conf. seconds")
    for names, row, away, (margin, confidence, seconds) in zip(pairs, errors, lost, said, strict=True):
        clear = f"{'-':>7s}" if margin is None else f"{margin:7.3f}"
        wrong = "WRONG" if away > WRONG else ""
        label = " -> ".join(names)
        print(f"{label:44s} {row.mean():7.2f} {away:7.1%} {clear} {confidence:7.2f} {seconds:7.1f}  {wrong}")
    seconds = np.mean([row[2] for row in said])
    label = f"MEAN {first} -> {second} ({len(pairs)} pairs)"
    print(f"{label:44s} {errors.mean():7.2f} {lost.mean():7.1%} {'':15s} {seconds:7.1f}  {(lost > WRONG).sum()} wrong")
    print(flush=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--data", type=Path, required=True, help="folder with the shapes")
    parser.add_argument("--kinds", default=KINDS, help="first:second, separated by commas (default: %(default)s)")
    parser.add_argument("--pairs", type=int, default=12, help="pairs of each two kinds (default %(default)s)")
    parser.add_argument("--seed", type=int, default=1, help="of the pairs (default %(default)s)")
    arguments = parser.parse_args()
    shapes = KnownShapes(arguments.data)
    for kinds in arguments.kinds.split(","):
        measure(shapes, *kinds.split(":"), arguments.pairs, arguments.seed)


if __name__ == "__main__":
    main()
