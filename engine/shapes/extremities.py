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


def mean_distances(shape: Shape) -> Floats:
    """Mean distance of each sample from the whole surface, (S,)."""
    means: Floats = shape.samples.distances @ shape.samples.cell_areas
    return means / shape.samples.cell_areas.sum()
