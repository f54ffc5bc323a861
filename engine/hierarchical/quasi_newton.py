# SPDX-License-Identifier: GPL-3.0-or-later
"""Limited-memory BFGS, for smooth functions without constraints."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from ..runtime.arrays import Floats

Objective = Callable[[Floats], tuple[float, Floats]]

_MEMORY = 10
_ARMIJO, _CURVATURE = 1e-4, 0.9
_SEARCHES = 20


def minimize_lbfgs(
    objective: Objective, start: Floats, max_iterations: int, tolerance: float = 1e-9
) -> tuple[Floats, float]:
    """Minimise a smooth function by a limited-memory quasi-Newton method with a Wolfe line search [1]_.

    SciPy's L-BFGS-B does the same and more, but hands vectors of a thousand numbers to a multithreaded linear algebra
    library; on a machine that is busy with something else it then waits ten times longer than it works.  Here are only
    sums of products.

    Parameters
    ----------
    objective : callable
        Takes (n,) and returns the value and the gradient (n,) there.
    start : (n,) array of float
        Where to start.
    max_iterations : int
        After how many steps to stop in any case.
    tolerance : float
        Stop when a step lowers the value by no more than this part of it (or of one, if it is smaller).

    Returns
    -------
    x : (n,) array of float
        The best point found.
    value : float
        The function there.

    References
    ----------
    .. [1] J. Nocedal, S. Wright, "Numerical Optimization", 2nd ed., algorithms 7.4 and 7.5.
    """
    x = start
    value, gradient = objective(x)
    memory: list[tuple[Floats, Floats, float]] = []
    for _ in range(max_iterations):
        direction = _newton_direction(gradient, memory)
        slope = _dot(gradient, direction)
        if slope >= 0:  # the memory has become useless
            memory.clear()
            direction, slope = -gradient, -_dot(gradient, gradient)
        if -slope <= tolerance**2 * (1 + abs(value)):
            break
        first = 1.0 if memory else min(1.0, 1.0 / np.sqrt(-slope))
        step, new_value, new_gradient = _search(objective, x, direction, (value, slope), first)
        if step == 0:
            break
        move, change = step * direction, new_gradient - gradient
        product = _dot(move, change)
        if product > 1e-10 * _dot(change, change):
            memory = [*memory[-_MEMORY + 1 :], (move, change, 1 / product)]
        decrease = value - new_value
        x, value, gradient = x + move, new_value, new_gradient
        if decrease <= tolerance * (1 + abs(value)):
            break
    return x, value


def _newton_direction(gradient: Floats, memory: list[tuple[Floats, Floats, float]]) -> Floats:
    """Multiply the gradient by the approximate inverse Hessian (two-loop recursion)."""
    direction = -gradient
    shares = []
    for move, change, inverse in reversed(memory):
        share = inverse * _dot(move, direction)
        direction = direction - share * change
        shares.append(share)
    if memory:
        _, change, inverse = memory[-1]
        direction = direction / (inverse * _dot(change, change))
    for (move, change, inverse), share in zip(memory, reversed(shares), strict=True):
        direction = direction + (share - inverse * _dot(change, direction)) * move
    return direction


def _search(
    objective: Objective, x: Floats, direction: Floats, here: tuple[float, float], step: float
) -> tuple[float, float, Floats]:
    """Find a step that lowers the value enough and flattens the slope, by bracketing; 0 if there is none.

    `here` is the value and the slope at x.
    """
    value, slope = here
    low, high = 0.0, np.inf
    best: tuple[float, float, Floats] = (0.0, value, direction)
    for _ in range(_SEARCHES):
        new_value, new_gradient = objective(x + step * direction)
        new_slope = _dot(new_gradient, direction)
        if new_value > value + _ARMIJO * step * slope:
            high = step
        else:
            if new_value < best[1]:
                best = (step, new_value, new_gradient)
            if abs(new_slope) <= -_CURVATURE * slope:
                return step, new_value, new_gradient
            if new_slope < 0:
                low = step
            else:
                high = step
        step = (low + high) / 2 if np.isfinite(high) else 2 * step
    return best


def _dot(first: Floats, second: Floats) -> float:
    return float((first * second).sum())
