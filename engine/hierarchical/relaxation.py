# SPDX-License-Identifier: GPL-3.0-or-later
"""The relaxed matching problem over small neighbourhoods, its quasi-Newton solution and its projection to integers."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy.optimize import linear_sum_assignment, minimize
from scipy.sparse import csr_array

from ..runtime.arrays import Floats, Ints, marked
from .problem import MatchingProblem

_SWEEPS = 50
"""Bound on the sweeps over all points of a descent; in practice a dozen are enough."""

_NOISE = 1e-9
"""Part of what the cost of a point is made of by which it falls if it falls at all: rounding is far less."""


@dataclass(frozen=True, eq=False)
class RelaxedMatching:
    r"""Match each of j points to a mixture of its own K candidates.

    Minimises :math:`\sum f_{ia} C_{ia} + \lambda \sum (d_X(i, k) - d_Y(a, b))^2 C_{ia} C_{kb}` over row-stochastic C,
    with the linear term f of the problem: equation 6 of the paper without the demand for integers, and without that for
    columns of C, equation 5, so that several points may share a candidate.  The (jK) x (jK) interaction is never built:
    with the square expanded, and rows of C that sum to one, what is left is a product of d_X with C d_Y, where C is
    sparse over the distinct candidates of all points.

    Parameters
    ----------
    problem : MatchingProblem
        The points against all m candidates.
    candidates : (j, K) array of int
        For each point the candidates that it may use, without repetition in a row.
    """

    problem: MatchingProblem
    candidates: Ints

    @cached_property
    def _used(self) -> tuple[Ints, Ints]:
        """The distinct candidates (u,), and where each of `candidates` stands among them (j, K)."""
        used, column = np.unique(self.candidates, return_inverse=True)
        return used, column.reshape(self.candidates.shape)

    @cached_property
    def _linear(self) -> Floats:
        return np.take_along_axis(self.problem.linear, self.candidates, axis=1)

    @cached_property
    def _target(self) -> Floats:
        used = self._used[0]
        return self.problem.target_distances[np.ix_(used, used)]

    @cached_property
    def _squares(self) -> tuple[Floats, Floats]:
        return np.square(self.problem.source_distances), np.square(self._target)

    @cached_property
    def _mixing(self) -> csr_array:
        """Matrix (j, u) that is filled with one mixture after another: to make it takes as long as to use it."""
        (j, k), (used, column) = self.candidates.shape, self._used
        return csr_array((np.zeros(j * k), column.ravel(), np.arange(0, j * k + 1, k)), shape=(j, len(used)))

    def value_and_gradient(self, mixture: Floats) -> tuple[float, Floats]:
        """Distortion of a mixture (j, K), and its derivative by each entry (j, K)."""
        used, column = self._used
        source_squared, target_squared = self._squares
        weight = self.problem.quadratic_weight
        rows = self._mixing
        rows.data[:] = mixture.ravel()
        mass = np.bincount(column.ravel(), mixture.ravel(), len(used))
        cross = np.take_along_axis(self.problem.source_distances @ (rows @ self._target), column, axis=1)
        row_sums = mixture.sum(axis=1)
        interaction = (source_squared @ row_sums)[:, None] - 2 * cross + (target_squared @ mass)[column]
        value = np.vdot(self._linear, mixture) + weight * np.vdot(interaction, mixture)
        return float(value), self._linear + 2 * weight * interaction

    def solve(self, max_iterations: int = 60) -> Floats:
        """Minimise from the uniform mixture, by a quasi-Newton method, L-BFGS.

        Rows are kept stochastic by a softmax.  The start is uniform on purpose: one that already leans to the present
        match is drawn to it and ends in a worse minimum.

        Returns
        -------
        (j, K) array of float
            The mixture; rows are not negative and sum to one.
        """
        shape = self.candidates.shape
        uniform, _ = self.value_and_gradient(np.full(shape, 1 / shape[1]))
        scale = 1 / uniform if uniform > 0 else 1.0  # so that it ends at the same place whatever the weights' size

        def softmax(logits: Floats) -> Floats:
            """Turn each row into a mixture: not negative, summing to one."""
            powers = np.exp(logits - logits.max(axis=1, keepdims=True))
            return powers / powers.sum(axis=1, keepdims=True)

        def objective(flat: Floats) -> tuple[float, Floats]:
            """Evaluate the distortion of the mixture of some logits, and its gradient by them."""
            mixture = softmax(flat.reshape(shape))
            value, gradient = self.value_and_gradient(mixture)
            gradient -= (gradient * mixture).sum(axis=1, keepdims=True)
            return scale * value, scale * (mixture * gradient).ravel()

        # The mixture is projected to integers next; more digits were not seen to give better matchings.
        ends = {"maxiter": max_iterations, "ftol": 1e-6, "gtol": 0.0}
        found = minimize(objective, np.zeros(self.candidates.size), jac=True, method="L-BFGS-B", options=ends)
        return softmax(found.x.reshape(shape))


def project(mixture: Floats, candidates: Ints) -> Ints:
    """Find the one-to-one assignment that takes most mass of a mixture.

    Parameters
    ----------
    mixture : (j, K) array of float
        Solution of a `RelaxedMatching`.
    candidates : (j, K) array of int
        Its candidates.

    Returns
    -------
    (j,) array of int
        For each point one of its own candidates, no two points the same.

    Raises
    ------
    ValueError
        If the candidates allow no such assignment.
    """
    used, column = np.unique(candidates, return_inverse=True)
    gain = np.full((len(candidates), len(used)), -np.inf)
    np.put_along_axis(gain, column.reshape(candidates.shape), mixture, axis=1)
    _, chosen = linear_sum_assignment(gain, maximize=True)
    return used[chosen]


def descend(problem: MatchingProblem, assignment: Ints) -> Ints:
    """Move one point at a time to the best free candidate, anywhere on Y, until no point can improve.

    This repairs what small neighbourhoods cannot: a point whose right place lies outside its neighbourhood.

    Parameters
    ----------
    problem : MatchingProblem
        The points against all m candidates.
    assignment : (j,) array of int
        Where to start, one-to-one.

    Returns
    -------
    (j,) array of int
        A one-to-one assignment that costs no more.
    """
    current = assignment.copy()
    source, target, linear = problem.source_distances, problem.target_distances, problem.linear
    to_matched = target[:, current]  # (m, j): distance from each candidate to the present match of each point
    squares = np.square(to_matched).sum(axis=1)
    free = ~marked(current, len(target))
    noise = _NOISE * (np.abs(linear[np.isfinite(linear)]).max() + problem.quadratic_weight * squares.max())
    for _ in range(_SWEEPS):
        moved = False
        for i in range(len(current)):
            # The square expanded, so that a point costs one matrix-vector product; the point's distance to itself is
            # zero wherever it goes, so it is taken out.
            misfit = squares - np.square(to_matched[:, i]) - 2 * (to_matched @ source[i]) + source[i] @ source[i]
            cost = linear[i] + 2 * problem.quadratic_weight * misfit
            here = cost[current[i]]
            cost[~free] = np.inf
            best = int(cost.argmin())
            if cost[best] < here - noise:
                squares += np.square(target[:, best]) - np.square(to_matched[:, i])
                free[[current[i], best]] = True, False
                current[i] = best
                to_matched[:, i] = target[:, best]
                moved = True
        if not moved:
            break
    return current
