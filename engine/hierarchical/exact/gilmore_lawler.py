# SPDX-License-Identifier: GPL-3.0-or-later
"""The bound of Gilmore and Lawler, and the branch and bound that uses it at every node."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...runtime.arrays import Bools, Floats, Ints
from ...runtime.progress import Progress, Steps
from ..problem import MatchingProblem
from .dual_ascent import assignment_duals
from .exclusion import Exclusion
from .incumbent import Incumbent

_NODES_PER_STEP = 128


def gilmore_lawler_bound(problem: MatchingProblem) -> float:
    r"""Bound the cost of all matchings from below.

    If x goes to y, the distances from x to the other points have to go to different distances from y.  Matching them in
    ascending order costs least, which bounds what the pair costs together with all others; the cheapest assignment
    over these costs is the bound [1]_ [2]_.

    Parameters
    ----------
    problem : MatchingProblem
        The problem; the linear term must be finite.

    Returns
    -------
    float
        No matching costs less.

    References
    ----------
    .. [1] P. C. Gilmore, "Optimal and suboptimal algorithms for the quadratic assignment problem", 1962.
    .. [2] E. L. Lawler, "The quadratic assignment problem", 1963.
    """
    inner = _inner_costs(problem.source_distances, problem.target_distances)
    u, v, _ = assignment_duals(problem.linear + problem.quadratic_weight * inner)
    return float(u.sum() + v.sum())


def _inner_costs(x: Floats, y: Floats) -> Floats:
    """Least sum of squared differences of the distances from a point to all others (k,) and from a candidate to k - 1.

    Both sets of distances are sorted, so the best choice is monotone: a dynamic program over the sorted distances,
    for all pairs of a point and a candidate at once.

    Parameters
    ----------
    x : (k, k) array of float
        Distances between the points, not negative, with a zero diagonal.
    y : (l, l) array of float
        Distances between the candidates, l >= k.

    Returns
    -------
    (k, l) array of float
        For each point and candidate.
    """
    k, free = len(x), len(y) - len(x)
    x, y = np.sort(x, axis=1)[:, 1:], np.sort(y, axis=1)[:, 1:]  # without the zero to itself
    if not free:
        return np.square(x[:, None] - y[None]).sum(axis=2)
    # best[i, a, q]: the distances so far go to the first of y, with q left out among those
    best = np.zeros((k, len(y), free + 1))
    for p in range(k - 1):
        cost = np.square(x[:, p, None, None] - y[:, p : p + free + 1])
        best = np.minimum.accumulate(best + cost, axis=2)
    return best[:, :, -1]


@dataclass(frozen=True, eq=False)
class _Node:
    """A partial matching; its tables are of the open points and free candidates."""

    bound: float
    spent: float
    points: Ints  # (k,)
    candidates: Ints  # (l,)
    linear: Floats  # (k, l) cost of each pair beside the points matched; the cap where ruled out
    matched: Ints  # (n,) candidates, -1 where open
    choice: tuple[int, int] | None = None  # row and column still to be taken

    def chosen(self, problem: MatchingProblem) -> _Node:
        """Carry out the choice."""
        if self.choice is None:
            return self
        i, a = self.choice
        point, candidate = self.points[i], self.candidates[a]
        points, candidates = np.delete(self.points, i), np.delete(self.candidates, a)
        linear = np.delete(np.delete(self.linear, i, axis=0), a, axis=1)
        x, y = problem.source_distances[point, points], problem.target_distances[candidate, candidates]
        linear += 2 * problem.quadratic_weight * np.square(x[:, None] - y)
        matched = self.matched.copy()
        matched[point] = candidate
        return _Node(self.bound, self.spent + float(self.linear[i, a]), points, candidates, linear, matched)


def gilmore_lawler_steps(incumbent: Incumbent, allowed: Bools, node_limit: int) -> Steps[tuple[float, int]]:
    """Search depth first for the best matching, bounding every node by Gilmore and Lawler.

    Far fewer and far dearer nodes than enumeration under a dual bound.  It wins where every candidate has to be taken,
    since then there is no choice of the distances; it loses soon when there is one.

    Parameters
    ----------
    incumbent : Incumbent
        Knows the problem, and the best matching so far; takes what is found.
    allowed : (n, m) array of bool
        Pairs that may be matched.
    node_limit : int
        Number of nodes after which to stop, once there is a matching.

    Yields
    ------
    Progress
        Every 128 nodes.

    Returns
    -------
    bound : float
        Lower bound of what was not visited; inf when everything was.
    nodes : int
        Nodes visited.
    """
    problem = incumbent.problem
    n, m = problem.size
    linear = np.where(allowed, problem.linear, incumbent.cap)
    stack = [_Node(-np.inf, 0.0, np.arange(n), np.arange(m), linear, np.full(n, -1))]
    nodes = 0
    while stack:
        if nodes >= node_limit and incumbent.assignment is not None:
            return min(node.bound for node in stack), nodes
        node = stack.pop()
        if node.bound >= incumbent.limit:
            continue
        nodes += 1
        node = node.chosen(problem)
        if len(node.points):
            stack.extend(_children(node, incumbent))
        else:
            incumbent.offer(node.matched)
        if nodes % _NODES_PER_STEP == 0:
            yield Progress(nodes / (nodes + 0.1 * node_limit), f"Exact search, {nodes} nodes")
    return np.inf, nodes


def _children(node: _Node, incumbent: Incumbent) -> list[_Node]:
    """Branch on the point with the fewest candidates below the limit; most promising child last."""
    problem = incumbent.problem
    x = problem.source_distances[np.ix_(node.points, node.points)]
    y = problem.target_distances[np.ix_(node.candidates, node.candidates)]
    cost = node.linear + problem.quadratic_weight * _inner_costs(x, y)
    u, v, _ = assignment_duals(cost)
    # What a pair costs beyond the best assignment; rows take different columns, so these add up to a bound.
    excess = np.maximum(cost - u[:, None] - v, 0)
    bound = node.spent + float(u.sum() + v.sum())
    limit = incumbent.limit
    if any(bound + _price(exclusion, node, excess, incumbent.cap) >= limit for exclusion in incumbent.exclusions):
        return []
    below = bound + excess < limit
    counts = below.sum(axis=1)
    row = int(counts.argmin())
    open_pairs = (node.points, node.candidates, np.where(below, node.linear, incumbent.cap), node.matched)
    return [
        _Node(max(node.bound, bound + float(excess[row, a])), node.spent, *open_pairs, (row, int(a)))
        for a in np.argsort(-excess[row], kind="stable")
        if below[row, a]
    ]


def _price(exclusion: Exclusion, node: _Node, excess: Floats, cap: float) -> float:
    """Bound what an exclusion costs beyond the best assignment, given the excess of each pair (k, l)."""
    done = np.flatnonzero(node.matched >= 0)
    needed = exclusion.count - int(exclusion.moved[done, node.matched[done]].sum())
    if needed > len(node.points):
        return cap
    moved = exclusion.moved[np.ix_(node.points, node.candidates)]
    cheapest = np.sort(np.where(moved, excess, cap).min(axis=1))
    return float(cheapest[: max(needed, 0)].sum())
