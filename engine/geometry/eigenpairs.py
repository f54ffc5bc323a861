# SPDX-License-Identifier: GPL-3.0-or-later
"""Eigenvalues and eigenfunctions of the Laplace-Beltrami operator."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from ..mesh.triangle_mesh import TriangleMesh
from ..runtime.arrays import Floats
from ..runtime.errors import SettingsError
from ..runtime.progress import Steps, at_once
from .block_krylov import lowest_eigenpairs_steps
from .laplacian import LaplaceBeltrami, laplace_beltrami

_ANTISYMMETRIC = 1e-4
"""Cubic moment, relative to that of the absolute value, below which it does not tell the sign."""

_ROWS = 1 << 12
"""Rows of the functions that are worked on together."""


@dataclass(frozen=True, eq=False)
class Spectrum:
    r"""The lowest eigenpairs of a surface's Laplace-Beltrami operator, :math:`W \phi_i = \lambda_i M \phi_i`.

    Attributes
    ----------
    values : (k,) array of float
        Eigenvalues, ascending, in one over area units of the mesh; the first is zero.
    functions : (n, k) array of float
        Eigenfunctions in the columns, orthonormal: :math:`\phi_i^T M \phi_j = \delta_{ij}`.
    mass : (n,) array of float
        M, the area that each vertex stands for.
    complete : bool
        Whether counting has proved that no eigenvalue is missing.

    Notes
    -----
    The signs are arbitrary, as are rotations among the functions of equal eigenvalues.  Each function is turned so
    that :math:`\sum_v m_v \phi(v)^3 > 0`, which depends on the surface only; where this vanishes, as for functions
    that are antisymmetric under a symmetry of the surface, so that the first of the largest values is positive.
    """

    values: Floats
    functions: Floats
    mass: Floats
    complete: bool

    @cached_property
    def area(self) -> float:
        """Area of the surface."""
        return float(self.mass.sum())

    @cached_property
    def zero_count(self) -> int:
        """Number of eigenvalues that are zero: more than one if rounding makes one so, of parts that hardly touch."""
        return int((self.values == 0).sum())

    def __len__(self) -> int:
        return len(self.values)


def eigenpairs_steps(surface: TriangleMesh | LaplaceBeltrami, count: int) -> Steps[Spectrum]:
    """Compute the lowest eigenpairs of a surface.

    Parameters
    ----------
    surface : TriangleMesh or LaplaceBeltrami
        The surface, or its operator: it hangs together, and every vertex has a triangle.
    count : int
        How many pairs, the constant function included; at most as many as there are vertices.

    Returns
    -------
    Spectrum
        The pairs.

    Raises
    ------
    SettingsError
        If fewer than one pair is asked for.

    Notes
    -----
    How the pairs are found is told at `block_krylov.lowest_eigenpairs_steps`.
    """
    if count < 1:
        raise SettingsError(f"At least one eigenfunction is needed, but {count} were asked for.")
    operator = surface if isinstance(surface, LaplaceBeltrami) else laplace_beltrami(surface)
    roots = np.sqrt(operator.mass)
    # M^-1/2 W M^-1/2, whose eigenvectors are those of the operator times M^1/2.
    inverse, matrix = 1 / roots, operator.stiffness.copy()
    matrix.data *= np.repeat(inverse, np.diff(matrix.indptr)) * inverse[matrix.indices]
    count = min(count, operator.vertex_count)
    guess = 4 * np.pi * count / (roots @ roots)  # Weyl's law
    pairs = yield from lowest_eigenpairs_steps(matrix, roots / np.linalg.norm(roots), count, guess)
    functions = pairs.vectors  # no copy, as it may be large
    functions /= roots[:, None]
    return Spectrum(pairs.values, _signed(functions, operator.mass), operator.mass, pairs.complete)


eigenpairs = at_once(eigenpairs_steps)


def _signed(functions: Floats, mass: Floats) -> Floats:
    """Turn each function in place to the sign that `Spectrum` describes."""
    moments, sizes = np.zeros((2, functions.shape[1]))
    for first in range(0, len(functions), _ROWS):
        rows = functions[first : first + _ROWS]
        cubes = rows * rows * rows
        moments += mass[first : first + _ROWS] @ cubes
        sizes += mass[first : first + _ROWS] @ np.abs(cubes)
    for column in np.flatnonzero(np.abs(moments) < _ANTISYMMETRIC * sizes):
        size = np.abs(functions[:, column])
        moments[column] = functions[np.flatnonzero(size > 0.999 * size.max())[0], column]
    functions *= np.where(moments < 0, -1.0, 1.0)
    return functions
