# SPDX-License-Identifier: GPL-3.0-or-later
"""Stretch of the surface around each vertex by a dense map."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from ....engine import SurfaceMap, TriangleMesh

DOUBLED = float(np.log(2))
"""The value where all lengths are doubled or halved."""

_MOST = 16.0
"""An edge that is stretched or shrunk more often counts as this: one that falls into a point would be infinite."""


def vertex_stretch(surface_map: SurfaceMap, domain: TriangleMesh, image: TriangleMesh) -> NDArray[np.float64]:
    r"""Measure how much a map changes the lengths of the edges around each vertex.

    The root of the mean of :math:`\log^2 s_e` over the edges e around a vertex, where :math:`s_e` is the stretch of the
    edge in units of the square root of both areas: zero where the map keeps lengths, and the same for twice as for half
    as long.

    Parameters
    ----------
    surface_map : SurfaceMap
        A map of the vertices of `domain` to points of `image`.
    domain, image : TriangleMesh
        The two meshes.

    Returns
    -------
    (n,) array of float
        For each vertex of the domain; nan without an edge that has a length.
    """
    logarithms = np.log(np.clip(surface_map.edge_stretch(domain, image), 1 / _MOST, _MOST))
    known = np.isfinite(logarithms)
    squares = np.repeat(np.square(logarithms[known]), 2)  # once for either end of each edge
    ends = domain.edges[known].ravel()
    counts = np.bincount(ends, minlength=domain.vertex_count)
    sums = np.bincount(ends, squares, domain.vertex_count)
    means = np.divide(sums, counts, out=np.full(domain.vertex_count, np.nan), where=counts > 0)
    return np.sqrt(means)
