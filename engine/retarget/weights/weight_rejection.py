# SPDX-License-Identifier: GPL-3.0-or-later
"""Rejection of weights of a wrong place: at vertices that a map tears away from their neighbours."""

from __future__ import annotations

import numpy as np
from scipy.sparse import csr_array

from ...mesh.connectivity.components import joined_components
from ...mesh.connectivity.welded_parts import WeldedParts
from ...mesh.surface_map import SurfaceMap
from ...mesh.triangle_mesh import TriangleMesh
from ...runtime.arrays import Bools, Ints, group_largest
from .skin_weights import row_differences

_STRETCH = 3.0
"""An edge that a map stretches by more may be torn."""

_DIFFERENCE = 0.5
"""It is, if the weights of its ends differ by more, of the 2 that are possible."""

_ISLAND = 0.02
"""Largest island, in units of the number of vertices of the largest one on the same part of the surface."""

_TORN_EDGES = 1 / 3
"""Part of its edges from which a vertex that is on no island is torn away as well."""


def torn_weights(weights: csr_array, surface_map: SurfaceMap, parts: WeldedParts, image: TriangleMesh) -> Bools:
    """Find vertices that a map takes to another place than the surface around them.

    Parameters
    ----------
    weights : (n, g) csr_array of float
        The weights that were carried across the map.
    surface_map : SurfaceMap
        Map of the n vertices.
    parts : WeldedParts
        The surface of these vertices.
    image : TriangleMesh
        The surface that they are mapped to.

    Returns
    -------
    (n,) array of bool
        Whether each lies on a small island in a ring of torn edges, or a third of its edges are torn.  An edge is torn
        if the map makes it much longer and the weights of its ends have little in common: one without the other
        happens on good maps, where a body is fatter here than there, or triangles are large.
    """
    images, values = parts.means @ surface_map.positions, csr_array(parts.means @ weights)
    a, b = parts.edges.T
    before = np.linalg.norm(parts.positions[a] - parts.positions[b], axis=1) / np.sqrt(parts.mesh.area)
    after = np.linalg.norm(images[a] - images[b], axis=1) / np.sqrt(image.area)
    torn = after > _STRETCH * before
    torn[torn] = row_differences(values[a[torn]], values[b[torn]]) > _DIFFERENCE
    if not torn.any():
        return np.zeros(parts.mesh.vertex_count, bool)
    rejected = _islands(parts, ~torn)
    inland = ~rejected[parts.edges].any(axis=1)
    rejected |= _degrees(parts, torn & inland) > _TORN_EDGES * _degrees(parts, inland)
    return rejected[parts.welded]


def _islands(parts: WeldedParts, whole: Bools) -> Bools:
    """Say of each welded vertex (w,) whether what whole edges (e,) join it to is small beside the rest of its part."""
    islands = joined_components(parts.welded_count, *parts.edges[whole].T)
    sizes = np.bincount(islands)[islands]
    return sizes <= _ISLAND * group_largest(parts.labels, sizes, parts.part_count)[parts.labels]


def _degrees(parts: WeldedParts, chosen: Bools) -> Ints:
    """Count the chosen edges (e,) at each welded vertex, (w,)."""
    return np.bincount(parts.edges[chosen].ravel(), minlength=parts.welded_count)
