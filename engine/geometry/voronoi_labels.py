# SPDX-License-Identifier: GPL-3.0-or-later
"""A surface divided among points of it: each vertex belongs to the nearest one."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike
from scipy.sparse.csgraph import dijkstra

from ..mesh.triangle_mesh import TriangleMesh, check_mesh
from ..runtime.arrays import Ints
from .corner_tables import corner_tables
from .geodesics import checked_sources

NO_REGION = -1
"""The region of a vertex that no point has a path to."""


def nearest_regions(mesh: TriangleMesh, vertices: ArrayLike) -> Ints:
    """Tell for each vertex which of some points is nearest along the surface.

    Distances are those in the graph of edges, and of straight lines that cross an edge: some percent too long, and so
    are the borders between regions that far out of place; but all points together cost no more than one.

    Parameters
    ----------
    mesh : TriangleMesh
        The surface.
    vertices : (k,) array_like of int
        Where the points are; of points at the same vertex, the first one counts.

    Returns
    -------
    (n,) array of int
        Numbers of points, 0 to k - 1; `NO_REGION` at vertices without a path to any.

    Raises
    ------
    MeshError
        If there is no such vertex, or the surface is none.
    """
    check_mesh(mesh)
    places = checked_sources(vertices, mesh.vertex_count)
    regions = np.full(mesh.vertex_count, NO_REGION)
    if not len(places):
        return regions
    distinct, first = np.unique(places, return_index=True)
    graph = corner_tables(mesh).graph
    _, _, sources = dijkstra(graph, directed=False, indices=distinct, min_only=True, return_predecessors=True)
    number = np.full(mesh.vertex_count, NO_REGION)
    number[distinct] = first
    reached = sources >= 0
    regions[reached] = number[sources[reached]]
    return regions
