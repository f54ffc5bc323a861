# SPDX-License-Identifier: GPL-3.0-or-later
"""Openings of a garment: ends of a surface through which the body that wears it goes on."""

from __future__ import annotations

from typing import Final

import numpy as np

from ..mesh.connectivity.components import joined_components
from ..mesh.triangle_mesh import TriangleMesh
from ..runtime.arrays import Floats

_COINCIDENT: Final = 1e-6
"""Vertices closer than this part of the diagonal of the bounding box are one: meshes are split at UV seams."""

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
        The surface.  Vertices at the same place count as one.

    Returns
    -------
    int
        How many boundary curves there are whose length is a good part of the root of its area, and whose middle is
        outside of the other pieces: an opening that a piece goes into, as a leg into a boot, is no end of the whole.
    """
    size = float(np.linalg.norm(np.ptp(mesh.vertices, axis=0)))
    cells = np.round(mesh.vertices / (_COINCIDENT * size)).astype(np.int64)
    _, place = np.unique(cells, axis=0, return_inverse=True)
    corners = place.ravel()[mesh.triangles]
    ends = np.sort(np.stack([corners, np.roll(corners, -1, axis=1)], axis=2).reshape(-1, 2), axis=1)
    ends = ends[ends[:, 0] != ends[:, 1]]
    edges, counts = np.unique(ends, axis=0, return_counts=True)
    border = edges[counts == 1]
    if not len(border):
        return 0
    points = np.zeros((int(place.max()) + 1, 3))
    points[place.ravel()] = mesh.vertices
    lengths = np.linalg.norm(points[border[:, 1]] - points[border[:, 0]], axis=1)
    curve = joined_components(len(points), *border.T)[border[:, 0]]
    girths = np.bincount(curve, lengths)
    piece = joined_components(len(points), *edges.T)
    count = 0
    for number in np.flatnonzero(girths > _LEAST_GIRTH * np.sqrt(mesh.area)):
        own = curve == number
        middle = lengths[own] @ points[border[own]].mean(axis=1) / girths[number]
        others = corners[piece[corners[:, 0]] != piece[border[own][0, 0]]]
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
