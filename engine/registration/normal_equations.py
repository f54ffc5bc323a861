# SPDX-License-Identifier: GPL-3.0-or-later
"""The linear equations of a surface that is drawn to points, solved again and again with other points."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from scipy.sparse import coo_array, csc_array, csr_array

from ..geometry.symmetric_factor import symmetric_factor
from ..mesh.closest_points import FoundPoints
from ..runtime.arrays import Floats, Ints, group_sums

Solve = Callable[[Floats], Floats]


class NormalEquations:
    r"""Least squares for the vertices x of a surface that are drawn to places, and so are points of its triangles.

    With the stiffness K of the surface, a weight a for each vertex, and for each point a weight b and the row e of its
    barycentric coordinates, the matrix is

    .. math:: K + \mathrm{diag}(a) + \sum_k b_k e_k^T e_k .

    Each point joins the corners of one triangle: where entries can be, and the order of elimination that fills in
    least, do not depend on the points, and are found once.

    Parameters
    ----------
    stiffness : (n, n) csr_array of float
        Says where K has entries.
    triangles : (m, 3) array of int
        Corners of the triangles.
    """

    def __init__(self, stiffness: csr_array, triangles: Ints) -> None:
        n = stiffness.shape[0]
        known, vertices = coo_array(stiffness), np.arange(n)
        corners = np.stack([triangles.repeat(3, axis=1).ravel(), np.tile(triangles, 3).ravel()])
        both = np.concatenate([[known.row, known.col], [vertices, vertices], corners], axis=1)
        pattern = csc_array((np.where(both[0] == both[1], len(both[0]), 1.0), both), shape=(n, n))
        # Everything is kept in the order in which it is eliminated.
        self._place = symmetric_factor(pattern).perm_c.astype(np.int64)
        self._order = np.argsort(self._place)
        entries, slots = np.unique(self._place[both[1]] * n + self._place[both[0]], return_inverse=True)
        columns, self._rows = np.divmod(entries, n)
        self._starts = np.searchsorted(columns, np.arange(n + 1))
        self._of_stiffness, self._diagonal, of_triangles = np.split(slots, np.cumsum([len(known.row), n]))
        self._corners = of_triangles.reshape(-1, 9)
        self._triangles = triangles

    def solver(self, own: Floats, points: FoundPoints, weights: Floats, stiffness: csr_array) -> Solve:
        """Factor the matrix for some points.

        Parameters
        ----------
        own : (n,) array of float
            Weight of each vertex, a.
        points : FoundPoints
            Points (k,) of the triangles.
        weights : (k,) array of float
            Their weights b.
        stiffness : (n, n) csr_array of float
            K, symmetric and positive semi-definite.

        Returns
        -------
        callable
            Takes a right-hand side (n, d) and returns the solution (n, d).
        """
        here = points.barycentric
        squares = (weights[:, None, None] * here[:, :, None] * here[:, None, :]).ravel()
        values = np.bincount(self._of_stiffness, coo_array(stiffness).data, len(self._rows)).astype(float, copy=False)
        values += np.bincount(self._corners[points.triangles].ravel(), squares, len(self._rows))
        values[self._diagonal] += own
        n = len(self._place)
        factor = symmetric_factor(csc_array((values, self._rows, self._starts), shape=(n, n)), ordered=True)

        def solve(right: Floats) -> Floats:
            """Solve for a right-hand side in the order of the vertices."""
            return factor.solve(right[self._order])[self._place]

        return solve

    def pull(self, points: FoundPoints, forces: Floats) -> Floats:
        """Sum forces (k, 3) at points (k,) of the triangles, over the vertices that they act on: (n, 3)."""
        corners = self._triangles[points.triangles].ravel()
        shares = points.barycentric[:, :, None] * forces[:, None, :]  # (k, 3, 3)
        return group_sums(corners, shares.reshape(-1, 3), len(self._place))
