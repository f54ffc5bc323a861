# SPDX-License-Identifier: GPL-3.0-or-later
"""Indicator function, on a grid, of the solid inside surfaces that are open, lie in each other, or leave gaps."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray
from scipy.fft import fftfreq, irfftn, next_fast_len, rfftfreq, rfftn
from scipy.sparse import csc_array

from ..mesh.area_samples import area_samples
from ..mesh.surface_points import interpolation_matrix
from ..mesh.triangle_mesh import TriangleMesh
from ..runtime.arrays import Floats

_MARGIN = 8
"""Places of the grid around the surfaces: the grid goes on at its other side, as Fourier transforms see it."""

_SAMPLES = 12.0
"""Points that stand for each square of the grid's spacing on the surface.  With 6 a body's function differs by 0.025 at
most, but from one mannequin to the other a finger was off by 6.7 % of the height, by 2.9 with 12 (tried once)."""

_BLUR = 0.8
"""Standard deviation of the blur, in places of the grid: else the function overshoots at the surface."""

MOST_PLACES = 5_000_000
"""Of a grid: some hundred megabytes while it is computed.  Surfaces spread more widely get a coarser one."""

_COARSER = 1.1
"""How many times as far apart places are moved at a time, until there are not more than twice as many with margins."""


@dataclass(frozen=True, eq=False)
class SolidIndicator:
    """About how often each place is inside of surfaces.

    Attributes
    ----------
    values : (a, b, c) array of float
        One inside, zero outside; more where surfaces lie in each other, and between zero and one around openings.
    origin : (3,) array of float
        Position of the first place of the grid.
    spacing : float
        Distance between places.
    """

    values: NDArray[np.float32]
    origin: Floats
    spacing: float

    def with_surfaces(self, mesh: TriangleMesh) -> SolidIndicator:
        """Add surfaces near those that are known, on the places that are there: it is linear in them."""
        low, high = (
            (end - self.origin) / self.spacing for end in (mesh.vertices.min(axis=0), mesh.vertices.max(axis=0))
        )
        first = np.floor(low).astype(np.int64) - _MARGIN
        own = _values(mesh, self.origin + first * self.spacing, self.spacing, _grid(high - first))
        begin, end = np.maximum(first, 0), np.minimum(first + own.shape, self.values.shape)
        here, there = (tuple(map(slice, begin - start, end - start)) for start in (np.zeros(3, np.int64), first))
        values = self.values.copy()
        values[here] += own[there]
        return replace(self, values=values)


def solid_indicator(mesh: TriangleMesh, spacing: float) -> SolidIndicator:
    r"""Compute the indicator function of the inside of surfaces [1]_.

    Parameters
    ----------
    mesh : TriangleMesh
        The surfaces; their triangles look outward.
    spacing : float
        Distance of the grid's places.  It is made larger if there would be too many.

    Returns
    -------
    SolidIndicator
        The function, on a grid with some places around the surfaces.

    Notes
    -----
    The gradient of the function is the surfaces' normal, turned inward, on the surfaces and zero elsewhere.  So it
    solves the Poisson equation :math:`\Delta \chi = \nabla \cdot V` with the normals as V, by Fourier transforms.

    References
    ----------
    .. [1] M. Kazhdan, "Reconstruction of solid models from oriented point sets", Symposium on Geometry Processing 2005.
    """
    low, high = mesh.vertices.min(axis=0), mesh.vertices.max(axis=0)
    spacing = max(spacing, float(np.cbrt(np.prod(np.maximum(high - low, spacing)) / MOST_PLACES)))
    while np.prod((high - low) / spacing + 2 * _MARGIN) > 2 * MOST_PLACES:  # around needles, margins are most of it
        spacing *= _COARSER
    origin = low - _MARGIN * spacing
    return SolidIndicator(_values(mesh, origin, spacing, _grid((high - origin) / spacing)), origin, spacing)


def _grid(size: Floats) -> tuple[int, ...]:
    """Numbers of places of a grid of at least that size (3,), and a margin, of which Fourier transforms are fast."""
    return tuple(next_fast_len(int(number), real=True) for number in np.ceil(size).astype(np.int64) + _MARGIN + 1)


def _values(mesh: TriangleMesh, origin: Floats, spacing: float, shape: tuple[int, ...]) -> NDArray[np.float32]:
    """Compute the indicator function on a grid, see `solid_indicator`."""
    samples = area_samples(mesh, spacing**2 / _SAMPLES)
    spreading = _spreading((samples.positions - origin) / spacing, shape)
    normals = mesh.triangle_normals[samples.triangles] * samples.areas[:, None]
    frequencies = [2 * np.pi * fftfreq(number) for number in shape[:2]] + [2 * np.pi * rfftfreq(shape[2])]
    waves = np.meshgrid(*(wave.astype(np.float32) for wave in frequencies), indexing="ij", sparse=True)
    squares = waves[0] ** 2 + waves[1] ** 2 + waves[2] ** 2
    squares[0, 0, 0] = 1.0
    solved = np.zeros(squares.shape, np.complex64)
    for wave, normal in zip(waves, normals.T, strict=True):
        transform = rfftn((spreading @ normal).astype(np.float32).reshape(shape))
        transform *= wave
        solved += transform
    solved *= 1j / (squares * spacing**2)
    for wave in waves:
        solved *= np.exp(-(_BLUR**2) / 2 * wave**2)
    solved[0, 0, 0] = 0
    values = irfftn(solved, s=shape)
    # The equation leaves a constant open: far from everything is outside.
    faces = [np.take(values, (0, -1), axis=axis).ravel() for axis in range(3)]
    return values - np.median(np.concatenate(faces))


def _spreading(places: Floats, shape: tuple[int, ...]) -> csc_array:
    """Make the matrix (number of places of a grid, s) that spreads values at points, in its units, (s, 3)."""
    cells = np.floor(places).astype(np.int64)
    upper = places - cells
    ends = np.stack([1 - upper, upper])  # weights of the places before and after, along each axis
    steps = np.array([shape[1] * shape[2], shape[2], 1])
    first = cells @ steps
    rows, weights = np.empty((len(places), 8), np.int64), np.empty((len(places), 8))
    for number, (i, j, k) in enumerate(np.ndindex(2, 2, 2)):
        rows[:, number] = first + steps @ (i, j, k)
        weights[:, number] = ends[i, :, 0] * ends[j, :, 1] * ends[k, :, 2]
    return csc_array(interpolation_matrix(weights, rows, int(np.prod(shape))).T)
