# SPDX-License-Identifier: GPL-3.0-or-later
"""Colours of regions and of checks, as pure array computations."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from .colors import NEUTRAL

if TYPE_CHECKING:
    from numpy.typing import NDArray

_SHARED = np.array([0.25, 0.55, 0.9])
"""Blue (sRGB) of what has a partner."""

_GOLDEN = (np.sqrt(5) - 1) / 2
"""Hues that are so far apart from one to the next never meet, however many there are."""

_LIGHTS = np.array([1.0, 0.72, 0.88])
_SATURATIONS = np.array([0.75, 0.75, 0.45])
"""Three kinds of colours in turn, for hues that come close to one another."""

_CHECKS = 12.0
"""So many checks lie along the longest extent of a shape."""

_EDGES = 3.0
"""So many edges, at least, lie along a check: vertices farther apart cannot show it."""

_OFFSET = 0.37
"""How far the checks are moved off the centre, so that no plane of symmetry is a border between them."""

_DARK, _LIGHT = 0.35, 0.5
"""How bright the dark checks are, and how much white is in the light ones."""

_RAMP = 3.0
"""How steep the border of a check is."""


def overlap_colors(has_partner: NDArray[np.bool_]) -> NDArray[np.float64]:
    """Give vertices (n,) sRGB colours, (n, 3): blue if they have a partner, `NEUTRAL` grey if not."""
    return np.where(has_partner[:, None], _SHARED, NEUTRAL)


def region_colors(regions: NDArray[np.int64]) -> NDArray[np.float64]:
    """Give vertices the colours of their regions.

    Parameters
    ----------
    regions : (n,) array of int
        Numbers of regions; negative if there is none.

    Returns
    -------
    (n, 3) array of float
        sRGB colours; regions of neighbouring numbers differ much; `NEUTRAL` grey where there is no region.
    """
    count = max(int(regions.max(initial=-1)) + 1, 1)
    numbers = np.arange(count)
    hues = (numbers * _GOLDEN) % 1
    light, saturation = _LIGHTS[numbers % 3], _SATURATIONS[numbers % 3]
    offsets = np.abs((hues[:, None] * 6 + np.array([0.0, 4.0, 2.0])) % 6 - 3) - 1
    table = light[:, None] * (1 - saturation[:, None] * (1 - np.clip(offsets, 0, 1)))
    return np.where((regions >= 0)[:, None], table[np.maximum(regions, 0)], NEUTRAL)


def check_size(positions: NDArray[np.float64], edge_length: float) -> float:
    """Choose the size of checks for a shape with vertices (n, 3) and edges of a usual length."""
    return max(float(np.ptp(positions, axis=0).max()) / _CHECKS, _EDGES * edge_length)


def checked(colors: NDArray[np.float64], places: NDArray[np.float64], size: float) -> NDArray[np.float64]:
    """Darken and lighten colours from one cube of space to the next.

    Parameters
    ----------
    colors : (n, 3) array of float
        sRGB colours of vertices.
    places : (n, 3) array of float
        Where on the source they are.
    size : float
        Length of the sides of the cubes.

    Returns
    -------
    (n, 3) array of float
        sRGB colours, dark in every other cube.
    """
    waves = np.sin(np.pi * (places / size + _OFFSET)).prod(axis=1)
    share = np.clip(0.5 + _RAMP * waves, 0, 1)
    dark, light = _DARK * colors, _LIGHT + (1 - _LIGHT) * colors
    return dark + share[:, None] * (light - dark)
