# SPDX-License-Identifier: GPL-3.0-or-later
"""Colours that show a match, as pure array computations.

Colours are chosen and mixed in sRGB, where equal steps look roughly equal, and converted to scene-linear values at
the end (`to_linear`), which is what Blender's color attributes hold.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray

__all__ = ["bandwidths", "distortion_colors", "match_colors", "opaque", "spread", "to_linear"]

NEUTRAL = 0.5
"""Grey (sRGB) of the places that no matched point can reach."""

_SATURATION = 0.75
"""Share of the grey in a colour that `match_colors` takes away."""

_BLOCK = 4_000_000
"""How many weights `spread` holds at a time."""

_ANCHORS = np.array(
    [[0.05, 0.09, 0.36], [0.13, 0.35, 0.60], [0.16, 0.60, 0.56], [0.60, 0.80, 0.27], [0.99, 0.91, 0.15]]
)
"""Dark blue, blue, teal, lime, yellow (sRGB): the way of `distortion_colors` from dark to light."""

_LMS_OF_RGB = np.array(
    [
        [0.4122214708, 0.5363325363, 0.0514459929],
        [0.2119034982, 0.6806995451, 0.1073969566],
        [0.0883024619, 0.2817188376, 0.6299787005],
    ]
)
_LAB_OF_LMS = np.array(
    [
        [0.2104542553, 0.7936177850, -0.0040720468],
        [1.9779984951, -2.4285922050, 0.4505937099],
        [0.0259040371, 0.7827717662, -0.8086757660],
    ]
)
"""The two linear maps of Oklab (B. Ottosson, "A perceptual color space for image processing", 2020)."""


def match_colors(positions: NDArray[np.float64]) -> NDArray[np.float64]:
    """Give points colours that tell where on the shape they are.

    Parameters
    ----------
    positions : (k, 3) array of float
        Where the points are.

    Returns
    -------
    (k, 3) array of float
        sRGB colours: the place along the three principal axes as red, green and blue, brightened and made vivid.
    """
    centred = positions - positions.mean(axis=0)
    _, _, axes = np.linalg.svd(centred, full_matrices=False)
    along = centred @ axes.T  # (k, up to 3)
    # The sign of a principal axis is arbitrary; let the longer tail of the shape point forward.
    along *= np.where((along**3).sum(axis=0) < 0, -1.0, 1.0)
    low = along.min(axis=0)
    extent = along.max(axis=0) - low
    flat = extent <= 1e-6 * float(extent.max())
    colors = np.full((len(positions), 3), NEUTRAL)
    colors[:, : along.shape[1]] = np.where(flat, NEUTRAL, (along - low) / np.where(flat, 1.0, extent))
    colors -= _SATURATION * colors.min(axis=1, keepdims=True)
    return 0.95 * colors / np.maximum(colors.max(axis=1, keepdims=True), 1e-3)


def bandwidths(source_pairs: NDArray[np.float64], target_pairs: NDArray[np.float64]) -> tuple[float, float]:
    """Choose how far each matched point's colour reaches on the two surfaces.

    Parameters
    ----------
    source_pairs, target_pairs : (k, k) array of float
        Distances between the matched points on each surface; inf where there is no path.

    Returns
    -------
    source, target : float
        Half the usual distance between neighbouring points of the source, and the same on the target in proportion
        to how far apart the same points are there: so a scaled copy gets the same colours.
    """
    apart = np.where(np.isfinite(source_pairs) & (source_pairs > 0), source_pairs, np.inf)
    nearest = apart.min(axis=1)
    nearest = nearest[np.isfinite(nearest)]
    both = np.isfinite(source_pairs) & np.isfinite(target_pairs)
    source_sum, target_sum = float(source_pairs[both].sum()), float(target_pairs[both].sum())
    if not len(nearest) or not source_sum or not target_sum:
        return 1.0, 1.0  # no two points apart on both surfaces: only the nearest point counts, whatever its reach
    source = float(np.median(nearest)) / 2
    return source, source * target_sum / source_sum


def spread(values: NDArray[np.float64], distances: NDArray[np.float64], bandwidth: float) -> NDArray[np.float64]:
    r"""Spread values from points over a surface.

    The mean with Gaussian weights, :math:`w_i(v) \propto \exp(-d_i(v)^2 / 2 h^2)`: smooth, within the range of the
    values, and the same formula on both surfaces, so that corresponding places get equal values.

    Parameters
    ----------
    values : (k, c) array of float
        Values at the points.
    distances : (k, n) array of float
        Distance from each point to each vertex; inf where there is no path.
    bandwidth : float
        The reach h of a point.

    Returns
    -------
    (n, c) array of float
        Values at the vertices; nan where no point has a path.
    """
    k, n = distances.shape
    result = np.full((n, values.shape[1]), np.nan)
    reached = np.flatnonzero(np.isfinite(distances).any(axis=0))
    for vertices in np.array_split(reached, max(1, -(-k * len(reached) // _BLOCK))):
        squares = (distances[:, vertices] / bandwidth) ** 2  # (k, block)
        squares -= squares.min(axis=0)  # the nearest point weighs one, however far it is
        weights = np.exp(-squares / 2)
        result[vertices] = (weights.T @ values) / weights.sum(axis=0)[:, None]
    return result


def distortion_colors(values: NDArray[np.float64], maximum: float) -> NDArray[np.float64]:
    """Show values as colours from dark blue (zero) to yellow (`maximum`), lightness growing evenly.

    Parameters
    ----------
    values : (n,) array of float
        Values, not negative; nan becomes `NEUTRAL` grey.
    maximum : float
        The value shown in yellow; if zero, everything is dark blue.

    Returns
    -------
    (n, 3) array of float
        sRGB colours.
    """
    known = np.isfinite(values)
    share = np.clip(np.where(known, values, 0.0) / (maximum or 1.0), 0.0, 1.0)
    anchors = np.cbrt(_linear(_ANCHORS) @ _LMS_OF_RGB.T) @ _LAB_OF_LMS.T  # Oklab: lightness first
    lightness = anchors[0, 0] + share * (anchors[-1, 0] - anchors[0, 0])
    lab = np.stack([np.interp(lightness, anchors[:, 0], channel) for channel in anchors.T], axis=1)
    linear = np.linalg.solve(_LMS_OF_RGB, np.linalg.solve(_LAB_OF_LMS, lab.T) ** 3).T
    colors = _srgb(np.clip(linear, 0.0, 1.0))
    return np.where(known[:, None], colors, NEUTRAL)


def to_linear(colors: NDArray[np.float64]) -> NDArray[np.float64]:
    """Convert sRGB colours (n, 3) to scene-linear ones; nan becomes `NEUTRAL` grey."""
    return _linear(np.where(np.isnan(colors), NEUTRAL, colors))


def opaque(colors: NDArray[np.float64]) -> NDArray[np.float32]:
    """Add alpha one to colours: (n, 3) to (n, 4)."""
    return np.concatenate([colors, np.ones((len(colors), 1))], axis=1).astype(np.float32)


def _linear(srgb: NDArray[np.float64]) -> NDArray[np.float64]:
    return np.where(srgb <= 0.04045, srgb / 12.92, ((srgb + 0.055) / 1.055) ** 2.4)


def _srgb(linear: NDArray[np.float64]) -> NDArray[np.float64]:
    return np.where(linear <= 0.0031308, linear * 12.92, 1.055 * linear ** (1 / 2.4) - 0.055)
