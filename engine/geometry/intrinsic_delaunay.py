# SPDX-License-Identifier: GPL-3.0-or-later
"""Intrinsic Delaunay triangulations: the same surface, cut into better triangles that need not be flat in space."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..mesh.connectivity.halfedges import group_half_edges
from ..mesh.connectivity.mesh_orientation import orient_consistently, turn_triangles
from ..mesh.triangle_mesh import TriangleMesh
from ..runtime.arrays import TINY, Floats, Ints, group_largest, numbered

_SLACK = 1e-6
"""By how much two sides of a triangle are at least longer than the third, in mean edge lengths."""

_BAD = -1e-9
"""Sum of cotangents, relative to their size, below which an edge is flipped: four points on a circle stay so."""


@dataclass(frozen=True, eq=False)
class IntrinsicTriangulation:
    """Triangles known by the lengths of their sides.

    Attributes
    ----------
    triangles : (m, 3) array of int
        Corners of each triangle.  Two triangles may have the same corners, and a triangle may meet a vertex twice.
    lengths : (m, 3) array of float
        Lengths of their sides; side i leads from corner i to corner i + 1.
    flips : int
        How many edges were flipped.
    """

    triangles: Ints
    lengths: Floats
    flips: int = 0


def triangle_lengths(mesh: TriangleMesh) -> Floats:
    """Measure the sides of the triangles of a mesh, (m, 3); side i leads from corner i to corner i + 1."""
    corners = mesh.vertices[mesh.triangles]
    return np.linalg.norm(corners - np.roll(corners, -1, axis=1), axis=2)


def mollified_lengths(lengths: Floats) -> Floats:
    r"""Lengthen all sides alike until every triangle has an area.

    The same length is added to every side [1]_: the smallest with which two sides of a triangle are always longer than
    the third by :math:`10^{-6}` of the mean side.  Where all triangles are like that already, nothing changes.

    Parameters
    ----------
    lengths : (m, 3) array of float
        Lengths of the sides of triangles.

    Returns
    -------
    (m, 3) array of float
        The lengths, made longer.

    References
    ----------
    .. [1] N. Sharp, K. Crane, "A Laplacian for nonmanifold triangle meshes", SGP 2020.
    """
    # The least that the other two sides exceed the longest by: 2 (s - longest) with the half perimeter s.
    slack = lengths.sum(axis=1) - 2 * lengths.max(axis=1)
    return lengths + max(0.0, _SLACK * float(lengths.mean()) - float(slack.min()))


def corner_cotangents(lengths: Floats) -> tuple[Floats, Floats]:
    """Cotangent of the angle opposite each side, and area, of triangles.

    Parameters
    ----------
    lengths : (m, 3) array of float
        Lengths of the sides of triangles that have an area.

    Returns
    -------
    cotangents : (m, 3) array of float
        Cotangent of the angle opposite each side.
    areas : (m,) array of float
        Areas.
    """
    a, b, c = lengths.T
    # Heron's formula as a product of differences of lengths, which keeps the digits of needles.
    half = (a + b + c) / 2
    areas = np.sqrt(np.maximum(half * (half - a) * (half - b) * (half - c), 0))
    squares = lengths**2
    opposite = squares.sum(axis=1, keepdims=True) - 2 * squares
    return opposite / (4 * np.maximum(areas, TINY))[:, None], areas


def intrinsic_delaunay(mesh: TriangleMesh) -> IntrinsicTriangulation:
    r"""Flip edges within the surface until it is triangulated as Delaunay wants it.

    An edge is flipped while the angles :math:`\alpha, \beta` opposite to it have
    :math:`\cot\alpha + \cot\beta < 0`; the new edge is straight within the two unfolded triangles [1]_.  This ends
    in the intrinsic Delaunay triangulation, which is unique but for points on a common circle, so that it does not
    matter in which order edges are flipped.  Before, lengths are mollified (see `mollified_lengths`).

    Parameters
    ----------
    mesh : TriangleMesh
        Any mesh.  Edges at the boundary and edges of more than two triangles are never flipped, nor are those along
        which a surface of one side has to be cut for its triangles to look to one side.

    Returns
    -------
    IntrinsicTriangulation
        On the same vertices, with as many triangles.

    Notes
    -----
    Which sides of triangles are glued is kept in a table, not found by their vertices: after some flips an edge may
    join the same two vertices as another one, or a vertex with itself.  Each round flips the longest bad edges, none
    of two in the same triangle; then only what has changed is looked at again.

    References
    ----------
    .. [1] M. Fisher, B. Springborn, P. Schröder, A. Bobenko, "An algorithm for the construction of intrinsic Delaunay
       triangulations with applications to digital geometry processing", Computing 81, 2007.
    """
    orientation = orient_consistently(
        mesh.triangles, mesh.triangle_areas, group_half_edges(mesh.triangles, mesh.vertex_count).twins
    )
    triangles, twins = turn_triangles(mesh.triangles.copy(), orientation.twins, orientation.turned)
    lengths = mollified_lengths(triangle_lengths(mesh))
    lengths = np.where(orientation.turned[:, None], lengths[:, ::-1], lengths)
    cotangents = corner_cotangents(lengths)[0]
    flips = 0
    waiting = np.arange(3 * len(triangles))
    # A limit far beyond need (some tens of rounds): rounding in triangles hardly larger than nothing cannot make it
    # run for ever.
    for _ in range(100 + len(triangles)):
        bad = _bad_sides(waiting, twins, cotangents)
        sides = _independent(bad, twins, lengths)
        if not len(sides):
            break
        flips += len(sides)
        touched = np.concatenate([sides, twins[sides]]) // 3
        _flip(triangles, lengths, twins, sides)
        cotangents[touched] = corner_cotangents(lengths[touched])[0]
        waiting = np.concatenate([bad, (3 * touched[:, None] + np.arange(3)).ravel()])
    return IntrinsicTriangulation(triangles, lengths, flips)


def _bad_sides(sides: Ints, twins: Ints, cotangents: Floats) -> Ints:
    """Those of some sides whose edges violate the Delaunay condition, each edge once by its smaller side."""
    other = twins[sides]
    # A side glued to its own triangle surrounds a vertex of degree one: there is no other diagonal.
    there = (other >= 0) & (other // 3 != sides // 3)
    sides, other = sides[there], other[there]
    first, second = cotangents.ravel()[sides], cotangents.ravel()[other]
    bad = first + second < _BAD * (1 + abs(first) + abs(second))
    return np.unique(np.minimum(sides[bad], other[bad]))


def _independent(sides: Ints, twins: Ints, lengths: Floats) -> Ints:
    """Choose edges of which no two share a triangle: those that are the longest in both their triangles."""
    rank = numbered(np.lexsort((sides, lengths.ravel()[sides])), len(sides))
    here, there = sides // 3, twins[sides] // 3
    longest = group_largest(np.concatenate([here, there]), np.tile(rank, 2), len(lengths), -1)
    return sides[(longest[here] == rank) & (longest[there] == rank)]


def _flip(triangles: Ints, lengths: Floats, twins: Ints, sides: Ints) -> None:
    """Replace edges a b between the triangles a b c and b a d by c d, in place; no two share a triangle.

    The triangles become c a d and d b c.
    """
    (f, i), (g, j) = np.divmod(sides, 3), np.divmod(twins[sides], 3)
    bc, ca, ad, db = 3 * f + (i + 1) % 3, 3 * f + (i + 2) % 3, 3 * g + (j + 1) % 3, 3 * g + (j + 2) % 3
    flat_corners, flat_lengths = triangles.ravel(), lengths.ravel()
    a, b, c, d = flat_corners[ad], flat_corners[bc], flat_corners[ca], flat_corners[db]
    length_ab = flat_lengths[sides]
    length_bc, length_ca, length_ad, length_db = (flat_lengths[side] for side in (bc, ca, ad, db))
    length_cd = _diagonal(length_ab, length_bc, length_ca, length_ad, length_db)
    triangles[f], lengths[f] = np.stack([c, a, d], axis=1), np.stack([length_ca, length_ad, length_cd], axis=1)
    triangles[g], lengths[g] = np.stack([d, b, c], axis=1), np.stack([length_db, length_bc, length_cd], axis=1)

    # Where the four outer sides have moved to; a side that they are glued to may itself have moved in this round.
    moved = np.arange(len(twins))
    outer, places = np.concatenate([ca, ad, db, bc]), np.concatenate([3 * f, 3 * f + 1, 3 * g, 3 * g + 1])
    moved[outer] = places
    glued_to = twins[outer]
    glued_to = np.where(glued_to >= 0, moved[glued_to], -1)
    twins[places] = glued_to
    twins[glued_to[glued_to >= 0]] = places[glued_to >= 0]
    twins[3 * f + 2], twins[3 * g + 2] = 3 * g + 2, 3 * f + 2


def _diagonal(ab: Floats, bc: Floats, ca: Floats, ad: Floats, db: Floats) -> Floats:
    """Length of c d, with the triangles a b c and b a d unfolded into the plane."""
    # a at the origin, b at (ab, 0), c above and d below.
    _, above = corner_cotangents(np.stack([ab, bc, ca], axis=1))
    _, below = corner_cotangents(np.stack([ab, ad, db], axis=1))
    along_c = (ab**2 + ca**2 - bc**2) / (2 * ab)
    along_d = (ab**2 + ad**2 - db**2) / (2 * ab)
    return np.hypot(along_c - along_d, 2 * (above + below) / ab)
