# SPDX-License-Identifier: GPL-3.0-or-later
"""Points spread evenly over the triangles of a mesh."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..runtime.arrays import Bools, Floats, Ints
from .triangle_mesh import TriangleMesh

_FIRST, _SECOND = 0.7548776662466927, 0.5698402909980532
"""Steps of a sequence that fills a square evenly from its first point on: the inverse of the real root of x^3 = x + 1,
and its square [1]_."""


@dataclass(frozen=True, eq=False)
class AreaSamples:
    """Points of a mesh.

    Attributes
    ----------
    positions : (s, 3) array of float
        Where they are.
    triangles : (s,) array of int
        The triangle that each lies in, in ascending order.
    areas : (s,) array of float
        The area that each stands for.
    """

    positions: Floats
    triangles: Ints
    areas: Floats

    def of_triangles(self, chosen: Bools) -> AreaSamples:
        """Return those of some of the triangles, (m,)."""
        kept = chosen[self.triangles]
        return AreaSamples(self.positions[kept], self.triangles[kept], self.areas[kept])


def area_samples(mesh: TriangleMesh, area: float) -> AreaSamples:
    """Spread points over a mesh [1]_.

    Parameters
    ----------
    mesh : TriangleMesh
        Any mesh.
    area : float
        The area that a point stands for at most; a triangle has one at least.

    Returns
    -------
    AreaSamples
        The points, always the same.

    References
    ----------
    .. [1] M. Roberts, "The unreasonable effectiveness of quasirandom sequences", 2018.
    """
    counts = np.maximum(np.ceil(mesh.triangle_areas / area), 1).astype(np.int64)
    triangles = np.repeat(np.arange(len(counts)), counts)
    number = np.arange(len(triangles)) - (np.cumsum(counts) - counts)[triangles]
    return AreaSamples(_places(mesh, triangles, number), triangles, (mesh.triangle_areas / counts)[triangles])


def even_samples(mesh: TriangleMesh, area: float) -> AreaSamples:
    """Spread points over a mesh each of which stands for the same area, about the given one: one point at least.

    Unlike those of `area_samples` they are no more where triangles are small, and not in every triangle.
    """
    count = max(int(mesh.area / area), 1)
    number = np.arange(count)
    ends = np.cumsum(mesh.triangle_areas)
    triangles = np.searchsorted(ends, (number + 0.5) / count * ends[-1])
    return AreaSamples(_places(mesh, triangles, number), triangles, np.full(count, ends[-1] / count))


def _places(mesh: TriangleMesh, triangles: Ints, number: Ints) -> Floats:
    """Points of a sequence, by their numbers (s,), in triangles (s,): positions (s, 3)."""
    a, b, c = (mesh.vertices[corner] for corner in mesh.triangles[triangles].T)
    u, v = (1 / 3 + number * _FIRST) % 1, (1 / 3 + number * _SECOND) % 1
    beyond = u + v > 1
    u[beyond], v[beyond] = 1 - u[beyond], 1 - v[beyond]
    return a + u[:, None] * (b - a) + v[:, None] * (c - a)
