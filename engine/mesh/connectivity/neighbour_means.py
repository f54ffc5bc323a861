# SPDX-License-Identifier: GPL-3.0-or-later
"""Averages over the vertices around each vertex of a mesh."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from ..triangle_mesh import TriangleMesh

__all__ = ["neighbour_means"]


def neighbour_means(mesh: TriangleMesh, values: NDArray[np.float64]) -> NDArray[np.float64]:
    """Mean of values per vertex (n,) over each vertex and its neighbours."""
    (first, second), n = mesh.edges.T, mesh.vertex_count
    sums = values + np.bincount(first, values[second], n) + np.bincount(second, values[first], n)
    return sums / (1 + np.bincount(first, minlength=n) + np.bincount(second, minlength=n))
