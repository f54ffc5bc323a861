# SPDX-License-Identifier: GPL-3.0-or-later
"""Openings of a garment: ends of a surface through which the body that wears it goes on."""

from __future__ import annotations

from typing import Final

import numpy as np
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components

from ..mesh.triangle_mesh import TriangleMesh

_COINCIDENT: Final = 1e-6
"""Vertices closer than this part of the diagonal of the bounding box are one: meshes are split at UV seams."""

_LEAST_GIRTH: Final = 0.2
"""An opening counts from this length on, in units of the root of the surface's area: a sleeve has about 0.25,
an open mouth 0.1."""


def open_ends(mesh: TriangleMesh) -> int:
    """Count the large openings of a surface, such as neck, sleeves and hem of a shirt.

    Parameters
    ----------
    mesh : TriangleMesh
        The surface.  Vertices at the same place count as one.

    Returns
    -------
    int
        How many boundary curves there are whose length is a good part of the root of its area.
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
    graph = coo_array((np.ones(len(border)), tuple(border.T)), shape=(len(points), len(points)))
    curve = connected_components(graph, directed=False)[1][border[:, 0]]
    girths = np.bincount(curve, lengths)
    return int((girths > _LEAST_GIRTH * np.sqrt(mesh.area)).sum())
