# SPDX-License-Identifier: GPL-3.0-or-later
"""A map corrected so that it takes some vertices exactly where they belong."""

from __future__ import annotations

import numpy as np

from ..geometry.geodesic_ball import distances_to_others, vicinity
from ..mesh.closest_points import ClosestPoints
from ..mesh.surface_points import SurfacePoints
from ..mesh.triangle_mesh import TriangleMesh
from ..runtime.arrays import TINY, Ints
from ..shapes.landmarks import placed_at_vertices

_REACH = 4.0
"""How far around a vertex the map is moved with it, in units of how far that is moved: enough that nothing folds."""

_LEAST_REACH = 0.02
"""The same at least, in sqrt(area)."""


def pinned(
    source: TriangleMesh,
    target: TriangleMesh,
    points: SurfacePoints,
    vertices: Ints,
    partners: Ints,
    *,
    search: ClosestPoints,
) -> SurfacePoints:
    r"""Move a map so that it takes vertices of the source exactly to vertices of the target.

    What each lacks is distributed over its surroundings by :math:`\varphi(t) = (1 - t)^4 (4 t + 1)`, t being the
    distance along the surface by the reach, a smooth function of compact support [1]_ that ends before the next such
    vertex.  The images moved so are brought back to the target by a search along its surface.

    Parameters
    ----------
    source, target : TriangleMesh
        The surfaces.
    points : SurfacePoints
        The point of the target for each vertex of the source, (n,).
    vertices, partners : (k,) array of int
        Vertices of the source, all different, and where they belong.
    search : ClosestPoints
        The search on the target.

    Returns
    -------
    SurfacePoints
        The points, for each vertex of the source, (n,).

    References
    ----------
    .. [1] H. Wendland, "Piecewise polynomial, positive definite and compactly supported radial functions of minimal
       degree", Advances in Computational Mathematics 4, 1995.
    """
    missing = target.vertices[partners] - points.positions[vertices]
    lengths = np.linalg.norm(missing, axis=1) * np.sqrt(source.area / target.area)
    reach = np.maximum(_REACH * lengths, _LEAST_REACH * np.sqrt(source.area))
    reach = np.minimum(reach, distances_to_others(source.vertices[vertices]))
    reach = np.maximum(reach, TINY)  # two landmarks may lie at one place, such as on closed lips
    steps = np.zeros((source.vertex_count, 3))
    for vertex, radius, step in zip(vertices, reach, missing, strict=True):
        near, distances = vicinity(source, int(vertex), float(radius))
        t = distances / radius
        steps[near] += ((1 - t) ** 4 * (4 * t + 1))[:, None] * step
    moving = np.flatnonzero(steps.any(axis=1))
    triangles, barycentric = points.triangles.copy(), points.barycentric.copy()
    if len(moving):
        found = search.walk(points.positions[moving] + steps[moving], points.nearest_vertices[moving])
        triangles[moving], barycentric[moving] = found.triangles, found.barycentric
    moved = SurfacePoints.from_barycentric(target, triangles, barycentric)
    return placed_at_vertices(moved, target, vertices, partners)
