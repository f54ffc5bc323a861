# SPDX-License-Identifier: GPL-3.0-or-later
from itertools import permutations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from engine.hierarchical.problem import MatchingProblem
from engine.hierarchical.relaxation import RelaxedMatching, descend, project


def random_problem(seed, n=6, m=9, weight=0.7):
    """Points in the plane: the distances are a metric, as on a surface."""
    rng = np.random.default_rng(seed)
    x, y = rng.random((n, 2)), rng.random((m, 2))
    distances = [np.linalg.norm(p[:, None] - p, axis=2) for p in (x, y)]
    return MatchingProblem(rng.random((n, m)), *distances, weight)


def random_candidates(seed, n=6, m=9, k=4):
    rng = np.random.default_rng(seed)
    return np.stack([rng.permutation(m)[:k] for _ in range(n)])


@given(st.integers(0, 10_000))
def test_value_is_the_distortion_written_out(seed):
    problem, candidates = random_problem(seed), random_candidates(seed)
    mixture = np.random.default_rng(seed).dirichlet(np.ones(4), 6)
    d_x, d_y = problem.source_distances, problem.target_distances
    expected = np.take_along_axis(problem.linear, candidates, axis=1).ravel() @ mixture.ravel()
    for i in range(6):
        for k in range(6):
            difference = d_x[i, k] - d_y[np.ix_(candidates[i], candidates[k])]
            expected += problem.quadratic_weight * mixture[i] @ np.square(difference) @ mixture[k]
    value, _ = RelaxedMatching(problem, candidates).value_and_gradient(mixture)
    assert value == pytest.approx(expected)


@given(st.integers(0, 10_000))
def test_gradient_agrees_with_finite_differences_along_the_simplex(seed):
    rng = np.random.default_rng(seed)
    relaxed = RelaxedMatching(random_problem(seed), random_candidates(seed))
    mixture, direction = rng.dirichlet(np.ones(4), 6), rng.standard_normal((6, 4))
    direction -= direction.mean(axis=1, keepdims=True)
    step = 1e-6
    ahead, behind = (relaxed.value_and_gradient(mixture + s * direction)[0] for s in (step, -step))
    slope = np.vdot(relaxed.value_and_gradient(mixture)[1], direction)
    assert (ahead - behind) / (2 * step) == pytest.approx(slope, rel=1e-5, abs=1e-7)


def test_an_integer_mixture_costs_what_its_assignment_costs():
    problem = random_problem(5)
    candidates = np.tile(np.arange(9), (6, 1))
    assignment = np.array([3, 1, 8, 0, 2, 5])
    value, _ = RelaxedMatching(problem, candidates).value_and_gradient(np.eye(9)[assignment])
    assert value == pytest.approx(problem.cost(assignment))


@pytest.mark.parametrize("scale", [1e-6, 1e3])
def test_the_size_of_the_weights_does_not_matter(scale):
    problem, candidates = random_problem(8), random_candidates(8)
    scaled = MatchingProblem(
        scale * problem.linear, problem.source_distances, problem.target_distances, scale * problem.quadratic_weight
    )
    mixture = RelaxedMatching(problem, candidates).solve()
    np.testing.assert_allclose(RelaxedMatching(scaled, candidates).solve(), mixture, atol=1e-6)
    start = np.argsort(candidates[:, 0]) % 9
    np.testing.assert_array_equal(descend(scaled, start), descend(problem, start))


def test_solution_is_a_stationary_point_better_than_the_uniform_mixture():
    relaxed = RelaxedMatching(random_problem(8), random_candidates(8))
    mixture = relaxed.solve(500)
    np.testing.assert_allclose(mixture.sum(axis=1), 1)
    value, gradient = relaxed.value_and_gradient(mixture)
    assert value < relaxed.value_and_gradient(np.full((6, 4), 0.25))[0]
    # Where there is mass the gradient is level within a row: no exchange of mass lowers the value.
    assert (mixture * (gradient - gradient.min(axis=1, keepdims=True))).sum() < 1e-3


@given(st.integers(0, 10_000))
def test_projection_takes_most_mass_one_to_one(seed):
    rng = np.random.default_rng(seed)
    candidates = np.stack([np.append(rng.permutation(7)[:2], 7 + i) for i in range(4)])
    mixture = rng.dirichlet(np.ones(3), 4)
    chosen = project(mixture, candidates)
    assert len(set(chosen)) == 4

    def mass(assignment):
        hits = candidates == np.asarray(assignment)[:, None]
        return mixture[hits].sum() if hits.any(axis=1).all() else -1

    best = max(mass([candidates[i, c] for i, c in enumerate(choice)]) for choice in _one_to_one(candidates))
    assert mass(chosen) == pytest.approx(best)


def _one_to_one(candidates):
    from itertools import product

    for choice in product(range(candidates.shape[1]), repeat=len(candidates)):
        if len({candidates[i, c] for i, c in enumerate(choice)}) == len(candidates):
            yield choice


@settings(max_examples=25)
@given(st.integers(0, 10_000))
def test_descent_ends_where_no_single_move_helps(seed):
    problem = random_problem(seed, n=5, m=8)
    start = np.random.default_rng(seed).permutation(8)[:5]
    end = descend(problem, start)
    assert len(set(end)) == 5
    assert problem.cost(end) <= problem.cost(start)
    for i in range(5):
        for free in set(range(8)) - set(end):
            moved = end.copy()
            moved[i] = free
            assert problem.cost(moved) >= problem.cost(end) - 1e-7


def test_descent_from_the_optimum_stays_there():
    problem = random_problem(4, n=5, m=6)
    optimum = min((np.array(p) for p in permutations(range(6), 5)), key=problem.cost)
    assert descend(problem, optimum).tolist() == optimum.tolist()
