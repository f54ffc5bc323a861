# SPDX-License-Identifier: GPL-3.0-or-later
"""Exclusion of a matching already found from a search."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...runtime.arrays import Bools, Floats, Ints


@dataclass(frozen=True, eq=False)
class Exclusion:
    """Keeps a search away from a matching already found.

    Attributes
    ----------
    moved : (n, m) array of bool
        True where giving point x candidate y counts as moved away.
    count : int
        At least this many points have to be moved away.
    """

    moved: Bools
    count: int

    def allows(self, assignment: Ints) -> bool:
        """Say whether an assignment (n,) of candidate numbers is far enough away."""
        return int(self.moved[np.arange(len(assignment)), assignment].sum()) >= self.count


def exclusion_surcharge(
    unary: Floats, open_rows: Bools, moved: Bools, needed: Ints, *, multiplier: float, cap: float
) -> Floats:
    """Bound what an exclusion adds to the sum of the cheapest labels.

    Parameters
    ----------
    unary : (b, k, K) array of float
        Costs of the labels in each of b nodes, with the multiplier taken off the moved ones.
    open_rows : (b, k) array of bool
        Which points are not matched yet.
    moved : (k, K) array of bool
        Labels that count as moved.
    needed : (b,) array of int
        How many of the open points have to take such a label; negative if more than enough have.
    multiplier : float
        Lagrange multiplier of the exclusion.
    cap : float
        Cost of what is impossible.

    Returns
    -------
    (b,) array of float
        Not negative.

    Notes
    -----
    Each open point asks for the difference between its cheapest moved and its cheapest unmoved label.  The `needed`
    smallest of these have to be paid; any other point that moves gives the multiplier back.
    """
    away = np.where(moved, unary, cap).min(axis=2)
    near = np.where(moved, cap, unary).min(axis=2)
    price = np.where(open_rows, away - near, np.inf)
    unforced = np.maximum(-price, 0) + np.minimum(price + multiplier, 0)
    ordered = np.minimum(np.maximum(np.sort(price, axis=1), -multiplier), cap)
    forced = np.concatenate([np.zeros((len(price), 1)), np.cumsum(ordered, axis=1)], axis=1)
    count = np.clip(needed, 0, unary.shape[1])
    result = unforced.sum(axis=1) + forced[np.arange(len(price)), count] + multiplier * np.maximum(-needed, 0)
    return np.where(needed > open_rows.sum(axis=1), cap, result)
