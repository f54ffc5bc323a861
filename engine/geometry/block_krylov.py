# SPDX-License-Identifier: GPL-3.0-or-later
"""Lowest eigenpairs of one symmetric positive semi-definite sparse matrix, with proof that none is missing."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from scipy.linalg import block_diag, qr
from scipy.sparse import csr_array

from ..runtime.arrays import Floats, Ints
from ..runtime.progress import Progress, Steps, within
from .shifted_factor import ShiftedFactor

_DENSE = 300
"""Rows up to which the matrix is simply solved as a dense one."""

_LEAST = 8
"""Least number of pairs that are computed: with fewer, no shift lies well among them."""

_TOLERANCE = 3e-4
"""Relative residual of the inverted problem at the last wanted pair: eigenvalues are then right to about its square.

Less for smaller eigenvalues, so that they are relatively as exact."""

_ROUGH = 1e-2
"""The same for eigenvalues that only show where a group of close ones ends."""

_BELOW = 0.25, 0.8
"""Part of the wanted eigenvalues that should lie below the shift."""

_SHIFTS = 8
"""How many shifts are tried."""

_LONGEST = 10
"""Limit of the columns of a Krylov space, in wanted pairs."""

_ROWS = 1 << 14
"""Rows of the eigenvectors that are computed together."""

_DEPENDENT = 1e-5
"""Ratio of the pivots of a new block up to which rounding makes up what is left of it."""

_LABEL = "Computing eigenfunctions"


class EigenPairs(NamedTuple):
    """Eigenpairs of a symmetric matrix.

    Attributes
    ----------
    values : (k,) array of float
        Eigenvalues, ascending.
    vectors : (n, k) array of float
        Orthonormal eigenvectors.
    complete : bool
        Whether counting has proved that no smaller eigenvalue is missing.
    """

    values: Floats
    vectors: Floats
    complete: bool


class _Ritz(NamedTuple):
    """Approximate eigenpairs from a Krylov space.

    Attributes
    ----------
    values : (c,) array of float
        Approximate eigenvalues, ascending, more than wanted; the last is beyond the end.
    basis : (n, e) array of float
        Orthonormal basis of the space.
    coefficients : (e, c) array of float
        Eigenvectors in this basis.
    end : float
        In the middle of the gap after the c - 1 eigenvalues before the last.
    converged : bool
        Whether they are as exact as they should be.
    """

    values: Floats
    basis: Floats
    coefficients: Floats
    end: float
    converged: bool


def lowest_eigenpairs_steps(matrix: csr_array, null: Floats, count: int, guess: float) -> Steps[EigenPairs]:
    r"""Compute the lowest eigenpairs of a matrix, in steps.

    Parameters
    ----------
    matrix : (n, n) csr_array of float
        Symmetric and positive semi-definite; its graph hangs together.
    null : (n,) array of float
        The eigenvector of the eigenvalue zero, of length one.
    count : int
        How many pairs, k; at most n.
    guess : float
        Roughly the k-th eigenvalue, to start from.

    Yields
    ------
    Progress
        About every 0.1 s.

    Returns
    -------
    EigenPairs
        The pairs.

    Notes
    -----
    A block Krylov space of :math:`(A - \sigma I)^{-1}` [1]_ with the shift in the middle of the wanted eigenvalues:
    both ends are then equally far, and the space needs little more than twice as many columns as there are pairs.
    Each block is made orthogonal to the two before it, then once to all.  Counting the negative pivots of the factors
    (Sylvester's law of inertia) tells how many eigenvalues lie below the shift, and in the end how many lie below the
    gap after the last pair.  If one is missing, the search is done again with wider blocks, which see more copies of
    a multiple eigenvalue, and at last with a shift below the spectrum.

    References
    ----------
    .. [1] R. Grimes, J. Lewis, H. Simon, "A shifted block Lanczos algorithm for solving sparse symmetric generalized
       eigenproblems", SIAM J. Matrix Anal. Appl. 15, 1994.
    """
    n = matrix.shape[0]
    wanted = max(count, _LEAST)
    if n <= max(_DENSE, 4 * wanted):
        # All of them, by divide and conquer: LAPACK's search for some fails at regular grids, and takes longer.  The
        # known eigenvector is moved to the upper end, or others of next to no eigenvalue would be mixed with it.
        largest = abs(matrix).sum(axis=1).max()
        values, vectors = np.linalg.eigh(matrix.toarray() + 2 * largest * np.outer(null, null))
        vectors = np.column_stack([null, vectors[:, : count - 1]])
        return EigenPairs(np.append(0, values[: count - 1].clip(0)), vectors, complete=True)
    order: Ints | None = None
    yield Progress(0.02, _LABEL)
    block = 8 if wanted < 150 else 16
    guess *= wanted / count
    for attempt, (start, end) in enumerate(((0.03, 0.9), (0.9, 0.93), (0.93, 0.96))):
        factor = None
        if attempt < 2:
            factor = yield from within(_interior_shift_steps(matrix, guess, wanted, order), start, start)
        if factor is None:
            factor = ShiftedFactor(matrix, -0.02 * guess, order)
        ritz = yield from within(_krylov_steps(factor, null, wanted, block, seed=attempt), start, end)
        order = factor.order
        del factor  # a hundred thousand rows take as much memory as all else
        there, expected = _count_below(matrix, ritz.end, order), len(ritz.values) - 1
        yield Progress(end, _LABEL)
        complete = ritz.converged and there == expected
        if complete:
            break
        # What is missing are copies of multiple eigenvalues: a block as wide as there are copies sees them all.
        block = min(block + max(block, (there or 0) - expected), n // 8)
    vectors = np.empty((n, count))
    for first in range(0, n, _ROWS):
        vectors[first : first + _ROWS] = ritz.basis[first : first + _ROWS] @ ritz.coefficients[:, :count]
        yield Progress(0.96 + 0.04 * first / n, _LABEL)
    return EigenPairs(ritz.values[:count], vectors, complete)


def _count_below(matrix: csr_array, shift: float, order: Ints | None) -> int | None:
    """Count the eigenvalues below a number; None if it cannot be told."""
    try:
        return ShiftedFactor(matrix, shift, order).negative_count
    except RuntimeError:  # an eigenvalue is there, to the last digit
        return None


def _interior_shift_steps(
    matrix: csr_array, guess: float, wanted: int, order: Ints | None
) -> Steps[ShiftedFactor | None]:
    """Find a shift with about half of the wanted eigenvalues below it; None if none of some is good.

    The guess is far off for long, thin or very open surfaces, but the count of what is below a shift leads from there.
    """
    shift = guess / 2
    for _ in range(_SHIFTS):
        yield Progress(0, _LABEL)
        try:
            factor = ShiftedFactor(matrix, shift, order)
        except RuntimeError:
            shift *= 1.01
            continue
        if factor.negative_count is None or not factor.is_accurate():
            shift *= 1.01  # close to an eigenvalue
            continue
        if _BELOW[0] * wanted <= factor.negative_count <= _BELOW[1] * wanted:
            return factor
        shift *= min(max(wanted / 2 / max(factor.negative_count, 0.5), 0.02), 50)
    return None


def _krylov_steps(factor: ShiftedFactor, null: Floats, wanted: int, block: int, seed: int) -> Steps[_Ritz]:
    """Extend a Krylov space until the wanted pairs have converged, or its limit is reached."""
    n = factor.size
    columns = min(n, int(2.6 * wanted) + 5 * block)
    longest = min(n, _LONGEST * (wanted + block))
    basis, projected = np.empty((n, columns), order="F"), np.zeros((columns, columns))
    # The known eigenvector is the first of the basis: all others are then orthogonal to it.
    basis[:, 0] = null
    random = np.random.default_rng(seed).standard_normal((n, block))
    basis[:, 1 : 1 + block] = _orthogonalised(random, basis[:, :1], 0)[1]
    start, check = 1, 2 * wanted
    while True:
        end = start + block
        if end + block > columns:
            columns = min(n, columns + columns // 3 + block)
            basis = _grown(basis, (n, columns), end)
            projected = _grown(projected, (columns, columns), start)
        image = factor.solve(basis[:, start:end])
        row, new, rest = _orthogonalised(image, basis[:, :end], max(0, start - block))
        basis[:, end : end + block] = new
        projected[:end, start:end], projected[start:end, :end] = row, row.T
        last = end + 2 * block > longest
        if end >= check or last:
            ritz = _rayleigh_ritz(factor, wanted, basis[:, : end + block], projected[:end, :end], rest)
            if ritz.converged or last:
                return ritz
            check = end + max(block, wanted // 12)
        start = end
        yield Progress(min(end / (2.5 * wanted + 4 * block), 1), _LABEL)


def _grown(array: Floats, shape: tuple[int, int], used: int) -> Floats:
    """Copy the used columns to a larger array, zero where the new rows and columns are."""
    larger = np.zeros(shape, order="F")
    larger[: len(array), :used] = array[:, :used]
    return larger


def _orthogonalised(image: Floats, basis: Floats, near: int) -> tuple[Floats, Floats, Floats]:
    """Split a block into what is in the span of a basis and the rest: image = basis row + new rest.

    Parameters
    ----------
    image : (n, b) array of float
        The block; overwritten.
    basis : (n, e) array of float
        Orthonormal.
    near : int
        Columns from here on contain all of what is in the span but for rounding.

    Returns
    -------
    row : (e, b) array of float
        Coefficients in the basis.
    new : (n, b) array of float
        Orthonormal, and orthogonal to the basis.
    rest : (b, b) array of float
        Coefficients in `new`.
    """
    local = basis[:, near:].T @ image
    image -= basis[:, near:] @ local
    row = basis.T @ image
    image -= basis @ row
    row[near:] += local
    new, rest = qr(image, mode="economic", check_finite=False)
    pivots = np.abs(rest.diagonal())
    if pivots.min() <= _DEPENDENT * pivots.max():
        # The space hardly grows any more: go on with directions that are new, whatever they are.
        for _ in range(2):
            new -= basis @ (basis.T @ new)
            new, factor = qr(new, mode="economic", check_finite=False)
            rest = factor @ rest
    return row, new, rest


def _rayleigh_ritz(factor: ShiftedFactor, wanted: int, basis: Floats, projected: Floats, rest: Floats) -> _Ritz:
    """Find the best approximate eigenpairs in a Krylov space, and judge them.

    The last columns of the basis are the block that comes next, to which the inverted matrix leads out of the space.
    """
    shift, block = factor.shift, len(rest)
    # The known eigenvector stays apart, or rounding would mix it with others of next to no eigenvalue.
    inverted, coefficients = np.linalg.eigh(projected[1:, 1:])
    inverted, coefficients = np.append(-1 / shift, inverted), block_diag(1, coefficients)
    with np.errstate(divide="ignore"):
        values = shift + 1 / inverted
    values[0] = 0
    # What has not converged may lie anywhere outside of the spectrum; the spectrum begins at zero.
    possible = np.flatnonzero((values > -0.01 * abs(shift)) & np.isfinite(values))
    chosen = possible[np.argsort(values[possible].clip(0), kind="stable")]
    values = values[chosen].clip(0)
    outside = rest @ coefficients[-block:, chosen] / inverted[chosen]
    residuals = np.linalg.norm(outside, axis=0)

    # Close eigenvalues belong together: the count is checked in a gap.
    gaps = np.diff(values[wanted - 1 :]) if len(values) > wanted else np.empty(0)
    wide = np.flatnonzero(gaps > 0.1 * values[wanted - 1] / wanted) if len(gaps) else gaps
    last = wanted + int(wide[0]) if len(wide) else len(values) - 1
    converged = bool(
        len(wide)
        and (residuals[:wanted] < _TOLERANCE * np.sqrt(values[:wanted] / values[wanted - 1]).clip(1e-5))[1:].all()
        and residuals[: last + 1].max() < _ROUGH
        and (factor.negative_count is None or (values < shift).sum() == factor.negative_count)
    )
    # The inverted matrix once more, which costs nothing: with what it adds from the next block, vectors are rid of the
    # roughness of the random start, which stiff parts of a bad mesh would blow up.
    outside = outside[:, : last + 1]
    vectors = np.concatenate([coefficients[:, chosen[: last + 1]], outside])
    correction = np.linalg.cholesky(np.eye(last + 1) + outside.T @ outside)
    end = float(values[last - 1 : last + 1].mean())
    return _Ritz(values[: last + 1], basis, vectors @ np.linalg.inv(correction).T, end, converged)
