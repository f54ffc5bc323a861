# SPDX-License-Identifier: GPL-3.0-or-later
"""Many plausible matchings of a few points, by beam search."""

from __future__ import annotations

import numpy as np

from ...runtime.arrays import TINY, Floats, Ints

_WEIGHT = 0.3  # of the descriptors beside the distances


def beam_matchings(distances_x: Floats, distances_y: Floats, dissimilarity: Floats, width: int) -> Ints:
    r"""Match points one after the other, keeping the best partial matchings only.

    The cost of images t is

    .. math:: \sum_i \Big[ w L_{i t_i} + \frac{2}{i} \sum_{j < i}
        \frac{2 \, |d^X_{ij} - d^Y_{t_i t_j}|}{d^X_{ij} + d^Y_{t_i t_j}} \Big]

    Parameters
    ----------
    distances_x : (m, m) array of float
        Distances between the points of X.
    distances_y : (n, n) array of float
        Distances between the points of Y, in the same unit; n >= m.
    dissimilarity : (m, n) array of float
        L, how unlike the descriptors of the points are.
    width : int
        How many matchings are kept at most, partial ones and in the end, r.

    Returns
    -------
    (r, m) array of int
        For each matching the images of the points, one after another; the cheapest first.
    """
    m, n = dissimilarity.shape
    images, costs = np.arange(n)[:, None], _WEIGHT * dissimilarity[0]
    for new in range(1, m):
        known = distances_x[new, :new, None]  # (new, 1)
        offered = distances_y[images]  # (r, new, n)
        stretch = 2 * np.abs(known - offered) / np.maximum(known + offered, TINY)
        extended = costs[:, None] + 2 * stretch.mean(axis=1) + _WEIGHT * dissimilarity[new]
        np.put_along_axis(extended, images, np.inf, axis=1)
        best = np.argsort(extended, axis=None, kind="stable")[: min(width, len(images) * (n - new))]
        costs = extended.ravel()[best]
        images = np.column_stack([images[best // n], best % n])
    return images
