# SPDX-License-Identifier: GPL-3.0-or-later
"""Pointwise descriptors: what a point can be recognised by, whatever the pose."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.distance import cdist

from ..runtime.arrays import Floats


def distance_histograms(distances: Floats, weights: Floats, bins: int, reach: float) -> Floats:
    """Histogram the distances from each point to the rest of its surface.

    Parameters
    ----------
    distances : (s, n) array of float
        Distances from s places that sample the surface to the n points to be described.
    weights : (s,) array of float
        How much surface each place stands for; normalised here.
    bins : int
        Number of bins of equal width.
    reach : float
        Distance at which the last bin ends; anything farther is counted in it.

    Returns
    -------
    (n, bins) array of float
        Histograms, not negative, each summing to one.

    Notes
    -----
    A distance is shared between the two bins whose centres enclose it, in proportion, so that the histogram is a
    continuous function of the point: a distance that crosses the border of a bin makes no jump.
    """
    n = distances.shape[1]
    share = np.asarray(weights, dtype=np.float64) / np.sum(weights)
    position = np.clip(distances * (bins / reach) - 0.5, 0, bins - 1)
    left = np.minimum(position.astype(np.int64), bins - 2)
    right_share = (position - left) * share[:, None]
    cell = left + np.arange(n) * bins  # one long histogram: bin b of point i is cell i * bins + b
    mass = np.concatenate([(share[:, None] - right_share).ravel(), right_share.ravel()])
    cells = np.concatenate([cell.ravel(), cell.ravel() + 1])
    counts: NDArray[Any] = np.bincount(cells, mass, n * bins)
    return counts.reshape(n, bins)


def earth_movers_distance(first: Floats, second: Floats, bin_width: float) -> Floats:
    r"""Compare histograms by how far their mass has to be moved.

    On a line the earth mover's distance is the area between the cumulative histograms,
    :math:`\sum_b |F_b - G_b| w` with bin width w.

    Parameters
    ----------
    first : (n, bins) array of float
        Histograms, each summing to one.
    second : (m, bins) array of float
        Histograms over the same bins.
    bin_width : float
        Width of a bin, in the units that the result shall have.

    Returns
    -------
    (n, m) array of float
        Distance of every first from every second histogram.
    """
    return cdist(np.cumsum(first, axis=1), np.cumsum(second, axis=1), "cityblock") * bin_width


def weighted_correlation(first: Floats, second: Floats, weights: Floats) -> float:
    """Pearson correlation of two functions (n,) at points that stand for some area each; 0 where one is constant."""
    weights = weights / weights.sum()
    first, second = first - weights @ first, second - weights @ second
    size = np.sqrt((weights @ np.square(first)) * (weights @ np.square(second)))
    return float(weights @ (first * second) / size) if size > 0 else 0.0
