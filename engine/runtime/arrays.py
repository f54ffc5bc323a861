# SPDX-License-Identifier: GPL-3.0-or-later
"""Types of arrays by short names, and small functions of arrays."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]
Bools = NDArray[np.bool_]

TINY = float(np.finfo(float).tiny)
"""Smallest positive number: what a divisor is at least, so that nothing is divided by zero."""


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


def group_largest(groups: Ints, values: NDArray[Any], count: int, least: float = 0.0) -> NDArray[Any]:
    """Largest of the values (k,) of each of some groups, by their numbers (k,), or what is least: (count,)."""
    largest = np.full(count, least)
    np.maximum.at(largest, groups, values)
    return largest


def group_smallest(groups: Ints, values: NDArray[Any], count: int, most: float = np.inf) -> NDArray[Any]:
    """Smallest of the values (k,) of each of some groups, by their numbers (k,), or what is most: (count,)."""
    smallest = np.full(count, most)
    np.minimum.at(smallest, groups, values)
    return smallest


def group_extents(groups: Ints, points: Floats, count: int) -> Floats:
    """Measure the longest side of the bounding box of each group's points, (k, 3), with groups (k,): (count,)."""
    low, high = np.full((count, 3), np.inf), np.full((count, 3), -np.inf)
    np.minimum.at(low, groups, points)
    np.maximum.at(high, groups, points)
    return (high - low).max(axis=1)


def weighted_quantile(values: Floats, weights: Floats, share: float = 0.5) -> float:
    """Find the smallest of the values (k,) up to which lies such a share of their weights (k,), by default the half."""
    order = np.argsort(values, kind="stable")
    sums = np.cumsum(weights[order])
    return float(values[order[min(int(np.searchsorted(sums, share * sums[-1])), len(order) - 1)]])


def ranges(starts: Ints, counts: Ints) -> Ints:
    """List so many numbers, (k,), from each of some starts (k,) on, one range after the other."""
    before = np.cumsum(counts) - counts
    return np.arange(counts.sum()) + np.repeat(starts - before, counts)


def slices(count: int, size: int) -> Iterator[slice]:
    """Part so many rows into slices of a size, of which the last may be shorter."""
    return (slice(start, min(start + size, count)) for start in range(0, count, size))


def evenly(count: int, most: int) -> Ints:
    """Choose so many of some numbers from 0 on at most, evenly: (k,)."""
    return np.linspace(0, count - 1, min(count, most)).astype(np.int64)


def unit_vectors(vectors: Floats, least: float = 0.0) -> Floats:
    """Scale vectors (..., d) to length one; those that are no longer than `least` become zero."""
    lengths = np.linalg.norm(vectors, axis=-1, keepdims=True)
    return np.divide(vectors, lengths, out=np.zeros_like(vectors), where=lengths > least)


def shares_along(points: Floats, starts: Floats, ways: Floats) -> Floats:
    """Tell how far along segments (..., d) their nearest places to points lie: from 0 at the start to 1, (...)."""
    squares = np.maximum(np.square(ways).sum(axis=-1), TINY)
    return (((points - starts) * ways).sum(axis=-1) / squares).clip(0, 1)


def distances_from_segments(points: Floats, starts: Floats, ways: Floats) -> Floats:
    """Measure how far points (..., d) are from segments, (...)."""
    return np.linalg.norm(points - starts - shares_along(points, starts, ways)[..., None] * ways, axis=-1)


def lengths_along(points: Floats) -> Floats:
    """Tell how far along a line each of its points (k, d) lies, from 0 at the first on, (k,)."""
    return np.append(0.0, np.cumsum(np.linalg.norm(np.diff(points, axis=0), axis=1)))


def eased(shares: Floats) -> Floats:
    """Let shares from 0 to 1 begin and end smoothly: less than 0 is 0, and more than 1 is 1."""
    shares = shares.clip(0, 1)
    return shares * shares * (3 - 2 * shares)


def spread_rows(rows: Floats, first: int, most: int, least: float = 0.0) -> Ints:
    """Pick rows of (n, d), from the first on each the farthest from those before, until none is far any more: (k,)."""
    chosen = [first]
    away = np.square(rows - rows[first]).sum(axis=1)
    while len(chosen) < most and away.max() > least**2:
        chosen.append(int(away.argmax()))
        away = np.minimum(away, np.square(rows - rows[chosen[-1]]).sum(axis=1))
    return np.array(chosen)


def squared_differences(first: NDArray[Any], second: NDArray[Any]) -> NDArray[Any]:
    """Squared Euclidean distance of every row of `first` (n, d) from every row of `second` (m, d): (n, m)."""
    square = np.square(first).sum(axis=1)[:, None] + np.square(second).sum(axis=1) - 2 * first @ second.T
    return np.maximum(square, 0, out=square)
