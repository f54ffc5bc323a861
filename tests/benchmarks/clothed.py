# SPDX-License-Identifier: GPL-3.0-or-later
"""Match bodies in clothes: pieces of their own that lie just above the body and move with it.

    python -m tests.benchmarks.clothed --data FOLDER [--pairs 12] [--seed 1]

FOLDER and the error of a map are described in `known_shapes`.  Three garments are put on either body of a pair, one
above the other: what of the surface is within a random distance of a random place, lifted by about a hundredth of the
body's size.  A row holds, for target to source,

    body       mean error of the body itself
    garments   of the vertices of the garments
    lost       share of these that are more than 20 away
    own        share that goes to the same garment

and the confidence and the seconds.  Errors are geodesic distances on the bodies, over the square root of their area,
times 100, of the vertices of the bodies that those of garments were lifted from.
"""

import argparse
import time
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from scipy.spatial import cKDTree

from engine import MatchSettings, TriangleMesh, match
from engine.geometry.geodesics import GeodesicSolver
from tests.benchmarks.known_shapes import LOST, KnownShapes

HEIGHTS = 0.008, 0.012, 0.016


@dataclass(frozen=True, eq=False)
class Clothed:
    """A body with what it wears; of each vertex, that of the bare body (n,), and the piece: 0 the body, (n,)."""

    mesh: TriangleMesh
    bare: np.ndarray
    pieces: np.ndarray


@dataclass(frozen=True, eq=False)
class Garment:
    """How far places (t,) of a body are from its middle, how far it reaches, and how high it lies, in sqrt(area)."""

    distances: np.ndarray
    reach: float
    height: float


def garments(shape, random):
    """Think of some garments for a body and all of its kind."""
    middles = shape.places[random.integers(len(shape.places), size=len(HEIGHTS))]
    rows = GeodesicSolver(shape.mesh).distances(middles)[:, shape.places] / np.sqrt(shape.mesh.area)
    return [Garment(row, random.uniform(0.2, 0.6), height) for row, height in zip(rows, HEIGHTS, strict=True)]


def clothed(shape, worn):
    """Dress a body."""
    mesh = shape.mesh
    nearest = cKDTree(mesh.vertices[shape.places]).query(mesh.vertices)[1]
    vertices, triangles, bare, count = [mesh.vertices], [mesh.triangles], [np.arange(mesh.vertex_count)], [0]
    for garment in worn:
        inside = garment.distances[nearest] < garment.reach
        own, faces = np.unique(mesh.triangles[inside[mesh.triangles].all(axis=1)], return_inverse=True)
        lift = garment.height * np.sqrt(mesh.area)
        count.append(sum(map(len, vertices)))
        triangles.append(faces.reshape(-1, 3) + count[-1])
        vertices.append(mesh.vertices[own] + lift * mesh.vertex_normals[own])
        bare.append(own)
    pieces = np.repeat(np.arange(len(bare)), [len(own) for own in bare])
    return Clothed(TriangleMesh(np.concatenate(vertices), np.concatenate(triangles)), np.concatenate(bare), pieces)


def scored(names, bodies, dressed):
    """Match two dressed bodies: the row of the table, and its numbers."""
    (source, target), (here, there) = bodies, dressed
    start = time.perf_counter()
    result = match(here.mesh, there.mesh, MatchSettings(dense=True))
    seconds = time.perf_counter() - start
    found = result.target_to_source.nearest_vertices
    errors, own = [], []
    for piece in range(len(HEIGHTS) + 1):
        rows = np.full(target.mesh.vertex_count, -1)
        its = np.flatnonzero(there.pieces == piece)
        rows[there.bare[its]] = its
        rows = rows[target.samples]
        covered = rows >= 0
        errors.append(source.vertex_errors(here.bare[found[rows]])[covered])
        own.append(here.pieces[found[rows[covered]]] == piece)
    body, away = errors[0].mean(), np.concatenate(errors[1:])
    numbers = (body, away.mean(), (away > LOST).mean(), np.concatenate(own[1:]).mean())
    numbers += (result.quality.confidence, seconds)
    return _row(f"{names[0]} -> {names[1]}", numbers), numbers


def _row(name, numbers):
    body, away, lost, own, confidence, seconds = numbers
    return f"{name:36s} {body:6.2f} {away:9.2f} {lost:6.1%} {own:6.1%} {confidence:6.2f} {seconds:8.1f}"


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--data", type=Path, required=True, help="folder with the shapes")
    parser.add_argument("--pairs", type=int, default=12, help="random pairs (default %(default)s)")
    parser.add_argument("--seed", type=int, default=1, help="of pairs and garments (default %(default)s)")
    options = parser.parse_args()
    shapes = KnownShapes(options.data)
    print(f"{'errors x 100 / sqrt(area)':36s} {'body':>6s} {'garments':>9s} {'lost':>6s} {'own':>6s}  conf.  seconds")
    table = []
    for number, names in enumerate(shapes.random_pairs(options.pairs, options.seed)):
        bodies = [shapes.read(name) for name in names]
        worn = garments(bodies[0], np.random.default_rng(options.seed + number))
        row, numbers = scored(names, bodies, [clothed(body, worn) for body in bodies])
        table.append(numbers)
        print(row, flush=True)
    print(_row(f"MEAN of {len(table)}", np.mean(table, axis=0)))


if __name__ == "__main__":
    main()
