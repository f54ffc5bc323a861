# SPDX-License-Identifier: GPL-3.0-or-later
"""The signs, and the order, in which the eigenfunctions of two shapes agree."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import permutations, product

import numpy as np

from ..runtime.arrays import Floats, Ints
from ..runtime.progress import Progress, Steps

_CLUSTER = 12  # candidates that look most alike, among which a point's true and mirrored images should be
_PLACES = 200  # so many points vote
_SMALL_GROUP = 3


@dataclass(frozen=True, eq=False)
class SignSequence:
    """One way to read the target's eigenfunctions.

    Attributes
    ----------
    order : (k,) array of int
        Which eigenfunction of the target stands for each of the source's.
    signs : (k,) array of int
        1 or -1, by which that eigenfunction is multiplied.
    disagreement : float
        Mean difference between the eigenfunctions at a point and at the best of the candidates that look like it.
    """

    order: Ints
    signs: Ints
    disagreement: float

    def apply(self, functions: Floats) -> Floats:
        """Read eigenfunctions of the target (m, k) as those of the source."""
        return functions[:, self.order] * self.signs


def consistent_sequences_steps(
    source: Floats, target: Floats, difference: Floats, groups: Sequence[Sequence[int]], count: int
) -> Steps[list[SignSequence]]:
    r"""Find the sign sequences for which the eigenfunctions of two shapes agree best.

    An eigenfunction is known up to its sign, and functions of nearly equal eigenvalues may change places.  Points that
    look alike by a descriptor without signs decide [1]_: for each point of the source, the most alike points of the
    target are a cluster in which its true image, and on a symmetric shape its mirror image, should be found.  A
    sequence is consistent if near every point some member of the cluster has the same values,

    .. math:: E(s) = \frac{1}{n} \sum_x \min_{y \in N(x)} \| \phi_X(x) - s\,\phi_Y(y) \|

    All sequences are tried.  On a symmetric shape the functions that are antisymmetric flip together, so that at least
    two sequences are consistent: those of the true and of the mirrored matching.

    Parameters
    ----------
    source : (n, k) array of float
        The first k eigenfunctions that are not constant, at points of X, made comparable in size between the shapes.
    target : (m, k) array of float
        The same of Y.
    difference : (n, m) array of float
        Difference of descriptors that need no signs.
    groups : sequence of sequence of int
        Numbers of eigenfunctions whose eigenvalues are nearly equal, so that they may stand in any order.  Those in no
        group keep their place.
    count : int
        How many sequences to return, at most.

    Yields
    ------
    Progress
        Before each order of the functions.

    Returns
    -------
    list of SignSequence
        The most consistent first.

    References
    ----------
    .. [1] A. Dubrovina, R. Kimmel, "Matching shapes by eigendecomposition of the Laplace-Beltrami operator",
       3DPVT 2010.
    """
    k = source.shape[1]
    voters = np.arange(0, len(source), max(1, len(source) // _PLACES))
    size = min(_CLUSTER, difference.shape[1])
    cluster = np.argpartition(difference[voters], size - 1, axis=1)[:, :size]  # (v, c)
    mine = source[voters]  # (v, k)
    signs = np.array(list(product((1, -1), repeat=k)))  # (2^k, k)
    orders = np.array(_orders(k, groups))  # (o, k)
    disagreements = np.empty((len(orders), len(signs)))
    for number, order in enumerate(orders):
        yield Progress(number / len(orders), "Comparing matchings")
        disagreements[number] = _disagreements(mine, target[:, order][cluster], signs)
    best = np.unravel_index(np.argsort(disagreements, axis=None, kind="stable")[:count], disagreements.shape)
    return [SignSequence(orders[i], signs[j], float(disagreements[i, j])) for i, j in zip(*best, strict=True)]


def _disagreements(mine: Floats, theirs: Floats, signs: Ints) -> Floats:
    """Compare points (v, k) to their clusters (v, c, k), with each of some signs (s, k): (s,)."""
    # |a - s b|^2 = |a|^2 + |b|^2 - 2 sum_i s_i a_i b_i: for all signs at once, one product.
    squares = np.tensordot(-2 * mine[:, None] * theirs, signs, (2, 1))  # (v, c, s)
    squares += (np.square(mine).sum(axis=1)[:, None] + np.square(theirs).sum(axis=2))[:, :, None]
    return np.asarray(np.sqrt(squares.min(axis=1).clip(0)).mean(axis=0))


def _orders(k: int, groups: Sequence[Sequence[int]]) -> list[list[int]]:
    """List the orders in which functions change places within their groups only."""
    orders = []
    for choice in product(*(_arrangements(list(group)) for group in groups)):
        order = list(range(k))
        for group, permuted in zip(groups, choice, strict=True):
            for place, function in zip(group, permuted, strict=True):
                order[place] = function
        orders.append(order)
    return orders


def _arrangements(group: list[int]) -> list[list[int]]:
    """List all orders of a small group; of a larger one, which has too many, those with neighbours exchanged once."""
    if len(group) <= _SMALL_GROUP:
        return [list(order) for order in permutations(group)]
    exchanged = [[*group[:i], group[i + 1], group[i], *group[i + 2 :]] for i in range(len(group) - 1)]
    return [group, *exchanged]
