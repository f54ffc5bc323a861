# SPDX-License-Identifier: GPL-3.0-or-later
"""Pointwise descriptors from eigenpairs of the Laplace-Beltrami operator, none of which depends on units or scale."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from ..geometry.eigenpairs import Spectrum
from ..runtime.arrays import Floats, Ints
from ..runtime.errors import SettingsError

_TIMES = 0.004, 1.0
"""First and last automatic time, in units of area: heat spreads over some hundredths, and over all of a surface."""

_WIDTH = 7
"""Width of a wave's band of energies, in steps between energies."""

_ROWS = 1 << 13
"""Vertices that are described together."""


def automatic_times(count: int = 16) -> Floats:
    """Choose the times, in units of area, at which heat kernels are compared, (count,).

    They are the same for all shapes, evenly spaced on a logarithmic scale.
    """
    return np.geomspace(*_TIMES, count)


def heat_kernel_signatures(spectrum: Spectrum, times: ArrayLike | None = None, *, relative: bool = True) -> Floats:
    r"""Describe each vertex by how much heat stays there [1]_.

    .. math:: h_t(x, x) = \sum_i e^{-\lambda_i t} \phi_i(x)^2

    Parameters
    ----------
    spectrum : Spectrum
        Eigenpairs of the surface; hundred are enough for the automatic times.
    times : (d,) array_like of float, optional
        Times in units of the surface's area; by default `automatic_times`.
    relative : bool
        Divide each column by :math:`\sum_i e^{-\lambda_i t}`, so that its mean over the surface is one and all times
        count alike in comparisons.  Otherwise the values are :math:`h_t(x, x)` times the area.

    Returns
    -------
    (n, d) array of float
        One row per vertex, without a unit.

    Raises
    ------
    SettingsError
        If a time is not greater than zero.

    References
    ----------
    .. [1] J. Sun, M. Ovsjanikov, L. Guibas, "A concise and provably informative multi-scale signature based on heat
       diffusion", SGP 2009.
    """
    array = automatic_times() if times is None else np.asarray(times, dtype=np.float64)
    if array.ndim != 1 or not (array > 0).all():
        raise SettingsError(f"The times of heat kernel signatures should be numbers greater than zero, not {times!r}.")
    weights = np.exp(-np.outer(spectrum.values * spectrum.area, array))
    if relative:
        weights /= weights.sum(axis=0)
    return _weighted_squares(spectrum, weights)


def automatic_energies(pairs: int, count: int = 50) -> Floats:
    """Choose the logarithms of eigenvalue times area at which waves are compared, (count,).

    They are the same for all shapes, evenly spaced, and by Weyl's law reach from the first of some pairs to four
    fifths of them.
    """
    return np.linspace(np.log(4 * np.pi), np.log(4 * np.pi * max(0.8 * pairs, 2)), count)


def wave_kernel_signatures(spectrum: Spectrum, energies: ArrayLike | None = None) -> Floats:
    r"""Describe each vertex by how likely a quantum particle of some energy is there [1]_.

    .. math:: w_e(x) = A \frac{\sum_i g_i \phi_i(x)^2}{\sum_i g_i}, \quad
        g_i = \exp\left(-\frac{(e - \log \lambda_i A)^2}{2 \sigma^2}\right)

    over the eigenfunctions that are not constant, with seven steps between energies as the width sigma.

    Parameters
    ----------
    spectrum : Spectrum
        Eigenpairs of the surface.
    energies : (d,) array_like of float, optional
        Logarithms of eigenvalue times area, evenly spaced, at least two; by default `automatic_energies` of the number
        of eigenpairs.

    Returns
    -------
    (n, d) array of float
        One row per vertex, without a unit; the mean of each column over the surface is one.

    Raises
    ------
    SettingsError
        If there are fewer than two energies, or no eigenfunctions but constant ones.

    References
    ----------
    .. [1] M. Aubry, U. Schlickewei, D. Cremers, "The wave kernel signature: a quantum mechanical approach to shape
       analysis", ICCV Workshops 2011.
    """
    array = automatic_energies(len(spectrum)) if energies is None else np.asarray(energies, dtype=np.float64)
    if array.ndim != 1 or len(array) < 2 or not array[-1] > array[0]:
        raise SettingsError(
            f"The energies of wave kernel signatures should be two or more growing numbers, not {energies!r}."
        )
    _require_functions(spectrum, 1)
    width = _WIDTH * (array[-1] - array[0]) / (len(array) - 1)
    logs = np.log(spectrum.values[spectrum.zero_count :] * spectrum.area)
    exponents = -np.square((array - logs[:, None]) / width) / 2
    weights = np.zeros((len(spectrum), len(array)))
    weights[spectrum.zero_count :] = np.exp(exponents - exponents.max(axis=0))
    return _weighted_squares(spectrum, weights / weights.sum(axis=0))


def eigenfunction_descriptor(spectrum: Spectrum, count: int) -> Floats:
    """Describe each vertex by the values of the first eigenfunctions that are not constant.

    Each is known up to its sign only, and functions of near-equal eigenvalues (see `multiplets`) up to a rotation.

    Parameters
    ----------
    spectrum : Spectrum
        Eigenpairs of the surface.
    count : int
        How many functions, d.

    Returns
    -------
    (n, d) array of float
        The functions times the square root of the area: their mean square over the surface is one.

    Raises
    ------
    SettingsError
        If there are not so many functions.
    """
    _require_functions(spectrum, count)
    first = spectrum.zero_count
    return spectrum.functions[:, first : first + count] * np.sqrt(spectrum.area)


def multiplets(values: Floats, gap: float = 0.05) -> list[Ints]:
    """Group eigenvalues so close to each other that their functions may have another order, or mix, on a like shape.

    Parameters
    ----------
    values : (k,) array of float
        Eigenvalues, ascending.
    gap : float
        Difference to the next, relative to it, from which on a new group begins.

    Returns
    -------
    list of (g,) arrays of int
        Indices in `values`, ascending; every index is in one group.
    """
    array = np.asarray(values, dtype=np.float64)
    apart = np.diff(array) > gap * np.abs(array[1:])
    return np.split(np.arange(len(array)), np.flatnonzero(apart) + 1) if len(array) else []


def _weighted_squares(spectrum: Spectrum, weights: Floats) -> Floats:
    """Sum squared eigenfunctions, times the area, with weights (k, d): (n, d)."""
    result = np.empty((len(spectrum.functions), weights.shape[1]))
    for first in range(0, len(result), _ROWS):
        rows = spectrum.functions[first : first + _ROWS]
        result[first : first + _ROWS] = (rows * rows) @ weights
    return result * spectrum.area


def _require_functions(spectrum: Spectrum, count: int) -> None:
    there = len(spectrum) - spectrum.zero_count
    if not 1 <= count <= there:
        raise SettingsError(
            f"{count} eigenfunctions that are not constant were asked for, but {there} of the {len(spectrum)} "
            "that were computed are: ask for at least one and for no more than there are."
        )
