# SPDX-License-Identifier: GPL-3.0-or-later
"""Good matchings without a proof: beam search over labels, and a search by moves and swaps."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from ...runtime.arrays import Floats, Ints
from ..problem import MatchingProblem
from .dual_ascent import PairModel
from .exclusion import Exclusion, exclusion_surcharge


def beam_search(model: PairModel, width: int) -> Ints:
    """Match point after point, keeping the most promising partial matchings.

    Parameters
    ----------
    model : PairModel
        The problem, best after a dual ascent: its costs then know of each other, which is what guides the search.
    width : int
        How many partial matchings are kept.

    Returns
    -------
    (w, k) array of int
        At most `width` matchings as candidate numbers, most promising first.  They need not be feasible where the
        model has forbidden pairs or exclusions.

    Notes
    -----
    Points whose cheapest label stands out most come first.  A partial matching is judged by its cost plus the
    cheapest label of each open point, given what the points already matched charge for it.
    """
    k = len(model.points)
    regret = np.sort(model.unary, axis=1)[:, min(1, model.unary.shape[1] - 1)]
    chosen = np.zeros((1, 0), dtype=np.int64)
    spent = np.zeros(1)
    unary = model.unary[None]
    order = np.argsort(-regret, kind="stable")
    for step, row in enumerate(order):
        cost = spent[:, None] + unary[:, row]  # (w, K)
        rest = order[step + 1 :]
        parent, label = np.nonzero(cost < model.cap)
        if not len(parent):
            break
        cost = cost[parent, label]
        if len(parent) > 4 * width:  # first by what the parents know, as looking ahead for each child is dear
            promise = cost + unary[:, rest].min(axis=2).sum(axis=1)[parent]
            best = np.argsort(promise, kind="stable")[: 4 * width]
            parent, label, cost = parent[best], label[best], cost[best]
        children = unary[parent]
        children += model.pair[row, label]
        partial = np.column_stack([chosen[parent], label])
        promise = cost + children[:, rest].min(axis=2).sum(axis=1) + _surcharge(model, children, partial, order)
        best = np.argsort(promise, kind="stable")[:width]
        chosen, spent, unary = partial[best], cost[best], children[best]
    if chosen.shape[1] < k:
        return np.zeros((0, k), dtype=np.int64)
    labels = np.empty_like(chosen)
    labels[:, order] = chosen
    return model.labels[np.arange(k), labels]


def _surcharge(model: PairModel, unary: Floats, partial: Ints, order: Ints) -> Floats:
    """Bound what the exclusions add to the cost of partial matchings (w, t) of the first t points of `order`."""
    result = np.zeros(len(partial))
    done = order[: partial.shape[1]]
    open_rows = np.broadcast_to(~np.isin(np.arange(len(order)), done), unary.shape[:2])
    for moved, needed, multiplier in zip(model.moved, model.needed, model.multipliers, strict=True):
        left = needed - moved[done, partial].sum(axis=1)
        extra = exclusion_surcharge(unary, open_rows, moved, left, multiplier=multiplier, cap=model.cap)
        np.maximum(result, extra, out=result)
    return result


def improve_matching(problem: MatchingProblem, assignment: Ints, exclusions: Sequence[Exclusion] = ()) -> Ints:
    """Move one point to a free candidate or swap two points, whichever gains most, while anything gains.

    Parameters
    ----------
    problem : MatchingProblem
        The problem.
    assignment : (n,) array of int
        A feasible matching that keeps to the exclusions.
    exclusions : sequence of Exclusion
        What the result has to keep away from, too.

    Returns
    -------
    (n,) array of int
        A matching that costs no more, and that no single move or swap improves.
    """
    current = np.array(assignment, dtype=np.int64)
    rows = np.arange(len(current))
    cost = problem.cost(current)
    tolerance = 1e-12 * abs(cost)
    while True:
        moves, swaps = _move_and_swap_gains(problem, current)
        for exclusion in exclusions:
            moved = exclusion.moved[rows, current]
            spare = moved.sum() - exclusion.count
            moves[spare - moved[:, None].astype(np.int64) + exclusion.moved < 0] = -np.inf
            after = exclusion.moved[:, current].astype(np.int64) - moved[:, None]  # (n, n): row i takes k's candidate
            swaps[spare + after + after.T < 0] = -np.inf
        if max(moves.max(), swaps.max()) <= tolerance:
            return current
        changed = current.copy()
        if moves.max() >= swaps.max():
            i, a = np.unravel_index(moves.argmax(), moves.shape)
            changed[i] = a
        else:
            i, k = np.unravel_index(swaps.argmax(), swaps.shape)
            changed[[i, k]] = current[[k, i]]
        # Where all but one candidate are far off, a gain may be no more than rounding, there and back for ever.
        if not problem.cost(changed) < cost:
            return current
        current, cost = changed, problem.cost(changed)


def _move_and_swap_gains(problem: MatchingProblem, current: Ints) -> tuple[Floats, Floats]:
    """Gain of moving each point to each candidate (n, m), and of swapping each two points (n, n)."""
    rows = np.arange(len(current))
    x, y, weight = problem.source_distances, problem.target_distances, 2 * problem.quadratic_weight
    # between[i, a, k]: what point i at candidate a costs together with point k where it is now
    between = weight * np.square(x[:, None, :] - y[:, current][None])
    between[rows, :, rows] = 0
    total = problem.linear + between.sum(axis=2)
    now = total[rows, current]
    moves = now[:, None] - total
    moves[:, current] = -np.inf
    at = between[:, current]  # (n, n, n): i at k's candidate, together with each other point
    both = weight * np.square(x - y[np.ix_(current, current)])  # the pair itself costs the same before and after
    pair = at[rows[:, None], rows, rows]  # i at k's candidate together with k still there: not a matching
    swapped = total[:, current] - pair  # (n, n): i at k's candidate, without k
    swaps = (now[:, None] - both) + (now[None, :] - both) - swapped - swapped.T
    swaps[rows, rows] = -np.inf
    return moves, swaps
