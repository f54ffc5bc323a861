# SPDX-License-Identifier: GPL-3.0-or-later
"""Short names of the types of arrays, whose shapes are said where they are used, and arrays made of indices."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]
Bools = NDArray[np.bool_]


def marked(places: Ints, count: int) -> Bools:
    """Mark some places, indices of any shape, among so many: (count,)."""
    marks = np.zeros(count, bool)
    marks[places] = True
    return marks


def numbered(places: Ints, count: int) -> Ints:
    """Give some places (k,) among so many their numbers, from 0 in their order, (count,); all others are -1."""
    numbers = np.full(count, -1)
    numbers[places] = np.arange(len(places))
    return numbers


def group_sums(groups: Ints, values: Floats, count: int) -> Floats:
    """Sum the rows of values (k, d) that are of the same of some groups, by their numbers (k,): (count, d)."""
    return np.stack([np.bincount(groups, column, count) for column in values.T], axis=1)


def group_means(groups: Ints, values: Floats, count: int) -> Floats:
    """Mean of the rows of values (k, d) of each group, none of them empty: (count, d); see `group_sums`."""
    return group_sums(groups, values, count) / np.bincount(groups, minlength=count)[:, None]


def ranges(starts: Ints, counts: Ints) -> Ints:
    """List so many numbers, (k,), from each of some starts (k,) on, one range after the other."""
    before = np.cumsum(counts) - counts
    return np.arange(counts.sum()) + np.repeat(starts - before, counts)
