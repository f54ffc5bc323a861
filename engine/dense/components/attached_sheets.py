# SPDX-License-Identifier: GPL-3.0-or-later
"""Small sheets on the main part, such as lashes and eye shells, mapped through what they lie on."""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from scipy.optimize import linear_sum_assignment

from ...mesh.closest_points import ClosestPoints
from ...mesh.connectivity.components import vertex_components
from ...mesh.triangle_mesh import TriangleMesh
from ...repair.clean_surface import CleanSurface
from ...runtime.arrays import TINY, Floats, Ints
from .component_pairs import radius_of
from .similarity_field import Surroundings

_SMALL = 0.02
"""Pieces up to this part of the main part's area are taken apart into sheets."""

_MOST_SHEETS = 64
"""Meshes with more sheets than these are in pieces for another reason: all of their vertices are split, for example."""

_ALIKE = 0.25
"""Root mean square distance, both ways and in radii, up to which one sheet may be another one."""

_LARGEST_RATIO = 2.0
"""By what factor the radii of partners may differ, once the sheet is carried."""

_NOT_POSSIBLE = 20.0
"""No pair costs more than that of leaving a sheet alone, so that as many as possible are made."""


@dataclass(frozen=True, eq=False)
class MappedSheets:
    """A map of the vertices of sheets.

    Attributes
    ----------
    vertices : (k,) array of int
        Vertices of the original mesh X.
    triangles, barycentric : (k,) array of int, (k, 3) array of float
        Where each lies on the original mesh Y.
    partners : (k,) array of int
        The piece of Y that each is mapped to.
    """

    vertices: Ints
    triangles: Ints
    barycentric: Floats
    partners: Ints


class _Sheet(NamedTuple):
    """A sheet: its mesh, the original vertices and triangles, its piece, and whether that has others."""

    mesh: TriangleMesh
    vertices: Ints
    triangles: Ints
    piece: int
    has_others: bool


def mapped_sheets(x: CleanSurface, y: CleanSurface, around: Surroundings) -> MappedSheets:
    """Map sheets that cleaning has welded into pieces together with others.

    Sheets that lie on each other, as the lashes, the film of tears and the shell of an eye do, share places here and
    there, so that what is one piece on X may be several on Y, divided elsewhere.  The surface below them knows where
    they belong: every vertex is moved as its surroundings are, and where a sheet comes to lie on one of the other mesh
    everywhere, both ways, each vertex goes to the closest point of that.

    Parameters
    ----------
    x, y : CleanSurface
        The meshes.
    around : Surroundings
        The main part of X and its map.

    Returns
    -------
    MappedSheets
        Empty if there are none: pieces that are one sheet on either mesh are compared as pieces.
    """
    here, there = _sheets(x), _sheets(y)
    chosen = _paired(here, there, around) if any(sheet.has_others for sheet in (*here, *there)) else []
    found = [(sheet, partner, ClosestPoints(partner.mesh).nearest(places)) for sheet, partner, places in chosen]
    return MappedSheets(
        np.concatenate([np.empty(0, np.int64), *(sheet.vertices for sheet, _, _ in found)]),
        np.concatenate([np.empty(0, np.int64), *(partner.triangles[at.triangles] for _, partner, at in found)]),
        np.concatenate([np.empty((0, 3)), *(at.barycentric for _, _, at in found)]),
        np.concatenate([np.empty(0, np.int64), *(np.full(len(s.vertices), p.piece) for s, p, _ in found)]),
    )


def _sheets(surface: CleanSurface) -> list[_Sheet]:
    """Take the small pieces beside the main part apart by the triangles of the original mesh."""
    mesh = surface.original
    areas = np.array([piece.mesh.area for piece in surface.pieces])
    small = np.append(areas <= _SMALL * areas[0], False)  # the last for vertices in no part
    small[0] = False
    pieces = surface.vertex_parts[mesh.triangles]
    triangles = np.flatnonzero(small[pieces[:, 0]] & (pieces == pieces[:, :1]).all(axis=1))
    labels = vertex_components(mesh.triangles[triangles], mesh.vertex_count)[mesh.triangles[triangles, 0]]
    numbers, first = np.unique(labels, return_index=True)
    if len(numbers) > _MOST_SHEETS:
        return []
    owners = pieces[triangles[first], 0]
    sheets = []
    for number, owner in zip(numbers, owners, strict=True):
        own = triangles[labels == number]
        if mesh.triangle_areas[own].any():
            sheets.append(_Sheet(*mesh.made_of(own), own, int(owner), np.count_nonzero(owners == owner) > 1))
    return sheets


def _carried(sheet: _Sheet, around: Surroundings) -> TriangleMesh:
    """Move a sheet as its surroundings move."""
    vertices = sheet.mesh.vertices
    carried = around.similarities(vertices, around.nearest(vertices)[0])(vertices)
    return TriangleMesh(carried, sheet.mesh.triangles)


def _paired(here: list[_Sheet], there: list[_Sheet], around: Surroundings) -> list[tuple[_Sheet, _Sheet, Floats]]:
    """Find which sheets of X come to lie on which of Y, and the places (n, 3) of their vertices there."""
    carried = [_carried(sheet, around) for sheet in here]
    costs = np.full((len(here), len(there)), _NOT_POSSIBLE)
    for i, j in np.ndindex(costs.shape):
        if not (here[i].has_others or there[j].has_others):
            continue
        sheet, partner = carried[i], there[j].mesh
        radii = radius_of(sheet), radius_of(partner)
        apart = np.linalg.norm(sheet.vertices.mean(axis=0) - partner.vertices.mean(axis=0))
        if apart <= min(radii) and max(radii) <= _LARGEST_RATIO * min(radii):
            ahead = ClosestPoints(partner).nearest(sheet.vertices).squared_distances
            back = ClosestPoints(sheet).nearest(partner.vertices).squared_distances
            costs[i, j] = np.sqrt((ahead.mean() + back.mean()) / 2) / max(min(radii), TINY)
    costs[costs > _ALIKE] = _NOT_POSSIBLE
    rows, columns = linear_sum_assignment(costs)
    pairs = [(i, j) for i, j in zip(rows, columns, strict=True) if costs[i, j] <= _ALIKE]
    return [(here[i], there[j], carried[i].vertices) for i, j in pairs]
