# SPDX-License-Identifier: GPL-3.0-or-later
"""Distances between any points of a surface, not only its vertices."""

from __future__ import annotations

from typing import Protocol

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import csr_array
from scipy.spatial.distance import cdist

from ..geometry.geodesics import GeodesicSolver
from ..mesh.surface_points import SurfacePoints
from ..mesh.triangle_mesh import TriangleMesh
from ..runtime.arrays import Floats, Ints
from ..runtime.background import can_go_beside
from ..runtime.parallel_map import shared_steps
from ..runtime.progress import Progress, Steps, within
from .shape import Shape

_MEMORY = 256_000_000  # bytes of rows that are kept
_PARTED = 32  # sources from which on distances are computed in two parts, one of them by a helper if there is one


class PointDistances(Protocol):
    """A metric on a surface that can be asked about points anywhere on its triangles.

    Inside a triangle, the squared distance to a fixed point is linear in the barycentric coordinates but for the term
    of `squared_offsets`.
    """

    mesh: TriangleMesh

    def prepare_steps(self, points: SurfacePoints) -> Steps[None]:  # noqa: ARG002  (some need no preparation)
        """Compute what the other methods need for some points, in short steps."""
        yield from ()

    def squares_to_vertices(self, points: SurfacePoints, vertices: Ints) -> Floats:
        """Squared distances from points (k,), prepared, to vertices (v,): (k, v)."""

    def squares_between(self, points: SurfacePoints) -> Floats:
        """Squared distances between points (k,), prepared: (k, k)."""

    def prepare_nearest_steps(self, points: SurfacePoints) -> Steps[None]:
        """Compute what `squares_by_nearest` needs for some points, in short steps: less than `prepare_steps` may do."""
        yield from self.prepare_steps(points)

    def squares_by_nearest(self, points: SurfacePoints) -> Floats:
        """Squared distances between points (k,) far from each other: almost those of `squares_between`."""
        return self.squares_between(points)

    def squared_sides(self, triangles: Ints) -> Floats:
        """Squared lengths, in this metric, of the sides 01, 02, 12 of triangles (q,): (q, 3)."""


class SurfaceDistances(PointDistances):
    r"""Distances between points inside triangles, interpolated from distances between vertices.

    In the plane the squared distance to a fixed point is quadratic, and its deviation from linear inside a triangle is
    known.  With barycentric coordinates b of p over the corners a, and the lengths l of the sides,

    .. math:: d^2(p, q) = \sum_a b_a d^2(a, q) - e(p), \quad e(p) = \sum_{a < c} b_a b_c l_{ac}^2 ,

    and likewise for q.  This is exact wherever the surface between the two points unfolds into the plane, for points
    in one triangle or in neighbouring ones too, it is continuous across edges, and zero from a point to itself.

    Distances are in the units of the shape, `Shape.scale`.

    Parameters
    ----------
    shape : Shape
        The surface.  The distances from its samples are used where they are needed; all other rows are computed on
        demand.
    memory : int
        Bytes of rows that may be kept from one request to the next, beside those of the samples.  One request may
        need more, and then gets it.

    Attributes
    ----------
    mesh : TriangleMesh
        The part of the surface on which the points lie.
    """

    def __init__(self, shape: Shape, memory: int = _MEMORY) -> None:
        self.mesh = shape.mesh
        self._shape = shape
        self._capacity = max(1, memory // (4 * shape.mesh.vertex_count))
        self._unit = shape.scale**2
        self._rows: dict[int, NDArray[np.float32]] = {}

    def prepare_steps(self, points: SurfacePoints) -> Steps[None]:
        """Compute the rows that distances from some points need, in short steps, if they are not there yet."""
        needed = np.unique(points.corners[points.barycentric > 0])
        shape = self._shape
        missing = np.setdiff1d(needed, [*self._rows, *shape.samples.vertices[: shape.samples.measured]])
        if len(self._rows) + len(missing) > self._capacity:
            wanted = set(needed.tolist())
            self._rows = {vertex: row for vertex, row in self._rows.items() if vertex in wanted}
        if not len(missing):
            return
        parts = np.array_split(missing, 2 if len(missing) >= _PARTED else 1)
        found = yield from shared_steps(measured_steps, None, [(shape.solver, part) for part in parts])
        for part, distances in zip(parts, found, strict=True):
            self._rows.update(zip(part.tolist(), (distances / shape.scale).astype(np.float32), strict=True))

    def prepare_nearest_steps(self, points: SurfacePoints) -> Steps[None]:
        """Compute the rows of the vertices nearest to some points, a third of all that `prepare_steps` computes."""
        yield from self.prepare_steps(SurfacePoints.at_vertices(self.mesh, points.nearest_vertices))

    def squares_to_vertices(self, points: SurfacePoints, vertices: Ints) -> Floats:
        """Squared distances from points (k,), prepared, to vertices (v,) of the part: (k, v).

        They can be slightly negative close to a point.
        """
        corners, weights = _weights(points)
        rows = self._gather(corners, vertices)
        return weights @ np.square(rows, out=rows) - self._offsets(points)[:, None]

    def squares_between(self, points: SurfacePoints) -> Floats:
        """Squared distances between points (k,), prepared: (k, k).

        Entry (i, j) follows the rows of point i; that of (j, i) differs by the error of fast marching.  Both can be
        slightly negative for neighbouring points.
        """
        corners, weights = _weights(points)
        offsets = self._offsets(points)
        square = self._gather(corners, corners)
        np.square(square, out=square)
        return (weights @ (weights @ square).T).T - offsets[:, None] - offsets

    def squares_by_nearest(self, points: SurfacePoints) -> Floats:
        r"""Squared distances between points (k,), of which only the nearest vertices are prepared: (k, k).

        From the nearest vertices p' and q', by :math:`d^2(p, q) = d^2(p', q) + d^2(p, q') - d^2(p', q')`.  In the plane
        this lacks the product of p - p' and q - q', less than the square of an edge.
        """
        nearest = points.nearest_vertices
        corners, weights = _weights(points)
        rows = np.square(self._gather(nearest, corners))
        mixed = (weights @ rows.T).T - self._offsets(points)  # from the vertex nearest to i to point j
        return mixed + mixed.T - rows[:, np.searchsorted(corners, nearest)]

    def to_all_vertices_steps(self, points: SurfacePoints) -> Steps[Floats]:
        """Measure the distances from points (k,) to all vertices of the whole surface, in units of the mesh: (k, n).

        They are ``inf`` on other parts of the surface.
        """
        yield from self.prepare_steps(points)
        shape = self._shape
        squares = self.squares_to_vertices(points, np.arange(self.mesh.vertex_count))
        return shape.surface.spread(np.sqrt(np.maximum(squares, 0)) * shape.scale, np.inf)

    def squared_sides(self, triangles: Ints) -> Floats:
        """Squared lengths of the sides 01, 02, 12 of triangles (q,): (q, 3)."""
        return _squared_sides(self.mesh.vertices, self.mesh.triangles[triangles]) / self._unit

    def _offsets(self, points: SurfacePoints) -> Floats:
        return squared_offsets(points.barycentric, self.squared_sides(points.triangles))

    def _gather(self, sources: Ints, vertices: Ints) -> Floats:
        """Distances from prepared vertices (s,) to vertices (v,), (s, v)."""
        samples = self._shape.samples.first(self._shape.samples.measured)
        number = dict(zip(samples.vertices.tolist(), samples.rows, strict=True))
        block = np.empty((len(sources), len(vertices)))
        for i, source in enumerate(sources.tolist()):
            row = self._rows.get(source)
            block[i] = (number[source] if row is None else row).take(vertices)
        return block


@can_go_beside
def distances_to_vertices_steps(mesh: TriangleMesh, points: SurfacePoints) -> Steps[Floats]:
    """Measure the distances from points of a mesh to all its vertices, as a match does.

    Parameters
    ----------
    mesh : TriangleMesh
        The mesh, as it is: it is cleaned here.
    points : SurfacePoints
        Places (k,) on it.

    Returns
    -------
    (k, n) array of float
        In units of the mesh; ``inf`` on other parts of the surface.
    """
    shape = yield from within(Shape.steps(mesh), 0.0, 0.2)
    own = points if shape.surface.is_whole else shape.surface.on_mesh(points)
    return (yield from within(SurfaceDistances(shape).to_all_vertices_steps(own), 0.2, 1.0))


class EmbeddedDistances(PointDistances):
    """Straight distances between points of a surface that lies in a space of any dimension.

    Diffusion distances are of this kind, with the coordinates exp(-lambda_i t) phi_i.  Coordinates are linear inside
    triangles, so distances between points anywhere are exact.

    Parameters
    ----------
    mesh : TriangleMesh
        The surface.
    coordinates : (n, d) array of float
        Where its vertices lie.
    """

    def __init__(self, mesh: TriangleMesh, coordinates: Floats) -> None:
        self.mesh = mesh
        self._coordinates = coordinates

    def squares_to_vertices(self, points: SurfacePoints, vertices: Ints) -> Floats:
        """Squared distances from points (k,) to vertices (v,): (k, v)."""
        return cdist(points.interpolate(self._coordinates), self._coordinates[vertices], "sqeuclidean")

    def squares_between(self, points: SurfacePoints) -> Floats:
        """Squared distances between points (k,): (k, k)."""
        places = points.interpolate(self._coordinates)
        return cdist(places, places, "sqeuclidean")

    def squared_sides(self, triangles: Ints) -> Floats:
        """Squared lengths of the sides 01, 02, 12 of triangles (q,): (q, 3)."""
        return _squared_sides(self._coordinates, self.mesh.triangles[triangles])


def symmetric_roots(squares: Floats) -> Floats:
    """Turn squared distances (k, k) into distances, equal in both directions and zero from a point to itself."""
    roots = np.sqrt(np.maximum((squares + squares.T) / 2, 0))
    np.fill_diagonal(roots, 0)
    return roots


def squared_offsets(barycentric: Floats, sides: Floats) -> Floats:
    """By how much linear interpolation overestimates squared distances at barycentric coordinates (..., 3): (...).

    `sides`, (..., 3), are the squared lengths of the sides 01, 02, 12.
    """
    a, b, c = (barycentric[..., i] for i in range(3))
    return a * b * sides[..., 0] + a * c * sides[..., 1] + b * c * sides[..., 2]


def _squared_sides(vertices: Floats, triangles: Ints) -> Floats:
    """Squared lengths of the sides 01, 02, 12 of triangles (q, 3) of vertices (n, d): (q, 3)."""
    a, b, c = vertices[triangles].transpose(1, 0, 2)
    return np.stack([np.square(q - p).sum(axis=1) for p, q in ((a, b), (a, c), (b, c))], axis=1)


def _weights(points: SurfacePoints) -> tuple[Ints, csr_array]:
    """List the corners that have weight in some points (k,): vertices (u,), and the weights (k, u)."""
    counts = points.barycentric > 0
    corners, column = np.unique(points.corners[counts], return_inverse=True)
    ends = np.append(0, np.cumsum(counts.sum(axis=1)))
    return corners, csr_array((points.barycentric[counts], column, ends), shape=(len(points), len(corners)))


def measured_steps(_: None, given: tuple[GeodesicSolver, Ints]) -> Steps[Floats]:
    """Compute the distances (s, n) from some sources (s,) to all vertices, where `shared_steps` has it done."""
    solver, sources = given
    rows = []
    for first, block in solver.distances_in_blocks(sources):
        rows.append(block)
        yield Progress((first + len(block)) / len(sources), "Measuring distances")
    return np.concatenate(rows)
