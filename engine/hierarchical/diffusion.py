# SPDX-License-Identifier: GPL-3.0-or-later
"""Diffusion distances: how differently heat spreads from two points."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from ..geometry.eigenpairs import Spectrum
from ..geometry.geodesics import checked_sources
from ..runtime.arrays import Floats, Ints
from ..runtime.errors import SettingsError

_MODES = 8.0
"""How many eigenfunctions, each counted by its weight, make up diffusion distances at the automatic time.

On bodies of people and animals in two poses, where true matches are known, fewer blur limbs into one another, and more
follow the differences of bodies.
"""

_BLOCK = 4_000_000
"""Distances that are computed together."""


class DiffusionMetric:
    r"""Diffusion distances on one surface, from its eigenpairs.

    .. math:: d_t^2(x, y) = A \sum_i e^{-2 \lambda_i t} (\phi_i(x) - \phi_i(y))^2

    the distance (11) of the paper [1]_.  With the area A of the surface, and time counted in units of area, nothing
    depends on the units of the mesh.

    Parameters
    ----------
    spectrum : Spectrum
        Eigenpairs of the surface.
    time : float, optional
        How long heat spreads, in units of the surface's area: t / A.  By default `automatic_time`.

    Attributes
    ----------
    time : float
        The time, in units of area.

    Raises
    ------
    SettingsError
        If the time is not greater than zero.

    Notes
    -----
    Distances are Euclidean ones between the points :math:`\sqrt{A} e^{-\lambda_i t} \phi_i(x)`, and computed by matrix
    products: rounding is about 1e-8 of the largest.

    References
    ----------
    .. [1] R. Coifman, S. Lafon, "Diffusion maps", Appl. Comput. Harmon. Anal. 21, 2006.
    """

    def __init__(self, spectrum: Spectrum, time: float | None = None) -> None:
        self.time = _checked_time(automatic_time(spectrum) if time is None else time)
        values = spectrum.values * spectrum.area
        weights = np.exp(-2 * values * self.time)
        self._points = spectrum.functions * (np.sqrt(weights * spectrum.area))
        self._squares = np.einsum("ni,ni->n", self._points, self._points)

    def distances(self, sources: ArrayLike) -> Floats:
        """Compute the distances from each source to every vertex.

        Parameters
        ----------
        sources : (S,) array_like of int
            Vertex indices.

        Returns
        -------
        (S, n) array of float
            Distances, without a unit.

        Raises
        ------
        MeshError
            If a source is not a vertex of the mesh.
        """
        checked = checked_sources(sources, len(self._points))
        result = np.empty((len(checked), len(self._points)))
        size = max(1, _BLOCK // len(self._points))
        for first in range(0, len(checked), size):
            result[first : first + size] = self._rows(checked[first : first + size])
        return result

    def _rows(self, sources: Ints) -> Floats:
        rows = self._points[sources] @ self._points.T
        rows *= -2
        rows += self._squares
        rows += self._squares[sources, None]
        np.maximum(rows, 0, out=rows)
        np.sqrt(rows, out=rows)
        rows[np.arange(len(sources)), sources] = 0
        return rows


def diffusion_distances(spectrum: Spectrum, sources: ArrayLike, time: float | None = None) -> Floats:
    """Compute diffusion distances (S, n) from some vertices (S,) to all; see `DiffusionMetric`."""
    return DiffusionMetric(spectrum, time).distances(sources)


def automatic_time(spectrum: Spectrum) -> float:
    r"""Choose how long heat spreads so that distances tell large from small parts of a surface apart.

    This is the time, in units of area, at which :math:`\sum_{\lambda_i > 0} e^{-2 \lambda_i t} = 8`: the mean of
    :math:`d_t^2` is twice this sum, which says how many eigenfunctions have their share in the distances.  It depends
    on the intrinsic shape alone, not on scale, resolution or how many eigenpairs were computed.

    Raises
    ------
    SettingsError
        If all eigenpairs are those of the eigenvalue zero.
    """
    values = spectrum.values[spectrum.zero_count :] * spectrum.area
    if not len(values):
        raise SettingsError(
            f"Diffusion needs eigenfunctions that are not constant, but the {len(spectrum)} that were computed are. "
            "Use more eigenfunctions."
        )
    # A surface with few pairs: as many of them as there are room for.
    modes = min(_MODES, len(values) / 2)
    # The sum falls with time, from more than `modes` at first to less than `modes` in the end.
    early, late = np.log(np.log(len(values) / modes) / 2 / values[[-1, 0]])
    for _ in range(60):
        middle = (early + late) / 2
        if np.exp(-2 * values * np.exp(middle)).sum() > modes:
            early = middle
        else:
            late = middle
    return float(np.exp(middle))


def heat_kernel(spectrum: Spectrum, time: float, sources: ArrayLike) -> Floats:
    r"""Evaluate the heat kernel :math:`h_t(x, z) = \sum_i e^{-\lambda_i t} \phi_i(x) \phi_i(z)`, (10) of the paper.

    Parameters
    ----------
    spectrum : Spectrum
        Eigenpairs of the surface.
    time : float
        How long heat spreads, in units of the surface's area.
    sources : (S,) array_like of int
        Vertices x.

    Returns
    -------
    (S, n) array of float
        The kernel times the area: without a unit, and one everywhere on a connected surface when time is long.

    Raises
    ------
    SettingsError
        If the time is not greater than zero.
    MeshError
        If a source is not a vertex of the mesh.
    """
    weights = np.exp(-spectrum.values * spectrum.area * _checked_time(time)) * spectrum.area
    rows = spectrum.functions[checked_sources(sources, len(spectrum.functions))]
    return (rows * weights) @ spectrum.functions.T


def _checked_time(time: float) -> float:
    if not (np.isfinite(time) and time > 0):
        raise SettingsError(f"The time of diffusion should be greater than zero, but is {time}.")
    return float(time)
