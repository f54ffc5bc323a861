# SPDX-License-Identifier: GPL-3.0-or-later
"""The bound of Gilmore and Lawler, and the search that uses it."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.optimize import linear_sum_assignment

from engine.hierarchical.exact.gilmore_lawler import gilmore_lawler_bound
from engine.hierarchical.problem import MatchingProblem
from tests.problems import all_costs, branch_and_bound, brute_force, random_problem, relabelled


@given(
    seed=st.integers(0, 10**6),
    size=st.sampled_from([(1, 1), (1, 4), (2, 2), (2, 5), (4, 4), (5, 7)]),
    weight=st.sampled_from([0.0, 0.3, 50.0]),
    kind=st.sampled_from(["table", "plane", "ties"]),
)
@settings(max_examples=80, deadline=None)
def test_the_bound_never_exceeds_the_optimum(seed, size, weight, kind):
    problem = random_problem(seed, *size, weight=weight, kind=kind)
    optimum = brute_force(problem)
    assert gilmore_lawler_bound(problem) <= optimum + 1e-9 * max(1.0, optimum)


@pytest.mark.parametrize("size", [(3, 3), (3, 5), (4, 6)])
def test_it_is_the_assignment_over_the_best_of_each_row_alone(size):
    # By definition: for x at y, the best that the other points could do as far as distances to x and y go.
    n, m = size
    problem = random_problem(1, n, m, weight=1.5)
    every, _ = all_costs(problem)
    cost = np.full((n, m), np.inf)
    for assignment in every:
        for i in range(n):
            apart = problem.source_distances[i] - problem.target_distances[assignment[i], assignment]
            alone = problem.linear[i, assignment[i]] + 1.5 * (apart**2).sum()
            cost[i, assignment[i]] = min(cost[i, assignment[i]], alone)
    rows, columns = linear_sum_assignment(cost)
    assert gilmore_lawler_bound(problem) == pytest.approx(cost[rows, columns].sum())


def test_without_quadratic_term_it_is_the_optimum():
    problem = random_problem(2, 5, 8, weight=0.0)
    assert gilmore_lawler_bound(problem) == pytest.approx(brute_force(problem))


def test_a_shape_and_its_copy_are_bounded_by_zero():
    distances = random_problem(3, 4, 6).target_distances
    assert gilmore_lawler_bound(MatchingProblem(np.zeros((6, 6)), distances, distances)) == pytest.approx(0, abs=1e-12)


def test_the_bound_does_not_depend_on_the_order():
    problem = random_problem(4, 5, 8)
    rng = np.random.default_rng(0)
    other = relabelled(problem, rng.permutation(5), rng.permutation(8))
    assert gilmore_lawler_bound(other) == pytest.approx(gilmore_lawler_bound(problem))


@given(
    seed=st.integers(0, 10**6),
    size=st.sampled_from([(1, 1), (1, 4), (4, 4), (6, 6), (5, 7)]),
    weight=st.sampled_from([0.0, 1.0, 50.0]),
    kind=st.sampled_from(["table", "plane", "ties"]),
)
@settings(max_examples=40, deadline=None)
def test_its_search_finds_the_optimum(seed, size, weight, kind):
    problem = random_problem(seed, *size, weight=weight, kind=kind)
    found = branch_and_bound(problem, method="gilmore-lawler")
    assert found.proven
    assert found.cost == pytest.approx(brute_force(problem), rel=1e-6, abs=1e-9)


@pytest.mark.parametrize("limit", [1, 3, 10, 30])
def test_its_search_bounds_the_optimum_when_stopped(limit):
    problem = random_problem(6, 7, 7)
    optimum = brute_force(problem)
    found = branch_and_bound(problem, method="gilmore-lawler", node_limit=limit)
    assert found.lower_bound <= optimum * (1 + 1e-9)
    assert found.cost >= optimum * (1 - 1e-9)
    assert gilmore_lawler_bound(problem) <= found.lower_bound * (1 + 1e-9)
