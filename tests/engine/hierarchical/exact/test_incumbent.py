# SPDX-License-Identifier: GPL-3.0-or-later
"""The best matching so far: what may be it, and what is."""

import numpy as np
import pytest

from engine.hierarchical.exact.exclusion import Exclusion
from engine.hierarchical.exact.incumbent import TOLERANCE, Incumbent
from engine.hierarchical.problem import MatchingProblem
from tests.problems import all_costs, brute_force, random_problem


def test_of_all_matchings_the_best_is_kept():
    problem = random_problem(0, 4, 6)
    incumbent = Incumbent(problem)
    best = np.inf
    for assignment, cost in zip(*all_costs(problem), strict=True):
        incumbent.offer(assignment)
        best = min(best, cost)
        assert incumbent.cost == pytest.approx(best)
    assert problem.cost(incumbent.assignment) == incumbent.cost


def test_of_equal_ones_the_first_is_kept():
    incumbent = Incumbent(MatchingProblem(np.zeros((2, 2)), np.zeros((2, 2)), np.zeros((2, 2))))
    incumbent.offer(np.array([1, 0]))
    incumbent.offer(np.array([0, 1]))
    assert incumbent.assignment.tolist() == [1, 0]


@pytest.mark.parametrize("bad", [[0, 1], [0, 1, 2, 3], [0, 1, 1], [0, 1, -1], [0, 1, 5], [[0, 1, 2]]])
def test_what_is_no_matching_is_not_feasible(bad):
    incumbent = Incumbent(random_problem(1, 3, 5))
    assert incumbent.feasible(np.array([0, 1, 4]))
    assert not incumbent.feasible(np.array(bad))
    incumbent.offer(np.array(bad), improve=True)
    assert incumbent.assignment is None
    assert incumbent.cost == np.inf


def test_forbidden_pairs_are_not_feasible():
    problem = random_problem(2, 3, 4, forbidden=0.4)
    every, costs = all_costs(problem)
    incumbent = Incumbent(problem)
    feasible = [incumbent.feasible(assignment) for assignment in every]
    assert 0 < sum(feasible) < len(every)
    np.testing.assert_array_equal(feasible, np.isfinite(costs))


@pytest.mark.parametrize("improve", [False, True])
def test_exclusions_are_kept_to(improve):
    problem = random_problem(3, 4, 5)
    every, costs = all_costs(problem)
    best = every[costs.argmin()]
    moved = np.ones((4, 5), bool)
    moved[np.arange(4), best] = False
    exclusions = [Exclusion(moved, 2)]
    incumbent = Incumbent(problem, exclusions)
    assert not incumbent.feasible(best)
    for assignment in every:
        incumbent.offer(assignment, improve=improve)
        assert incumbent.assignment is None or (incumbent.assignment != best).sum() >= 2
    assert incumbent.cost == pytest.approx(brute_force(problem, exclusions))
    assert incumbent.cost > costs.min()


def test_improving_never_makes_it_dearer_and_leaves_a_matching():
    problem = random_problem(4, 6, 9)
    rng = np.random.default_rng(0)
    gained = 0
    for _ in range(20):
        offered = rng.permutation(9)[:6]
        incumbent = Incumbent(problem)
        incumbent.offer(offered, improve=True)
        assert incumbent.feasible(incumbent.assignment)
        assert incumbent.cost <= problem.cost(offered) + 1e-12
        assert incumbent.cost == problem.cost(incumbent.assignment)
        gained += incumbent.cost < problem.cost(offered) - 1e-3
    assert gained > 10


@pytest.mark.parametrize("kind", ["table", "plane", "ties"])
def test_before_anything_is_found_any_matching_is_of_interest_and_nothing_forbidden_is(kind):
    problem = random_problem(5, 4, 5, weight=2.0, forbidden=0.2, kind=kind)
    incumbent = Incumbent(problem)
    costs = all_costs(problem)[1]
    assert costs[np.isfinite(costs)].max() < incumbent.limit < incumbent.cap


def test_afterwards_only_what_is_cheaper_than_a_proof_can_tell():
    problem = random_problem(6, 4, 5)
    incumbent = Incumbent(problem)
    incumbent.offer(np.arange(4))
    assert incumbent.limit < incumbent.cost
    assert incumbent.limit == pytest.approx(incumbent.cost * (1 - TOLERANCE), rel=1e-9)


def test_at_an_optimum_of_zero_rounding_is_of_no_interest():
    distances = random_problem(7, 2, 5).target_distances
    incumbent = Incumbent(MatchingProblem(np.zeros((5, 5)), distances, distances))
    incumbent.offer(np.arange(5))
    assert incumbent.cost == 0
    assert -1e-9 < incumbent.limit < 0
