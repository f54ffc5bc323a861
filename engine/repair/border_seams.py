# SPDX-License-Identifier: GPL-3.0-or-later
"""Pieces of a surface whose borders run side by side: it was cut there, or never closed."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from scipy.sparse import csr_array
from scipy.spatial import cKDTree

from ..mesh.connectivity.adjacency import pair_matrix
from ..mesh.connectivity.components import joined_components, vertex_components
from ..mesh.connectivity.halfedges import EdgeGroups, triangle_slots
from ..mesh.triangle_mesh import triangle_areas
from ..runtime.arrays import Bools, Floats, Ints, evenly, group_sums, marked, unit_vectors

_SMALLEST = 0.01
"""Area of a piece that is joined to others, as a part of the whole: lashes and buttons lie on something."""

_GAP, _SPACINGS = 0.015, 0.5
"""How wide a gap may be, in the root of the area of the whole, and how much more in spacings of the border's vertices,
as those of the other border lie between them."""

_OVERLAP = 0.5
"""How far a border may lie behind the other one, in spacings and as a part of the widest gap: a shirt hangs over what
is under it."""

_TURNED = 0.5
"""Cosine between the directions in which both surfaces would go on, up to which they may be one; that of two layers
which end at the same place is one."""

_ALONGSIDE = 0.7
"""Length of a border that runs along others, as a part of all of it, from which on it was one with them."""

_LYING, _LYING_POINTS = 0.5, 500
"""Part of a piece that may be as near to another one as a gap is wide; of one that lies on the other, as clothes or the
inner side of a shell do, all is.  And at how many points that is told."""

_SMOOTHED = 3
"""How often the directions in which a surface ends are averaged along its border, which may be ragged."""

_ROUNDS, _AVERAGED = 2, 8
"""How often vertices are paired again with the gap closed, and over how many neighbours it is averaged."""

_FEWEST = 6
"""Vertices of a border that can tell."""


class _Borders(NamedTuple):
    """Where pieces end.

    Attributes
    ----------
    vertices : (k,) array of int
        Vertices at borders.
    pieces, loops : (k,) array of int
        The piece, and the closed curve, that each belongs to.
    lengths : (k,) array of float
        Length of the border around each.
    outward : (k, 3) array of float
        Direction in which the surface would go on, a unit vector.
    neighbours : (k, k) sparse array
        1 for the next vertices along the border.
    owners : (n,) array of int
        The piece of every vertex of the mesh.
    """

    vertices: Ints
    pieces: Ints
    loops: Ints
    lengths: Floats
    outward: Floats
    neighbours: csr_array
    owners: Ints


def seam_partners(vertices: Floats, triangles: Ints, groups: EdgeGroups) -> Ints:
    """Find vertices of different pieces that face each other across a narrow gap.

    A body whose halves were mirrored but not merged, or a head beside the neck that it belongs to, are one surface.
    What is next to another piece anywhere but at its border is not: clothes stay apart from the body.

    Parameters
    ----------
    vertices : (n, 3) array of float
        Positions.
    triangles : (m, 3) array of int
        Corners of each triangle.
    groups : EdgeGroups
        The half-edges of each edge.

    Returns
    -------
    (n,) array of int
        For each vertex, the vertex that stands for it: itself, or of two that face each other the first one.
    """
    representatives = np.arange(len(vertices))
    borders, area = _borders(vertices, triangles, groups)
    if borders is None:
        return representatives
    places, count = vertices[borders.vertices], len(borders.vertices)
    widest = _GAP * np.sqrt(area) + _SPACINGS * borders.lengths
    shifts = np.zeros((count, 3))
    # What is nearest across a gap, of ragged borders, may be any tooth: with the gap closed on average, it is the like.
    for _ in range(_ROUNDS + 1):
        nearest = _nearest(borders, places, shifts, 2 * widest)
        facing = _facing(borders, places, nearest, widest)
        gaps = np.zeros((count, 4))
        gaps[facing, :3], gaps[facing, 3] = places[nearest[facing]] - places[facing], 1
        for _ in range(_AVERAGED):
            gaps = (gaps + borders.neighbours @ gaps) / 3
        shifts = gaps[:, :3] / np.where(gaps[:, 3:] > 0, gaps[:, 3:], np.inf)
    covered = np.zeros(count)
    covered[facing] = borders.lengths[facing]
    alongside = np.bincount(borders.loops, covered) / np.bincount(borders.loops, borders.lengths)
    one = marked(facing, count)
    # The other border may go on elsewhere, as that of a scan does beyond a patch.
    joined = alongside[borders.loops] >= _ALONGSIDE
    mutual = one & (nearest[nearest] == np.arange(count)) & one[nearest]
    chosen = np.flatnonzero(mutual & (joined | joined[nearest]))
    chosen = chosen[~_on_others(vertices, borders, chosen, nearest[chosen], _GAP * float(np.sqrt(area)))]
    first, second = borders.vertices[chosen], borders.vertices[nearest[chosen]]
    representatives[np.maximum(first, second)] = np.minimum(first, second)
    return representatives


def _nearest(borders: _Borders, places: Floats, shifts: Floats, reach: Floats) -> Ints:
    """Find the nearest vertex at the border of another piece to places (k, 3) that were shifted, (k,); -1 for none."""
    nearest = np.full(len(places), -1)
    for piece in np.unique(borders.pieces):
        own, other = np.flatnonzero(borders.pieces == piece), np.flatnonzero(borders.pieces != piece)
        tree = cKDTree(places[other])
        found = tree.query(places[own] + shifts[own], distance_upper_bound=float(reach[own].max()))[1]
        within = found < len(other)
        nearest[own[within]] = other[found[within]]
    return nearest


def _facing(borders: _Borders, places: Floats, nearest: Ints, widest: Floats) -> Ints:
    """Find the vertices beyond which the surface goes on, at the nearest one of another piece."""
    facing = np.flatnonzero(nearest >= 0)
    partner = nearest[facing]
    gaps = places[partner] - places[facing]
    ahead = np.einsum("kd,kd->k", gaps, borders.outward[facing])
    back = -np.einsum("kd,kd->k", gaps, borders.outward[partner])
    behind = -_OVERLAP * np.minimum(borders.lengths[facing], widest[facing])
    opposite = np.einsum("kd,kd->k", borders.outward[facing], borders.outward[partner]) < _TURNED
    near = np.linalg.norm(gaps, axis=1) <= widest[facing]
    return facing[near & opposite & (np.minimum(ahead, back) >= behind)]


def _on_others(vertices: Floats, borders: _Borders, first: Ints, second: Ints, reach: float) -> Bools:
    """Tell for which vertices of borders that face each other, (c,) each, one piece lies on the other all over."""
    pairs = np.sort(np.stack([borders.pieces[first], borders.pieces[second]], axis=1), axis=1)
    kinds, number = np.unique(pairs, axis=0, return_inverse=True)
    lying = np.zeros(len(kinds), bool)
    for kind, pair in enumerate(kinds):
        smaller, larger = sorted((np.flatnonzero(borders.owners == piece) for piece in pair), key=len)
        some = smaller[evenly(len(smaller), _LYING_POINTS)]
        near = np.isfinite(cKDTree(vertices[larger]).query(vertices[some], distance_upper_bound=reach)[0])
        lying[kind] = near.mean() > _LYING
    return lying[number.reshape(-1)]


def _borders(vertices: Floats, triangles: Ints, groups: EdgeGroups) -> tuple[_Borders | None, float]:
    """Find where large pieces end, and the area of all; None, and maybe no area, if fewer than two of them do."""
    open_edges = groups.order[groups.starts[groups.counts == 1]]
    if not len(open_edges):
        return None, 0.0
    areas = triangle_areas(vertices, triangles)
    area = float(areas.sum())
    pieces = vertex_components(triangles, len(vertices))
    sizes = np.bincount(pieces[triangles[:, 0]], areas, minlength=int(pieces.max()) + 1)
    tails, heads, tops = (triangle_slots(triangles, open_edges, shift) for shift in (0, 1, 2))
    large = sizes[pieces[tails]] > _SMALLEST * area
    tails, heads, tops = tails[large], heads[large], tops[large]
    if len(np.unique(pieces[tails])) < 2:
        return None, area
    border = np.unique(np.concatenate([tails, heads]))
    tail, head = np.searchsorted(border, tails), np.searchsorted(border, heads)
    k = len(border)
    along = vertices[heads] - vertices[tails]
    lengths = np.linalg.norm(along, axis=1)
    middles = (vertices[heads] + vertices[tails]) / 2
    away = middles - vertices[tops]
    unit = along / np.where(lengths > 0, lengths, 1)[:, None]
    away -= np.einsum("kd,kd->k", away, unit)[:, None] * unit
    away = unit_vectors(away)
    outward = group_sums(tail, away, k) + group_sums(head, away, k)
    neighbours = pair_matrix(np.stack([tail, head], axis=1), np.ones(len(tail)), k)
    for _ in range(_SMOOTHED):
        outward = unit_vectors(outward)
        outward = outward + neighbours @ outward
    loops = joined_components(k, tail, head)
    enough = np.bincount(loops)[loops] >= _FEWEST
    around = (np.bincount(tail, lengths, k) + np.bincount(head, lengths, k)) / 2
    if len(np.unique(pieces[border[enough]])) < 2:
        return None, area
    loops, kept = np.unique(loops[enough], return_inverse=True)[1], np.flatnonzero(enough)
    neighbours = neighbours[kept][:, kept]
    outward = unit_vectors(outward[kept])
    return _Borders(border[kept], pieces[border[kept]], loops, around[kept], outward, neighbours, pieces), area
