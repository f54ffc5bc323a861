# SPDX-License-Identifier: GPL-3.0-or-later
"""Lower bounds of the matching problem by dual ascent: message passing between points, and assignment duals."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import linear_sum_assignment

from ...runtime.arrays import Bools, Floats, Ints
from ...runtime.progress import Progress, Steps
from ..problem import MatchingProblem, forbidding_cost
from .exclusion import Exclusion


@dataclass(eq=False)
class PairModel:
    r"""The matching problem as costs of single choices and of pairs of choices, all of them not negative.

    Each of k points takes one of K labels; label a of point i stands for candidate ``labels[i, a]``.

    .. math:: \mathrm{constant} + \sum_i \mathrm{unary}_{i a_i} + \sum_{i < j} \mathrm{pair}_{i a_i j a_j}

    never exceeds the cost of a matching that keeps to the exclusions, and `constant` alone is a lower bound of all.

    Attributes
    ----------
    points : (k,) array of int
        The points that are still to be matched.
    labels : (k, K) array of int
        Candidate of each label.
    constant : float
        Lower bound of the cost, with what the points already matched cost.
    unary : (k, K) array of float
        Cost of a label, not negative.
    pair : (k, K, k, K) array of float
        Cost of two labels together, not negative, symmetric; zero between a point and itself.
    alive : (k, K) array of bool
        Labels not yet ruled out.
    cap : float
        More than any matching costs: stands for "forbidden", without the arithmetic of infinity.
    moved : (e, k, K) array of bool
        For each exclusion, the labels that count as moved.
    needed : (e,) array of int
        For each exclusion, how many of the k points have to take such a label; negative if more than enough do.
    multipliers : (e,) array of float
        Lagrange multipliers of the exclusions, not negative, already charged to `unary` and `constant`.
    """

    points: Ints
    labels: Ints
    constant: float
    unary: Floats
    pair: Floats
    alive: Bools
    cap: float
    moved: Bools
    needed: Ints
    multipliers: Floats

    def eliminate(self, limit: float) -> bool:
        """Rule out, in place, the labels that no matching cheaper than `limit` uses.

        The bound of a label is its own cost plus, at every other point, the cheapest label beside it.

        Returns
        -------
        bool
            Whether every point has a label left.
        """
        for i in range(len(self.points)):
            beside = (self.pair[i] + self.unary).min(axis=2)  # (K, k)
            beside[:, i] = self.unary[i]
            self.alive[i] &= self.constant + beside.sum(axis=1) < limit
            self.unary[i, ~self.alive[i]] = self.cap
        return bool(self.alive.any(axis=1).all())

    def compact(self) -> PairModel:
        """Leave out labels that are ruled out, as far as a rectangular array can; cheapest labels come first."""
        count = int(self.alive.sum(axis=1).max(initial=0))
        order = np.argsort(np.where(self.alive, self.unary, np.inf), axis=1, kind="stable")[:, :count]
        rows = np.arange(len(self.points))
        tables: tuple[NDArray[Any], ...] = self.labels, self.unary, self.alive
        labels, unary, alive = (np.take_along_axis(table, order, axis=1) for table in tables)
        pair = self.pair[rows[:, None, None, None], order[:, :, None, None], rows[:, None], order]
        moved = np.take_along_axis(self.moved, np.broadcast_to(order, (len(self.moved), *order.shape)), axis=2)
        return replace(self, labels=labels, unary=unary, pair=pair, alive=alive, moved=moved)

    def choose(self, row: int, label: int) -> PairModel:
        """Return the model of the other points once the point in `row` has taken `label`."""
        rest = np.delete(np.arange(len(self.points)), row)
        taken = self.labels[rest] == self.labels[row, label]
        return PairModel(
            self.points[rest],
            self.labels[rest],
            self.constant + float(self.unary[row, label]),
            np.where(taken, self.cap, self.unary[rest] + self.pair[row, label, rest]),
            self.pair[rest][:, :, rest],
            self.alive[rest] & ~taken,
            self.cap,
            self.moved[:, rest],
            self.needed - self.moved[:, row, label],
            self.multipliers,
        )


def pair_model(problem: MatchingProblem, exclusions: Sequence[Exclusion] = ()) -> PairModel:
    """Write a matching problem as a `PairModel` with one label per candidate.

    Parameters
    ----------
    problem : MatchingProblem
        The problem; its distances have to be symmetric with a zero diagonal.
    exclusions : sequence of Exclusion
        What the matching has to keep away from.
    """
    n, m = problem.size
    allowed = np.isfinite(problem.linear)
    cap = forbidding_cost(problem)
    linear = np.where(allowed, problem.linear, cap)
    lowest = linear.min(axis=1)
    unary = linear - lowest[:, None]
    x, y = problem.source_distances, problem.target_distances
    unary[~allowed] = cap
    pair = x[:, None, :, None] - y[None, :, None, :]
    np.square(pair, out=pair)
    pair *= 2 * problem.quadratic_weight  # both orders of a pair at once
    pair[:, np.arange(m), :, np.arange(m)] = cap
    pair[np.arange(n), :, np.arange(n), :] = 0
    return PairModel(
        points=np.arange(n),
        labels=np.tile(np.arange(m), (n, 1)),
        constant=float(lowest.sum()),
        unary=unary,
        pair=pair,
        alive=allowed,
        cap=cap,
        moved=np.array([e.moved for e in exclusions], dtype=bool).reshape(-1, n, m),
        needed=np.array([e.count for e in exclusions], dtype=np.int64),
        multipliers=np.zeros(len(exclusions)),
    )


def dual_ascent_steps(
    model: PairModel, sweeps: int, limit: float = np.inf, tolerance: float = 1e-3
) -> Steps[PairModel]:
    r"""Raise the constant of a model as far as its other costs stay not negative.

    A sweep lets all disjoint pairs of points of each round of a round-robin tournament shake hands: the costs of both
    points go into the pair's table and come back as what the table can spare [1]_.  The potentials of the linear
    assignment problem over the costs of single labels then charge for candidates wanted by several points, and a
    Lagrange multiplier per exclusion charges for keeping too near to a matching already found.

    Parameters
    ----------
    model : PairModel
        The model; used up, its arrays become those of the result.
    sweeps : int
        The most sweeps made.
    limit : float
        A constant at which to stop, as no better bound is needed.
    tolerance : float
        Stop when three sweeps together close less than this part of the gap to `limit` (of the constant, if `limit`
        is infinite).

    Yields
    ------
    Progress
        One per sweep.

    Returns
    -------
    PairModel
        The same problem with a constant that is not smaller.

    References
    ----------
    .. [1] S. Tourani, A. Shekhovtsov, C. Rother, B. Savchynskyy, "MPLP++: Fast, Parallel Dual Block-Coordinate Ascent
       for Dense Graphical Models", ECCV 2018.
    """
    rounds = _rounds(len(model.points))
    tables = [model.pair[i, :, j, :] for i, j in rounds]
    history = [model.constant]
    for sweep in range(sweeps):
        for (i, j), table in zip(rounds, tables, strict=True):
            _shake_hands(model.unary, table, i, j)
        _charge_candidates(model)
        _charge_exclusions(model)
        history.append(model.constant)
        gap = limit - model.constant if np.isfinite(limit) else abs(model.constant)
        if gap <= 0 or (sweep >= 3 and history[-1] - history[-4] <= tolerance * gap):
            break
        yield Progress((sweep + 1) / sweeps, "Bounding the best matching")
    for (i, j), table in zip(rounds, tables, strict=True):
        model.pair[i, :, j, :] = table
        model.pair[j, :, i, :] = table.transpose(0, 2, 1)
    _forbid_again(model)
    return model


def _rounds(count: int) -> list[tuple[Ints, Ints]]:
    """All pairs of `count` points, in rounds of disjoint pairs (the circle method of a tournament)."""
    players = list(range(count + count % 2))
    rounds = []
    for _ in range(len(players) - 1):
        half = len(players) // 2
        pairs = [p for p in zip(players[:half], players[: -half - 1 : -1], strict=True) if max(p) < count]
        first, second = np.array(pairs, dtype=np.int64).reshape(-1, 2).T
        rounds.append((first, second))
        players = [players[0], players[-1], *players[1:-1]]
    return rounds


def _shake_hands(unary: Floats, table: Floats, i: Ints, j: Ints) -> None:
    """Move costs between labels and pair tables, (p, K, K) for the p disjoint pairs (i, j), in place."""
    table += unary[i][:, :, None]
    table += unary[j][:, None, :]
    first = 0.5 * table.min(axis=2)
    table -= first[:, :, None]
    second = table.min(axis=1)
    table -= second[:, None, :]
    rest = table.min(axis=2)
    table -= rest[:, :, None]
    unary[i] = first + rest
    unary[j] = second


def assignment_duals(cost: Floats) -> tuple[Floats, Floats, Ints]:
    """Solve the linear assignment problem and its dual.

    Parameters
    ----------
    cost : (n, m) array of float
        Finite costs, n <= m.

    Returns
    -------
    rows : (n,) array of float
        Potentials u, with u_i + v_j <= cost_ij.
    columns : (m,) array of float
        Potentials v <= 0, zero where no row is assigned; u and v together sum to the optimum.
    assignment : (n,) array of int
        The column assigned to each row.
    """
    rows, assignment = linear_sum_assignment(cost)
    excess = cost - cost[rows, assignment][:, None]
    columns = np.zeros(cost.shape[1])
    # The shortest paths of the exchange graph; the optimum has no negative cycle, so that n rounds suffice.
    for _ in range(len(cost)):
        shorter = np.minimum(columns, (excess + columns[assignment][:, None]).min(axis=0))
        if np.array_equal(shorter, columns):
            break
        columns = shorter
    return cost[rows, assignment] - columns[assignment], columns, assignment


def _charge_candidates(model: PairModel) -> None:
    """Charge for candidates that several points want."""
    k = len(model.points)
    used, labels = np.unique(model.labels, return_inverse=True)
    cost = np.full((k, max(len(used), k)), model.cap)
    rows = np.arange(k)[:, None]
    labels = labels.reshape(model.labels.shape)
    cost[rows, labels] = model.unary
    u, v, _ = assignment_duals(cost)
    model.constant += float(u.sum() + v.sum())
    model.unary -= u[:, None] + v[labels]
    np.maximum(model.unary, 0, out=model.unary)  # rounding


def _charge_exclusions(model: PairModel) -> None:
    """Set each exclusion's multiplier to what is best while the rest stays as it is."""
    for e, (moved, needed) in enumerate(zip(model.moved, model.needed, strict=True)):
        away = np.where(moved, model.unary, model.cap).min(axis=1)
        near = np.where(moved, model.cap, model.unary).min(axis=1)
        price = np.sort(away - near)  # what each point asks for moving, cheapest first
        if needed > len(price):
            model.constant += model.cap
            continue
        change = max(price[needed - 1], -model.multipliers[e]) if needed > 0 else -model.multipliers[e]
        model.multipliers = model.multipliers.copy()  # shared between models
        model.multipliers[e] += change
        model.unary -= change * moved
        lowest = model.unary.min(axis=1)
        model.unary -= lowest[:, None]
        model.constant += float(change * needed + lowest.sum())


def _forbid_again(model: PairModel) -> None:
    """Give whatever is forbidden its full cost again: the ascent spreads it over the tables."""
    model.unary[~model.alive] = model.cap
    for i in range(len(model.points)):
        same = model.labels[i][:, None, None] == model.labels  # (K, k, K)
        same[:, i] = False
        model.pair[i][same] = model.cap
