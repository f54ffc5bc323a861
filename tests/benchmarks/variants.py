# SPDX-License-Identifier: GPL-3.0-or-later
"""The same surface as other files hold it: other numbering, place, size and triangles.

A map between variants gives one between the originals: from an original to its variant, by the map to the variant of
the other, and back to that original.  So the error of a map never contains how far apart the vertices of a variant are.
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from engine import SurfacePoints, TriangleMesh
from engine.mesh.closest_points import ClosestPoints
from tests.messes import halves_apart
from tests.shapes import permuted, rotation, subdivided


@dataclass(frozen=True, eq=False)
class Variant:
    """A surface as it is given to a match.

    Attributes
    ----------
    mesh : TriangleMesh
        The variant.
    there : SurfacePoints
        For each vertex of the original, its point on the variant.
    back : callable
        Takes points of the variant to the original.
    """

    mesh: TriangleMesh
    there: SurfacePoints
    back: Callable[[SurfacePoints], SurfacePoints]

    def images(self, vertices, dense_map, image):
        """Follow vertices (k,) of the original to the variant, by a map, and back to the original of `image`."""
        triangles, barycentric = self.there.triangles[vertices], self.there.barycentric[vertices]
        starts = SurfacePoints.from_barycentric(self.mesh, triangles, barycentric)
        if (barycentric.max(axis=1) > 1 - 1e-9).all():
            rows = starts.nearest_vertices
            found = dense_map.triangles[rows], dense_map.barycentric[rows]
        else:
            places = starts.interpolate(dense_map.positions)
            walked = ClosestPoints(image.mesh).walk(places, dense_map.nearest_vertices[starts.nearest_vertices])
            found = walked.triangles, walked.barycentric
        return image.back(SurfacePoints.from_barycentric(image.mesh, *found))


def as_is(mesh, seed=0):  # noqa: ARG001  (variants are all called alike)
    return Variant(mesh, SurfacePoints.at_vertices(mesh, np.arange(mesh.vertex_count)), lambda points: points)


def _renumbered(original, mesh, new):
    """Variant whose triangles are those of the original, with the vertices numbered `new` (n,)."""
    old = np.empty(len(new), np.int64)
    old[new] = np.arange(len(new))

    def back(points):
        return SurfacePoints.from_corners(original, old[points.corners], points.barycentric)

    return Variant(mesh, SurfacePoints.at_vertices(mesh, new), back)


def permute(mesh, seed=0):
    """Vertices and triangles in random order, each triangle from a random corner."""
    vertices, triangles, new = permuted(mesh.vertices, mesh.triangles, seed)
    return _renumbered(mesh, TriangleMesh(vertices, triangles), new)


def rotate(mesh, seed=0):
    """Turned about a random axis by a random angle, and moved by about its own length."""
    random = np.random.default_rng(seed)
    turn = rotation(random.standard_normal(3), random.uniform(0, 2 * np.pi))
    shift = random.standard_normal(3) * np.sqrt(mesh.area)
    moved = TriangleMesh(mesh.vertices @ turn.T + shift, mesh.triangles)
    return _renumbered(mesh, moved, np.arange(mesh.vertex_count))


def scale(mesh, seed=0):
    """Larger or smaller by a random factor of up to a thousand."""
    factor = 1000 ** np.random.default_rng(seed).uniform(-1, 1)
    return _renumbered(mesh, TriangleMesh(factor * mesh.vertices, mesh.triangles), np.arange(mesh.vertex_count))


def subdivide(mesh, seed=0, parts=2):  # noqa: ARG001  (variants are all called alike)
    """Each edge split into `parts` and each triangle into parts^2, in its plane."""
    fine = TriangleMesh(*subdivided(mesh.vertices, mesh.triangles, parts))

    def back(points):
        parents = mesh.triangles[points.triangles // parts**2]
        found = ClosestPoints(mesh).walk(points.positions, parents)
        return SurfacePoints.from_barycentric(mesh, found.triangles, found.barycentric)

    return Variant(fine, SurfacePoints.at_vertices(fine, np.arange(mesh.vertex_count)), back)


def decimate(mesh, seed=0, share=0.5):  # noqa: ARG001  (variants are all called alike)
    """Edges collapsed by quadric errors until a share of the triangles is left."""
    import fast_simplification

    arrays = mesh.vertices.copy(), mesh.triangles.copy()  # it takes no read-only ones
    vertices, triangles = fast_simplification.simplify(*arrays, target_reduction=1 - share)
    coarse = TriangleMesh(vertices, triangles)

    def back(points):
        return _closest(mesh, points.positions, points.interpolate(coarse.vertex_normals))

    return Variant(coarse, _closest(coarse, mesh.vertices, mesh.vertex_normals), back)


def coarse(mesh, seed=0):
    """A quarter of the triangles, as many as a character of an older game has."""
    return decimate(mesh, seed, share=0.25)


def coarsest(mesh, seed=0):
    """A twentieth of the triangles, as many as something far away in a game has."""
    return decimate(mesh, seed, share=0.05)


def split(mesh, seed=0, gap=0.01):  # noqa: ARG001  (variants are all called alike)
    """Two halves, one on either side of the middle, moved apart: as if mirrored, but never merged."""
    halves = TriangleMesh(*halves_apart(mesh.vertices, mesh.triangles, gap * np.sqrt(mesh.area)))

    def back(points):
        return SurfacePoints.from_barycentric(mesh, points.triangles, points.barycentric)

    return Variant(halves, SurfacePoints.at_vertices(halves, np.arange(mesh.vertex_count)), back)


def _closest(mesh, positions, normals):
    """Closest points on a mesh that look to the same side, so that parts that touch are not confused."""
    length = np.sqrt(mesh.area / mesh.vertex_count)
    normals = normals / np.maximum(np.linalg.norm(normals, axis=1, keepdims=True), 1e-12)
    found = ClosestPoints(mesh).nearest(positions, normals, normal_length=length, normal_weight=length**2)
    return SurfacePoints.from_barycentric(mesh, found.triangles, found.barycentric)


def _both(make):
    return lambda source, target: (make(source, 1), make(target, 2))


VARIANTS = {
    "permute": _both(permute),
    "rotate": _both(rotate),
    "scale": _both(scale),
    "subdivide-target": lambda source, target: (as_is(source), subdivide(target)),
    "subdivide-source": lambda source, target: (subdivide(source), as_is(target)),
    "decimate-target": lambda source, target: (as_is(source), decimate(target)),
    "decimate-source": lambda source, target: (decimate(source), as_is(target)),
    "coarse": _both(coarse),
    "coarsest": _both(coarsest),
    "split-target": lambda source, target: (as_is(source), split(target)),
    "split-source": lambda source, target: (split(source), as_is(target)),
}
"""Variants of a pair: both surfaces changed where that does not change the triangles, else one of them."""
