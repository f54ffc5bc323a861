# SPDX-License-Identifier: GPL-3.0-or-later
"""Bodies in pieces, and whether a map keeps these together and as large as they are."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy.spatial import cKDTree

from ..mesh.surface_map import SurfaceMap
from ..mesh.triangle_mesh import TriangleMesh
from ..runtime.arrays import Floats, Ints

_TOUCHING, _APART = 0.02, 0.08
"""How much farther than its nearest vertex from other pieces one may be that touches them, and how far apart the images
are of a piece that is torn off: in sqrt(area)."""


@dataclass(frozen=True, eq=False)
class PiecedBody:
    """A body in pieces.

    Attributes
    ----------
    mesh : TriangleMesh
        The mesh, n vertices.
    pieces : (n,) array of int
        The piece that each vertex is of; -1 if it is not of the body.
    """

    mesh: TriangleMesh
    pieces: Ints

    @cached_property
    def areas(self) -> Floats:
        """Area of each vertex as a part of the body's, (n,)."""
        areas = self.mesh.vertex_areas * (self.pieces >= 0)
        return areas / areas.sum()

    @cached_property
    def unit(self) -> float:
        """Square root of the area of the body."""
        return float(np.sqrt(self.mesh.vertex_areas[self.pieces >= 0].sum()))

    @cached_property
    def shares(self) -> Floats:
        """Area of each piece as a part of the body's, (p,)."""
        return self.on_pieces(self.pieces, self.areas)

    def without(self, pieces: Ints) -> PiecedBody:
        """Return the body without some pieces."""
        return PiecedBody(self.mesh, np.where(np.isin(self.pieces, pieces), -1, self.pieces))

    def on_pieces(self, pieces: Ints, areas: Floats) -> Floats:
        """Sum areas (k,) that are on pieces (k,), -1 for none, for each piece, (p,)."""
        return np.bincount(pieces + 1, areas, int(self.pieces.max()) + 2).astype(np.float64)[1:]


def common_cut(first: PiecedBody, second: PiecedBody) -> float:
    """Tell what part of the area of two bodies is common to the largest pieces of each, the second largest, and so on.

    It is 1 for bodies that are cut alike, wherever they are cut, and small where only one of them is cut.
    """
    shares = np.zeros((2, max(len(first.shares), len(second.shares))))
    for row, body in zip(shares, (first, second), strict=True):
        row[: len(body.shares)] = np.sort(body.shares)[::-1]
    return float(shares.min(axis=0).sum())


def without_partner(source: PiecedBody, target: PiecedBody, found: SurfaceMap) -> Ints:
    """Tell which pieces of a body but the first have none of the other: a map takes most of them to its first piece."""
    main = target.pieces[found.nearest_vertices] == 0
    alone = np.flatnonzero(source.on_pieces(source.pieces, source.areas * main) > source.shares / 2)
    return alone[alone > 0]


def resized_share(source: PiecedBody, target: PiecedBody, found: SurfaceMap) -> float:
    """Tell what part of a body a map would have to move from some pieces of the other to others, to fill them evenly.

    Parameters
    ----------
    source, target : PiecedBody
        The bodies.
    found : SurfaceMap
        A map from the source to the target.

    Returns
    -------
    float
        Half of the sum over pieces of the target of how much their shares of its area differ from the shares of the
        source's that are mapped there (the distance in total variation).  Near zero for bodies that are cut alike.
    """
    carried = target.on_pieces(target.pieces[found.nearest_vertices], source.areas)
    return float(np.abs(carried - target.shares).sum() / 2)


def torn_share(source: PiecedBody, target: PiecedBody, found: SurfaceMap) -> float:
    """Tell what part of a body is in pieces whose images do not touch those of what they touch.

    Parameters
    ----------
    source, target : PiecedBody
        The bodies.
    found : SurfaceMap
        A map from the source to the target.

    Returns
    -------
    float
        The part of the source's area; the first piece, which the others hang on, is in none.
    """
    vertices, images = source.mesh.vertices, found.positions
    body = np.flatnonzero(source.pieces >= 0)
    torn = 0.0
    for piece in np.unique(source.pieces[source.pieces > 0]):
        its, others = body[source.pieces[body] == piece], body[source.pieces[body] != piece]
        distances, nearest = cKDTree(vertices[others]).query(vertices[its])
        touching = distances <= distances.min() + _TOUCHING * source.unit
        apart = np.linalg.norm(images[its] - images[others[nearest]], axis=1) / target.unit - distances / source.unit
        if np.median(apart[touching]) > _APART:
            torn += float(source.areas[its].sum())
    return torn
