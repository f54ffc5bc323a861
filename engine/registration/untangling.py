# SPDX-License-Identifier: GPL-3.0-or-later
"""Repair of a map between surfaces where it went astray or turned triangles over."""

from __future__ import annotations

import numpy as np
from scipy.sparse import csr_array, diags_array
from scipy.sparse.linalg import cg

from ..geometry.symmetric_factor import symmetric_factor
from ..mesh.closest_points import ClosestPoints
from ..mesh.surface_points import SurfacePoints
from ..mesh.triangle_mesh import TriangleMesh
from ..runtime.arrays import Bools, Floats, Ints, group_means, marked, numbered, slices, unit_vectors
from ..runtime.progress import Progress, Steps

_ROUNDS = 11  # none of them is the last after averaging, which others have to put right
_AVERAGED = 4  # every so many rounds, what is still flipped is averaged first
_SWEEPS = 3  # of averaging
_MANY = 1000  # flipped triangles from which on a round costs time: only then it is given up when rounds do not help
_HELPED = (
    0.9  # part of them that rounds up to averaging may leave: by hand, on cats whose edges are split into 8 and 16
)
_ITERATIONS = 8
_FACTORED = 2000  # unknowns up to which factors solve the equations of a step sooner, by hand, on people
_RESIDUAL = 1e-3  # relative one at which more of them are solved
_DESCENTS = 100  # conjugate gradient steps at most for that: some fifty are taken
_LEAST_AREA = 0.2  # part of its own area, in the scale of the target, that a triangle's image should have
_SMALLEST = 0.01  # part of the mean area from which on a triangle counts: one without area has no side to be on
_TETHER = 1e-3  # weight of staying in place, squared distances in units of the mean area, against the areas that lack
_CHUNK = 200_000


def follow_neighbours(mesh: TriangleMesh, values: Ints, astray: Bools) -> Ints:
    """Replace the values of some vertices by those of vertices near by.

    Parameters
    ----------
    mesh : TriangleMesh
        The surface.
    values : (n,) array of int
        Anything that is known of vertices.
    astray : (n,) array of bool
        Whose value is not to be trusted.

    Returns
    -------
    (n,) array of int
        The values; each that was astray is that of its nearest neighbour that was not or that got one before, where
        there is any in its part of the surface.
    """
    values, astray = values.copy(), astray.copy()
    touched = np.flatnonzero(astray[mesh.edges].any(axis=1))
    # The longest first: of several that are written to the same place the last stays.
    touched = touched[np.argsort(-mesh.edge_lengths[touched], kind="stable")]
    edges = mesh.edges[touched]
    tail, head = edges.ravel(), edges[:, ::-1].ravel()
    while len(tail):
        known = astray[tail] & ~astray[head]
        if not known.any():
            break
        values[tail[known]] = values[head[known]]
        astray[tail[known]] = False
        left = astray[tail]
        tail, head = tail[left], head[left]
    return values


def flipped_triangles(
    source: TriangleMesh, target: TriangleMesh, triangles: Ints, barycentric: Floats, among: Ints | None = None
) -> Ints:
    """Find the triangles that a map turns over.

    Parameters
    ----------
    source, target : TriangleMesh
        The surfaces.
    triangles, barycentric : (n,) array of int, (n, 3) array of float
        The point of the target that each vertex of the source is mapped to.
    among : (f,) array of int, optional
        Triangles of the source to look at; by default all.

    Returns
    -------
    array of int
        Triangles of the source whose image looks against the mean normal of the target at its corners.
    """
    among = np.arange(source.triangle_count) if among is None else among
    flipped = [among[:0]]
    for chunk in slices(len(among), _CHUNK):
        part = among[chunk]
        image = _Image(source, target, triangles, barycentric, part)
        flipped.append(part[image.areas(image.positions) < 0])
    return np.concatenate(flipped)


class _Image:
    """Where a map takes some triangles (f,): their v vertices, with the sides of the target that they should be on."""

    def __init__(
        self, source: TriangleMesh, target: TriangleMesh, triangles: Ints, barycentric: Floats, among: Ints
    ) -> None:
        self.vertices, corners = np.unique(source.triangles[among], return_inverse=True)
        self.corners = corners.reshape(-1, 3)  # numbers in `vertices`
        points = SurfacePoints.from_barycentric(target, triangles[self.vertices], barycentric[self.vertices])
        self.positions, self.nearest_vertices = points.positions, points.nearest_vertices
        normals = points.interpolate(target.vertex_normals)[self.corners].sum(axis=1)
        self.normals = unit_vectors(normals)  # (f, 3)

    def areas(self, positions: Floats) -> Floats:
        """Areas of the triangles, as seen from their sides, for positions (v, 3) of the vertices: (f,)."""
        a, b, c = positions[self.corners].transpose(1, 0, 2)
        return np.einsum("fd,fd->f", np.cross(b - a, c - a), self.normals) / 2

    def slopes(self, positions: Floats, chosen: Ints) -> Floats:
        """Differentiate the areas of some triangles (l,) by the positions of their corners, (l, 3, 3)."""
        a, b, c = positions[self.corners[chosen]].transpose(1, 0, 2)
        opposite = np.stack([b - c, c - a, a - b], axis=1)
        return np.cross(opposite, self.normals[chosen, None]) / 2

    def average(self, chosen: Bools) -> None:
        """Move chosen ones of the vertices (v,) to the mean of their neighbours, some times."""
        for _ in range(_SWEEPS):
            places = self.positions.T.take(self.corners, axis=1)  # (3, f, 3 corners)
            others = (places.sum(axis=2, keepdims=True) - places).reshape(3, -1).T
            around = group_means(self.corners.ravel(), others, len(self.positions)) / 2
            self.positions[chosen] = around[chosen]


def untangle_steps(
    source: TriangleMesh,
    target: TriangleMesh,
    triangles: Ints,
    barycentric: Floats,
    *,
    search: ClosestPoints,
    shown: Bools | None = None,
) -> Steps[None]:
    r"""Turn flipped triangles of a map back, in place.

    The vertices x of the flipped triangles and their neighbours are moved to where

    .. math:: \sum_t \frac{(\beta r_t - a_t(x))_+^2}{r_t} + \epsilon |x - x_0|^2

    is least, and back onto the target.  Here :math:`a_t` is the area of the image of a triangle as seen from outside,
    negative if it is flipped, and :math:`r_t` what it would be in the scale of the target [1]_.  Now and then, vertices
    that this did not help go to the mean of their neighbours.

    Parameters
    ----------
    source : TriangleMesh
        The surface that is mapped.
    target : TriangleMesh
        The surface that it is mapped to.
    triangles, barycentric : (n,) array of int, (n, 3) array of float
        The point of the target that each vertex of the source is mapped to.
    search : ClosestPoints
        The search on the target.
    shown : (n,) array of bool, optional
        Vertices of the source that count: triangles with others may stay flipped.

    Yields
    ------
    Progress
        After each round; meanwhile the arrays hold what was reached.

    Notes
    -----
    Flips where the target folds more sharply than its triangles show may stay.  Of dense meshes these are many, and go
    from one triangle to the next: once that is seen, it ends.

    References
    ----------
    .. [1] P. Knupp, "Hexahedral and tetrahedral mesh untangling", Engineering with Computers 17, 2001.
    """
    edges = source.edges
    counted = np.ones(source.triangle_count, bool) if shown is None else shown[source.triangles].all(axis=1)
    flipped = flipped_triangles(source, target, triangles, barycentric, np.flatnonzero(counted))
    begun = 0  # how many the first round since the last averaging left
    for number in range(_ROUNDS):
        if not len(flipped):
            break
        moving = marked(source.triangles[flipped], source.vertex_count)
        moving[edges[moving[edges].any(axis=1)]] = True
        around = np.flatnonzero(moving[source.triangles].any(axis=1))
        image = _Image(source, target, triangles, barycentric, around)
        rest = source.triangle_areas[around] * (target.area / source.area)
        free = np.flatnonzero(moving[image.vertices])
        if number % _AVERAGED == _AVERAGED - 1:
            image.average(np.isin(image.vertices, source.triangles[flipped]))
        members = image.vertices[free]
        found = search.walk(_opened(image, rest, free), image.nearest_vertices[free])
        triangles[members], barycentric[members] = found.triangles, found.barycentric
        flipped = flipped_triangles(source, target, triangles, barycentric, around[counted[around]])
        begun = len(flipped) if number % _AVERAGED == 0 else begun
        if number % _AVERAGED == _AVERAGED - 1 and len(flipped) > max(_MANY, _HELPED * begun):
            break
        yield Progress((number + 1) / _ROUNDS, "Mapping every vertex")


def _opened(image: _Image, rest: Floats, free: Ints) -> Floats:
    """Positions of the free vertices (q,), (q, 3), at which the triangles come nearer to their areas (f,) at rest.

    Found by damped Gauss-Newton steps without a search along lines: none of them decides anything, so that what is
    nearly the same comes out nearly the same.
    """
    rest = np.maximum(rest, _SMALLEST * float(rest.mean()))
    number = numbered(free, len(image.vertices))
    now, unknowns = image.positions.copy(), np.arange(3 * len(free))
    for _ in range(_ITERATIONS):
        lack = np.maximum(_LEAST_AREA - image.areas(now) / rest, 0)
        lacking = np.flatnonzero(lack)
        rows, corners = np.nonzero(number[image.corners[lacking]] >= 0)
        slopes = image.slopes(now, lacking)[rows, corners] / np.sqrt(rest[lacking[rows], None])  # (e, 3)
        columns = 3 * number[image.corners[lacking[rows], corners]][:, None] + np.arange(3)
        # Areas are products of positions: beside the Jacobian, what they lack bounds by how much they can change.
        around = np.bincount(columns[:, 0] // 3, lack[lacking[rows]], len(free)).repeat(3)
        held = np.sqrt(_TETHER + around)
        # The rows of the triangles, then one for each unknown, which adds the square of `held` to the diagonal.
        ends = np.cumsum(np.append(0, 3 * np.bincount(rows, minlength=len(lacking))))
        starts = np.concatenate([ends, ends[-1] + 1 + unknowns])
        entries = (np.append(slopes, held), np.append(columns, unknowns), starts)
        jacobian = csr_array(entries, shape=(len(starts) - 1, len(unknowns)))
        back = _TETHER * (image.positions - now)[free].ravel() / held
        pull = jacobian.T @ np.append((lack * np.sqrt(rest))[lacking], back)
        now[free] += _solved(jacobian.T @ jacobian, pull).reshape(-1, 3)
    return now[free]


def _solved(system: csr_array, right: Floats) -> Floats:
    """Solve positive definite equations of few neighbours each: many of them by conjugate gradients."""
    if len(right) <= _FACTORED:
        return symmetric_factor(system).solve(right)
    solution: Floats = cg(system, right, rtol=_RESIDUAL, maxiter=_DESCENTS, M=diags_array(1 / system.diagonal()))[0]
    return solution
