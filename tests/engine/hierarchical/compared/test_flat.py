# SPDX-License-Identifier: GPL-3.0-or-later
"""Flat quadratic matching."""

import copy
from itertools import permutations

import numpy as np
import pytest

from engine import MatchError, MatchSettings, Shape, TriangleMesh, run
from engine.hierarchical.compared.flat import flat_candidates
from engine.hierarchical.exact.branch_and_bound import distinct_matchings_steps
from engine.hierarchical.sampled_pair import Pair
from tests.shapes import creature


@pytest.fixture(scope="module")
def pair():
    shapes = [Shape(TriangleMesh(*creature(pose, 9, turn)[:2])) for pose, turn in ((0.0, 0.0), (0.7, 0.5))]
    for shape in shapes:
        run(shape.sample_steps(120))
    return Pair(*shapes, MatchSettings())


def flat(pair, points, candidates=None, count=1, **options):
    """Match points to as many candidates as flat matching offers, if it is not said to how many."""
    candidates = candidates or flat_candidates(points, len(pair.target.samples))
    return run(distinct_matchings_steps(pair.problem(points, candidates), count, **options))


def test_it_is_the_best_of_all_assignments(pair):
    (found,) = flat(pair, 4, 8, node_limit=10**6)
    problem = pair.problem(4, 8)
    costs = [problem.cost(np.array(assignment)) for assignment in permutations(range(8), 4)]
    assert found.proven
    assert found.cost == pytest.approx(min(costs))
    assert problem.cost(found.assignment) == pytest.approx(found.cost)


def test_all_points_are_matched_at_once_to_twice_as_many(pair):
    (found,) = flat(pair, 12, node_limit=10**6)
    assert found.proven
    assert len(set(found.assignment.tolist())) == 12
    assert found.assignment.max() < 24
    (alike,) = flat(pair, 12, 24, node_limit=10**6)
    np.testing.assert_array_equal(alike.assignment, found.assignment)


def test_stopped_early_it_bounds_the_optimum(pair):
    hard = copy.copy(pair)
    hard.linear = np.zeros_like(pair.linear)  # distances alone: the root cannot prove it
    (full,) = flat(hard, 14, node_limit=10**6)
    (stopped,) = flat(hard, 14, node_limit=1)
    assert full.proven
    assert full.nodes > 1
    assert stopped.nodes < full.nodes
    assert not stopped.proven
    assert stopped.lower_bound <= full.cost <= stopped.cost + 1e-9


def test_distinct_matchings_lie_apart(pair):
    first, second = flat(pair, 8, count=2, radius=0.3, node_limit=10**6)
    assert first.cost <= second.cost
    apart = pair.target_distances[first.assignment, second.assignment] > 0.3
    assert apart.sum() >= 4


def test_as_many_candidates_are_offered_as_an_exact_search_takes():
    assert flat_candidates(10, 512) == 20
    assert flat_candidates(64, 512) == 78
    assert flat_candidates(70, 512) == 71
    assert flat_candidates(10, 15) == 15
    assert flat_candidates(200, 512) == 200


def test_too_many_points_are_refused(pair):
    with pytest.raises(MatchError, match="too many"):
        flat(pair, 80, node_limit=10)
    with pytest.raises(MatchError, match="fewer points"):
        flat(pair, 20, 10, node_limit=10)
