# SPDX-License-Identifier: GPL-3.0-or-later
"""Match bodies without limbs, such as stones or organs, with what is left of them.

    python -m tests.benchmarks.smooth_bodies [--bodies 24] [--seed 1] [--vertices 300] [--missing 0,0.08,0.2]
        [--bent 0.02]

Each body is a ball with six bumps and dents.  The target is the same one in another meshing, turned, a little bent, and
without a cap that has the given share of its triangles.  A row holds

    missing            that share
    mean, worst        mean error of target_to_source over a body's vertices: of all bodies, and of the worst of them
    wrong, believed    bodies with a mean error of more than 12, and how many of them have a confidence of 0.5 or more
    conf., seconds     mean confidence, and mean time from two meshes to both maps

Errors are distances in space over the square root of the area, times 100.
"""

import argparse
import time

import numpy as np
from scipy.spatial import ConvexHull

from engine import MatchSettings, TriangleMesh, match
from tests.shapes import compacted, outward, rotation

BUMPS, HEIGHT = 6, 0.4
WRONG, BELIEVED = 12.0, 0.5


def random_sphere(vertices, random):
    """Mesh a sphere evenly, but at random."""
    heights = 1 - 2 * (np.arange(vertices) + 0.5) / vertices
    around = np.pi * (1 + np.sqrt(5)) * (np.arange(vertices) + 0.5)
    radius = np.sqrt(1 - heights**2)
    places = np.stack([radius * np.cos(around), radius * np.sin(around), heights], axis=1)
    places += random.normal(0, 0.3 / np.sqrt(vertices), places.shape)
    places /= np.linalg.norm(places, axis=1)[:, None]
    places = places @ random_rotation(random).T
    return places, outward(places, ConvexHull(places).simplices)


def random_rotation(random):
    """Turn about a random axis."""
    return rotation(random.standard_normal(3), random.uniform(0, 2 * np.pi))


def random_body(random):
    """Make a function that takes places on the sphere to those of a random body."""
    centres = random.standard_normal((BUMPS, 3))
    centres /= np.linalg.norm(centres, axis=1)[:, None]
    heights = random.uniform(-HEIGHT, 1.5 * HEIGHT, BUMPS)
    sharpness, sides = random.uniform(2, 8, BUMPS), random.uniform(0.6, 1.4, 3)

    def body(places):
        bumps = np.exp(sharpness * (places @ centres.T - 1)) @ heights
        return (1 + bumps)[:, None] * places * sides

    return body


def pair_of_bodies(number, vertices, missing, bent):
    """A body and what is left of it: both meshes, and where on the first body their vertices are, (n, 3) each."""
    random = np.random.default_rng(number)
    body, bend = random_body(random), bent * random.standard_normal((3, 3, 3))
    (sphere, triangles), (other, faces) = (random_sphere(vertices, random) for _ in range(2))
    heights = other[faces].mean(axis=1) @ random.standard_normal(3)
    other, faces = compacted(other, faces[heights <= np.quantile(heights, 1 - missing)])
    places = body(other)
    turned = (places + np.einsum("cij,ni,nj->nc", bend, places, places)) @ random_rotation(random).T
    return (TriangleMesh(body(sphere), triangles), TriangleMesh(turned, faces)), (body(sphere), places)


def measure(number, vertices, missing, bent):
    """Match a body with what is left of it: mean error, confidence, and time."""
    (source, target), (_, places) = pair_of_bodies(number, vertices, missing, bent)
    start = time.perf_counter()
    result = match(source, target, MatchSettings(dense=True))
    seconds = time.perf_counter() - start
    away = np.linalg.norm(result.target_to_source.positions - places, axis=1)
    return 100 * away.mean() / np.sqrt(source.area), result.quality.confidence, seconds


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--bodies", type=int, default=24, help="how many (default %(default)s)")
    parser.add_argument("--seed", type=int, default=1, help="of the random bodies (default %(default)s)")
    parser.add_argument("--vertices", type=int, default=300, help="of a whole body (default %(default)s)")
    parser.add_argument("--missing", default="0,0.08,0.2", help="shares of the target (default %(default)s)")
    parser.add_argument("--bent", type=float, default=0.02, help="how much the target is bent (default %(default)s)")
    options = parser.parse_args()
    numbers = np.random.default_rng(options.seed).integers(2**31, size=options.bodies)
    print("missing   mean  worst  wrong  believed  conf.  seconds")
    for missing in map(float, options.missing.split(",")):
        rows = np.array([measure(number, options.vertices, missing, options.bent) for number in numbers])
        errors, confidences, seconds = rows.T
        wrong = errors > WRONG
        believed = (wrong & (confidences >= BELIEVED)).sum()
        what = f"{errors.mean():6.2f} {errors.max():6.2f} {wrong.sum():6d} {believed:9d}"
        print(f"{missing:7.2f} {what} {confidences.mean():6.2f} {seconds.mean():8.1f}", flush=True)


if __name__ == "__main__":
    main()
