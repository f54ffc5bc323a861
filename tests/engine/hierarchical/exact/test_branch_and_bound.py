# SPDX-License-Identifier: GPL-3.0-or-later
"""The exact search: the optimum, a valid bound when stopped, and matchings that are truly different."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.optimize import linear_sum_assignment

from engine.hierarchical.exact import branch_and_bound as module
from engine.hierarchical.exact import incumbent as incumbent_module
from engine.hierarchical.exact.branch_and_bound import (
    branch_and_bound_steps,
    distinct_matchings_steps,
)
from engine.hierarchical.exact.exclusion import Exclusion
from engine.hierarchical.exact.incumbent import TOLERANCE
from engine.hierarchical.problem import MatchingProblem
from engine.runtime.errors import MatchError
from engine.runtime.progress import Progress, run
from tests.problems import all_costs, branch_and_bound, brute_force, random_problem, relabelled, shape_problem


def replaced(problem, **arrays):
    """Return the problem with some of its arrays replaced."""
    fields = ("linear", "source_distances", "target_distances", "quadratic_weight")
    return MatchingProblem(**({name: getattr(problem, name) for name in fields} | arrays))


def assert_is_optimum(found, problem, optimum):
    assert found.proven
    assert found.lower_bound == found.cost
    assert len(set(found.assignment.tolist())) == problem.size[0]
    assert found.cost == pytest.approx(problem.cost(found.assignment))
    assert found.cost == pytest.approx(optimum, rel=2 * TOLERANCE, abs=1e-9)


@given(
    seed=st.integers(0, 10**6),
    size=st.sampled_from([(1, 1), (1, 3), (2, 2), (3, 3), (3, 7), (5, 7), (6, 6), (7, 7), (4, 9)]),
    weight=st.sampled_from([0.0, 0.1, 1.0, 1000.0]),
    forbidden=st.sampled_from([0.0, 0.0, 0.3]),
    kind=st.sampled_from(["table", "plane", "ties"]),
)
@settings(max_examples=150, deadline=None)
def test_it_finds_what_trying_everything_finds(seed, size, weight, forbidden, kind):
    problem = random_problem(seed, *size, weight=weight, forbidden=forbidden, kind=kind)
    optimum = brute_force(problem)
    if np.isfinite(optimum):
        assert_is_optimum(branch_and_bound(problem), problem, optimum)
    else:
        with pytest.raises(MatchError, match="forbidden"):
            branch_and_bound(problem)


@given(
    seed=st.integers(0, 10**6),
    size=st.sampled_from([(1, 2), (3, 3), (4, 6), (6, 6), (5, 7)]),
    counts=st.lists(st.integers(0, 7), min_size=1, max_size=2),
    kind=st.sampled_from(["table", "plane", "ties"]),
)
@settings(max_examples=150, deadline=None)
def test_it_finds_the_best_that_keeps_to_the_exclusions(seed, size, counts, kind):
    problem = random_problem(seed, *size, forbidden=0.1 * (seed % 2), kind=kind)
    rng = np.random.default_rng(seed)
    exclusions = [Exclusion(rng.random(size) < rng.random(), count) for count in counts]
    if not np.isfinite(brute_force(problem)):
        return
    optimum = brute_force(problem, exclusions)
    found = branch_and_bound(problem, exclusions=exclusions)
    if np.isfinite(optimum):
        assert_is_optimum(found, problem, optimum)
        assert all(exclusion.allows(found.assignment) for exclusion in exclusions)
    else:
        assert found is None


@pytest.mark.parametrize(
    ("n", "m", "seed", "noise"), [(20, 20, 0, 0.1), (20, 20, 2, 0.2), (12, 24, 0, 0.1), (12, 24, 3, 0.15)]
)
def test_the_optimum_does_not_depend_on_the_start(n, m, seed, noise):
    # Charging a pair twice over-prunes and still passes tests by brute force; a good start then finds another optimum.
    problem = shape_problem(seed, n, m, noise=noise)
    best = branch_and_bound(problem)
    assert best.proven
    _, worst = linear_sum_assignment(-problem.linear)
    for initial in ([], [worst], [best.assignment]):
        found = branch_and_bound(problem, initial=initial)
        assert found.proven
        assert found.cost == pytest.approx(best.cost, rel=2 * TOLERANCE)


@pytest.fixture
def bad_start(monkeypatch):
    """Leave the search with one bad matching and no means to improve it: all else has to come from the tree."""

    def worst(problem, _exclusions):
        finite = np.where(np.isfinite(problem.linear), -problem.linear, np.inf)
        return [linear_sum_assignment(finite)[1]]

    monkeypatch.setattr(module, "beam_search", lambda model, _width: np.zeros((0, len(model.points)), dtype=np.int64))
    monkeypatch.setattr(module, "_feasible_matchings", worst)
    monkeypatch.setattr(incumbent_module, "improve_matching", lambda _problem, assignment, _exclusions: assignment)


@pytest.mark.usefixtures("bad_start")
@pytest.mark.parametrize("dive", [0, 10, 20_000])
def test_the_tree_alone_finds_the_optimum(monkeypatch, dive):
    monkeypatch.setattr(module, "_DIVE", dive)
    for seed in range(30):
        size = ((6, 6), (5, 8), (6, 7))[seed % 3]
        problem = random_problem(seed, *size, kind=("table", "plane", "ties")[seed // 3 % 3])
        rng = np.random.default_rng(seed)
        exclusions = [Exclusion(rng.random(size) < 0.5, 4)] if seed % 2 else []
        found = branch_and_bound(problem, exclusions=exclusions)
        assert_is_optimum(found, problem, brute_force(problem, exclusions))


@pytest.mark.usefixtures("bad_start")
def test_the_limit_of_nodes_holds_before_there_is_a_matching():
    problem = random_problem(3, 8, 12)
    start = linear_sum_assignment(-problem.linear)[1]
    away = [Exclusion(np.arange(12) != start[:, None], 8)]
    assert branch_and_bound(problem, exclusions=away, node_limit=1) is None
    found = branch_and_bound(problem, exclusions=away)
    assert found.proven
    assert (found.assignment != start).all()


@pytest.mark.usefixtures("bad_start")
def test_the_tree_alone_finds_the_optimum_of_a_larger_problem():
    problem = shape_problem(1, 20, 20, noise=0.15)
    start = branch_and_bound(problem, node_limit=1)
    found = branch_and_bound(problem)
    assert found.proven
    assert found.cost < 0.9 * start.cost
    _, cheapest = linear_sum_assignment(problem.linear)
    other = branch_and_bound(problem, initial=[cheapest])
    assert other.cost == pytest.approx(found.cost, rel=2 * TOLERANCE)


@pytest.mark.usefixtures("bad_start")
@pytest.mark.parametrize("dive", [10, 20_000])
def test_the_bound_is_valid_whenever_the_search_stops(monkeypatch, dive):
    monkeypatch.setattr(module, "_DIVE", dive)
    worse = 0
    for seed in range(6):
        problem = random_problem(seed, *((7, 7) if seed % 2 else (6, 8)))
        optimum = brute_force(problem)
        for node_limit in (1, 2, 5, 10, 20, 50, 100, 200, 400):
            found = branch_and_bound(problem, node_limit=node_limit)
            assert found.cost == pytest.approx(problem.cost(found.assignment))
            assert found.cost >= optimum * (1 - 1e-9)
            assert found.lower_bound <= optimum * (1 + 1e-9)
            assert found.proven == (found.lower_bound == found.cost)
            worse += found.cost > 1.01 * optimum
    assert worse > 5


@pytest.mark.parametrize("node_limit", [1, 10, 100])
def test_the_bound_of_a_larger_problem_is_valid_when_the_limit_stops_the_search(node_limit):
    for size in [(12, 16), (12, 12)]:
        problem = shape_problem(4, *size, noise=0.3)
        optimum = branch_and_bound(problem)
        assert optimum.proven
        found = branch_and_bound(problem, node_limit=node_limit)
        assert found.lower_bound <= optimum.cost * (1 + 1e-9)
        assert found.cost >= optimum.cost * (1 - 1e-9)


def test_more_nodes_never_weaken_what_is_known():
    problem = random_problem(2, 10, 16)
    found = [branch_and_bound(problem, node_limit=limit) for limit in (1, 1000, 10**7)]
    assert found[-1].proven
    costs = [f.cost for f in found]
    bounds = [f.lower_bound for f in found]
    assert costs == sorted(costs, reverse=True)
    assert bounds == sorted(bounds)


@given(
    seed=st.integers(0, 10**6),
    size=st.sampled_from([(2, 4), (4, 6), (6, 6), (5, 7)]),
    radius=st.sampled_from([0.0, 0.3, 0.6]),
    kind=st.sampled_from(["table", "plane", "ties"]),
)
@settings(max_examples=50, deadline=None)
def test_distinct_matchings_are_the_best_ones(seed, size, radius, kind):
    problem = random_problem(seed, *size, kind=kind)
    every, costs = all_costs(problem)
    allowed = np.ones(len(every), dtype=bool)
    found = run(distinct_matchings_steps(problem, 3, radius))
    for matching in found:
        assert_is_optimum(matching, problem, costs[allowed].min())
        apart = problem.target_distances[matching.assignment, every] > radius
        allowed &= 2 * apart.sum(axis=1) >= size[0]
    if len(found) < 3:
        assert not allowed.any()


def test_a_mirrored_shape_has_two_answers():
    # An isosceles chain: reversing it changes no distance, so both answers cost the same.
    places = np.array([0.0, 1.0, 2.5, 4.0, 5.0])
    distances = np.abs(places[:, None] - places)
    problem = MatchingProblem(np.zeros((5, 5)), distances, distances)
    first, second = run(distinct_matchings_steps(problem, 2, 0.5))
    assert sorted([first.assignment.tolist(), second.assignment.tolist()]) == [[0, 1, 2, 3, 4], [4, 3, 2, 1, 0]]
    assert first.cost == second.cost == 0
    assert first.proven
    assert second.proven


def test_a_shape_matched_to_itself_is_proven_to_cost_nothing():
    points = np.random.default_rng(0).random((12, 3))
    distances = np.linalg.norm(points[:, None] - points, axis=2)
    found = branch_and_bound(MatchingProblem(np.zeros((12, 12)), distances, distances))
    assert found.assignment.tolist() == list(range(12))
    assert found.proven
    assert found.cost == 0


@given(seed=st.integers(0, 10**6), size=st.sampled_from([(5, 5), (6, 10), (8, 8)]))
@settings(max_examples=25, deadline=None)
def test_the_optimum_does_not_depend_on_the_order(seed, size):
    problem = random_problem(seed, *size)
    rng = np.random.default_rng(seed)
    rows, columns = rng.permutation(size[0]), rng.permutation(size[1])
    found = branch_and_bound(problem)
    other = branch_and_bound(relabelled(problem, rows, columns))
    assert other.cost == pytest.approx(found.cost, rel=2 * TOLERANCE)
    # No ties in a random table: the matching itself is the same.
    assert columns[other.assignment].tolist() == found.assignment[rows].tolist()


@pytest.mark.parametrize("scale", [1e-6, 1e6])
def test_the_units_do_not_matter(scale):
    problem = shape_problem(0, 10, 20)
    found = branch_and_bound(problem)
    other = branch_and_bound(
        replaced(
            problem,
            linear=scale**2 * problem.linear,
            source_distances=scale * problem.source_distances,
            target_distances=scale * problem.target_distances,
        )
    )
    assert other.assignment.tolist() == found.assignment.tolist()
    assert other.cost == pytest.approx(scale**2 * found.cost)
    assert other.proven


def test_a_constant_added_to_the_descriptors_changes_only_the_cost():
    problem = shape_problem(1, 8, 14)
    found = branch_and_bound(problem)
    for offset in (-10.0, 10.0):
        other = branch_and_bound(replaced(problem, linear=problem.linear + offset))
        assert other.assignment.tolist() == found.assignment.tolist()
        assert other.cost == pytest.approx(found.cost + 8 * offset)
        assert other.proven


def test_the_same_input_gives_the_same_output():
    problem = random_problem(3, 10, 16)
    first, second = (branch_and_bound(problem, node_limit=500) for _ in range(2))
    assert first.assignment.tolist() == second.assignment.tolist()
    assert (first.cost, first.lower_bound, first.nodes) == (second.cost, second.lower_bound, second.nodes)


def test_the_problem_is_not_changed():
    problem = shape_problem(2, 8, 12)
    before = [a.copy() for a in (problem.linear, problem.source_distances, problem.target_distances)]
    run(distinct_matchings_steps(problem))
    after = (problem.linear, problem.source_distances, problem.target_distances)
    assert all((a == b).all() for a, b in zip(before, after, strict=True))


@pytest.mark.parametrize("size", [(10, 14), (10, 10)])
def test_progress_rises(size):
    problem = random_problem(5, *size)
    reports = list(branch_and_bound_steps(problem, node_limit=5000))
    assert all(isinstance(report, Progress) and 0 <= report.fraction <= 1 for report in reports)
    fractions = [report.fraction for report in reports]
    assert fractions == sorted(fractions)
    assert len(fractions) > 5


def test_starts_that_are_not_matchings_are_left_out():
    problem = random_problem(6, 4, 6)
    bad = [np.array([0, 0, 1, 2]), np.array([0, 1, 2, 6]), np.array([-1, 1, 2, 3]), np.array([0, 1]), np.array([])]
    assert branch_and_bound(problem, initial=bad).cost == pytest.approx(brute_force(problem))


def test_no_matching_far_enough_away_is_no_error():
    problem = random_problem(7, 4, 6)
    assert branch_and_bound(problem, exclusions=[Exclusion(np.zeros((4, 6), dtype=bool), 1)]) is None
    assert len(run(distinct_matchings_steps(problem, 3, radius=10.0))) == 1


def test_a_problem_without_any_matching_is_an_error():
    linear = np.ones((3, 4))
    linear[:2, 1:] = np.inf  # two points that only want the first candidate
    problem = replaced(random_problem(8, 3, 4), linear=linear)
    with pytest.raises(MatchError, match="No matching is possible"):
        branch_and_bound(problem)


def test_a_problem_that_needs_too_much_memory_is_refused():
    with pytest.raises(MatchError, match="100 points and 101 candidates are too many"):
        branch_and_bound(random_problem(9, 100, 101))
