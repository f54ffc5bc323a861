# SPDX-License-Identifier: GPL-3.0-or-later
"""Alignment of two trees: which node of the one each node of the other stands for, as far as ancestors allow."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from ...runtime.arrays import Bools, Floats
from ..rig.skeleton import Skeleton

_REPEATED = 0.12
"""What it costs that a node gets the partner of its parent again, in units of gains."""

_SKIPPED, _MOST_SKIPPED = 0.08, 0.24
"""What each node costs that is passed over between the partners of a node and its parent, and all of them at most."""

_ELSEWHERE = 0.3
"""What it costs that the partner of a node hangs on another branch than that of its parent."""


def aligned(gains: Floats, nodes: Skeleton, partners: Skeleton, real: Bools) -> NDArray[Any]:
    r"""Choose a partner for each node of a tree so that chains are aligned as chains.

    The sum of the gains is made as large as it gets, less what the steps from a node to its children cost: the partner
    of the child hangs right below that of the node, or some are passed over (a gap), or it is the same again, or hangs
    elsewhere.  On two chains this is the alignment of sequences of Needleman and Wunsch [1]_; on trees each node of the
    first is handled after its children, and any node of the second is tried as its partner.

    Parameters
    ----------
    gains : (b, a) array of float
        What it is worth that a node has such a partner; negative for none that fits, minus infinity to forbid it.
    nodes : Skeleton
        The tree whose nodes, b, get partners.
    partners : Skeleton
        The tree of the partners, a.
    real : (a,) array of bool
        Whether it costs to pass over such a partner.

    Returns
    -------
    (b,) array of int
        The partner of each node, -1 for none.

    References
    ----------
    .. [1] S. B. Needleman and C. D. Wunsch, "A general method applicable to the search for similarities in the amino
       acid sequence of two proteins", Journal of Molecular Biology 48, 1970.
    """
    count, other = gains.shape
    free = other  # the column for a node without a partner above it
    best = np.zeros((count, other + 1))
    choice = np.full((count, other + 1), -1)
    apart = _step_costs(partners, real)
    for node in nodes.order[::-1]:
        below = best[nodes.children(int(node))].sum(axis=0)  # what the children gain, for each partner of the node
        own = gains[node] + below[:free]
        values = own[None] - apart  # (a + 1, a): partner above, own partner
        found = values.argmax(axis=1)
        reached = values[np.arange(free + 1), found]
        taken = reached > below  # else it stays alone, and its children hang on whatever is above it
        best[node] = np.where(taken, reached, below)
        choice[node] = np.where(taken, found, -1)
    result = np.full(count, -1)
    above = np.full(count, free)
    for node in nodes.order:
        parent = nodes.parents[node]
        if parent >= 0:
            above[node] = result[parent] if result[parent] >= 0 else above[parent]
        result[node] = choice[node, above[node]]
    return result


def _step_costs(tree: Skeleton, real: Bools) -> Floats:
    """Cost of the step from one partner to another, (a + 1, a); the last row is for no partner above."""
    count = len(tree)
    costs = np.full((count + 1, count), _ELSEWHERE)
    costs[count] = 0.0
    for start in range(count):
        costs[start, start] = _REPEATED
        layer, passed = tree.children(start), np.zeros(len(tree.children(start)))
        while len(layer):
            costs[start, layer] = np.minimum(passed, _MOST_SKIPPED)
            following = [
                (child, gone + _SKIPPED * real[node])
                for node, gone in zip(layer, passed, strict=True)
                for child in tree.children(int(node))
            ]
            layer = np.array([child for child, _ in following], np.int64)
            passed = np.array([gone for _, gone in following])
    return costs
