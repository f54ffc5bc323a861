# SPDX-License-Identifier: GPL-3.0-or-later
"""From some points matched to many, level by level."""

from dataclasses import dataclass
from itertools import pairwise

import numpy as np
import pytest

from engine import MatchSettings
from engine.hierarchical.hierarchy import level_sizes, refine_steps
from engine.hierarchical.problem import MatchingProblem
from engine.runtime.progress import run


@dataclass
class PointPair:
    """Points in space in place of two sampled shapes: `order` (n,) names those of Y that are those of X, moved."""

    source: np.ndarray
    target: np.ndarray
    settings: MatchSettings

    def problem(self, points, extra=None):
        x, y = (np.linalg.norm(p[:, None] - p, axis=2) for p in (self.source[:points], self.target))
        linear = np.zeros((points, len(y)))
        return MatchingProblem(linear if extra is None else linear + extra, x, y)


def moved_points(seed, count, more=0, noise=0.0):
    """A pair of point sets, the second shuffled with more points, and the truth."""
    rng = np.random.default_rng(seed)
    target = rng.normal(size=(count + more, 3))
    truth = rng.permutation(count + more)[:count]
    source = target[truth] @ np.linalg.qr(rng.normal(size=(3, 3)))[0] + noise * rng.normal(size=(count, 3))
    return PointPair(source, target, MatchSettings()), truth


@pytest.mark.parametrize(("coarse", "finest"), [(10, 64), (8, 64), (3, 3), (10, 4), (7, 8), (1, 1024)])
def test_levels_double_up_to_the_finest(coarse, finest):
    sizes = level_sizes(coarse, finest)
    assert sizes[0] == min(coarse, finest)
    assert sizes[-1] == finest
    assert all(b == min(2 * a, finest) > a for a, b in pairwise(sizes))


def test_the_levels_of_the_paper():
    assert level_sizes(10, 64) == [10, 20, 40, 64]


@pytest.mark.parametrize("more", [0, 15])
def test_copies_are_matched_exactly_from_a_few_points(more):
    pair, truth = moved_points(0, 30, more)
    levels = run(refine_steps(pair, truth[:5], [5, 10, 20, 30]))
    for level, size in zip(levels, (5, 10, 20, 30), strict=True):
        np.testing.assert_array_equal(level.assignment, truth[:size])
        assert level.iterations == 1


def test_points_that_begin_beside_their_place_find_it():
    pair, truth = moved_points(1, 24, 12)
    start = truth[:8].copy()
    free = np.setdiff1d(np.arange(36), truth[:8])
    start[3] = free[np.linalg.norm(pair.target[free] - pair.target[truth[3]], axis=1).argmin()]
    levels = run(refine_steps(pair, start, [8, 24]))
    np.testing.assert_array_equal(levels[0].assignment, truth[:8])
    np.testing.assert_array_equal(levels[1].assignment, truth)
    assert levels[0].iterations > 1


@pytest.mark.parametrize("seed", range(4))
def test_each_level_is_a_matching_that_is_no_worse_than_what_it_began_with(seed):
    pair, _ = moved_points(seed, 20, 10, noise=0.3)
    start = np.random.default_rng(seed).permutation(30)[:10]
    first, second = run(refine_steps(pair, start, [10, 20]))
    assert pair.problem(10).cost(first.assignment) < pair.problem(10).cost(start)
    again = run(refine_steps(pair, first.assignment, [10]))[0]
    assert pair.problem(10).cost(again.assignment) <= pair.problem(10).cost(first.assignment) * (1 + 1e-9)
    for level, size in ((first, 10), (second, 20)):
        assert level.assignment.shape == (size,)
        assert len(np.unique(level.assignment)) == size
        assert 1 <= level.iterations <= 8


def test_where_distances_cannot_tell_the_other_term_decides():
    # Points and their mirror images have the same distances, also from the first point, which is its own.
    rng = np.random.default_rng(2)
    half = rng.normal([4, 0, 0], size=(8, 3))
    places = np.concatenate([[[0.0, 0, 0]], half, half * [-1, 1, 1]])
    pair = PointPair(places, places, MatchSettings())
    for truth in (np.arange(17), np.concatenate([[0], np.roll(np.arange(1, 17), 8)])):
        term = np.ones((17, 17))
        term[np.arange(17), truth] = 0
        found = run(refine_steps(pair, np.array([0]), [9, 17], 50 * term))
        for level in found:
            np.testing.assert_array_equal(level.assignment, truth[: len(level.assignment)])


def test_progress_names_the_points_of_each_level():
    pair, truth = moved_points(3, 12)
    steps = list(refine_steps(pair, truth[:3], [3, 6, 12]))
    assert [step.label for step in steps] == [f"Matching {n} points" for n in (3, 6, 12)]
    assert [step.fraction for step in steps] == pytest.approx([0, 1 / 3, 2 / 3])
