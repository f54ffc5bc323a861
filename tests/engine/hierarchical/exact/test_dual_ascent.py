# SPDX-License-Identifier: GPL-3.0-or-later
"""The bound by dual ascent: it never exceeds what a matching costs, and it never falls."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.optimize import linear_sum_assignment

from engine.hierarchical.exact.dual_ascent import assignment_duals, dual_ascent_steps, pair_model
from engine.hierarchical.exact.exclusion import Exclusion
from engine.hierarchical.problem import MatchingProblem
from engine.runtime.progress import run
from tests.problems import all_costs, brute_force, random_problem, shape_problem


def model_cost(model, labels):
    """What a model says that labels (k,) cost."""
    k = len(labels)
    pairs = sum(model.pair[i, labels[i], j, labels[j]] for i in range(k) for j in range(i))
    return model.constant + model.unary[np.arange(k), labels].sum() + pairs


def labels_of(model, assignment):
    """The labels that stand for candidates, -1 where there is none."""
    found = model.labels == assignment[model.points][:, None]
    return np.where(found.any(axis=1), found.argmax(axis=1), -1)


@given(
    seed=st.integers(0, 10**6),
    size=st.sampled_from([(1, 1), (1, 4), (2, 2), (3, 5), (4, 4), (5, 6)]),
    weight=st.sampled_from([0.0, 0.1, 1.0, 100.0]),
    kind=st.sampled_from(["table", "plane", "ties"]),
    sweeps=st.integers(0, 12),
)
@settings(max_examples=80, deadline=None)
def test_a_model_never_overstates_any_matching(seed, size, weight, kind, sweeps):
    problem = random_problem(seed, *size, weight=weight, forbidden=0.2 * (seed % 2), kind=kind)
    every, costs = all_costs(problem)
    model = run(dual_ascent_steps(pair_model(problem), sweeps))
    scale = max(1.0, float(np.abs(costs[np.isfinite(costs)]).max(initial=1.0)))
    assert (model.unary >= 0).all()
    assert (model.pair >= -1e-9 * scale).all()
    for assignment, cost in zip(every, costs, strict=True):
        if np.isfinite(cost):
            assert model_cost(model, assignment) <= cost + 1e-9 * scale


@given(seed=st.integers(0, 10**6), count=st.integers(0, 4), sweeps=st.integers(1, 12))
@settings(max_examples=60, deadline=None)
def test_with_exclusions_it_never_overstates_what_keeps_to_them(seed, count, sweeps):
    problem = random_problem(seed, 4, 6)
    rng = np.random.default_rng(seed)
    exclusions = [Exclusion(rng.random((4, 6)) < 0.4, count), Exclusion(rng.random((4, 6)) < 0.6, 2)]
    model = run(dual_ascent_steps(pair_model(problem, exclusions), sweeps))
    assert (model.multipliers >= 0).all()
    for assignment, cost in zip(*all_costs(problem), strict=True):
        if all(exclusion.allows(assignment) for exclusion in exclusions):
            assert model_cost(model, assignment) <= cost + 1e-9


def test_an_exclusion_raises_the_bound():
    problem = shape_problem(0, 10, 16, noise=0.01)
    free = run(dual_ascent_steps(pair_model(problem), 40))
    best = free.unary.argmin(axis=1)
    exclusion = Exclusion(problem.target_distances[best] > 0.3, 5)
    kept_away = run(dual_ascent_steps(pair_model(problem, [exclusion]), 40))
    assert kept_away.constant > free.constant + 0.05


def test_square_matchings_keep_their_cost_exactly():
    problem = random_problem(4, 5, 5)
    model = run(dual_ascent_steps(pair_model(problem), 10))
    for assignment, cost in zip(*all_costs(problem), strict=True):
        assert model_cost(model, assignment) == pytest.approx(cost)


def test_the_bound_never_falls_and_is_below_random_matchings():
    problem = shape_problem(1, 12, 20)
    model = pair_model(problem)
    steps = dual_ascent_steps(model, 25, tolerance=0.0)
    constants = [model.constant for _ in steps]
    assert (np.diff(constants) >= -1e-12).all()
    assert constants[-1] > constants[0]
    rng = np.random.default_rng(0)
    assert all(constants[-1] <= problem.cost(rng.permutation(20)[:12]) for _ in range(200))


def test_without_quadratic_term_the_bound_is_the_linear_assignment():
    problem = random_problem(5, 6, 9, weight=0.0)
    rows, columns = linear_sum_assignment(problem.linear)
    model = run(dual_ascent_steps(pair_model(problem), 20))
    assert model.constant == pytest.approx(problem.linear[rows, columns].sum(), rel=1e-6)


def test_it_stops_at_the_limit():
    problem = shape_problem(2, 10, 16)
    full = run(dual_ascent_steps(pair_model(problem), 30)).constant
    model = pair_model(problem)
    limit = model.constant + 0.3 * (full - model.constant)
    steps = list(dual_ascent_steps(model, 30, limit))
    assert limit <= model.constant < full
    assert len(steps) < 29


@pytest.mark.parametrize("seed", range(5))
def test_elimination_and_compaction_keep_every_better_matching(seed):
    problem = shape_problem(seed, 5, 7)
    every, costs = all_costs(problem)
    limit = float(np.sort(costs)[10])
    model = run(dual_ascent_steps(pair_model(problem), 20))
    before = [model_cost(model, assignment) for assignment in every]
    assert model.eliminate(limit)
    compact = model.compact()
    assert compact.unary.shape[1] == model.alive.sum(axis=1).max()
    assert not model.alive.all()
    for assignment, cost, stated in zip(every, costs, before, strict=True):
        if cost < limit:
            labels = labels_of(compact, assignment)
            assert (labels >= 0).all()
            assert compact.alive[np.arange(5), labels].all()
            assert model_cost(compact, labels) == pytest.approx(stated)


def test_elimination_notices_when_nothing_is_left():
    problem = random_problem(0, 4, 6)
    model = run(dual_ascent_steps(pair_model(problem), 20))
    assert not model.eliminate(model.constant)


def test_a_choice_leaves_the_costs_of_the_matchings_that_agree():
    problem = random_problem(6, 5, 6)
    moved = np.random.default_rng(0).random((5, 6)) < 0.5
    moved[2, 4] = True
    exclusion = Exclusion(moved, 3)
    model = run(dual_ascent_steps(pair_model(problem, [exclusion]), 10))
    smaller = model.choose(2, 4)
    assert smaller.points.tolist() == [0, 1, 3, 4]
    assert smaller.needed.tolist() == [2]
    for assignment in all_costs(problem)[0]:
        if assignment[2] == 4:
            rest = assignment[smaller.points]
            assert model_cost(smaller, rest) == pytest.approx(model_cost(model, assignment))
    assert not smaller.alive[:, 4].any()


@given(seed=st.integers(0, 10**6), size=st.sampled_from([(1, 1), (1, 5), (4, 4), (5, 9), (8, 8)]), ties=st.booleans())
@settings(max_examples=60, deadline=None)
def test_assignment_duals_are_feasible_and_tight(seed, size, ties):
    rng = np.random.default_rng(seed)
    cost = rng.integers(-2, 3, size).astype(float) if ties else rng.normal(size=size)
    u, v, assignment = assignment_duals(cost)
    rows, columns = linear_sum_assignment(cost)
    assert u.sum() + v.sum() == pytest.approx(cost[rows, columns].sum(), abs=1e-9)
    assert (u[:, None] + v <= cost + 1e-9).all()
    assert (v <= 0).all()
    assert (v[np.setdiff1d(np.arange(size[1]), assignment)] == 0).all()


def test_the_bound_is_invariant_to_scale():
    problem = random_problem(7, 5, 8)
    larger = MatchingProblem(
        1e6 * problem.linear, 1e3 * problem.source_distances, 1e3 * problem.target_distances, problem.quadratic_weight
    )
    bound, large_bound = (run(dual_ascent_steps(pair_model(p), 15)).constant for p in (problem, larger))
    assert large_bound == pytest.approx(1e6 * bound)
    assert bound <= brute_force(problem)
