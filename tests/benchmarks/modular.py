# SPDX-License-Identifier: GPL-3.0-or-later
"""Match whole bodies with bodies put together from separate pieces, as modular characters are.

    python -m tests.benchmarks.modular --data FOLDER [--pairs 12] [--seed 1] [--style inserted] [--both]

FOLDER and the error of a map are described in `known_shapes`.  Of each pair of poses the target, with `--both` either
body, is cut into a trunk and the parts around its five ends, each at a random distance along the surface.  Styles:

    inserted   parts go on beneath the surface of the trunk, open there
    capped     the same, and all borders are closed
    gap        parts end before the trunk does, open

A row holds the mean error of target to source and of source to target at places that the target still has, the share
of these that is lost (more than 20 away) in the former, the share of the trunk's area of all, and the confidence and
the seconds.  Errors are geodesic distances on the whole shapes, over the square root of their area, times 100.
"""

import argparse
import time
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components
from scipy.spatial import cKDTree

from engine import MatchSettings, TriangleMesh, match
from engine.geometry.geodesics import GeodesicSolver
from tests.benchmarks.known_shapes import LOST, KnownShapes

ENDS = 5
OVERLAP, DEPTH, GAP = 0.05, 0.012, 0.03
"""How far parts go on beneath the trunk and how deep, and how wide a gap is: in sqrt(area)."""


@dataclass(frozen=True, eq=False)
class Modular:
    """A body of pieces; for each vertex of it that of the whole body (n,), or -1, and the piece, 0 the trunk, (n,)."""

    mesh: TriangleMesh
    whole: np.ndarray
    pieces: np.ndarray

    def vertices(self, count):
        """For each of so many vertices of the whole body the one that shows, or -1, (count,)."""
        found = np.full(count, -1)
        for piece in range(self.pieces.max() + 1):  # the trunk hides what is beneath it
            own = np.flatnonzero((self.pieces == piece) & (self.whole >= 0))
            own = own[found[self.whole[own]] < 0]
            found[self.whole[own]] = own
        return found


def ends_of(shape, random):
    """Choose the ends of a body, which all of its kind share, and how far from them it is cut in the root of its area.

    Distances of places from the ends, (5, t), and from each end to the cut, (5,).
    """
    solver = GeodesicSolver(shape.mesh)
    rows = solver.distances(shape.places[:1])
    rows = solver.distances(np.array([rows[0].argmax()]))
    for _ in range(ENDS - 1):
        rows = np.concatenate([rows, solver.distances(np.array([rows.min(axis=0).argmax()]))])
    rows = rows[:, shape.places] / np.sqrt(shape.mesh.area)
    centre = rows.max(axis=0).argmin()
    return rows, random.uniform(0.25, 0.55, len(rows)) * rows[:, centre]


def put_together(shape, rows, cuts, style):
    """Cut a body into pieces."""
    mesh = shape.mesh
    unit = np.sqrt(mesh.area)
    nearest = cKDTree(mesh.vertices[shape.places]).query(mesh.vertices)[1]
    beyond = rows[:, nearest] - cuts[:, None]
    owner = np.where((beyond < 0).any(axis=0), beyond.argmin(axis=0) + 1, 0)
    vertices, triangles, whole, pieces, count = [], [], [], [], 0
    for piece in range(len(cuts) + 1):
        if piece == 0:
            inside = owner == 0
        else:
            reach = -GAP if style == "gap" else OVERLAP
            inside = (beyond[piece - 1] < reach) & (beyond.argmin(axis=0) == piece - 1)
        chosen = inside[mesh.triangles].all(axis=1) if piece or style == "gap" else inside[mesh.triangles].any(axis=1)
        if not chosen.any():
            continue
        own, faces = np.unique(mesh.triangles[chosen], return_inverse=True)
        positions = mesh.vertices[own]
        if piece and style != "gap":
            ramp = np.clip(1 + beyond[piece - 1][own] / OVERLAP, 0, 1) * DEPTH * unit
            positions = positions - ramp[:, None] * mesh.vertex_normals[own]
        faces, added = faces.reshape(-1, 3), 0
        if style == "capped":
            positions, faces = closed_up(positions, faces)
            added = len(positions) - len(own)
        vertices.append(positions)
        triangles.append(faces + count)
        whole.append(np.append(own, np.full(added, -1)))
        pieces.append(np.full(len(positions), piece))
        count += len(positions)
    return Modular(
        TriangleMesh(np.concatenate(vertices), np.concatenate(triangles)), np.concatenate(whole), np.concatenate(pieces)
    )


def as_it_is(mesh):
    """A body in one piece."""
    return Modular(mesh, np.arange(mesh.vertex_count), np.zeros(mesh.vertex_count, np.int64))


def closed_up(vertices, triangles):
    """Close all borders, each by a fan around its middle."""
    ends = np.stack([triangles.ravel(), np.roll(triangles, -1, axis=1).ravel()], axis=1)
    n = len(vertices)
    is_border = ~np.isin(ends[:, 0] * n + ends[:, 1], ends[:, 1] * n + ends[:, 0])
    tails, heads = ends[is_border].T
    labels = connected_components(coo_array((np.ones(len(tails)), (tails, heads)), shape=(n, n)), directed=False)[1]
    loops = np.unique(labels[tails], return_inverse=True)[1]
    middles = np.stack([np.bincount(loops, column[tails]) for column in vertices.T], axis=1)
    middles /= np.bincount(loops)[:, None]
    fans = np.stack([heads, tails, n + loops], axis=1)
    return np.concatenate([vertices, middles]), np.concatenate([triangles, fans])


def scored(names, bodies, given):
    """Match two bodies: the row of the table, and its numbers."""
    (source, target), (here, there) = bodies, given
    start = time.perf_counter()
    result = match(here.mesh, there.mesh, MatchSettings(dense=True))
    seconds = time.perf_counter() - start
    first, second = (body.vertices(shape.mesh.vertex_count) for body, shape in zip(given, bodies, strict=True))
    rows, columns = second[target.samples], first[source.samples]
    back = source.vertex_errors(here.whole[result.target_to_source.nearest_vertices[rows]])
    ahead = target.vertex_errors(there.whole[result.source_to_target.nearest_vertices[columns]])
    kept = (rows >= 0) & (columns >= 0)
    trunk = there.mesh.triangle_areas[there.pieces[there.mesh.triangles[:, 0]] == 0].sum() / there.mesh.area
    numbers = back[kept].mean(), ahead[kept].mean(), (back[kept] > LOST).mean(), trunk
    numbers += (result.quality.confidence, seconds)
    return _row(f"{names[0]} -> {names[1]}", numbers), numbers


def _row(name, numbers):
    back, ahead, lost, trunk, confidence, seconds = numbers
    return f"{name:36s} {back:6.2f} {ahead:7.2f} {lost:6.1%} {trunk:6.0%} {confidence:6.2f} {seconds:8.1f}"


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--data", type=Path, required=True, help="folder with the shapes")
    parser.add_argument("--pairs", type=int, default=12, help="random pairs (default %(default)s)")
    parser.add_argument("--seed", type=int, default=1, help="of pairs and cuts (default %(default)s)")
    parser.add_argument("--style", choices=("inserted", "capped", "gap"), default="inserted", help="how it is cut")
    parser.add_argument("--both", action="store_true", help="cut either body, each elsewhere")
    options = parser.parse_args()
    shapes = KnownShapes(options.data)
    print(f"{'errors x 100 / sqrt(area)':36s}   back   ahead   lost  trunk  conf.  seconds")
    table = []
    for number, names in enumerate(shapes.random_pairs(options.pairs, options.seed)):
        bodies = [shapes.read(name) for name in names]
        random = np.random.default_rng(options.seed + number)
        rows, cuts = ends_of(bodies[0], random)
        others = cuts * random.uniform(0.6, 1.2, len(cuts))
        source = put_together(bodies[0], rows, others, options.style) if options.both else as_it_is(bodies[0].mesh)
        given = source, put_together(bodies[1], rows, cuts, options.style)
        row, numbers = scored(names, bodies, given)
        table.append(numbers)
        print(row, flush=True)
    print(_row(f"MEAN of {len(table)}", np.mean(table, axis=0)))


if __name__ == "__main__":
    main()
