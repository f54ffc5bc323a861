# SPDX-License-Identifier: GPL-3.0-or-later
"""Matching problems for tests and benchmarks, and their exact solution by trying everything."""

from __future__ import annotations

import itertools
from typing import TYPE_CHECKING, Any

import numpy as np

from engine.hierarchical.exact.branch_and_bound import branch_and_bound_steps
from engine.hierarchical.problem import MatchingProblem
from engine.runtime.progress import run

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from engine.hierarchical.exact.branch_and_bound import BoundedMatching
    from engine.hierarchical.exact.exclusion import Exclusion


def random_distances(rng: np.random.Generator, count: int, kind: str = "table") -> NDArray[np.float64]:
    """Distances between `count` things: any table, points in the plane, or few different numbers (many ties)."""
    if kind == "plane":
        points = rng.random((count, 2))
        return np.linalg.norm(points[:, None] - points[None], axis=2)
    table = rng.integers(0, 3, (count, count)).astype(float) if kind == "ties" else rng.random((count, count))
    table = np.triu(table, 1)
    return table + table.T


def random_problem(
    seed: int, n: int, m: int, *, weight: float = 1.0, forbidden: float = 0.0, kind: str = "table"
) -> MatchingProblem:
    """Make a problem without any structure; `forbidden` is the part of the pairs that are not allowed."""
    rng = np.random.default_rng(seed)
    linear = rng.integers(0, 3, (n, m)).astype(float) if kind == "ties" else rng.random((n, m))
    linear[rng.random((n, m)) < forbidden] = np.inf
    return MatchingProblem(linear, random_distances(rng, n, kind), random_distances(rng, m, kind), weight)


def shape_problem(seed: int, n: int, m: int, *, noise: float = 0.05, linear: float = 0.3) -> MatchingProblem:
    """Make a problem like that of two poses: points on a body with two mirrored limbs at each end, and noisy ones.

    Mirroring the body changes its distances little, so that there are two good and quite different matchings.
    """
    rng = np.random.default_rng(seed)
    limb = rng.integers(0, 4, m)
    along = rng.random(m)
    end = np.where(limb < 2, -1.0, 1.0)
    side = np.where(limb % 2 == 0, -1.0, 1.0)
    points = np.stack([end * (0.4 + 0.6 * along), side * 0.5 * along, 0.1 * rng.standard_normal(m)], axis=1)
    points += 0.03 * rng.standard_normal(points.shape)
    moved = points[rng.permutation(m)[:n]] + noise * rng.standard_normal((n, 3))
    x = np.linalg.norm(moved[:, None] - moved[None], axis=2)
    y = np.linalg.norm(points[:, None] - points[None], axis=2)
    return MatchingProblem(linear * np.abs(x.mean(axis=1)[:, None] - y.mean(axis=1)), x, y)


def all_costs(problem: MatchingProblem) -> tuple[NDArray[np.int64], NDArray[np.float64]]:
    """Every assignment (p, n) and its cost (p,)."""
    n, m = problem.size
    every = np.array(list(itertools.permutations(range(m), n)), dtype=np.int64)
    difference = problem.source_distances - problem.target_distances[every[:, :, None], every[:, None, :]]
    linear = problem.linear[np.arange(n), every].sum(axis=1)
    return every, linear + problem.quadratic_weight * np.square(difference).sum(axis=(1, 2))


def brute_force(problem: MatchingProblem, exclusions: tuple[Exclusion, ...] | list[Exclusion] = ()) -> float:
    """The least cost of all assignments that keep to the exclusions; inf if there is none."""
    every, costs = all_costs(problem)
    for exclusion in exclusions:
        moved = exclusion.moved[np.arange(every.shape[1]), every].sum(axis=1)
        costs = np.where(moved >= exclusion.count, costs, np.inf)
    return float(costs.min())


def relabelled(problem: MatchingProblem, rows: NDArray[np.int64], columns: NDArray[np.int64]) -> MatchingProblem:
    """The same problem with its points and its candidates in another order."""
    return MatchingProblem(
        problem.linear[np.ix_(rows, columns)],
        problem.source_distances[np.ix_(rows, rows)],
        problem.target_distances[np.ix_(columns, columns)],
        problem.quadratic_weight,
    )


def branch_and_bound(problem: MatchingProblem, **options: Any) -> BoundedMatching | None:
    """Minimise the distortion exactly, in one go."""
    return run(branch_and_bound_steps(problem, **options))
