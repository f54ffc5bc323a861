# SPDX-License-Identifier: GPL-3.0-or-later
"""Matrix products that are too small for threads."""

from __future__ import annotations

import numpy as np

from .arrays import Floats

# OpenBLAS, which NumPy carries, leaves products of at most so many multiplications to the calling thread.
_SERIAL_MATRIX, _SERIAL_VECTOR = 250_000, 9_000

# From here on threads are worth their while.
_LARGE = 30_000_000


def product(first: Floats, second: Floats) -> Floats:
    """Multiply a matrix by a matrix or vector without waking the threads of the linear algebra library.

    Solvers make thousands of products of some hundred rows.  OpenBLAS shares even these out among threads, which then
    spin for some milliseconds while they wait for more.  On an idle machine this gains nothing; where other programs,
    such as a render, use the cores, it makes a solver ten times slower.

    Parameters
    ----------
    first : (n, k) array of float
    second : (k, m) or (k,) array of float

    Returns
    -------
    (n, m) or (n,) array of float
    """
    rows, inner = first.shape
    columns = second.shape[1] if second.ndim == 2 else 1
    serial = _SERIAL_MATRIX if second.ndim == 2 else _SERIAL_VECTOR
    work = rows * inner * columns
    if work <= serial or work > _LARGE:
        return first @ second
    result = np.empty((rows, *second.shape[1:]))
    if rows >= columns:
        step = max(1, serial // (inner * columns))
        for start in range(0, rows, step):
            np.matmul(first[start : start + step], second, out=result[start : start + step])
    else:
        step = max(1, serial // (inner * rows))
        for start in range(0, columns, step):
            result[:, start : start + step] = first @ second[:, start : start + step]
    return result
