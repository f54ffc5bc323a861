# SPDX-License-Identifier: GPL-3.0-or-later
"""Which vertices of a mesh are joined by an edge, as a matrix."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from scipy.sparse import coo_array, csr_array

if TYPE_CHECKING:
    from ..triangle_mesh import TriangleMesh

__all__ = ["vertex_adjacency"]


def vertex_adjacency(mesh: TriangleMesh) -> csr_array:
    """Return the matrix (n, n) of a mesh with n vertices that is one where an edge joins them, and else zero."""
    n, (a, b) = mesh.vertex_count, mesh.edges.T
    ends = (np.concatenate([a, b]), np.concatenate([b, a]))
    return csr_array(coo_array((np.ones(2 * len(a)), ends), shape=(n, n)))
