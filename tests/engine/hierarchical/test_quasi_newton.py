# SPDX-License-Identifier: GPL-3.0-or-later
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.optimize import minimize, rosen, rosen_der

from engine.hierarchical.quasi_newton import minimize_lbfgs


@given(st.integers(0, 10_000))
def test_quadratics_end_in_their_minimum(seed):
    rng = np.random.default_rng(seed)
    factor = rng.standard_normal((12, 12))
    matrix = factor @ factor.T + 0.1 * np.eye(12)
    target = rng.standard_normal(12)
    x, value = minimize_lbfgs(
        lambda x: ((x - target) @ matrix @ (x - target) / 2, matrix @ (x - target)), np.zeros(12), 500
    )
    assert value < 1e-5
    assert np.linalg.norm(matrix @ (x - target)) < 1e-2


def test_a_curved_valley_is_followed_to_its_end():
    start = np.full(8, -1.0)
    x, value = minimize_lbfgs(lambda x: (float(rosen(x)), rosen_der(x)), start, 1000)
    np.testing.assert_allclose(x, 1, atol=1e-2)
    assert value == pytest.approx(rosen(x))


def test_it_does_about_as_well_as_scipy_in_as_many_steps():
    rng = np.random.default_rng(3)
    angles = rng.standard_normal((30, 40))

    def objective(x):
        return float(np.cos(angles @ x).sum() + x @ x / 2), x - angles.T @ np.sin(angles @ x)

    start = 0.1 * rng.standard_normal(40)
    _, value = minimize_lbfgs(objective, start, 60)
    peer = minimize(objective, start, jac=True, method="L-BFGS-B", options={"maxiter": 60})
    assert value <= objective(start)[0]
    assert value <= peer.fun + 0.1 * (objective(start)[0] - peer.fun)


def test_the_value_never_rises_and_a_minimum_is_left_alone():
    seen = []

    def objective(x):
        seen.append(float(np.abs(x).sum() ** 1.5 + x @ x))
        return seen[-1], 1.5 * np.abs(x).sum() ** 0.5 * np.sign(x) + 2 * x

    _, value = minimize_lbfgs(objective, np.array([3.0, -2.0]), 50)
    assert value <= seen[0]
    x, value = minimize_lbfgs(lambda x: (float(x @ x), 2 * x), np.zeros(4), 10)
    assert value == 0
    assert not x.any()
