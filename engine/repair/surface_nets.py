# SPDX-License-Identifier: GPL-3.0-or-later
"""Surfaces of equal value of a function on a grid."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ..runtime.arrays import Floats, Ints, group_means

_RING = (0, 0), (-1, 0), (-1, -1), (0, -1)
"""Cells around an edge of the grid, by their offsets along the two other axes."""


def surface_net(values: NDArray[np.float32], level: float = 0.0) -> tuple[Floats, Ints]:
    """Mesh the surface on which a function has a value [1]_.

    Parameters
    ----------
    values : (a, b, c) array of float32
        The function on a grid.  Inside is where it is larger; all beyond the grid is outside.
    level : float
        The value.

    Returns
    -------
    vertices : (n, 3) array of float
        One in each cell that the surface crosses, the mean of where it crosses the edges: in units of the grid, from
        its first place.
    triangles : (m, 3) array of int
        Two for each edge that the surface crosses, which look outward.  Where two sheets cross one cell they share its
        vertex.

    References
    ----------
    .. [1] S. Gibson, "Constrained elastic surface nets: generating smooth surfaces from binary segmented data",
       MICCAI 1998.
    """
    values = np.pad(values, 1, constant_values=level - 1)
    inside = values > level
    cells = tuple(np.array(values.shape) - 1)
    rings, points = [], []
    for axis in range(3):
        lower, upper = (_part(axis, part) for part in (slice(None, -1), slice(1, None)))
        change = inside[lower] != inside[upper]
        where = np.argwhere(change)
        below, above = values[lower][change].astype(np.float64), values[upper][change].astype(np.float64)
        crossing = where.astype(np.float64)
        crossing[:, axis] += (below - level) / (below - above)
        others = [other for other in range(3) if other != axis]
        ring = np.empty((len(where), 4), np.int64)
        for number, offset in enumerate(_RING):
            cell = where.copy()
            cell[:, others] += offset
            ring[:, number] = np.ravel_multi_index(tuple(cell.T), cells)
        backward = inside[lower][change] == (axis == 1)
        ring[backward] = ring[backward, ::-1]
        rings.append(ring)
        points.append(crossing)
    quads, crossings = np.concatenate(rings), np.repeat(np.concatenate(points), 4, axis=0)
    used, inverse = np.unique(quads, return_inverse=True)
    owners: Ints = inverse.reshape(-1).astype(np.int64)
    vertices = group_means(owners, crossings, len(used)) - 1
    a, b, c, d = owners.reshape(-1, 4).T
    shorter = np.linalg.norm(vertices[a] - vertices[c], axis=1) < np.linalg.norm(vertices[b] - vertices[d], axis=1)
    first = np.where(shorter[:, None], np.stack([a, b, c], axis=1), np.stack([a, b, d], axis=1))
    second = np.where(shorter[:, None], np.stack([a, c, d], axis=1), np.stack([b, c, d], axis=1))
    return vertices, np.concatenate([first, second])


def _part(axis: int, part: slice) -> tuple[slice, ...]:
    """Index a part of a grid along one axis."""
    return tuple(part if other == axis else slice(None) for other in range(3))
