# SPDX-License-Identifier: GPL-3.0-or-later
"""Factors of shifted symmetric matrices of surfaces: solve, and count eigenvalues below the shift."""

from __future__ import annotations

import numpy as np
from scipy.sparse import csc_array, csr_array, eye_array

from ..runtime.arrays import Floats, Ints
from .symmetric_factor import symmetric_factor

_ACCURATE = 1e-5
"""Relative error of a solution's image from which on a factorisation is not used."""


class ShiftedFactor:
    """A sparse symmetric matrix minus a multiple of the identity, factored once to be solved with many times.

    Parameters
    ----------
    matrix : (n, n) csr_array of float
        Symmetric; its graph hangs together.
    shift : float
        What is subtracted from the diagonal.
    order : (n,) array of int, optional
        Order of elimination, as `order` of another shift; by default the rows are ordered by minimum degree.

    Attributes
    ----------
    shift : float
        The shift.
    order : (n,) array of int
        Order of elimination; the same is good for every shift.
    negative_count : int or None
        Number of eigenvalues of the matrix below the shift, by Sylvester's law of inertia: as many as negative pivots.
        None if the factorisation had to leave the diagonal, so that its pivots tell nothing.

    Raises
    ------
    RuntimeError
        If the shift is an eigenvalue to the last digit.
    """

    def __init__(self, matrix: csr_array, shift: float, order: Ints | None = None) -> None:
        self.shift = shift
        shifted = csc_array(matrix - shift * eye_array(matrix.shape[0], format="csr"))
        if order is not None:
            shifted = csc_array(shifted[order][:, order])
        self._shifted = shifted
        # Its pivots stay on the diagonal, which keeps their signs meaningful.
        self._factor = symmetric_factor(shifted, ordered=order is not None)
        symmetric = bool((self._factor.perm_r == self._factor.perm_c).all())
        self.negative_count = int((self._factor.U.diagonal() < 0).sum()) if symmetric else None
        self._inner_order = order
        inner = np.argsort(self._factor.perm_c)
        self.order: Ints = inner if order is None else order[inner]

    @property
    def size(self) -> int:
        """Number of rows, n."""
        return self._shifted.shape[0]

    def is_accurate(self) -> bool:
        """Whether a trial solution is good: without pivoting it need not be, above all close to an eigenvalue."""
        right = np.random.default_rng(0).standard_normal(self.size)
        error = self._shifted @ self._factor.solve(right) - right
        return bool(np.linalg.norm(error) < _ACCURATE * np.linalg.norm(right))

    def solve(self, right: Floats) -> Floats:
        """Solve for the columns of an (n, b) array."""
        if self._inner_order is None:
            return self._factor.solve(np.asfortranarray(right))
        solution = np.empty(right.shape)
        solution[self._inner_order] = self._factor.solve(np.asfortranarray(right[self._inner_order]))
        return solution
