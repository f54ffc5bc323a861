# SPDX-License-Identifier: GPL-3.0-or-later
"""Closest points on a surface: searched everywhere, or only along the surface from a known place."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from scipy.sparse import csr_array
from scipy.spatial import cKDTree

from ..runtime.arrays import TINY, Floats, Ints, ranges, slices
from ..runtime.errors import MeshError
from ..runtime.worker import search_threads
from .surface_points import SurfacePoints
from .triangle_mesh import TriangleMesh, check_mesh

_BLOCK = 10_000
"""Points that are searched side by side; the last steps, of few points each, are then shared by many."""

_CHUNK = 2500
"""Points around which triangles are tried at once: with about six each, the arrays are long enough for the calls to
cost little, and short enough to stay in the cache."""

_STARTS = 2
"""Nearest vertices from which a search everywhere sets out: the nearest alone misses several times as often, and the
next is mostly a corner of the triangle that is found from it."""

_FEW_PAIRS = 15_000
"""Pairs of a point and a triangle up to which all are tried: that takes 0.1 microseconds a pair, and never misses
where triangles are not 1e7 times smaller than their distances from one another, beyond which squares are rounded too
coarsely.  A search from the nearest vertices takes at least 1.4 milliseconds."""

_TREE_CHUNK = 100_000
"""Points looked up in the tree at once, which bounds the memory of their coordinates and normals side by side."""

_MANY = 20_000
"""From so many points on it pays to sort them and to search the tree by all processors."""

_REMEMBERED = 4
"""How many of the vertices visited last a search remembers: the three corners of a triangle and one to spare."""

_NORMAL_LENGTH, _NORMAL_GATE = 0.008, 0.3
"""How many units of length (in the root of the area) a unit of difference of the normals counts when points are
matched, and below which cosine only: more would draw points of a curved surface together."""


@dataclass(frozen=True, eq=False)
class FoundPoints:
    """Points of a surface that a search found, one for each point it was asked for.

    Attributes
    ----------
    triangles : (k,) array of int
        The triangle in which each lies.
    barycentric : (k, 3) array of float
        Its barycentric coordinates there: not negative, summing to one.
    squared_distances : (k,) array of float
        Squared distance from the point asked for, without any penalty for its normal.
    """

    triangles: Ints
    barycentric: Floats
    squared_distances: Floats

    def __len__(self) -> int:
        return len(self.triangles)

    def __repr__(self) -> str:
        return f"<FoundPoints: {len(self)} points>"

    def interpolate(self, triangles: Ints, values: Floats) -> Floats:
        """Values (n, d) of the vertices that the triangles of the surface, (m, 3), name, at the points, (k, d)."""
        return np.einsum("kc,kcd->kd", self.barycentric, values[triangles[self.triangles]])

    def on(self, mesh: TriangleMesh) -> SurfacePoints:
        """Name them as points of the mesh that was searched, or of one with the same triangles."""
        return SurfacePoints.from_barycentric(mesh, self.triangles, self.barycentric)

    def with_others(self, places: Ints, others: FoundPoints) -> FoundPoints:
        """Put other points in the place of some of these, by their numbers (l,)."""
        triangles, barycentric, squares = self.triangles.copy(), self.barycentric.copy(), self.squared_distances.copy()
        triangles[places], barycentric[places] = others.triangles, others.barycentric
        squares[places] = others.squared_distances
        return FoundPoints(triangles, barycentric, squares)

    def nearest_vertices(self, triangles: Ints) -> Ints:
        """Tell which corner of its triangle each is nearest to, of the surface's (m, 3): vertices (k,)."""
        return triangles[self.triangles, self.barycentric.argmax(axis=1)]


def closest_in_triangles(points: Floats, a: Floats, b: Floats, c: Floats) -> tuple[Floats, Floats]:
    """Find the point of each triangle that is closest to a point.

    Parameters
    ----------
    points : (k, 3) array of float
        A point for each triangle.
    a, b, c : (k, 3) array of float
        Corners of the triangles, which may be needles, or have fallen together into a line or a point.

    Returns
    -------
    barycentric : (k, 3) array of float
        Barycentric coordinates of the closest points, not negative and summing to one.
    squared_distances : (k,) array of float
        Squared distances to them.

    Notes
    -----
    The coordinates are found by orthogonalisation, not from the determinant of the Gram matrix, which loses all digits
    in needles: an error then only moves the point across the needle, never along it.
    """
    origin = np.ascontiguousarray(a.T)
    v, w, squared_distances = _closest(*(np.subtract(corner.T, origin) for corner in (points, b, c)))
    return np.stack([1 - v - w, v, w], axis=1).clip(min=0), squared_distances


class ClosestPoints:
    r"""Search for closest points on one surface.

    Parameters
    ----------
    mesh : TriangleMesh
        The surface.

    See Also
    --------
    ClosestPoints.moved : the same for other positions of the vertices.

    Notes
    -----
    A search for the minimum of the squared distance, to which a penalty for normals that disagree may be added:

    .. math:: |p - x|^2 + w \max(g - n_p \cdot n_T, 0)

    where x lies in triangle T, w is `normal_weight`, a squared length, and g is `normal_gate`.  A penalty that grows
    with every deviation of the normals draws points of a curved surface together and collapses a map; with a gate well
    below one only sides that face away are avoided.
    """

    def __init__(self, mesh: TriangleMesh) -> None:
        check_mesh(mesh)
        self._start(mesh.vertices, _Rings(mesh.triangles, mesh.vertex_count))

    def __repr__(self) -> str:
        return f"<ClosestPoints: {len(self.vertices)} vertices, {len(self.triangles)} triangles>"

    def _start(self, vertices: Floats, rings: _Rings) -> None:
        self.vertices = vertices
        self._rings = rings
        self._coordinates = np.ascontiguousarray(vertices.T)  # (3, n): whole rows are faster to compute with
        self._trees: dict[float, cKDTree] = {}

    def __getstate__(self) -> dict[str, Any]:
        """Leave out what is computed when that is asked for."""
        kept = "vertices", "_rings", "_coordinates"
        return {name: self.__dict__[name] for name in kept} | {"_trees": {}}

    def forget(self) -> None:
        """Let go of normals and trees until they are asked for again: some 200 bytes a vertex."""
        self.__dict__ = self.__getstate__()

    def moved(self, vertices: Floats) -> ClosestPoints:
        """Return a search on the same triangles with other positions (n, d) of the vertices.

        Not only in space: the positions may have any number of coordinates, such as features beside the place.  Normals
        can be used in three dimensions alone.  The search shares what depends on the triangles alone, which takes
        longest to build.  Unlike those of a `TriangleMesh` the positions are not copied: they must not be changed
        while the search is used.
        """
        if vertices.ndim != 2 or len(vertices) != len(self.vertices):
            raise MeshError(
                f"The moved surface needs positions of the shape ({len(self.vertices)}, d), but got {vertices.shape}."
            )
        other = object.__new__(ClosestPoints)
        other._start(vertices, self._rings)
        return other

    @property
    def triangles(self) -> Ints:
        """Corners of the triangles, (m, 3)."""
        return self._rings.triangles

    @cached_property
    def _area_vectors(self) -> Floats:
        """Triangle normals times twice the area, (3, m)."""
        a, b, c = (self._coordinates.take(corner, axis=1) for corner in self.triangles.T)
        b -= a
        c -= a
        return np.stack([b[1] * c[2] - b[2] * c[1], b[2] * c[0] - b[0] * c[2], b[0] * c[1] - b[1] * c[0]])

    @cached_property
    def _triangle_normals(self) -> Floats:
        """Unit normals of the triangles, (3, m); zero without an area."""
        return _unit(self._area_vectors)

    @cached_property
    def vertex_normals(self) -> Floats:
        """Unit normal at each vertex, weighted by triangle area, (n, 3); zero at a vertex without a triangle."""
        corners, n = self.triangles.ravel(), len(self.vertices)
        return _unit(np.stack([np.bincount(corners, np.repeat(part, 3), n) for part in self._area_vectors])).T

    def _tree(self, normal_length: float) -> cKDTree:
        """Tree over the vertices that have triangles, with their normals if these count."""
        if normal_length not in self._trees:
            coordinates = self.vertices
            if normal_length:
                coordinates = np.concatenate([coordinates, normal_length * self.vertex_normals], axis=1)
            # A balanced tree takes twice as long to build, and is hardly faster to search.
            self._trees[normal_length] = cKDTree(coordinates[self._rings.used], leafsize=16, balanced_tree=False)
        return self._trees[normal_length]

    def nearest_vertices(self, points: Floats, normals: Floats | None = None, normal_length: float = 0.0) -> Ints:
        """Find the nearest vertex to each point, on the whole surface.

        Parameters
        ----------
        points : (k, 3) array of float
            Points in space.
        normals : (k, 3) array of float, optional
            Unit normals that belong to them.
        normal_length : float
            How many units of length a unit of difference between normals counts: the nearest is meant in the space of
            position and normal_length x normal, six-dimensional.

        Returns
        -------
        (k,) array of int
            Vertices that have triangles.

        Raises
        ------
        MeshError
            If points or normals are not (k, 3) finite numbers, or not as many.
        """
        return self._nearest_vertices(points, normals, normal_length, 1)[:, 0]

    def _nearest_vertices(self, points: Floats, normals: Floats | None, normal_length: float, count: int) -> Ints:
        """Find the `count` nearest vertices, (k, count), or all where there are fewer."""
        points, normals = _checked_pair(points, normals, self.vertices.shape[1])
        weight = float(normal_length) if normals is not None else 0.0
        tree = self._tree(weight)
        count = min(count, tree.n)
        found = np.empty((len(points), count), np.int64)
        # Many points are looked up neighbour after neighbour, else every step in the tree has to wait for the memory,
        # and by as many threads as may be.
        many = len(points) >= _MANY
        order = spatial_order(points) if many else np.arange(len(points))
        for rows in slices(len(points), _TREE_CHUNK):
            part = order[rows]
            query = points[part]
            if normals is not None and weight:
                query = np.concatenate([query, weight * normals[part]], axis=1)
            found[part] = tree.query(query, np.arange(1, count + 1), workers=search_threads() if many else 1)[1]
        return self._rings.used[found]

    def nearest(
        self,
        points: Floats,
        normals: Floats | None = None,
        *,
        normal_length: float = 0.0,
        normal_weight: float = 0.0,
        normal_gate: float = 0.3,
    ) -> FoundPoints:
        """Find the closest point on the whole surface: from the nearest vertex, along the surface.

        Parameters
        ----------
        points : (k, 3) array of float
            Points in space.
        normals : (k, 3) array of float, optional
            Unit normals that belong to them.
        normal_length : float
            Weight of the normals in the choice of the vertex, a length; see `nearest_vertices`.
        normal_weight, normal_gate : float
            Weight, a squared length, and gate of the normals in the search from there; see `walk`.

        Returns
        -------
        FoundPoints
            The closest points.  Where triangles are many, and differ much in size, the closest may be in a large
            triangle far from the nearest vertex, and be missed.
        """
        points, normals = _checked_pair(points, normals, self.vertices.shape[1])
        if len(points) * len(self.triangles) <= _FEW_PAIRS:
            return self._of_all(points, normals, normal_weight, normal_gate)
        starts = self._nearest_vertices(points, normals, normal_length, _STARTS)
        return self.walk(points, starts, normals, normal_weight=normal_weight, normal_gate=normal_gate)

    def _of_all(self, points: Floats, normals: Floats | None, normal_weight: float, normal_gate: float) -> FoundPoints:
        """Find the closest point of few triangles to each of few points by trying all; as in `nearest`."""
        a, b, c = (self._coordinates.take(corner, axis=1) for corner in self.triangles.T)
        centre = self._coordinates.mean(axis=1, keepdims=True)  # rounding grows with the distance from the origin
        origin, ab, ac, own = a - centre, b - a, c - a, points - centre.T
        ab_ab, ab_ac, ac_ac = _dot(ab, ab), _dot(ab, ac), _dot(ac, ac)
        ab_ap, ac_ap = own @ ab - _dot(origin, ab), own @ ac - _dot(origin, ac)  # (k, m)
        divisor = np.maximum(ab_ab, TINY)
        height = ac - (ab_ac / divisor) * ab
        w = (ac_ap - (ab_ac / divisor) * ab_ap) / np.maximum(_dot(height, height), TINY)
        v = (ab_ap - w * ab_ac) / divisor
        inside = (v >= 0) & (w >= 0) & (v + w <= 1)
        sides = _closest_on_sides(ab_ab, ab_ac, ac_ac, ab_ap, ac_ap)
        v, w = (np.where(inside, *pair) for pair in zip((v, w), sides, strict=True))
        cost = v * (v * ab_ab - 2 * ab_ap) + w * (w * ac_ac + 2 * v * ab_ac - 2 * ac_ap)
        cost += _dot(origin, origin) - 2 * own @ origin  # all but |own|^2, which a point's triangles have in common
        if normals is not None and normal_weight:
            product = normals @ self._triangle_normals
            cost += normal_weight * np.maximum(normal_gate - product, 0)
        triangles = cost.argmin(axis=1)
        return FoundPoints(triangles, *closest_in_triangles(points, *(part.T[triangles] for part in (a, b, c))))

    def at_vertices(self, points: Floats, vertices: Ints) -> FoundPoints:
        """Name vertices (k,), which must have triangles, as what was found for points (k, 3)."""
        places = self._rings.starts[vertices]
        triangles, slot = np.divmod(self._rings.corners[places], 3)
        squared_distances = np.square(points - self.vertices[vertices]).sum(axis=1)
        return FoundPoints(triangles, np.eye(3)[slot], squared_distances)

    def walk(
        self,
        points: Floats,
        start_vertices: Ints,
        normals: Floats | None = None,
        *,
        normal_weight: float = 0.0,
        normal_gate: float = 0.3,
        steps: int = 64,
    ) -> FoundPoints:
        """Find the closest point along the surface: downhill from a vertex, never jumping to another sheet.

        Parameters
        ----------
        points : (k, 3) array of float
            Points in space.
        start_vertices : (k,) or (k, s) array of int
            Where each search starts; vertices that have triangles.  A further start is followed if a triangle around
            it is better than what was found from those before.
        normals : (k, 3) array of float, optional
            Unit normals that belong to the points.
        normal_weight : float
            How much squared distance a unit of the normals' product below the gate counts as.
        normal_gate : float
            Product of the normals from which on they count as agreeing.
        steps : int
            Around how many vertices, at most, triangles are tried from each start.

        Returns
        -------
        FoundPoints
            For each point a minimum: no triangle around any of the corners of its triangle is better, unless the
            steps ran out.

        Raises
        ------
        MeshError
            If a start vertex has no triangle or is none, or points or normals are not (k, 3) finite numbers.
        """
        points, normals = _checked_pair(points, normals, self.vertices.shape[1])
        starts = np.asarray(start_vertices, np.int64)
        starts = starts[:, None] if starts.ndim == 1 else starts
        exists = (starts >= 0) & (starts < len(self.vertices))
        if not exists.all() or not self._rings.counts[starts].all():
            raise MeshError("A search along the surface starts at a vertex without a triangle. Delete loose vertices.")
        k = len(points)
        triangles, barycentric, squared_distances = np.empty(k, np.int64), np.empty((k, 3)), np.empty(k)
        for part in slices(k, _BLOCK):
            penalty = None
            if normals is not None and normal_weight:
                chunk = np.ascontiguousarray(normals[part].T)
                penalty = _NormalPenalty(chunk, self._triangle_normals, normal_weight, normal_gate)
            walk = _Walk(self._coordinates, self._rings, np.ascontiguousarray(points[part].T), penalty)
            for start in starts[part].T:
                walk.search(start, steps)
            triangles[part], barycentric[part], squared_distances[part] = walk.found()
        return FoundPoints(triangles, barycentric, squared_distances)


def facing(search: ClosestPoints, points: Floats, normals: Floats, size: float) -> FoundPoints:
    """Find the closest point of a surface to each point, among those that look to the same side.

    Parameters
    ----------
    search : ClosestPoints
        The surface.
    points, normals : (k, 3) array of float
        The points, and the unit normals that they should agree with.
    size : float
        Root of the area of the surfaces.
    """
    length = _NORMAL_LENGTH * size
    return search.nearest(points, normals, normal_length=length, normal_weight=length**2, normal_gate=_NORMAL_GATE)


class _Rings:
    """The triangles around each vertex, side by side, as places: corners of triangles, (3 m,), sorted by vertex."""

    def __init__(self, triangles: Ints, vertex_count: int) -> None:
        self.triangles = triangles
        m = len(triangles)
        short = np.int32 if 3 * m <= np.iinfo(np.int32).max else np.int64  # half the memory of a large mesh
        # Transposing a sparse matrix is a counting sort, several times as fast as argsort.
        table = csr_array(
            (np.arange(3 * m, dtype=short), triangles.ravel(), np.arange(0, 3 * m + 1, 3)), shape=(m, vertex_count)
        ).tocsc()
        self.corners = table.data  # 3 x triangle + which of its corners the vertex is
        self.starts = table.indptr.astype(np.int64)  # (n + 1,)
        self.counts = np.diff(self.starts)
        self.used = np.flatnonzero(self.counts)
        flat, slot = triangles.ravel().astype(short), self.corners % 3
        self.next = flat[self.corners + np.where(slot == 2, -2, 1)]  # the triangle's other corners, in its cyclic order
        self.last = flat[self.corners + np.where(slot == 0, 2, -1)]

    def around(self, vertices: Ints) -> tuple[Ints, Ints]:
        """Places around vertices (k,): all of them (p,), and how many each vertex has (k,)."""
        counts = self.counts.take(vertices)
        return ranges(self.starts.take(vertices), counts), counts


@dataclass(frozen=True, eq=False)
class _NormalPenalty:
    """What is added to squared distances: weight x max(gate - product of the normals, 0)."""

    normals: Floats  # (3, k)
    triangle_normals: Floats  # (3, m)
    weight: float
    gate: float

    def of(self, points: Ints, triangles: Ints) -> Floats:
        """Return the penalty of pairs (p,) of a point and a triangle."""
        product = _dot(self.normals.take(points, axis=1), self.triangle_normals.take(triangles, axis=1))
        return self.weight * np.maximum(self.gate - product, 0)


class _Walk:
    """The search for some points at once; all arrays of vectors are (3, k)."""

    def __init__(self, coordinates: Floats, rings: _Rings, points: Floats, penalty: _NormalPenalty | None) -> None:
        k = points.shape[1]
        self.coordinates, self.rings, self.points, self.penalty = coordinates, rings, points, penalty
        self.cost = np.full(k, np.inf)
        self.squared_distances = np.full(k, np.inf)
        self.places = np.zeros(k, np.int64)
        self.corners = np.full((3, k), -1)  # the vertex of the place, the next and the last
        self.barycentric = np.zeros((3, k))  # of these
        self.visited = np.full((_REMEMBERED, k), -1)  # the latest first

    def search(self, starts: Ints, steps: int) -> None:
        """Try the triangles around vertices until none is better around any corner of the best."""
        # A search from a corner of the best triangle would end there.
        active = np.flatnonzero((self.corners != starts).all(axis=0))
        vertices = starts[active]
        for number in range(steps):
            if not len(active):
                break
            for first in range(0, len(active), _CHUNK):
                self._try_around(active[first : first + _CHUNK], vertices[first : first + _CHUNK])
            if number == steps - 1:  # what follows only says where to go on
                break
            self.visited[1:, active] = self.visited[:-1, active]
            self.visited[0, active] = vertices
            corners = self.corners.take(active, axis=1)
            tried = (corners[:, None, :] == self.visited.take(active, axis=1)).any(axis=1)
            # The heaviest of the corners that are left.
            choice = (self.barycentric.take(active, axis=1) - 2 * tried).argmax(axis=0)
            left = np.flatnonzero(~tried.all(axis=0))
            active, vertices = active[left], corners[choice[left], left]

    def _try_around(self, points: Ints, vertices: Ints) -> None:
        """Try the triangles around a vertex for each point, and keep the best where it is better than what is known."""
        rings = self.rings
        places, counts = rings.around(vertices)  # (p,) and (k,), p about 6 k
        following, last = rings.next.take(places), rings.last.take(places)
        before = self.visited[:2].take(points, axis=1)
        if before.max(initial=-1) >= 0:
            # Triangles around the vertices that were visited just before are known.
            before = np.repeat(before, counts, axis=1)
            new = np.flatnonzero(((following != before) & (last != before)).all(axis=0))
            places, following, last = places.take(new), following.take(new), last.take(new)
            counts = np.bincount(np.repeat(np.arange(len(points)), counts).take(new), minlength=len(points))
            left = np.flatnonzero(counts)
            points, vertices, counts = points[left], vertices[left], counts[left]
            if not len(points):
                return
        origin = self.coordinates.take(vertices, axis=1)
        ap = np.repeat(self.points.take(points, axis=1) - origin, counts, axis=1)
        origin = np.repeat(origin, counts, axis=1)
        ab = self.coordinates.take(following, axis=1) - origin
        ac = self.coordinates.take(last, axis=1) - origin
        v, w, squared = _closest(ap, ab, ac)
        cost = squared
        if self.penalty is not None:
            cost = squared + self.penalty.of(np.repeat(points, counts), rings.corners.take(places) // 3)
        least, where = _least(cost, counts)
        better = np.flatnonzero(least < self.cost[points])
        points, vertices, where = points[better], vertices[better], where[better]
        self.cost[points] = least[better]
        self.squared_distances[points] = squared[where]
        self.places[points] = places[where]
        self.corners[:, points] = vertices, following[where], last[where]
        self.barycentric[:, points] = 1 - v[where] - w[where], v[where], w[where]

    def found(self) -> tuple[Ints, Floats, Floats]:
        """Triangles (k,), coordinates in the order of their corners (k, 3), and squared distances (k,)."""
        triangles, slot = np.divmod(self.rings.corners[self.places], 3)
        order = (np.arange(3) - slot[:, None]) % 3  # corner i of the triangle is corner i - slot from the place
        barycentric = np.take_along_axis(self.barycentric.T, order, axis=1)
        return triangles, barycentric.clip(min=0), self.squared_distances


def _closest(ap: Floats, ab: Floats, ac: Floats) -> tuple[Floats, Floats, Floats]:
    """Closest points a + v ab + w ac of triangles to points a + ap: v, w and the squared distances, (k,) each.

    The vectors are (3, k).
    """
    ab_ab, ab_ac, ac_ac, ab_ap, ac_ap = _dot(ab, ab), _dot(ab, ac), _dot(ac, ac), _dot(ab, ap), _dot(ac, ap)
    divisor = np.maximum(ab_ab, TINY)
    height = ac - (ab_ac / divisor) * ab
    w = _dot(height, ap) / np.maximum(_dot(height, height), TINY)
    v = (ab_ap - w * ab_ac) / divisor
    outside = np.flatnonzero((v < 0) | (w < 0) | (v + w > 1))
    products = (product.take(outside) for product in (ab_ab, ab_ac, ac_ac, ab_ap, ac_ap))
    v[outside], w[outside] = _closest_on_sides(*products)
    rest = ap - v * ab
    rest -= w * ac
    return v, w, _dot(rest, rest)


def _closest_on_sides(
    ab_ab: Floats, ab_ac: Floats, ac_ac: Floats, ab_ap: Floats, ac_ap: Floats
) -> tuple[Floats, Floats]:
    """Find v and w of the closest points on the three sides, from the scalar products (k,) of the vectors."""
    bc_bc = ab_ab + ac_ac - 2 * ab_ac
    bc_bp = ac_ap - ab_ap - ab_ac + ab_ab
    squares = (np.maximum(square, TINY) for square in (ab_ab, ac_ac, bc_bc))
    on_ab, on_ac, on_bc = (
        np.minimum(np.maximum(along, 0), square) / square
        for along, square in zip((ab_ap, ac_ap, bc_bp), squares, strict=True)
    )
    # Squared distances less |ap|^2, which all have in common.
    to_ab = on_ab * (on_ab * ab_ab - 2 * ab_ap)
    to_ac = on_ac * (on_ac * ac_ac - 2 * ac_ap)
    to_bc = on_bc * (on_bc * bc_bc - 2 * bc_bp) + (ab_ab - 2 * ab_ap)
    ab_best = to_ab <= np.minimum(to_ac, to_bc)
    ac_best = ~ab_best & (to_ac <= to_bc)
    v = np.where(ab_best, on_ab, np.where(ac_best, 0, 1 - on_bc))
    w = np.where(ab_best, 0, np.where(ac_best, on_ac, on_bc))
    return v, w


def _dot(x: Floats, y: Floats) -> Floats:
    """Scalar products of vectors (3, k)."""
    return np.einsum("dk,dk->k", x, y)


def _least(values: Floats, counts: Ints) -> tuple[Floats, Ints]:
    """Least of each run of values, the runs as long as counts (k,) say, none empty, and where it comes first, (k,)."""
    least = np.minimum.reduceat(values, np.cumsum(counts) - counts)
    equal = np.flatnonzero(values == np.repeat(least, counts))
    if len(equal) == len(least):
        return least, equal
    run = np.repeat(np.arange(len(counts)), counts).take(equal)
    return least, equal[np.append(True, run[1:] != run[:-1])]


def _checked_pair(points: Floats, normals: Floats | None, dimensions: int) -> tuple[Floats, Floats | None]:
    """Return points (k, d) and their normals (k, 3), if they have any, after a look at their shapes and values."""
    points = _checked(points, "points", dimensions)
    normals = None if normals is None else _checked(normals, "normals", 3)
    if normals is not None and len(normals) != len(points):
        raise MeshError(f"There are {len(normals)} normals to search with for {len(points)} points, not one for each.")
    return points, normals


def _checked(vectors: Floats, name: str, dimensions: int) -> Floats:
    """Return vectors (k, d) after a look at their shape and values."""
    array = np.asarray(vectors, np.float64)
    if array.ndim != 2 or array.shape[1] != dimensions:
        raise MeshError(f"The {name} to search with should have the shape (k, {dimensions}), but have {array.shape}.")
    if not np.isfinite(array).all():
        raise MeshError(f"Some of the {name} to search with are not finite numbers.")
    return array


def spatial_order(points: Floats) -> Ints:
    """Order of points (k, d) along a Morton curve through 128^3 cells of the first three coordinates."""
    if not len(points):
        return np.empty(0, np.int64)
    points = points[:, :3]
    low = points.min(axis=0)
    size = max(float((points.max(axis=0) - low).max()), TINY)
    cells = ((points - low) / size * 127).astype(np.int64)
    bits = np.arange(7)
    spread = ((np.arange(128)[:, None] >> bits & 1) << 3 * bits).sum(axis=1)
    x, y, z = spread[cells].T
    return np.argsort(x << 2 | y << 1 | z, kind="stable")


def _unit(vectors: Floats) -> Floats:
    """Scale vectors (3, k) to length one, leaving zero vectors alone."""
    lengths = np.sqrt(_dot(vectors, vectors))
    return np.divide(vectors, lengths, out=np.zeros_like(vectors), where=lengths > 0)
