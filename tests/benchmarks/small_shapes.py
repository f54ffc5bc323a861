# SPDX-License-Identifier: GPL-3.0-or-later
"""Seconds for pairs of shapes of less than 1,000 vertices: alike and not, whole, broken and in pieces.

    python -m tests.benchmarks.small_shapes [--count 3] [--seed 0]

The shapes are spheres with random bumps.  A row holds the kind of pair, the vertices of both, the seconds of one core
from two meshes to both maps, and the confidence, which should be near zero where the shapes have nothing in common.
"""

import argparse
import time

import numpy as np

from engine import HierMatchError, TriangleMesh, match, use_processes
from tests.messes import without_faces
from tests.shapes import icosphere, rotation


def bumpy(random, fineness):
    """A sphere with three to seven bumps, (n, 3) and (m, 3)."""
    vertices, triangles = icosphere(fineness)
    for _ in range(random.integers(3, 8)):
        direction = random.standard_normal(3)
        angles = np.arccos(
            np.clip(vertices @ direction / np.linalg.norm(vertices, axis=1) / np.linalg.norm(direction), -1, 1)
        )
        vertices = vertices * (1 + random.uniform(0.5, 3) * np.exp(-(angles**2) / random.uniform(0.02, 0.2)))[:, None]
    return vertices, triangles


def posed(random, vertices):
    """The same shape turned, scaled and gently deformed."""
    turn = rotation(random.standard_normal(3), random.uniform(0, np.pi))
    return (vertices @ turn.T) * random.uniform(0.1, 10) * (1 + 0.1 * np.sin(vertices))


def pairs(random):
    """Kind -> two shapes."""
    first, second = bumpy(random, 6), bumpy(random, 5)
    again = posed(random, first[0]), first[1]
    yield "alike", first, again
    yield "alike, faces missing", first, without_faces(*again, 0.1, seed=int(random.integers(1000)))
    yield "unlike", first, second
    other = second[0] + [2.5, 0, 0]
    pieces = np.concatenate([first[0], other]), np.concatenate([first[1], second[1] + len(first[0])])
    yield "unlike, in pieces", pieces, bumpy(random, 5)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--count", type=int, default=3, help="pairs of each kind (default %(default)s)")
    parser.add_argument("--seed", type=int, default=0, help="of the shapes (default %(default)s)")
    options = parser.parse_args()
    use_processes(1)
    random = np.random.default_rng(options.seed)
    print(f"{'kind':22s} {'vertices':>11s} {'seconds':>8s} confidence")
    for _ in range(options.count):
        for kind, *shapes in pairs(random):
            meshes = [TriangleMesh(*shape) for shape in shapes]
            start = time.process_time()
            try:
                said = f"{match(*meshes).quality.confidence:.2f}"
            except HierMatchError as error:
                said = str(error)
            seconds = time.process_time() - start
            counts = " + ".join(str(mesh.vertex_count) for mesh in meshes)
            print(f"{kind:22s} {counts:>11s} {seconds:8.1f} {said}", flush=True)


if __name__ == "__main__":
    main()
