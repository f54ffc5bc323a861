# SPDX-License-Identifier: GPL-3.0-or-later
"""Agreement in place of right and of wrong maps between shapes that stand alike.

    python -m tests.benchmarks.standing --data FOLDER [--pairs 12] [--seed 5]

FOLDER is described in `known_shapes`; its shapes of one kind stand alike, more or less.  Of each random pair of closed
shapes all candidates for the map are judged by the truth: right is one with at most three hundredths of the places lost
(`known_shapes.LOST`).  A row holds the agreement of each, see `engine.geometry.procrustes.agreement_in_place`; last
come the ranges of both, from which `credibility` has its constants.
"""

import argparse
from pathlib import Path

import numpy as np
from scipy.spatial import cKDTree

from engine import MatchSettings, Shape
from engine.dense.dense_registration import EIGENPAIRS, registered_pair_steps
from engine.geometry.procrustes import agreement_in_place
from engine.runtime.progress import run
from engine.shapes.borders import has_border
from engine.shapes.shape_preparation import Wanted, prepared_shapes_steps
from tests.benchmarks.known_shapes import LOST, KnownShapes

WRONG = 0.03


def judged(source, target):
    """Agreement of each candidate for the map of two shapes, and whether it is right."""
    x, y = Shape(source.mesh), Shape(target.mesh)
    if has_border(x) or has_border(y):
        return
    settings = MatchSettings(dense=True)
    run(prepared_shapes_steps(x, y, Wanted(settings.samples, None, EIGENPAIRS)))
    pair = run(registered_pair_steps(x, y))
    known = cKDTree(target.mesh.vertices)
    rows = cKDTree(x.mesh.vertices).query(source.mesh.vertices[source.samples])[1]
    for candidate in pair.candidates:
        found = candidate.registration
        places = found.on_target.interpolate(y.mesh.triangles, y.mesh.vertices)[rows]
        lost = (target.vertex_errors(known.query(places)[1]) > LOST).mean()
        yield agreement_in_place(x.mesh.vertices, found.positions, pair.source.mass), bool(lost <= WRONG)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--data", type=Path, required=True, help="folder with the shapes")
    parser.add_argument("--pairs", type=int, default=12, help="random pairs (default %(default)s)")
    parser.add_argument("--seed", type=int, default=5, help="of the pairs (default %(default)s)")
    options = parser.parse_args()
    shapes = KnownShapes(options.data)
    found = []
    for first, second in shapes.random_pairs(options.pairs, options.seed):
        rows = list(judged(shapes.read(str(first)), shapes.read(str(second))))
        found += rows
        said = ", ".join(f"{agreement:.2f} {'right' if right else 'wrong'}" for agreement, right in rows)
        print(f"{first} -> {second}: {said or 'open'}", flush=True)
    for name, wanted in (("right", True), ("wrong", False)):
        values = [agreement for agreement, right in found if right is wanted]
        if values:
            print(f"{name}: {len(values)}, {min(values):.2f} to {max(values):.2f}, median {np.median(values):.2f}")


if __name__ == "__main__":
    main()
