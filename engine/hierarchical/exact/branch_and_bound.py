# SPDX-License-Identifier: GPL-3.0-or-later
"""Exact minimisation of the distortion by branch and bound, with a valid bound whenever it stops early."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.optimize import linear_sum_assignment

from ...runtime.arrays import Bools, Ints
from ...runtime.errors import MatchError
from ...runtime.progress import Progress, Steps, part_of, told, within
from ..problem import MatchingProblem
from .dual_ascent import PairModel, dual_ascent_steps, pair_model
from .enumeration import Enumeration
from .exclusion import Exclusion
from .incumbent import Incumbent
from .local_search import beam_search

LARGEST = 5000  # pairs of a point and a candidate; their square in float64 is 200 MB
_BEAM = 60
_ROOT_SWEEPS = 60
_NODE_SWEEPS = 20
_DIVE = 20_000  # nodes after which a subtree is better bounded anew than enumerated
_IMPROVED = 5  # matchings of the beam search that local search improves
_SMALL = 3  # points; so few are enumerated in any case


@dataclass(frozen=True, eq=False)
class BoundedMatching:
    """A matching and what is known about the optimum.

    Attributes
    ----------
    assignment : (n,) array of int
        Candidate of each point.
    cost : float
        Its distortion.
    lower_bound : float
        No matching that keeps to the exclusions costs less; equal to `cost` when proven.
    proven : bool
        Whether no matching costs less than ``(1 - TOLERANCE) * cost``, see `incumbent`.
    nodes : int
        Nodes of the search tree visited.
    """

    assignment: Ints
    cost: float
    lower_bound: float
    proven: bool
    nodes: int


def branch_and_bound_steps(
    problem: MatchingProblem,
    *,
    node_limit: int = 1_000_000,
    exclusions: Sequence[Exclusion] = (),
    initial: Sequence[Ints] = (),
) -> Steps[BoundedMatching | None]:
    """Minimise the distortion exactly.

    Parameters
    ----------
    problem : MatchingProblem
        The problem, of at most 5000 pairs of a point and a candidate.
    node_limit : int
        Number of nodes after which to stop with the best matching so far and a lower bound.  It is a number of nodes
        and not of seconds, so that the same input always has the same output.
    exclusions : sequence of Exclusion
        Matchings to keep away from.
    initial : sequence of (n,) array of int
        Matchings to start from; those that are not feasible are left out.

    Yields
    ------
    Progress
        About every 0.1 s of work or more often, up to some 30 points and 60 candidates.

    Returns
    -------
    BoundedMatching or None
        The best matching; None if no matching keeps to the exclusions, or none was found in so many nodes, as several
        exclusions at once can make hard.

    Raises
    ------
    MatchError
        If the problem is too large, or allows no matching at all.

    Notes
    -----
    The root is bounded by dual ascent; beam and local search give a first matching; labels whose bound exceeds its
    cost are ruled out for good.  What is left is searched depth first in batches, branching on the point with the
    fewest labels left, each node being bounded by the cheapest label of each open point.  Where that takes too long,
    the subtree is split at its top and each part is bounded anew by dual ascent.

    A proof holds up to `incumbent.TOLERANCE`, relative to the cost.  Memory peaks at about four times the table of all
    pairs of pairs, (n m)^2 numbers.
    """
    n, m = problem.size
    if n * m > LARGEST:
        raise MatchError(
            f"{n} points and {m} candidates are too many for an exact search ({n * m} pairs, at most {LARGEST}): "
            "use fewer points or candidates."
        )
    feasible = _feasible_matchings(problem, exclusions)
    if feasible is None:
        return None
    incumbent = Incumbent(problem, exclusions)
    for assignment in [*feasible, *initial]:
        incumbent.offer(np.asarray(assignment, dtype=np.int64), improve=True)
    search = _Search(incumbent, node_limit)
    lower_bound = yield from search.steps()
    if incumbent.assignment is None:
        return None
    proven = lower_bound >= incumbent.limit
    cost = incumbent.cost
    return BoundedMatching(incumbent.assignment, cost, cost if proven else lower_bound, proven, search.nodes)


def distinct_matchings_steps(
    problem: MatchingProblem, count: int = 2, radius: float = 0.2, node_limit: int = 1_000_000
) -> Steps[list[BoundedMatching]]:
    """Find the best matchings that are not variations of each other, such as the true and the mirrored one.

    Parameters
    ----------
    problem : MatchingProblem
        The problem.
    count : int
        How many matchings to find.
    radius : float
        Two matchings are distinct if at least half of the points, rounded up, lie farther than this from each other,
        in the units of the distances.
    node_limit : int
        As in `matchings_of_each_steps`.

    Returns
    -------
    list of BoundedMatching
        At most `count`, the best one first: each is the best that is distinct from all before it, and its lower bound
        is among those.
    """
    return matchings_of_each_steps([problem] * count, problem.target_distances > radius, node_limit)


def matchings_of_each_steps(
    problems: Sequence[MatchingProblem], apart: Bools, node_limit: int, exclusions: Sequence[Exclusion] = ()
) -> Steps[list[BoundedMatching]]:
    """Find the best matching of each of some problems that is no variation of one before.

    Parameters
    ----------
    problems : sequence of MatchingProblem
        Problems that differ in what single matches cost.
    apart : (m, m) array of bool
        Which candidates are different places: two matchings are distinct if they take at least half of the points,
        rounded up, to such.
    node_limit : int
        For each matching: number of nodes after which its search stops.
    exclusions : sequence of Exclusion
        What all of them are to keep away from.

    Yields
    ------
    Progress
        About every 0.1 s of work or more often, up to some 30 points and 60 candidates.

    Returns
    -------
    list of BoundedMatching
        One for each problem; up to the first of which all matchings are variations of those before.

    Raises
    ------
    MatchError
        As `branch_and_bound_steps`.
    """
    found: list[BoundedMatching] = []
    excluded = list(exclusions)
    for number, problem in enumerate(problems):
        search = branch_and_bound_steps(problem, node_limit=node_limit, exclusions=excluded)
        matching = yield from within(search, *part_of(number, len(problems)))
        if matching is None:
            break
        found.append(matching)
        excluded.append(Exclusion(apart[matching.assignment], (problem.size[0] + 1) // 2))
    return found


def _feasible_matchings(problem: MatchingProblem, exclusions: Sequence[Exclusion]) -> list[Ints] | None:
    """Return some feasible matchings, or None if an exclusion allows none."""
    try:
        _, cheapest = linear_sum_assignment(problem.linear)
    except ValueError as error:
        raise MatchError("No matching is possible: too many pairs of a point and a candidate are forbidden.") from error
    matchings = [cheapest]
    for exclusion in exclusions:
        _, farthest = linear_sum_assignment(np.where(np.isfinite(problem.linear), -1.0 * exclusion.moved, np.inf))
        if not exclusion.allows(farthest):
            return None
        matchings.append(farthest)
    return matchings


@dataclass(frozen=True, eq=False)
class _Node:
    """A subtree: the matchings that agree with `matched` where that is not -1, and with the choice, if there is one."""

    bound: float
    matched: Ints  # (n,) candidates, -1 where open
    model: PairModel  # of the open points
    choice: tuple[int, int] | None = None  # row and label in the model that are still to be taken

    def chosen(self) -> tuple[PairModel, Ints]:
        """Carry out the choice: the model of the remaining points, and the candidates of the others."""
        if self.choice is None:
            return self.model, self.matched
        row, label = self.choice
        matched = self.matched.copy()
        matched[self.model.points[row]] = self.model.labels[row, label]
        return self.model.choose(row, label), matched


class _Search:
    """State of one branch and bound."""

    def __init__(self, incumbent: Incumbent, node_limit: int) -> None:
        self.incumbent = incumbent
        self.node_limit = node_limit
        self.nodes = 0

    def steps(self) -> Steps[float]:
        """Search; return a lower bound, which is not below the incumbent's limit if that is proven."""
        problem, incumbent = self.incumbent.problem, self.incumbent
        model = pair_model(problem, incumbent.exclusions)
        model = yield from self._bounded(model, _ROOT_SWEEPS, np.inf, 1e-3)
        for rank, assignment in enumerate(beam_search(model, _BEAM)):
            incumbent.offer(assignment, improve=rank < _IMPROVED)
        stack = [_Node(model.constant, np.full(problem.size[0], -1), model)]
        while stack:
            node = stack.pop()
            if node.bound >= incumbent.limit:
                continue
            open_bound = yield from self._explore(node, stack)
            if self._exhausted:
                return min([open_bound, *(other.bound for other in stack)])
        return np.inf

    @property
    def _exhausted(self) -> bool:
        return self.nodes >= self.node_limit

    def _progress(self) -> Progress:
        return Progress(self.nodes / (self.nodes + 0.1 * self.node_limit), f"Exact search, {self.nodes} nodes")

    def _bounded(self, model: PairModel, sweeps: int, limit: float, tolerance: float) -> Steps[PairModel]:
        """Raise the bound of a model, which is used up."""
        return told(dual_ascent_steps(model, sweeps, limit, tolerance), lambda _: self._progress())

    def _explore(self, node: _Node, stack: list[_Node]) -> Steps[float]:
        """Search a subtree, or push its parts on the stack; the bound of what the node limit leaves unvisited."""
        self.nodes += 1
        limit = self.incumbent.limit
        model, matched = node.chosen()
        if node.choice is not None:
            if not model.eliminate(limit):  # the fewer labels are left, the cheaper is the ascent
                return np.inf
            model = yield from self._bounded(model.compact(), _NODE_SWEEPS, limit, 5e-3)
        if model.constant >= limit or not model.eliminate(limit):
            return np.inf
        node = _Node(max(node.bound, model.constant), matched, model.compact())
        walk = Enumeration(node.model)
        before = self.nodes
        while not walk.finished:
            if self._exhausted:
                return max(node.bound, walk.bound)
            if walk.nodes > _DIVE and len(node.model.points) > _SMALL:
                stack.extend(self._split(node))
                return np.inf
            bounds, matchings = walk.step(self.incumbent.limit)
            self.nodes = before + walk.nodes
            for bound, matching in zip(bounds, matchings, strict=True):
                if bound >= self.incumbent.limit:
                    break
                whole = node.matched.copy()
                whole[node.model.points] = matching
                self.incumbent.offer(whole)
            yield self._progress()
        return np.inf

    def _split(self, node: _Node) -> list[_Node]:
        """Branch on the point with the fewest labels left; most promising child last."""
        model = node.model
        counts = model.alive.sum(axis=1)
        regret = np.sort(model.unary, axis=1)[:, min(1, model.unary.shape[1] - 1)]
        row = int(np.lexsort((-regret, counts))[0])
        beside = (model.pair[row] + model.unary).min(axis=2)  # (K, k)
        beside[:, row] = model.unary[row]
        bounds = model.constant + beside.sum(axis=1)
        open_labels = model.alive[row] & (bounds < self.incumbent.limit)
        labels = [a for a in np.argsort(-bounds, kind="stable") if open_labels[a]]
        return [_Node(max(node.bound, float(bounds[a])), node.matched, model, (row, int(a))) for a in labels]
