# SPDX-License-Identifier: GPL-3.0-or-later
"""The matching problem: the distortion of a correspondence, to be minimised."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..runtime.arrays import Floats, Ints
from ..runtime.errors import MatchError


@dataclass(frozen=True, eq=False)
class MatchingProblem:
    r"""Match n points of X to m >= n candidates on Y, each x to one y and each y to at most one x.

    .. math:: \mathrm{dis}(c) = \mu \sum_x d_F(x, c(x)) + \lambda \sum_{x, x'} (d_X(x, x') - d_Y(c(x), c(x')))^2

    The double sum counts each pair of points twice (equations 2-4 of [1]_).

    Parameters
    ----------
    linear : (n, m) array of float
        mu d_F, the weighted difference of the descriptors; ``inf`` forbids a pair.
    source_distances : (n, n) array of float
        d_X between the points, symmetric with a zero diagonal.
    target_distances : (m, m) array of float
        d_Y between the candidates, symmetric with a zero diagonal.
    quadratic_weight : float
        lambda, not negative.

    Raises
    ------
    MatchError
        If the shapes do not fit together or there are fewer candidates than points.

    References
    ----------
    .. [1] D. Raviv, A. Dubrovina, R. Kimmel, "Hierarchical Matching of Non-rigid Shapes", SSVM 2011.
    """

    linear: Floats
    source_distances: Floats
    target_distances: Floats
    quadratic_weight: float = 1.0

    def __post_init__(self) -> None:
        n, m = self.linear.shape
        if self.source_distances.shape != (n, n) or self.target_distances.shape != (m, m):
            raise MatchError(
                f"A linear term of shape {(n, m)} needs distances of shapes {(n, n)} and {(m, m)}, not "
                f"{self.source_distances.shape} and {self.target_distances.shape}."
            )
        if n > m:
            raise MatchError(f"{n} points cannot be matched one to one to {m} candidates: use fewer points.")

    @property
    def size(self) -> tuple[int, int]:
        """Numbers of points and of candidates (n, m)."""
        n, m = self.linear.shape
        return n, m

    def linear_cost(self, assignment: Ints) -> float:
        """Evaluate the sum of the descriptor differences of an assignment (n,) of candidate numbers (equation 3)."""
        return float(self.linear[np.arange(len(assignment)), assignment].sum())

    def quadratic_cost(self, assignment: Ints) -> float:
        """Evaluate the sum of the squared differences of distances of an assignment, without lambda (equation 4)."""
        difference = self.source_distances - self.target_distances[np.ix_(assignment, assignment)]
        return float(np.square(difference).sum())

    def cost(self, assignment: Ints) -> float:
        """Evaluate the distortion of an assignment (n,) of candidate numbers (equation 2)."""
        return self.linear_cost(assignment) + self.quadratic_weight * self.quadratic_cost(assignment)


def forbidding_cost(problem: MatchingProblem) -> float:
    """Return a cost that rules a pair out, without the arithmetic of infinity.

    It is four times what the cost of a feasible matching can be in absolute value, so that with a single such pair
    any sum exceeds the cost of any feasible matching, and yet the rounding of sums does no harm.
    """
    n, _ = problem.size
    linear = np.abs(problem.linear, where=np.isfinite(problem.linear), out=np.zeros(problem.linear.shape))
    farthest = max(problem.source_distances.max(initial=0.0), problem.target_distances.max(initial=0.0))
    most = n * float(linear.max(initial=0.0)) + n * n * problem.quadratic_weight * float(farthest) ** 2
    return 4 * most if most > 0 else 1.0
