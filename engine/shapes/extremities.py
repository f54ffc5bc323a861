# SPDX-License-Identifier: GPL-3.0-or-later
"""The ends of limbs, of ears, of tails: what two bodies have in common whatever their proportions."""

from __future__ import annotations

import numpy as np

from ..geometry.best_distinct import best_distinct
from ..runtime.arrays import Floats, Ints
from .shape import Shape

_REACH = 0.15
"""Distance, in sqrt(area), in which a tip is farther from the rest of the surface than all else."""

_MOST_TIPS = 16
"""Tips that are looked at; of more, the farthest from the rest."""

_PROMINENT, _BESIDE = 0.05, 10
"""By how much, in units of the mean of all places, ends of limbs are farther from the rest than all ways to farther
ones, and how many samples lie beside one: hands, feet and heads of six characters have 0.09 to 0.97, hips, shins and
breasts, which are tips as well by distance alone, less than 0.05 (tried once)."""

_FILLED = 0.3
"""Distance, in sqrt(area), from all others of a place that stands in where there are too few tips."""


def limb_tips(shape: Shape) -> Ints:
    """Find the ends of limbs, of ears, of tails: samples that are farther from the rest than all around them.

    Parameters
    ----------
    shape : Shape
        With samples.

    Returns
    -------
    (k,) array of int
        Numbers of samples, those first whose mean distance from the rest is largest.
    """
    distances, means = shape.samples.distances, mean_distances(shape)
    largest = np.where(distances < _REACH, means, -np.inf).max(axis=1)
    tips = np.flatnonzero(means >= largest)
    return tips[np.argsort(-means[tips], kind="stable")][:_MOST_TIPS]


def spread_extremities(shape: Shape, count: int, apart: float, *, filled: bool = True) -> Ints:
    """Choose tips of different limbs; where there are too few, places far from all of them.

    Parameters
    ----------
    shape : Shape
        With samples.
    count : int
        How many are wanted at most.
    apart : float
        Least distance between two tips, in sqrt(area): those of ears and of nose, or of toes, are nearer.
    filled : bool
        Whether other places are taken at all.

    Returns
    -------
    (k,) array of int
        Numbers of samples, k <= count, the farthest from the rest first, then those that fill up.
    """
    distances = shape.samples.distances
    chosen: list[int] = []
    for places, least in ((limb_tips(shape), apart), (np.arange(len(distances) if filled else 0), _FILLED)):
        far = (distances > least).item
        chosen += best_distinct(places.tolist(), far, count - len(chosen), beside=chosen)
    return np.array(chosen, np.int64)


def prominent_ends(shape: Shape) -> Ints:
    """Find the ends of limbs by how far out they are: peaks of the mean distance from the rest, by their prominence.

    As of mountains, the prominence of a peak is how far one has to go down to reach a higher one, known as its
    persistence [1]_.  Other than by distances alone, neither where a limb is bent nor hips count as ends.

    Parameters
    ----------
    shape : Shape
        With samples.

    Returns
    -------
    (k,) array of int
        Numbers of samples, the farthest from the rest first.

    References
    ----------
    .. [1] H. Edelsbrunner, D. Letscher, A. Zomorodian, "Topological Persistence and Simplification", Discrete &
       Computational Geometry 28, 2002.
    """
    far = mean_distances(shape)
    count = len(far)
    near = np.argsort(shape.samples.distances, axis=1)[:, 1 : _BESIDE + 1]
    beside = np.zeros((count, count), bool)
    beside[np.arange(count)[:, None], near] = True
    beside |= beside.T
    peaks = np.full(count, -1)  # the highest that is reached without going farther down; -1 below what was seen so far
    prominence = np.zeros(count)
    for place in np.argsort(-far, kind="stable"):
        met = np.setdiff1d(peaks[beside[place]], [-1])
        highest = met[far[met].argmax()] if len(met) else place
        prominence[met] = np.where(met == highest, 0.0, far[met] - far[place])
        peaks[np.isin(peaks, met)] = peaks[place] = highest
    last = np.unique(peaks)
    prominence[last] = far[last] - far.min()
    ends = np.flatnonzero(prominence > _PROMINENT * np.average(far, weights=shape.samples.cell_areas))
    return ends[np.argsort(-far[ends], kind="stable")]


def mean_distances(shape: Shape) -> Floats:
    """Mean distance of each sample from the whole surface, (S,)."""
    means: Floats = shape.samples.distances @ shape.samples.cell_areas
    return means / shape.samples.cell_areas.sum()
