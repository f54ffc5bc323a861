# SPDX-License-Identifier: GPL-3.0-or-later
"""What the benchmarks share: reading shapes, pairs with known correspondence, the error of a match, and its time."""

import csv
import multiprocessing
import os
import time
from dataclasses import asdict, dataclass, fields
from functools import cached_property

import numpy as np
from scipy.spatial import cKDTree

from engine import Shape, TriangleMesh
from engine.shapes.surface_distances import squared_offsets
from tests.shapes import creature


def read_off(path):
    """Read the vertices (n, 3) and triangles (m, 3) of an .off file."""
    words = path.read_text().split()
    count, faces = int(words[1]), int(words[2])
    numbers = np.array(words[4:], float)
    triangles = numbers[3 * count : 3 * count + 4 * faces].reshape(faces, 4)[:, 1:]
    return numbers[: 3 * count].reshape(count, 3), triangles.astype(np.int64)


def known(path, suffix=""):
    """Read the vertices that a shape's .vts file names: line i of two shapes is the same place.

    With the suffix ".sym", those of the mirror image.
    """
    return np.loadtxt(path.parent / "corres" / f"{path.stem}{suffix}.vts", dtype=int) - 1


def interpolated(mesh, distances, points):
    """Interpolate distances over sqrt(area) at the corners of points, (..., k, 3), as of straight lines, (..., k)."""
    a, b, c = mesh.vertices[points.corners].transpose(1, 0, 2)
    sides = np.stack([np.square(q - p).sum(axis=1) for p, q in ((a, b), (a, c), (b, c))], axis=1)
    inside = (np.square(distances) * points.barycentric).sum(axis=-1)
    return np.sqrt(np.maximum(inside - squared_offsets(points.barycentric, sides) / mesh.area, 0))


def timed(function):
    """Call a function: what it returns, and the seconds of processor time."""
    start = time.process_time()
    return function(), time.process_time() - start


def each_in_its_process(measure, tasks, jobs):
    """Yield what a function makes of each task, in their order, so many at the same time; then each has one core."""
    if jobs > 1:
        os.environ["HIERMATCH_PROCESSES"] = "1"
    with multiprocessing.get_context("spawn").Pool(jobs) as pool:
        yield from pool.imap(measure, tasks)


def write_rows(path, rows):
    """Write instances of a dataclass as a table, .csv."""
    path.parent.mkdir(parents=True, exist_ok=True)
    with path.open("w", newline="") as file:
        writer = csv.DictWriter(file, [field.name for field in fields(rows[0])])
        writer.writeheader()
        writer.writerows(map(asdict, rows))


@dataclass(frozen=True, eq=False)
class KnownPair:
    """Two surfaces and their true correspondence, at places (t,) spread over the source.

    `images` are target vertices (t,): of the true correspondence, and of the mirrored one where that is known.
    """

    name: str
    source: TriangleMesh
    target: TriangleMesh
    places: np.ndarray  # (t, d) positions that name the places, in the space of `named`
    named: np.ndarray  # (n, d) such positions of the vertices of the source
    images: tuple[np.ndarray, ...]

    @cached_property
    def shapes(self):
        """Source and target as `Shape`: what is computed once is kept."""
        return Shape(self.source), Shape(self.target)

    def truth(self, vertices):
        """Return the `Truth` for matches of some source vertices (k,)."""
        _, nearest = cKDTree(self.places).query(self.named[vertices])
        return Truth(self.shapes[1], [images[nearest] for images in self.images])


class Truth:
    """True images of some points, and the geodesic distances from them."""

    def __init__(self, shape, images):
        self._shape = shape
        vertices, number = np.unique(images, return_inverse=True)
        self._rows = shape.solver.distances(vertices) / shape.scale
        self._number = number.reshape(len(images), -1)

    def errors(self, points):
        """Geodesic distance over sqrt(area) from true image to match, per correspondence: (true and mirrored, k).

        `points` lie anywhere on a target of one part.
        """
        return interpolated(self._shape.mesh, self._rows[self._number[..., None], points.corners], points)


def data_pairs(folder, names):
    """Pairs "source:target", separated by commas, of the .off files anywhere in a folder."""
    paths = {path.stem: path for path in sorted(folder.rglob("*.off"))}
    for name in names.split(","):
        path_x, path_y = (paths[stem] for stem in name.split(":"))
        (vertices_x, triangles_x), (vertices_y, triangles_y) = read_off(path_x), read_off(path_y)
        yield KnownPair(
            name,
            TriangleMesh(vertices_x, triangles_x),
            TriangleMesh(vertices_y, triangles_y),
            vertices_x[known(path_x)],
            vertices_x,
            (known(path_y), known(path_y, ".sym")),
        )


CREATURES = ((0.0, 0.5), (0.0, 1.0), (0.3, 0.9), (1.0, 0.2), (0.7, 0.0), (-0.4, 0.6))


def creature_pairs(poses=CREATURES, resolutions=(18, 16)):
    """Pairs of the body that the tests make, in two poses and two meshings."""
    for number, (first, second) in enumerate(poses):
        vertices_x, triangles_x, rest_x = creature(first, resolutions[0])
        vertices_y, triangles_y, rest_y = creature(second, resolutions[1], turn=0.3 + 0.2 * number)
        _, image = cKDTree(rest_y).query(rest_x)
        yield KnownPair(
            f"creature {first}:{second}",
            TriangleMesh(vertices_x, triangles_x),
            TriangleMesh(vertices_y, triangles_y),
            rest_x,
            rest_x,
            (image,),
        )
