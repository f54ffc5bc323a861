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

NEUTRAL = 0.5
"""Grey (sRGB) of the places that no matched point can reach."""

_HUES = 290.0
"""Degrees of the circle of hues that lie along a shape in `match_colors`: red to violet, so that no two ends meet."""

_SHIFT = 50.0
"""Degrees of hue between the two sides of a shape that is thin: less than from one limb to the next along it."""

_PALE = 0.45
"""Saturation at one side of a shape; at the other it is one."""

_BRIGHT = 0.95
"""Largest of red, green and blue, so that shading is still seen."""

_STRAY = 0.002
"""Part of a surface that may lie beyond either end of the scale of `match_colors`."""

_BLOCK = 4_000_000
"""How many weights `spread` holds at a time."""

_DISTORTION = np.array(
    [[0.05, 0.09, 0.36], [0.13, 0.35, 0.60], [0.16, 0.60, 0.56], [0.60, 0.80, 0.27], [0.99, 0.91, 0.15]]
)
"""Dark blue, blue, teal, lime, yellow (sRGB): the way of `distortion_colors` from dark to light."""

_CONFIDENCE = np.array(
    [[0.30, 0.02, 0.14], [0.62, 0.10, 0.16], [0.90, 0.40, 0.22], [0.98, 0.75, 0.50], [0.99, 0.97, 0.90]]
)
"""Dark red, red, orange, sand, nearly white (sRGB): the way of `confidence_colors` from dark to light."""

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


def match_colors(positions: NDArray[np.float64], weights: NDArray[np.float64] | None = None) -> NDArray[np.float64]:
    """Give points colours that tell where on the shape they are.

    Parameters
    ----------
    positions : (k, 3) array of float
        Where the points are.
    weights : (k,) array of float, optional
        How much each counts when the axes and the ends of the shape are found, such as the area around it; if given,
        a small share of the weight (`_STRAY`) may lie beyond the ends, so that what flies about changes nothing.

    Returns
    -------
    (k, 3) array of float
        sRGB colours: the place along the longest principal axis as the hue, from red to violet, along the second as how
        vivid it is, and along the third as a shift of the hue.
    """
    stray = 0.0 if weights is None else _STRAY
    shares = np.full(len(positions), 1 / len(positions)) if weights is None else weights / weights.sum()
    inner = np.clip(positions, *_ends(positions, shares, stray))  # else what flies about would turn the axes
    centre = shares @ inner
    _, axes = np.linalg.eigh((inner - centre).T @ (shares[:, None] * (inner - centre)))
    axes = axes[:, ::-1]  # the longest first
    # The sign of a principal axis is arbitrary; let the longer tail of the shape point forward.
    axes *= np.where(shares @ ((inner - centre) @ axes) ** 3 < 0, -1.0, 1.0)
    along = (positions - centre) @ axes  # (k, 3)
    low, high = _ends(along, shares, stray)
    extent = high - low
    flat = extent <= 1e-6 * float(extent.max())
    along = np.where(flat, NEUTRAL, np.clip((along - low) / np.where(flat, 1.0, extent), 0.0, 1.0))
    hue = (_HUES * along[:, :1] + _SHIFT * (along[:, 2:] - 0.5)) / 60 + np.array([0.0, 4.0, 2.0])  # of red, green, blue
    vivid = np.clip(np.abs(hue % 6 - 3) - 1, 0.0, 1.0)
    return _BRIGHT * (1 - (_PALE + (1 - _PALE) * along[:, 1:2]) * (1 - vivid))


def _ends(
    values: NDArray[np.float64], shares: NDArray[np.float64], stray: float
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Return between which values of each column (k, c) all but so much of the weight lies at either end, (c,) each."""
    order = np.argsort(values, axis=0, kind="stable")
    sums = np.cumsum(shares[order], axis=0)
    ends = []
    for end in (stray, 1 - stray):
        places = [min(int(np.searchsorted(column, end)), len(values) - 1) for column in sums.T]
        ends.append(np.array([values[order[place, c], c] for c, place in enumerate(places)]))
    return ends[0], ends[1]


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
    return _shades(values / (maximum or 1.0), _DISTORTION)


def confidence_colors(values: NDArray[np.float64]) -> NDArray[np.float64]:
    """Show values (n,) from 0 to 1 as sRGB colours from dark red (zero) to nearly white, lightness growing evenly."""
    return _shades(values, _CONFIDENCE)


def _shades(share: NDArray[np.float64], anchors_srgb: NDArray[np.float64]) -> NDArray[np.float64]:
    """Go the way through some colours (a, 3), ever lighter, by a share (n,) of it; nan becomes `NEUTRAL` grey."""
    known = np.isfinite(share)
    share = np.clip(np.where(known, share, 0.0), 0.0, 1.0)
    anchors = np.cbrt(_linear(anchors_srgb) @ _LMS_OF_RGB.T) @ _LAB_OF_LMS.T  # Oklab: lightness first
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
