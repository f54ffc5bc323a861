# SPDX-License-Identifier: GPL-3.0-or-later
"""All matchings below a limit, each once."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from engine.hierarchical.exact import enumeration
from engine.hierarchical.exact.dual_ascent import dual_ascent_steps, pair_model
from engine.hierarchical.exact.enumeration import Enumeration
from engine.hierarchical.exact.exclusion import Exclusion
from engine.runtime.progress import run
from tests.problems import all_costs, brute_force, random_problem, shape_problem


def visited(search, limit):
    """All matchings that a search completes, and their bounds."""
    found = {}
    while not search.finished:
        bounds, matchings = search.step(limit)
        assert (np.diff(bounds) >= 0).all()
        for bound, matching in zip(bounds, matchings.tolist(), strict=True):
            assert tuple(matching) not in found
            found[tuple(matching)] = bound
    return found


def below(problem, limit, exclusions=()):
    """All matchings of a problem that cost less, and their costs."""
    return {
        tuple(assignment.tolist()): cost
        for assignment, cost in zip(*all_costs(problem), strict=True)
        if cost < limit and all(exclusion.allows(assignment) for exclusion in exclusions)
    }


@given(
    seed=st.integers(0, 10**6),
    size=st.sampled_from([(1, 1), (1, 3), (2, 4), (3, 3), (4, 5)]),
    kind=st.sampled_from(["table", "plane"]),
    part=st.sampled_from([0.1, 0.5, 1.0]),
)
@settings(max_examples=60, deadline=None)
def test_just_the_matchings_below_the_limit_are_visited(seed, size, kind, part):
    problem = random_problem(seed, *size, kind=kind, forbidden=0.2 * (seed % 2))
    costs = np.sort(all_costs(problem)[1])
    costs = costs[np.isfinite(costs)]
    model = pair_model(problem)
    limit = costs[int(part * (len(costs) - 1))] + 1e-6 if len(costs) else model.cap / 2
    found, truth = visited(Enumeration(model), limit), below(problem, limit)
    assert found.keys() == truth.keys()
    for matching, bound in found.items():
        assert bound == pytest.approx(truth[matching], abs=1e-9)


@pytest.mark.parametrize("seed", range(5))
def test_after_a_dual_ascent_none_is_missed(seed):
    problem = random_problem(seed, 4, 6)
    limit = float(np.quantile(all_costs(problem)[1], 0.1))
    model = run(dual_ascent_steps(pair_model(problem), 10))
    assert model.eliminate(limit)
    found, truth = visited(Enumeration(model.compact()), limit), below(problem, limit)
    assert truth.keys() <= found.keys()
    for matching, cost in truth.items():
        assert found[matching] <= cost + 1e-9


@pytest.mark.parametrize("count", [0, 2, 4, 5])
def test_exclusions_are_kept_to(count):
    problem = random_problem(11, 4, 5)
    exclusions = [Exclusion(np.random.default_rng(0).random((4, 5)) < 0.6, count)]
    model = pair_model(problem, exclusions)
    limit = model.cap / 2
    truth = below(problem, limit, exclusions)
    assert (not truth) == (count == 5)
    assert visited(Enumeration(model), limit).keys() == truth.keys()


@pytest.mark.parametrize("sweeps", [1, 8])
def test_with_multipliers_all_that_keep_to_exclusions_are_visited(sweeps):
    problem = shape_problem(0, 5, 7)
    best = pair_model(problem).unary.argmin(axis=1)
    exclusions = [Exclusion(problem.target_distances[best] > 0.4, 3)]
    limit = brute_force(problem, exclusions) * 1.3
    model = run(dual_ascent_steps(pair_model(problem, exclusions), sweeps))
    found, truth = visited(Enumeration(model), limit), below(problem, limit, exclusions)
    assert len(truth) > 1
    assert truth.keys() <= found.keys()
    for matching in found:
        assert exclusions[0].allows(np.array(matching))


def test_the_bound_is_below_all_that_is_still_to_come():
    problem = random_problem(12, 4, 6)
    search, open_ones = Enumeration(pair_model(problem)), below(problem, np.inf)
    limit = max(open_ones.values()) + 1
    before = search.bound
    while not search.finished:
        assert search.bound <= min(open_ones.values()) + 1e-9
        for matching in search.step(limit)[1].tolist():
            open_ones.pop(tuple(matching))
        assert search.bound >= before - 1e-9
        before = search.bound
    assert not open_ones
    assert search.bound == np.inf


def test_a_limit_that_falls_on_the_way_finds_the_optimum():
    problem = shape_problem(1, 5, 7)
    search, best, whole = Enumeration(pair_model(problem)), 1e9, Enumeration(pair_model(problem))
    while not search.finished:
        bounds, _ = search.step(best)
        best = min(best, bounds.min(initial=np.inf))
    assert best == pytest.approx(brute_force(problem))
    visited(whole, 1e9)
    assert search.nodes < whole.nodes


def test_small_batches_visit_the_same(monkeypatch):
    problem = random_problem(13, 4, 6)
    limit = float(np.median(all_costs(problem)[1]))
    together = visited(Enumeration(pair_model(problem)), limit)
    monkeypatch.setattr(enumeration, "_BATCH", 1)
    assert visited(Enumeration(pair_model(problem)), limit) == together
    assert len(together) == pytest.approx(180, abs=1)


def test_below_the_optimum_nothing_is_visited():
    problem = random_problem(14, 4, 5)
    assert visited(Enumeration(pair_model(problem)), brute_force(problem) * 0.999) == {}
