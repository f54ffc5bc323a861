# SPDX-License-Identifier: GPL-3.0-or-later
"""Openings of a garment: ends of a surface through which the body that wears it goes on."""

from __future__ import annotations

from typing import Final

import numpy as np

from ..mesh.connectivity.components import joined_components
from ..mesh.connectivity.welded_parts import WeldedParts
from ..mesh.triangle_mesh import TriangleMesh
from ..runtime.arrays import Floats

_LEAST_GIRTH: Final = 0.2
"""An opening counts from this length on, in units of the root of the surface's area: a sleeve has about 0.25,
an open mouth 0.1."""

_FILLED: Final = 0.5
"""Winding number of other pieces from which on the middle of an opening is inside of them: an arm in its sleeve, a
neck in its collar.  Whole characters have from 0.7 on, garments alone 0 (`tests/engine/retarget/test_open_ends.py`)."""


def open_ends(mesh: TriangleMesh) -> int:
    """Count the large openings of a surface, such as neck, sleeves and hem of a shirt, that nothing goes into.

    Parameters
    ----------
    mesh : TriangleMesh
        The surface.  Seams that it was cut open at, as for UVs, are closed.

    Returns
    -------
    int
        How many boundary curves there are whose length is a good part of the root of its area, and whose middle is
        outside of the other pieces: an opening that a piece goes into, as a leg into a boot, is no end of the whole.
    """
    parts = WeldedParts.of(mesh)
    points, border = parts.positions, parts.closed.boundary_edges
    if not len(border):
        return 0
    lengths = np.linalg.norm(points[border[:, 1]] - points[border[:, 0]], axis=1)
    curve = joined_components(len(points), *border.T)[border[:, 0]]
    girths = np.bincount(curve, lengths)
    count = 0
    for number in np.flatnonzero(girths > _LEAST_GIRTH * np.sqrt(mesh.area)):
        own = curve == number
        middle = lengths[own] @ points[border[own]].mean(axis=1) / girths[number]
        others = parts.triangles[parts.labels[parts.triangles[:, 0]] != parts.labels[border[own][0, 0]]]
        count += abs(_winding_number(points[others] - middle)) < _FILLED
    return int(count)


def _winding_number(triangles: Floats) -> float:
    """Say how often triangles (k, 3, 3) go around the origin: 1 inside of a closed surface, 0 outside [1]_.

    References
    ----------
    .. [1] A. Van Oosterom, J. Strackee, "The solid angle of a plane triangle", IEEE Trans. Biomed. Eng. 30, 1983.
    """
    a, b, c = triangles.transpose(1, 0, 2)
    x, y, z = np.linalg.norm(triangles, axis=2).T
    volumes = np.einsum("kd,kd->k", a, np.cross(b, c))
    bases = x * y * z + np.einsum("kd,kd->k", a, b) * z
    bases += np.einsum("kd,kd->k", b, c) * x + np.einsum("kd,kd->k", c, a) * y
    return float(np.arctan2(volumes, bases).sum() / (2 * np.pi))
