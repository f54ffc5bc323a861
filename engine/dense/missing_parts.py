# SPDX-License-Identifier: GPL-3.0-or-later
"""Missing parts: regions of a surface without a counterpart on another, told by the maps between them."""

from __future__ import annotations

import numpy as np
from scipy.spatial import cKDTree

from ..mesh.connectivity.adjacency import neighbour_means
from ..mesh.surface_points import SurfacePoints
from ..mesh.triangle_mesh import TriangleMesh
from ..runtime.arrays import Bools, Floats

_SPACINGS, _LEAST_TRIP = 3.0, 0.03
"""Length of a round trip from which on it does not lead home: vertex spacings, and a part of sqrt(area)."""

_EDGE = 0.7
"""Part of that length from which on a place belongs to a missing part that it borders on."""

_MOSTLY = 0.5
"""Part of a vertex and its neighbours that must not be at home for it to count as such."""

_OTHER_SPACINGS, _LEAST_GAP = 1.25, 0.02
"""How far from all that the other surface is mapped to a place is not reached: spacings of the other surface's
vertices, and a part of sqrt(area)."""

_DENSE = 20_000
"""Vertices from which on they lie so close that the middles of their triangles reach no more."""

_LEAST_CORE = 0.001
"""Least area that is not reached, as a part of the surface, for something to be missing: half a finger of a person."""


def round_trips(source: TriangleMesh, there: SurfacePoints, back: SurfacePoints) -> Floats:
    """Distance between each vertex of the source and where two maps bring it, there and back, (n,).

    `there` holds a point of the target for each vertex of the source, `back` one of the source for each of the target.
    """
    return np.linalg.norm(there.interpolate(back.positions) - source.vertices, axis=1)


def with_partner(source: TriangleMesh, target: TriangleMesh, there: SurfacePoints, back: SurfacePoints) -> Bools:
    """Tell which vertices of the source have a partner on the target, by a pair of maps.

    Parameters
    ----------
    source, target : TriangleMesh
        The surfaces, n and n' vertices.
    there, back : SurfacePoints
        A point of the target for each vertex of the source, and the other way round.

    Returns
    -------
    (n,) array of bool
        False on each connected part of the surface that the target lacks.

    Notes
    -----
    What is missing on the target is mapped to whatever is left, and from there the way back leads elsewhere.  It does
    so too where the maps disagree; but then something of the target is mapped to the place, whereas to the middle of a
    missing part nothing is.
    """
    unit, n = float(np.sqrt(source.area)), source.vertex_count
    longest = max(_SPACINGS * unit / np.sqrt(n), _LEAST_TRIP * unit)
    trips = round_trips(source, there, back)
    lost = _mostly(source, trips >= longest)
    away = lost | _mostly(source, trips >= _EDGE * longest)
    core = lost.copy()
    least = max(_OTHER_SPACINGS / np.sqrt(target.vertex_count), _LEAST_GAP)
    core[lost] = _gaps(source.vertices[lost], target, back) > least * unit
    part = source.parts_of(away)
    areas = np.bincount(part, source.vertex_areas * core, n)
    return ~(away & (areas[part] >= _LEAST_CORE * source.area))


def _gaps(places: Floats, target: TriangleMesh, back: SurfacePoints) -> Floats:
    """Distances from places (k, 3) to what the target is mapped to, (k,): its vertices and its triangles' middles."""
    if not len(places):
        return np.empty(0)
    reached = back.positions
    if len(reached) < _DENSE:
        reached = np.concatenate([reached, reached[target.triangles].mean(axis=1)])
    return cKDTree(reached, balanced_tree=False, compact_nodes=False).query(places)[0]


def _mostly(mesh: TriangleMesh, marked: Bools) -> Bools:
    """Tell whether the larger part of each vertex and its neighbours is marked, (n,)."""
    return neighbour_means(mesh, marked.astype(np.float64)) > _MOSTLY
