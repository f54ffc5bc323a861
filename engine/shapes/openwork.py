# SPDX-License-Identifier: GPL-3.0-or-later
"""Openwork: wire frames, grids and cages, which have next to no inside, but enclose one."""

from __future__ import annotations

import numpy as np
from scipy.ndimage import binary_fill_holes, distance_transform_edt

from ..geometry.handle_loops import genus
from ..mesh.area_samples import even_samples
from ..mesh.connectivity.mesh_orientation import enclosed_volumes
from ..mesh.triangle_mesh import TriangleMesh
from ..repair.solid_indicator import MOST_PLACES
from ..repair.surface_nets import surface_net

FLAT = 0.02
"""Volume, by the power 3/2 of the area, below which a piece has no inside: a ball has 0.094."""

_HANDLES = 3
"""Handles from which on a closed surface without an inside is openwork: wire frames of balls, a head and a waist have 5
to 127, and of the pieces of seven characters in clothes none of those without an inside has more than one (tried
once)."""

_SMALLEST = 24
"""Places of the grid along openwork at least, by hand: it may be far smaller than the whole body.  If it is far larger,
as a fence is, `MOST_PLACES` make the grid coarser."""

_MARGIN = 3
"""Places of the grid beyond what is closed."""

_ROUND = 0.05
"""Volume, by the power 3/2 of the area, from which on openwork is filled and not only thicker: half of a ball's, by
hand."""

_WIDER = 1, 2, 4
"""How many times as wide holes are closed, one after the other, until it is filled: for five of the 48
pieces of wire of the robot of ``docs/results.md`` once is not enough (tried once)."""


def is_openwork(mesh: TriangleMesh) -> bool:
    """Say whether a connected piece has many holes through it, and hardly an inside of its own."""
    if not mesh.is_closed:
        return False
    corners = mesh.vertices[mesh.triangles] - mesh.vertices[0]
    volume = float(np.linalg.det(corners).sum()) / 6
    return abs(volume) < FLAT * mesh.area**1.5 and genus(mesh) >= _HANDLES


def filled_openwork(mesh: TriangleMesh, spacing: float, hole: float) -> TriangleMesh:
    """Put a surface around what openwork encloses: its holes are closed, and what is left inside is filled.

    Parameters
    ----------
    mesh : TriangleMesh
        The openwork.
    spacing : float
        Distance of the places of a grid on which that is done.
    hole : float
        Width of the holes that are closed, by a morphological closing with a ball of that radius, so that it is hardly
        dented there; if nothing is enclosed then, wider ones.

    Returns
    -------
    TriangleMesh
        A surface without holes, or what was given if it encloses nothing.
    """
    for wider in _WIDER:
        filled = _closed(mesh, spacing, wider * hole)
        if enclosed_volumes(filled)[1].sum() >= _ROUND * filled.area**1.5:
            return filled
    return mesh


def _closed(mesh: TriangleMesh, spacing: float, hole: float) -> TriangleMesh:
    """Close holes of a surface up to a width, and fill what is inside, on a grid."""
    low, high = mesh.vertices.min(axis=0), mesh.vertices.max(axis=0)
    size = float((high - low).max())
    hole = min(hole, size)
    least = float(np.cbrt(np.prod(high - low + 2 * hole) / MOST_PLACES))
    spacing = max(min(spacing, size / _SMALLEST), least)
    radius = hole / spacing
    origin = low - (radius + _MARGIN) * spacing
    shape = np.ceil((high - origin) / spacing + radius + _MARGIN).astype(np.int64) + 1
    empty = np.ones(shape, bool)
    places = np.rint((even_samples(mesh, spacing**2 / 4).positions - origin) / spacing).astype(np.int64)
    empty[tuple(places.T)] = False
    wide = distance_transform_edt(empty) <= radius
    inside = binary_fill_holes((distance_transform_edt(wide) > radius) | ~empty)
    vertices, triangles = surface_net(inside.astype(np.float32), 0.5)
    return TriangleMesh(vertices * spacing + origin, triangles)
