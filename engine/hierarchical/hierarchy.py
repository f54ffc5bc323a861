# SPDX-License-Identifier: GPL-3.0-or-later
"""The hierarchy: from some points matched exactly to many matched well, level by level."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.optimize import linear_sum_assignment

from ..runtime.arrays import Floats, Ints, marked, squared_differences
from ..runtime.progress import Progress, Steps
from .problem import MatchingProblem
from .relaxation import RelaxedMatching, descend, project
from .sampled_pair import Pair

_MAX_ITERATIONS = 8


@dataclass(frozen=True, eq=False)
class Refined:
    """A matching at the end of a level.

    Attributes
    ----------
    assignment : (j,) array of int
        For each of the first j samples of X, its sample of Y.
    iterations : int
        Relaxed solves made in the level.
    """

    assignment: Ints
    iterations: int


def level_sizes(coarse: int, finest: int) -> list[int]:
    """Numbers of points of the levels: doubling, coarse and finest included."""
    sizes = [min(coarse, finest)]
    while sizes[-1] < finest:
        sizes.append(min(2 * sizes[-1], finest))
    return sizes


def refine_steps(
    pair: Pair, assignment: Ints, sizes: list[int], orientation_term: Floats | None = None
) -> Steps[list[Refined]]:
    """Add points level by level and improve all of them at each level.

    Parameters
    ----------
    pair : Pair
        The two shapes.
    assignment : (j0,) array of int
        Matching of the first j0 samples of X to samples of Y.
    sizes : list of int
        Number of points of each level, increasing, the first at least j0.
    orientation_term : (S, T) array of float, optional
        Added to the linear term (see `Pair.orientation_term`).

    Returns
    -------
    list of Refined
        The end of each level.
    """
    levels = []
    for number, size in enumerate(sizes):
        problem = pair.problem(size, extra=None if orientation_term is None else orientation_term[:size])
        assignment = _add_points(problem, assignment)
        here = Progress(number / len(sizes), f"Matching {size} points")
        assignment, iterations = yield from _converge(problem, assignment, pair.settings.neighbourhood, here)
        levels.append(Refined(assignment, iterations))
    return levels


def _add_points(problem: MatchingProblem, assignment: Ints) -> Ints:
    """Place new points where their descriptors and their distances to the points already matched fit best."""
    old, size = len(assignment), problem.size[0]
    if size == old:
        return assignment
    known = problem.source_distances[old:, :old]  # (new, old)
    offered = problem.target_distances[:, assignment]  # (m, old)
    cost = problem.linear[old:] + 2 * problem.quadratic_weight * squared_differences(known, offered)
    free = ~marked(assignment, cost.shape[1])
    _, chosen = linear_sum_assignment(cost[:, free])
    return np.concatenate([assignment, np.flatnonzero(free)[chosen]])


def _converge(
    problem: MatchingProblem, assignment: Ints, neighbourhood: int, here: Progress
) -> Steps[tuple[Ints, int]]:
    """Solve the relaxed problem over each point's neighbourhood until the distortion no longer falls."""
    cost = problem.cost(assignment)
    for iteration in range(_MAX_ITERATIONS):
        candidates = _neighbourhoods(problem, assignment, neighbourhood)
        proposal = project(RelaxedMatching(problem, candidates).solve(), candidates)
        yield here
        proposal = descend(problem, proposal)
        proposed = problem.cost(proposal)
        if proposed >= cost - 1e-9 * abs(cost):
            return assignment, iteration + 1
        assignment, cost = proposal, proposed
    return assignment, _MAX_ITERATIONS


def _neighbourhoods(problem: MatchingProblem, assignment: Ints, count: int) -> Ints:
    """For each point the candidates nearest to its present match, that one included, (j, count)."""
    count = min(count, problem.size[1])
    # The match itself is at distance zero; only exact duplicates could displace it, so it is put first by hand.
    distances = problem.target_distances[assignment].copy()
    distances[np.arange(len(assignment)), assignment] = -1
    return np.argpartition(distances, count - 1, axis=1)[:, :count]
