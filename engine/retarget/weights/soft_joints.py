# SPDX-License-Identifier: GPL-3.0-or-later
"""Skin weights where a body in one piece takes the place of one in plates: it bends where they turned apart."""

from __future__ import annotations

import numpy as np
from scipy.sparse import csr_array
from scipy.sparse.csgraph import dijkstra

from ...mesh.connectivity.welded_parts import WeldedParts
from ...mesh.surface_map import SurfaceMap
from ...runtime.arrays import group_largest
from .skin_weights import row_differences
from .weight_filling import filled

_JUMP = 1.0
"""Two neighbours are moved by different plates if their weights differ by more, of the 2 that are possible: half of
what moves the one does not move the other."""

_REACH = 0.1
"""How far from the joint of two plates the surface bends, in units of the root of either plate's area: some three
centimetres at an elbow.  With less, triangles at bent joints are stretched; with more, short plates have no middle that
keeps its shape (`tests/engine/retarget/weights/test_soft_joints.py`)."""


def with_soft_joints(
    weights: csr_array, parts: WeldedParts, source_parts: WeldedParts, surface_map: SurfaceMap
) -> csr_array:
    """Let weights pass over gradually where neighbours on a surface lie on separate plates of the source.

    Plates turn apart at a joint and leave a gap, or slide into each other.  A surface that goes on there would tear,
    along whatever line the map has drawn.

    Parameters
    ----------
    weights : (n, g) csr_array of float
        Weights that were carried from the source.
    parts : WeldedParts
        The surface that they are on.
    source_parts : WeldedParts
        The source.
    surface_map : SurfaceMap
        Where each of the n vertices lies on the source.

    Returns
    -------
    (n, g) csr_array of float
        The weights: near a joint they are continued harmonically from either side; the middle of each plate keeps its
        own.
    """
    if source_parts.part_count == 1:
        return weights
    plate = source_parts.vertex_labels[surface_map.nearest_vertices][parts.first]
    values = csr_array(parts.means @ weights)
    one, other = parts.edges.T
    joint = plate[one] != plate[other]
    joint[joint] = row_differences(values[one[joint]], values[other[joint]]) > _JUMP
    if not joint.any():
        return weights
    source = source_parts.mesh
    areas = np.bincount(source_parts.vertex_labels, source.vertex_areas, source_parts.part_count)
    reach = _REACH * np.sqrt(areas * parts.mesh.area / source.area)[plate]
    lengths = np.linalg.norm(parts.positions[one] - parts.positions[other], axis=1)
    count = parts.welded_count
    graph = csr_array((lengths, (one, other)), shape=(count, count))
    begin = np.unique(parts.edges[joint])
    away = dijkstra(graph, directed=False, indices=begin, min_only=True, limit=float(reach.max()))
    soft = (away <= reach) & (away < group_largest(plate, away, source_parts.part_count)[plate])
    return filled(weights, ~soft[parts.welded], parts)
