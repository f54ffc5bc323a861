# SPDX-License-Identifier: GPL-3.0-or-later
"""Repair of a map between surfaces where it went astray or turned triangles over."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from scipy.sparse import csr_array, diags_array

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from .closest_points import ClosestPoints
    from .mesh import TriangleMesh

__all__ = ["flipped_triangles", "follow_neighbours", "heaviest_corners", "located", "torn_vertices", "untangle"]

_ROUNDS = 4
_RINGS = 2  # of vertices around a flipped triangle that move with it
_SWEEPS = 3  # of averaging before each search
_CHUNK = 200_000
_TORN = 6.0  # times the median: edges that a map stretches more than this lead to another place
_TINY = np.finfo(float).tiny


def follow_neighbours(mesh: TriangleMesh, values: NDArray[np.int64], astray: NDArray[np.bool_]) -> NDArray[np.int64]:
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
    tail, head = _both_ways(mesh.edges[touched])
    while len(tail):
        known = astray[tail] & ~astray[head]
        if not known.any():
            break
        values[tail[known]] = values[head[known]]
        astray[tail[known]] = False
        left = astray[tail]
        tail, head = tail[left], head[left]
    return values


def torn_vertices(mesh: TriangleMesh, images: NDArray[np.float64]) -> NDArray[np.bool_]:
    """Find the vertices that a map takes far away from where it takes most of their neighbours.

    Parameters
    ----------
    mesh : TriangleMesh
        The surface.
    images : (n, 3) array of float
        Where its vertices are mapped to.

    Returns
    -------
    (n,) array of bool
        Vertices at least half of whose edges are stretched six times more than the median.
    """
    tail, head = mesh.edges.T
    lengths = np.maximum(mesh.edge_lengths, 1e-3 * mesh.edge_lengths.mean())
    stretch = np.linalg.norm(images[tail] - images[head], axis=1) / lengths
    long = np.flatnonzero(stretch > _TORN * np.median(stretch))
    many = np.bincount(mesh.edges[long].ravel(), minlength=mesh.vertex_count)
    degree = np.bincount(mesh.edges.ravel(), minlength=mesh.vertex_count)
    return (many > 0) & (2 * many >= degree)


def flipped_triangles(
    source: TriangleMesh,
    target: TriangleMesh,
    triangles: NDArray[np.int64],
    barycentric: NDArray[np.float64],
    among: NDArray[np.int64] | None = None,
) -> NDArray[np.int64]:
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
    if among is None:
        among, vertices = np.arange(source.triangle_count), np.arange(source.vertex_count)
        number = vertices
    else:
        vertices = np.unique(source.triangles[among])
        number = np.zeros(source.vertex_count, np.int64)
        number[vertices] = np.arange(len(vertices))
    images = located(target, triangles[vertices], barycentric[vertices])
    flipped = []
    for start in range(0, len(among), _CHUNK):
        part = among[start : start + _CHUNK]
        corners = source.triangles[part]
        outward = sum(target.triangle_normals.take(triangles.take(corner), axis=0) for corner in corners.T)
        a, b, c = (images.take(number.take(corner), axis=0) for corner in corners.T)
        flipped.append(part[np.einsum("fd,fd->f", np.cross(b - a, c - a), outward) < 0])
    return np.concatenate(flipped) if flipped else among


def located(mesh: TriangleMesh, triangles: NDArray[np.int64], barycentric: NDArray[np.float64]) -> NDArray[np.float64]:
    """Positions (k, 3) of points given by triangles (k,) and barycentric coordinates (k, 3)."""
    return np.einsum("kc,kcd->kd", barycentric, mesh.vertices[mesh.triangles[triangles]])


def heaviest_corners(
    mesh: TriangleMesh, triangles: NDArray[np.int64], barycentric: NDArray[np.float64]
) -> NDArray[np.int64]:
    """For each point, the corner of its triangle with the largest coordinate, (k,)."""
    corner = barycentric.argmax(axis=1)
    return mesh.triangles[triangles, corner]


def untangle(
    source: TriangleMesh,
    reference: NDArray[np.float64],
    target: TriangleMesh,
    triangles: NDArray[np.int64],
    barycentric: NDArray[np.float64],
    *,
    search: ClosestPoints,
) -> None:
    """Turn flipped triangles of a map back, in place.

    Where a triangle is flipped, the steps from the reference to the surface are averaged over the vertices around, and
    the closest points are searched anew from those of neighbours that are in order.

    Parameters
    ----------
    source : TriangleMesh
        The surface that is mapped.
    reference : (n, 3) array of float
        Its vertices laid near to the target, without folds: where its details are taken from.
    target : TriangleMesh
        The surface that it is mapped to.
    triangles, barycentric : (n,) array of int, (n, 3) array of float
        The point of the target that each vertex of the source is mapped to.
    search : ClosestPoints
        The search on the target.

    Notes
    -----
    Flips that are in the reference itself, or where the target folds more sharply than its triangles show, stay.
    """
    flipped = flipped_triangles(source, target, triangles, barycentric)
    if not len(flipped):
        return
    edges = source.edges
    moving = np.zeros(source.vertex_count, bool)
    moving[source.triangles[flipped]] = True
    for _ in range(_RINGS):
        moving[edges[moving[edges].any(axis=1)]] = True
    members = np.flatnonzero(moving)
    near = np.flatnonzero(moving[edges].any(axis=1))
    around = np.flatnonzero(moving[source.triangles].any(axis=1))
    average, known = _neighbour_average(source, near, members)
    for _ in range(_ROUNDS):
        astray = np.zeros(source.vertex_count, bool)
        astray[source.triangles[flipped]] = True
        astray &= moving
        steps = located(target, triangles[known], barycentric[known]) - reference[known]
        rows = np.searchsorted(known, members)
        for _ in range(_SWEEPS):
            steps[rows] = average @ steps
        starts = np.zeros(source.vertex_count, np.int64)
        starts[known] = heaviest_corners(target, triangles[known], barycentric[known])
        starts = follow_neighbours(source, starts, astray)[members]
        found = search.walk(reference[members] + steps[rows], starts)
        triangles[members], barycentric[members] = found.triangles, found.barycentric
        flipped = flipped_triangles(source, target, triangles, barycentric, around)
        if not len(flipped):
            break


def _neighbour_average(
    mesh: TriangleMesh, edges: NDArray[np.int64], members: NDArray[np.int64]
) -> tuple[csr_array, NDArray[np.int64]]:
    """Matrix that averages over the neighbours of members (q,), and which vertices it reads (p,), sorted: (q, p).

    `edges` are those that touch members.  Neighbours count by the inverse of their distance.
    """
    tail, head = _both_ways(mesh.edges[edges])
    weights = np.repeat(1 / np.maximum(mesh.edge_lengths[edges], _TINY), 2)
    known = np.unique(mesh.edges[edges])
    is_member = np.zeros(mesh.vertex_count, bool)
    is_member[members] = True
    inside = is_member[tail]
    rows, columns = np.searchsorted(members, tail[inside]), np.searchsorted(known, head[inside])
    sums = csr_array((weights[inside], (rows, columns)), shape=(len(members), len(known)))
    return csr_array(diags_array(1 / sums.sum(axis=1)) @ sums), known


def _both_ways(edges: NDArray[np.int64]) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """Tails and heads of the edges (e, 2) in both directions: an edge and its opposite side by side, (2 e,) each."""
    return edges.ravel(), edges[:, ::-1].ravel()
