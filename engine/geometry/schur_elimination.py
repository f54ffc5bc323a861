# SPDX-License-Identifier: GPL-3.0-or-later
"""Factors of shifted symmetric matrices of surfaces: solve, and count eigenvalues below the shift."""

from __future__ import annotations

import numpy as np
from scipy.sparse import csc_array, csr_array, eye_array
from scipy.sparse.csgraph import dijkstra

from ..runtime.arrays import Bools, Floats, Ints
from .symmetric_factor import symmetric_factor

_LARGE = 45_000
"""Rows from which on nested dissection is used: minimum degree is better below, and on some meshes very slow above."""

_LEAF = 60
"""Rows of a part that is not cut any more."""

_LANDMARKS = 5
"""Vertices from which steps are counted to tell where in the surface a vertex is."""

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
        Order of elimination, as `order` of another shift or from `nested_dissection`; by default the rows are ordered
        by minimum degree.

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


def elimination_order(matrix: csr_array) -> Ints | None:
    """Choose the order for `ShiftedFactor` by the size of the matrix; the same serves for every shift."""
    return nested_dissection(matrix) if matrix.shape[0] > _LARGE else None


def nested_dissection(matrix: csr_array) -> Ints:
    """Order the rows of a matrix of a surface so that its factors stay sparse.

    The graph of the matrix is cut into halves again and again, at right angles to where each part is longest; the
    vertices at a cut are eliminated after both halves.  Where a vertex is, is told by the numbers of edges to some
    landmarks.

    Parameters
    ----------
    matrix : (n, n) csr_array
        Symmetric; its graph hangs together.

    Returns
    -------
    (n,) array of int
        The rows, in the order of elimination.

    References
    ----------
    .. [1] A. George, "Nested dissection of a regular finite element mesh", SIAM J. Numer. Anal. 10, 1973.
    """
    n = matrix.shape[0]
    places = _hop_distances(matrix)
    depth = max(0, int(np.ceil(np.log2(n / _LEAF))))
    part = np.zeros(n, np.int64)
    # When a vertex is eliminated: in-order number of its part in the tree of cuts, or of the cut it is on.
    level, position = np.full(n, depth), np.zeros(n, np.int64)
    inside = np.ones(n, bool)
    tails, heads = matrix.tocoo().coords
    for current in range(depth):
        rows = np.flatnonzero(inside)
        upper = np.zeros(n, bool)
        upper[rows] = _upper_halves(places[rows], part[rows], 1 << current)
        crossing = upper[tails] & ~upper[heads] & (part[tails] == part[heads])
        cut = np.unique(tails[crossing])
        inside[cut] = False
        level[cut], position[cut] = current, (part[cut] + 1) << (depth - current)
        part = np.where(inside, 2 * part + upper, part)
        kept = inside[tails] & inside[heads]
        tails, heads = tails[kept], heads[kept]
    position[inside] = part[inside] + 1
    # A cut has the in-order position of the end of its part: there, larger parts come later.
    return np.lexsort((part, -level, position))


def _hop_distances(matrix: csr_array) -> Floats:
    """Count the edges from each vertex to landmarks far from one another, (n, landmarks)."""
    graph = abs(matrix)
    nearest = dijkstra(graph, indices=0, unweighted=True)
    columns: list[Floats] = []
    for _ in range(_LANDMARKS):
        columns.append(dijkstra(graph, indices=int(nearest.argmax()), unweighted=True))
        nearest = np.minimum(nearest, columns[-1]) if len(columns) > 1 else columns[0]
    return np.stack(columns, axis=1)


def _upper_halves(places: Floats, part: Ints, count: int) -> Bools:
    """Halve parts, each at the median along its longest direction: true in the upper halves."""
    sizes = np.bincount(part, minlength=count)
    centred = np.stack(
        [column - (np.bincount(part, column, count) / np.maximum(sizes, 1))[part] for column in places.T]
    )
    d = len(centred)
    spread = np.empty((count, d, d))
    for i in range(d):
        for j in range(i + 1):
            spread[:, i, j] = spread[:, j, i] = np.bincount(part, centred[i] * centred[j], count)
    longest = np.linalg.eigh(spread)[1][:, :, -1]
    along = np.einsum("dk,kd->k", centred, longest[part])
    order = np.lexsort((along, part))
    rank = np.empty(len(part), np.int64)
    rank[order] = np.arange(len(part)) - (np.cumsum(sizes) - sizes)[part[order]]
    return rank >= sizes[part] / 2
