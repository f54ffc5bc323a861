# SPDX-License-Identifier: GPL-3.0-or-later
"""Beam search, and the search by moves and swaps."""

import itertools

import numpy as np
import pytest
from scipy.optimize import linear_sum_assignment

from engine.hierarchical.exact.dual_ascent import dual_ascent_steps, pair_model
from engine.hierarchical.exact.exclusion import Exclusion
from engine.hierarchical.exact.local_search import beam_search, improve_matching
from engine.hierarchical.problem import MatchingProblem
from engine.runtime.progress import run
from tests.problems import brute_force, random_problem, shape_problem


def neighbours(assignment, m):
    """Every matching that differs by one move or one swap."""
    n = len(assignment)
    for i, a in itertools.product(range(n), set(range(m)) - set(assignment.tolist())):
        yield np.where(np.arange(n) == i, a, assignment)
    for i, k in itertools.combinations(range(n), 2):
        swapped = assignment.copy()
        swapped[[i, k]] = swapped[[k, i]]
        yield swapped


@pytest.mark.parametrize("seed", range(8))
@pytest.mark.parametrize(("n", "m"), [(1, 3), (5, 5), (6, 9)])
def test_no_move_or_swap_improves_the_result(seed, n, m):
    problem = random_problem(seed, n, m, forbidden=0.0 if seed % 2 else 0.1)
    _, start = linear_sum_assignment(problem.linear)
    result = improve_matching(problem, start)
    assert len(set(result.tolist())) == n
    assert problem.cost(result) <= problem.cost(start)
    best = min((problem.cost(other) for other in neighbours(result, m)), default=np.inf)
    assert best >= problem.cost(result) * (1 - 1e-9)


@pytest.mark.parametrize("seed", range(8))
def test_the_result_keeps_to_the_exclusions_and_is_best_among_its_neighbours_that_do(seed):
    n, m = 6, 8
    problem = random_problem(seed, n, m)
    rng = np.random.default_rng(seed)
    start = rng.permutation(m)[:n]
    moved = rng.random((n, m)) < 0.5
    exclusion = Exclusion(moved, int(moved[np.arange(n), start].sum()))
    result = improve_matching(problem, start, [exclusion])
    assert exclusion.allows(result)
    allowed = [problem.cost(other) for other in neighbours(result, m) if exclusion.allows(other)]
    assert min(allowed, default=np.inf) >= problem.cost(result) * (1 - 1e-9)


@pytest.mark.parametrize("n", [4, 8])
def test_points_that_are_alike_but_for_rounding_are_not_exchanged_for_ever(n):
    # Each is as far from all others, so exchanging two changes nothing; but what that costs is lost in rounding.
    away = 1.0 - np.eye(n)
    random = np.random.default_rng(n).integers(-3, 4, (n, n)) * np.finfo(float).eps
    problem = MatchingProblem(np.zeros((n, n)), away + np.triu(random, 1) + np.triu(random, 1).T, away)
    start = np.arange(n)
    assert problem.cost(improve_matching(problem, start)) <= problem.cost(start)


def test_the_start_is_not_changed():
    problem = random_problem(0, 5, 7)
    start = np.arange(5)
    improve_matching(problem, start)
    assert (start == np.arange(5)).all()


def test_a_wide_beam_tries_everything():
    for seed in range(5):
        problem = random_problem(seed, 4, 5)
        matchings = beam_search(pair_model(problem), 1000)
        assert len(matchings) == 5 * 4 * 3 * 2
        assert min(problem.cost(c) for c in matchings) == pytest.approx(brute_force(problem))


def test_the_beam_finds_the_pose_after_dual_ascent():
    problem = shape_problem(3, 12, 24, noise=0.01)
    matchings = beam_search(run(dual_ascent_steps(pair_model(problem), 30)), 20)
    assert all(len(set(c.tolist())) == 12 for c in matchings)
    exact = improve_matching(problem, matchings[0])
    assert problem.cost(matchings[0]) == pytest.approx(problem.cost(exact))


def test_the_beam_heeds_exclusions():
    problem = random_problem(5, 5, 6)
    moved = np.ones((5, 6), dtype=bool)
    moved[np.arange(5), np.arange(5)] = False
    exclusion = Exclusion(moved, 5)  # a derangement
    matchings = beam_search(pair_model(problem, [exclusion]), 10)
    assert len(matchings) > 0
    assert all(exclusion.allows(c) for c in matchings)


def test_the_beam_returns_nothing_where_nothing_is_allowed():
    linear = np.full((2, 3), np.inf)
    linear[:, 0] = 1
    problem = MatchingProblem(linear, np.zeros((2, 2)), np.zeros((3, 3)))
    assert beam_search(pair_model(problem), 10).shape == (0, 2)
