# SPDX-License-Identifier: GPL-3.0-or-later
"""The best matching that a search has found so far."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from ...runtime.arrays import Ints
from ..problem import MatchingProblem, forbidding_cost
from .exclusion import Exclusion
from .local_search import improve_matching

TOLERANCE = 1e-7
"""Relative tolerance of a proof: no matching costs less than ``(1 - TOLERANCE)`` times a proven one."""


class Incumbent:
    """Keeps the best of the matchings it is offered.

    Parameters
    ----------
    problem : MatchingProblem
        What the matchings are to solve.
    exclusions : sequence of Exclusion
        What they have to keep away from.

    Attributes
    ----------
    cap : float
        What stands for "forbidden": `forbidding_cost` of the problem.
    assignment : (n,) array of int or None
        The best matching so far.
    cost : float
        Its distortion; inf without one.
    """

    def __init__(self, problem: MatchingProblem, exclusions: Sequence[Exclusion] = ()) -> None:
        self.problem = problem
        self.exclusions = exclusions
        self.cap = forbidding_cost(problem)
        self.assignment: Ints | None = None
        self.cost = np.inf

    @property
    def limit(self) -> float:
        """What a matching must undercut to be of interest, within the tolerance of a proof."""
        if self.assignment is None:
            return self.cap / 2
        # The second part is for an optimum near zero, as of a shape matched to itself: there, rounding decides.
        return self.cost - TOLERANCE * abs(self.cost) - 1e-13 * self.cap

    def feasible(self, assignment: Ints) -> bool:
        """Say whether an array is a matching, with no forbidden pair, that keeps to the exclusions."""
        n, m = self.problem.size
        return bool(
            assignment.shape == (n,)
            and assignment.min() >= 0
            and assignment.max() < m
            and len(np.unique(assignment)) == n
            and np.isfinite(self.problem.linear_cost(assignment))
            and all(exclusion.allows(assignment) for exclusion in self.exclusions)
        )

    def offer(self, assignment: Ints, *, improve: bool = False) -> None:
        """Keep a matching if it is feasible and the best so far; optionally improve it by local search first."""
        if not self.feasible(assignment):
            return
        if improve:
            assignment = improve_matching(self.problem, assignment, self.exclusions)
        cost = self.problem.cost(assignment)
        if cost < self.cost:
            self.assignment, self.cost = assignment, cost
