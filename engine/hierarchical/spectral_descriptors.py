# SPDX-License-Identifier: GPL-3.0-or-later
"""Pointwise descriptors from eigenpairs of the Laplace-Beltrami operator, none of which depends on units or scale."""

from __future__ import annotations

import numpy as np

from ..geometry.eigenpairs import Spectrum
from ..runtime.arrays import Floats, Ints
from ..runtime.errors import SettingsError

_TIMES = np.geomspace(0.004, 1.0, 16)
"""Times of heat kernels, in units of area: heat spreads over some hundredths, at last over all of a surface."""

_WIDTH = 7
"""Width of a wave's band of energies, in steps between energies."""

_ROWS = 1 << 13
"""Vertices that are described together."""


def heat_kernel_signatures(spectrum: Spectrum, times: Floats = _TIMES) -> Floats:
    r"""Describe each vertex by how much heat stays there [1]_.

    .. math:: A \frac{h_t(x, x)}{\sum_i e^{-\lambda_i t}}, \quad h_t(x, x) = \sum_i e^{-\lambda_i t} \phi_i(x)^2

    The sum makes all times count alike in comparisons.

    Parameters
    ----------
    spectrum : Spectrum
        Eigenpairs of the surface; a hundred are enough for the usual times.
    times : (d,) array of float
        Times in units of the surface's area; by default the same for all shapes, evenly spaced on a logarithmic scale.

    Returns
    -------
    (n, d) array of float
        One row per vertex, without a unit; the mean of each column over the surface is one.

    References
    ----------
    .. [1] J. Sun, M. Ovsjanikov, L. Guibas, "A concise and provably informative multi-scale signature based on heat
       diffusion", SGP 2009.
    """
    weights = np.exp(-np.outer(spectrum.values * spectrum.area, times))
    return _weighted_squares(spectrum, weights / weights.sum(axis=0))


def automatic_energies(pairs: int, count: int = 50) -> Floats:
    """Choose the logarithms of eigenvalue times area at which waves are compared, (count,).

    They are the same for all shapes, evenly spaced, and by Weyl's law reach from the first of some pairs to four
    fifths of them.
    """
    return np.linspace(np.log(4 * np.pi), np.log(4 * np.pi * max(0.8 * pairs, 2)), count)


def wave_kernel_signatures(spectrum: Spectrum, energies: Floats | None = None) -> Floats:
    r"""Describe each vertex by how likely a quantum particle of some energy is there [1]_.

    .. math:: w_e(x) = A \frac{\sum_i g_i \phi_i(x)^2}{\sum_i g_i}, \quad
        g_i = \exp\left(-\frac{(e - \log \lambda_i A)^2}{2 \sigma^2}\right)

    over the eigenfunctions that are not constant, with seven steps between energies as the width sigma.

    Parameters
    ----------
    spectrum : Spectrum
        Eigenpairs of the surface.
    energies : (d,) array of float, optional
        Logarithms of eigenvalue times area, evenly spaced, at least two; by default `automatic_energies` of the number
        of eigenpairs.

    Returns
    -------
    (n, d) array of float
        One row per vertex, without a unit; the mean of each column over the surface is one.

    Raises
    ------
    SettingsError
        If there are no eigenfunctions but constant ones.

    References
    ----------
    .. [1] M. Aubry, U. Schlickewei, D. Cremers, "The wave kernel signature: a quantum mechanical approach to shape
       analysis", ICCV Workshops 2011.
    """
    energies = automatic_energies(len(spectrum)) if energies is None else energies
    _require_functions(spectrum, 1)
    width = _WIDTH * (energies[-1] - energies[0]) / (len(energies) - 1)
    logs = np.log(spectrum.values[spectrum.zero_count :] * spectrum.area)
    exponents = -np.square((energies - logs[:, None]) / width) / 2
    weights = np.zeros((len(spectrum), len(energies)))
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
