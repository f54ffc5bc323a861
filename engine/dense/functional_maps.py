# SPDX-License-Identifier: GPL-3.0-or-later
"""Functional maps in both directions between two surfaces, and their refinement by bijective ZoomOut."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import qr, solve_triangular

from ..runtime.arrays import Floats, Ints, slices
from ..runtime.progress import Progress, Steps, run

_INDEPENDENT = 0.3
"""Part of a function at the samples that those before it must leave unexplained; less is aliasing."""

_BLOCK = 1 << 22
"""Entries of a product that are held at a time: 16 MB of float32."""

_CHUNK = 32
"""Rows among which the largest entry of a column is sought together."""


class PointMaps(NamedTuple):
    """Point to point maps in both directions between points of X and points of Y.

    Attributes
    ----------
    on_y : (p,) array of int
        For each point of X, the number of its image among the points of Y.
    on_x : (q,) array of int
        For each point of Y, the number of its image among the points of X.
    """

    on_y: Ints
    on_x: Ints


class FunctionalMaps(NamedTuple):
    """Linear maps between functions on X and functions on Y, in the first k basis functions of each.

    Attributes
    ----------
    onto_x : (k, k) array of float
        Takes the coefficients of a function on Y to those of its pullback, a function on X.
    onto_y : (k, k) array of float
        Takes the coefficients of a function on X to those of its pullback, a function on Y.
    """

    onto_x: Floats
    onto_y: Floats


class SampledBasis:
    """Basis functions at samples of a surface, ready for least squares fits with any leading number of them.

    Parameters
    ----------
    functions : (p, k) array of float
        The value of each function at each sample, for instance of eigenfunctions of the Laplace-Beltrami operator.

    Attributes
    ----------
    functions : (p, k) array of float
        The same.
    size : int
        How many leading functions the samples can tell apart; no fit should use more.
    """

    def __init__(self, functions: Floats) -> None:
        self.functions = functions
        # The factors of the first columns are the first columns of the factors: one decomposition serves every size.
        triangular = qr(functions, mode="r", check_finite=False)[0]
        unexplained = np.abs(triangular.diagonal())
        lengths = np.linalg.norm(functions[:, : len(unexplained)], axis=0)
        dependent = np.flatnonzero(unexplained <= _INDEPENDENT * lengths)
        self.size = int(dependent[0]) if len(dependent) else len(unexplained)
        triangular = triangular[: self.size, : self.size]
        self._inverse = solve_triangular(triangular, np.eye(self.size), check_finite=False)
        self._orthogonal = functions[:, : self.size] @ self._inverse

    def coefficients(self, values: Floats, size: int) -> Floats:
        """Fit functions given at the samples, (p, d), by the first basis functions: coefficients (size, d)."""
        return self._inverse[:size, :size] @ (self._orthogonal[:, :size].T @ values)


def spectral_sizes(first: int, last: int, count: int) -> list[int]:
    """List numbers of eigenfunctions from first to last, growing by about the same factor; at most `count` of them."""
    first = min(first, last)
    return sorted({round(size) for size in np.geomspace(first, last, count)})


def fit_functional_maps(x: SampledBasis, y: SampledBasis, maps: PointMaps, size: int) -> FunctionalMaps:
    r"""Fit functional maps to point maps between samples.

    .. math:: C_X = \arg\min_C \|\Phi_X C - \Phi_Y \circ T_{XY}\|^2, \quad
        C_Y = \arg\min_C \|\Phi_Y C - \Phi_X \circ T_{YX}\|^2

    over the samples of either surface [1]_.

    Parameters
    ----------
    x, y : SampledBasis
        Eigenfunctions at the samples.
    maps : PointMaps
        Between the samples.
    size : int
        Number of eigenfunctions k; fewer if the samples of a surface cannot tell so many apart.

    Returns
    -------
    FunctionalMaps
        Of size k.

    References
    ----------
    .. [1] M. Ovsjanikov, M. Ben-Chen, J. Solomon, A. Butscher, L. Guibas, "Functional maps: a flexible representation
       of maps between shapes", SIGGRAPH 2012.
    """
    size = min(size, x.size, y.size)
    return FunctionalMaps(
        x.coefficients(y.functions[maps.on_y, :size], size), y.coefficients(x.functions[maps.on_x, :size], size)
    )


def points_from_functions(maps: FunctionalMaps, functions_x: Floats, functions_y: Floats) -> PointMaps:
    r"""Find point maps in both directions that agree best with functional maps in both directions.

    The image of a point a of X is the point b of Y with the least

    .. math:: \|\Phi_X(a) C_X - \Phi_Y(b)\|^2 + \|\Phi_X(a) - \Phi_Y(b) C_Y\|^2

    and the image of b is the a with the least: an energy that knows both directions keeps the maps close to inverse
    to each other [1]_.

    Parameters
    ----------
    maps : FunctionalMaps
        Of size k.
    functions_x : (m, >= k) array of float
        Eigenfunctions at points of X.
    functions_y : (n, >= k) array of float
        Eigenfunctions at points of Y.

    Returns
    -------
    PointMaps
        Between these points.

    References
    ----------
    .. [1] J. Ren, A. Poulenard, P. Wonka, M. Ovsjanikov, "Continuous and orientation-preserving correspondences via
       functional maps", SIGGRAPH Asia 2018.
    """
    return run(points_from_functions_steps(maps, functions_x, functions_y))


def points_from_functions_steps(maps: FunctionalMaps, functions_x: Floats, functions_y: Floats) -> Steps[PointMaps]:
    """Find point maps that agree best with functional maps, in short steps; see `points_from_functions`."""
    size = len(maps.onto_x)
    here, there = functions_x[:, :size], functions_y[:, :size]
    squares_x = _squared_lengths(here) + _squared_lengths(here @ maps.onto_x)
    squares_y = _squared_lengths(there) + _squared_lengths(there @ maps.onto_y)
    # Both products of the energy have the same right factor: one of half the width is enough.
    return (yield from _nearest_steps(2.0 * (here @ (maps.onto_x + maps.onto_y.T)), there, squares_x, squares_y))


def nearest_both_ways(rows_x: Floats, rows_y: Floats) -> PointMaps:
    """Find for each row of either array the nearest row of the other, in the Euclidean sense.

    Parameters
    ----------
    rows_x : (m, d) array of float
        Descriptors of points of X.
    rows_y : (n, d) array of float
        Descriptors of points of Y.

    Returns
    -------
    PointMaps
        Between these points.
    """
    return run(_nearest_steps(2.0 * rows_x, rows_y, _squared_lengths(rows_x), _squared_lengths(rows_y)))


def refine_bijective_steps(x: SampledBasis, y: SampledBasis, maps: PointMaps, sizes: list[int]) -> Steps[PointMaps]:
    """Refine point maps between samples by bijective ZoomOut [1]_ [2]_.

    With more and more eigenfunctions, functional maps are fitted to the point maps, and point maps found from them.

    Parameters
    ----------
    x, y : SampledBasis
        Eigenfunctions at the samples.
    maps : PointMaps
        Between the samples; right up to the wavelength of the first size.
    sizes : list of int
        Numbers of eigenfunctions, growing; those above what the samples can tell apart are left out.

    Yields
    ------
    Progress
        After each size.

    Returns
    -------
    PointMaps
        Between the samples.

    References
    ----------
    .. [1] S. Melzi, J. Ren, E. Rodola, A. Sharma, P. Wonka, M. Ovsjanikov, "ZoomOut: spectral upsampling for efficient
       shape correspondence", SIGGRAPH Asia 2019.
    .. [2] J. Ren, S. Melzi, M. Ovsjanikov, P. Wonka, "MapTree: recovering multiple solutions in the space of maps",
       SIGGRAPH Asia 2020.
    """
    limit = min(x.size, y.size)
    possible = sorted({min(size, limit) for size in sizes})
    for number, size in enumerate(possible):
        functional = fit_functional_maps(x, y, maps, size)
        maps = points_from_functions(functional, x.functions, y.functions)
        yield Progress((number + 1) / len(possible), "Refining maps")
    return maps


def _squared_lengths(rows: Floats) -> Floats:
    return np.einsum("pd,pd->p", rows, rows)


def _nearest_steps(left: Floats, right: Floats, squares_x: Floats, squares_y: Floats) -> Steps[PointMaps]:
    """Find the largest entry of each row and column of left right^T - squares_x - squares_y^T.

    The squares ride along as two more columns of the factors.  float32 is twice as fast and, with values of order one,
    still tells distances of a thousandth of a wavelength.
    """
    m, n = len(left), len(right)
    left = np.column_stack([left, -squares_x, np.ones(m)]).astype(np.float32)
    right = np.column_stack([right, np.ones(n), -squares_y]).astype(np.float32)
    on_y, on_x = np.empty(m, np.int64), np.zeros(n, np.int64)
    best = np.full(n, -np.inf, np.float32)
    for part in slices(m, max(_BLOCK // n, 1)):
        likeness = left[part] @ right.T
        on_y[part] = likeness.argmax(axis=1)
        rows, values = _largest_of_columns(likeness)
        better = values > best
        on_x[better], best[better] = part.start + rows[better], values[better]
        yield Progress(part.stop / m, "Comparing maps")
    return PointMaps(on_y, on_x)


def _largest_of_columns(product: NDArray[np.float32]) -> tuple[Ints, NDArray[np.float32]]:
    """Row and value of the largest entry of each column, first in chunks of rows: many times faster than argmax."""
    m, n = product.shape
    whole = m // _CHUNK * _CHUNK
    maxima = product[:whole].reshape(-1, _CHUNK, n).max(axis=1)
    if whole < m:
        maxima = np.concatenate([maxima, product[whole:].max(axis=0, keepdims=True)])
    rows = np.minimum(maxima.argmax(axis=0)[:, None] * _CHUNK + np.arange(_CHUNK), m - 1)  # (n, chunk)
    columns = np.arange(n)
    entries = product.ravel().take(rows * n + columns[:, None])
    within = entries.argmax(axis=1)
    return rows[columns, within], entries[columns, within]
