# SPDX-License-Identifier: GPL-3.0-or-later
"""Ends of a body that has no skin below its clothes, as characters for games are made: boots without feet in them."""

from __future__ import annotations

import numpy as np

from ...mesh.connectivity.components import joined_components
from ...mesh.connectivity.welded_parts import WeldedParts
from ...mesh.triangle_mesh import TriangleMesh
from ...runtime.arrays import Floats
from .contact import Surface

_SHARE = 0.25
"""Least part of an item, by area, that lies beyond the rims of holes."""

_FAR = 1.5
"""How far beyond a rim half of that lies at least, in radii of the hole.  What covers a hole, as hair does on an open
skull, lies within one of its radii.  Of 29 clothes and parts of nine characters, taken out of them in turn, those that
are limbs have 2.3 to 8.8, what covers holes 0.3 to 1.0."""


def continues_body(body: TriangleMesh, item: TriangleMesh) -> bool:
    """Tell whether an item stands for a part that a body lacks: the body is cut open, and the item goes on from there.

    Parameters
    ----------
    body : TriangleMesh
        The body without the item.
    item : TriangleMesh
        What it wears.
    """
    sewn = WeldedParts.of(body).closed
    found = Surface(sewn).clearance(item.vertices)
    beyond = ~found.known
    if item.vertex_areas[beyond].sum() < _SHARE * item.area:
        return False
    away, radii = np.abs(found.distances[beyond]), _hole_radii(sewn)[found.vertices[beyond]]
    return bool((away > _FAR * radii).mean() > 1 / 2)


def _hole_radii(mesh: TriangleMesh) -> Floats:
    """Find how wide the holes are, (n,): for each vertex on a rim its root mean square distance from the centre."""
    edges = mesh.boundary_edges
    holes = joined_components(mesh.vertex_count, edges[:, 0], edges[:, 1])
    rim = np.unique(edges)
    count = np.bincount(holes[rim], minlength=int(holes.max()) + 1).clip(min=1)
    squares = np.zeros(len(count))
    for axis in range(3):
        along = mesh.vertices[rim, axis]
        centre = np.bincount(holes[rim], along, len(count)) / count
        squares += np.bincount(holes[rim], (along - centre[holes[rim]]) ** 2, len(count))
    return np.sqrt(squares / count)[holes]
