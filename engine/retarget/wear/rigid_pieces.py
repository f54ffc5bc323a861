# SPDX-License-Identifier: GPL-3.0-or-later
"""Pieces of clothes that do not bend: buttons, buckles, glasses, jewellery."""

from __future__ import annotations

import numpy as np
from scipy.spatial import cKDTree

from ...geometry.procrustes import nearest_similarity
from ...mesh.closest_points import ClosestPoints
from ...mesh.connectivity.components import joined_components
from ...mesh.connectivity.welded_parts import WeldedParts
from ...mesh.triangle_mesh import TriangleMesh
from ...runtime.arrays import Bools, Floats, Ints, group_extents, group_means, group_sums

_TINY, _SMALL = 0.02, 0.12
"""Size of a loose part, in units of the root of the body's area, up to which it is rigid whatever its shape, and up to
which it is if it is solid: 3 and 16 cm for a human."""

_SOLID = 0.5
"""How much of a part's area may be left over when normals cancel out: 0 for closed surfaces, 1 for flat ones, such as
strands of hair."""

_TOGETHER = 0.005
"""How near, in the same unit, parts are that are one piece: the frame of glasses and their lenses."""

_LARGEST = 0.2
"""Size, in the same unit, up to which parts that nearly touch are one: glasses are, beads all around a neck are not."""

_NAMED_TOGETHER = 0.05
"""The same for what is said to be rigid as a whole, such as a helmet and its visor."""

_LEAST_VERTICES = 3


def rigid_pieces(item: TriangleMesh, unit: float, named: Bools | None = None, *, search: bool = True) -> Ints:
    """Find the rigid pieces of an item.

    Parameters
    ----------
    item : TriangleMesh
        The item.
    unit : float
        Root of the area of the body that wears it.
    named : (n,) array of bool, optional
        Vertices that are known to be rigid: those that hang together, or nearly so, are one piece each.
    search : bool
        Whether to look for others: small loose parts that are solid.

    Returns
    -------
    (n,) array of int
        The piece that each vertex belongs to, numbered from 0; -1 where the item bends.
    """
    labels = np.full(item.vertex_count, -1)
    count = 0
    if named is not None and named.any():
        labels[named] = _groups(item, named, _NAMED_TOGETHER * unit, np.inf)[named]
        count = int(labels.max()) + 1
    if search:
        parts = WeldedParts.of(item)
        rigid = _solid_parts(parts, unit)[parts.vertex_labels] & (labels < 0)
        if rigid.any():
            labels[rigid] = count + _groups(item, rigid, _TOGETHER * unit, _LARGEST * unit, parts)[rigid]
    return labels


def placed_rigidly(before: Floats, after: Floats, scale: float | None = None) -> Floats:
    """Move points by the similarity that takes them nearest to where they should go.

    Parameters
    ----------
    before, after : (n, 3) array of float
        The points, and where they should go.
    scale : float, optional
        How many times as large they become, if that is known.

    Returns
    -------
    (n, 3) array of float
        The points, moved by one rotation, scale and translation.
    """
    linear, translation = nearest_similarity(before, after, scale=scale)
    return before @ linear.T + translation


def moved_along(vertices: Floats, moves: Floats, pieces: Ints) -> Floats:
    """Find how far each rigid piece moves with what is around it that bends.

    Parameters
    ----------
    vertices : (n, 3) array of float
        An item.
    moves : (n, 3) array of float
        How far its vertices are moved; of those of pieces it does not count.
    pieces : (n,) array of int
        The piece that each vertex belongs to, -1 where the item bends.

    Returns
    -------
    (p, 3) array of float
        The mean move of what bends nearest to the vertices of each piece; zero if nothing does.
    """
    soft, rigid = np.flatnonzero(pieces < 0), np.flatnonzero(pieces >= 0)
    count = int(pieces.max(initial=-1)) + 1
    if not (len(soft) and len(rigid)):
        return np.zeros((count, 3))
    near = soft[cKDTree(vertices[soft]).query(vertices[rigid])[1]]
    return group_means(pieces[rigid], moves[near], count)


def _solid_parts(parts: WeldedParts, unit: float) -> Bools:
    """Tell which parts are small and solid, (p,)."""
    closed = parts.closed
    labels = parts.labels[closed.triangles[:, 0]]
    count = parts.part_count
    areas = np.bincount(labels, closed.triangle_areas, count)
    vectors = closed.triangle_normals * closed.triangle_areas[:, None]
    solid = np.linalg.norm(group_sums(labels, vectors, count), axis=1) <= _SOLID * areas
    vertices = np.bincount(parts.labels, minlength=count)
    fits = (parts.sizes <= _TINY * unit) | ((parts.sizes <= _SMALL * unit) & solid)
    return fits & (vertices >= _LEAST_VERTICES) & (areas > 0)


def _groups(item: TriangleMesh, chosen: Bools, gap: float, largest: float, parts: WeldedParts | None = None) -> Ints:
    """Give the chosen vertices numbers of pieces, (n,): parts that nearly touch are one, if that is not too large."""
    n = item.vertex_count
    tails, heads = item.edges[chosen[item.edges].all(axis=1)].T
    welded = np.arange(n) if parts is None else parts.first[parts.welded]
    labels = joined_components(n, np.append(tails, np.arange(n)), np.append(heads, welded))
    vertices = np.flatnonzero(chosen)
    pairs = _touching(item, chosen, labels, gap)
    count = int(labels.max()) + 1
    groups = joined_components(count, *pairs.T)[labels]
    too_large = (group_extents(groups[vertices], item.vertices[vertices], count) > largest)[groups]
    pieces = np.where(too_large, count + labels, groups)
    numbers = np.full(n, -1)
    numbers[chosen] = np.unique(pieces[chosen], return_inverse=True)[1].ravel()
    return numbers


def _touching(item: TriangleMesh, chosen: Bools, labels: Ints, gap: float) -> Ints:
    """Find the pairs of parts (p, 2), of the chosen vertices, that are nearer than a gap, by their labels (n,)."""
    inside = item.triangles[chosen[item.triangles].all(axis=1)]
    of_triangles, of_vertices = labels[inside[:, 0]], np.flatnonzero(chosen)
    found = [np.empty((0, 2), np.int64)]
    for part in np.unique(of_triangles):
        triangles = inside[of_triangles == part]
        corners = item.vertices[triangles].reshape(-1, 3)
        points = item.vertices[of_vertices]
        near = ((points > corners.min(axis=0) - gap) & (points < corners.max(axis=0) + gap)).all(axis=1)
        others = of_vertices[near & (labels[of_vertices] != part)]
        if not len(others):
            continue
        used, local = np.unique(triangles, return_inverse=True)
        search = ClosestPoints(TriangleMesh(item.vertices[used], local.reshape(-1, 3)))
        distances = search.nearest(item.vertices[others]).squared_distances
        close = np.unique(labels[others[distances < gap**2]])
        found.append(np.column_stack([np.full(len(close), part), close]))
    return np.concatenate(found)
