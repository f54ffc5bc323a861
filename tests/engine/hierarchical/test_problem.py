# SPDX-License-Identifier: GPL-3.0-or-later
"""The distortion of a correspondence."""

import numpy as np
import pytest

from engine.hierarchical.problem import MatchingProblem
from engine.runtime.errors import MatchError
from tests.problems import random_problem, relabelled


def test_cost_is_the_double_sum_of_the_paper():
    problem = random_problem(0, 4, 6, weight=2.5)
    assignment = np.array([5, 0, 3, 1])
    linear = sum(problem.linear[i, assignment[i]] for i in range(4))
    quadratic = sum(
        (problem.source_distances[i, k] - problem.target_distances[assignment[i], assignment[k]]) ** 2
        for i in range(4)
        for k in range(4)
    )
    assert problem.linear_cost(assignment) == pytest.approx(linear)
    assert problem.quadratic_cost(assignment) == pytest.approx(quadratic)
    assert problem.cost(assignment) == pytest.approx(linear + 2.5 * quadratic)


def test_a_shape_matched_to_itself_costs_nothing():
    distances = random_problem(1, 3, 5).target_distances
    problem = MatchingProblem(np.zeros((5, 5)), distances, distances)
    assert problem.cost(np.arange(5)) == 0
    assert problem.cost(np.array([1, 0, 2, 3, 4])) > 0


def test_cost_does_not_depend_on_the_order_of_points_and_candidates():
    problem = random_problem(2, 5, 7)
    rng = np.random.default_rng(0)
    rows, columns = rng.permutation(5), rng.permutation(7)
    assignment = np.array([6, 2, 0, 5, 1])
    new_number = np.argsort(columns)
    assert relabelled(problem, rows, columns).cost(new_number[assignment[rows]]) == pytest.approx(
        problem.cost(assignment)
    )


def test_forbidden_pairs_cost_infinitely_much():
    problem = random_problem(3, 3, 3)
    linear = problem.linear.copy()
    linear[1, 2] = np.inf
    problem = MatchingProblem(linear, problem.source_distances, problem.target_distances)
    assert problem.cost(np.array([0, 2, 1])) == np.inf
    assert problem.cost(np.array([0, 1, 2])) < np.inf


def test_arrays_that_do_not_fit_together_are_refused():
    with pytest.raises(MatchError, match=r"\(4, 4\)"):
        MatchingProblem(np.zeros((3, 5)), np.zeros((4, 4)), np.zeros((5, 5)))


def test_more_points_than_candidates_are_refused():
    with pytest.raises(MatchError, match="5 points cannot be matched one to one to 3 candidates"):
        MatchingProblem(np.zeros((5, 3)), np.zeros((5, 5)), np.zeros((3, 3)))
