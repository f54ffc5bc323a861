# SPDX-License-Identifier: GPL-3.0-or-later
"""Eigenvalues and eigenfunctions of the Laplace-Beltrami operator."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy.sparse import csr_array

from ..mesh.triangle_mesh import TriangleMesh
from ..runtime.arrays import Floats, Ints
from ..runtime.errors import SettingsError
from ..runtime.progress import Progress, Steps, run, within
from .block_krylov import EigenPairs, lowest_eigenpairs_steps
from .laplacian import LaplaceBeltrami, laplace_beltrami

_MARGIN = 10
"""Pairs more than its share by area that are first computed of a part of a surface."""

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
        Eigenvalues, ascending, in one over area units of the mesh; as many zeros come first as the surface has parts.
    functions : (n, k) array of float
        Eigenfunctions in the columns, orthonormal: :math:`\phi_i^T M \phi_j = \delta_{ij}`.  Zero on vertices without
        a triangle, and each on all parts of the surface but one.
    mass : (n,) array of float
        M, the area that each vertex stands for; zero for vertices without a triangle.
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
        """Number of eigenvalues that are zero: of parts of the surface, as far as they are among the pairs."""
        return int((self.values == 0).sum())

    def __len__(self) -> int:
        return len(self.values)


def eigenpairs(surface: TriangleMesh | LaplaceBeltrami, count: int) -> Spectrum:
    """Compute the lowest eigenpairs of a surface; see `eigenpairs_steps`."""
    return run(eigenpairs_steps(surface, count))


def eigenpairs_steps(surface: TriangleMesh | LaplaceBeltrami, count: int) -> Steps[Spectrum]:
    """Compute the lowest eigenpairs of a surface, in steps.

    Parameters
    ----------
    surface : TriangleMesh or LaplaceBeltrami
        The surface, or its operator.
    count : int
        How many pairs, the constant function included; where it is larger than the number of vertices with a
        triangle, there are as many pairs as those.

    Yields
    ------
    Progress
        About every 0.1 s for tens of thousands of vertices.

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
    Parts of the surface that do not hang together are solved apart, as equal parts would have every eigenvalue twice.
    How the pairs of one part are found is told at `block_krylov.lowest_eigenpairs_steps`.
    """
    if count < 1:
        raise SettingsError(f"At least one eigenfunction is needed, but {count} were asked for.")
    operator = surface if isinstance(surface, LaplaceBeltrami) else laplace_beltrami(surface)
    parts = operator.components
    count = min(count, sum(len(part) for part in parts))
    matrix = _normalised(operator)
    shares = [operator.mass[part].sum() / operator.area for part in parts]
    counts = [min(len(part), count, int(count * share) + _MARGIN) for part, share in zip(parts, shares, strict=True)]
    found: dict[int, EigenPairs] = {}
    todo, fraction = list(range(len(parts))), 0.0
    while todo:
        work = np.cumsum([0, *(len(parts[i]) * counts[i] for i in todo)])
        ends = fraction + 0.95 * (1 - fraction) * work / work[-1]
        for i, start, end in zip(todo, ends[:-1], ends[1:], strict=True):
            part, roots = parts[i], np.sqrt(operator.mass[parts[i]])
            guess = 4 * np.pi * counts[i] / (roots @ roots)  # Weyl's law
            steps = lowest_eigenpairs_steps(_block(matrix, part), roots / np.linalg.norm(roots), counts[i], guess)
            found[i] = yield from within(steps, float(start), float(end))
            yield Progress(float(end), "Computing eigenfunctions")
        fraction = float(ends[-1])
        todo = [i for i in _too_few(found, count) if counts[i] < min(len(parts[i]), count)]
        for i in todo:
            counts[i] = min(len(parts[i]), count, 2 * counts[i])
    return _merged(operator, found, count)


def _normalised(operator: LaplaceBeltrami) -> csr_array:
    """M^-1/2 W M^-1/2, whose eigenvectors are those of the operator times M^1/2."""
    mass = operator.mass
    inverse = np.divide(1, np.sqrt(mass), out=np.zeros_like(mass), where=mass > 0)
    matrix = operator.stiffness.copy()
    matrix.data *= np.repeat(inverse, np.diff(matrix.indptr)) * inverse[matrix.indices]
    return matrix


def _block(matrix: csr_array, part: Ints) -> csr_array:
    """Rows and columns of a part of the surface."""
    return matrix if len(part) == matrix.shape[0] else csr_array(matrix[part][:, part])


def _too_few(found: dict[int, EigenPairs], count: int) -> list[int]:
    """Parts that may have more eigenvalues among the lowest `count` than have been computed."""
    values = np.sort(np.concatenate([pairs.values for pairs in found.values()]))
    limit = values[count - 1] if count <= len(values) else np.inf
    return [i for i, pairs in found.items() if pairs.values[-1] < limit]


def _merged(operator: LaplaceBeltrami, found: dict[int, EigenPairs], count: int) -> Spectrum:
    """Put the pairs of all parts into one order."""
    parts = [operator.components[i] for i in found]
    owner = np.repeat(np.arange(len(parts)), [len(pairs.values) for pairs in found.values()])
    column = np.concatenate([np.arange(len(pairs.values)) for pairs in found.values()])
    values = np.concatenate([pairs.values for pairs in found.values()])
    order = np.lexsort((column, owner, values))[:count]
    if len(parts) == 1 and len(parts[0]) == operator.vertex_count:
        functions = found[0].vectors  # no copy, as it may be large
        functions /= np.sqrt(operator.mass)[:, None]
    else:
        functions = np.zeros((operator.vertex_count, count))
        for number, (part, pairs) in enumerate(zip(parts, found.values(), strict=True)):
            here = np.flatnonzero(owner[order] == number)
            functions[part[:, None], here] = pairs.vectors[:, column[order][here]] / np.sqrt(operator.mass[part, None])
    complete = all(pairs.complete for pairs in found.values())
    return Spectrum(values[order], _signed(functions, operator.mass), operator.mass, complete)


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
