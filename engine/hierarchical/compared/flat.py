# SPDX-License-Identifier: GPL-3.0-or-later
"""Flat quadratic matching: all points at once, exactly.

This is the method without a hierarchy, which hierarchical matching is measured against.
"""

from __future__ import annotations

from ...runtime.progress import Steps
from ..exact.branch_and_bound import BoundedMatching, distinct_matchings_steps
from ..sampled_pair import Pair

_PAIRS = 5000  # of a point and a candidate: what an exact search takes


def flat_candidates(points: int, samples: int) -> int:
    """Choose how many of the samples of Y to offer: twice as many as points, as far as an exact search allows.

    Never less than the points, which have to find room.
    """
    return min(samples, max(points, min(2 * points, _PAIRS // points)))


def flat_steps(
    pair: Pair, points: int, candidates: int | None = None, *, count: int = 1, radius: float = 0.2, node_limit: int
) -> Steps[list[BoundedMatching]]:
    """Match all points at once to samples of Y, by branch and bound.

    With about twenty points it begins to take long to prove the optimum; what is returned then says so, and holds a
    lower bound (the paper's figure 4 [1]_).

    Parameters
    ----------
    pair : Pair
        The two shapes.
    points : int
        How many samples of X to match.
    candidates : int, optional
        How many samples of Y to offer; see `flat_candidates`.
    count : int
        How many distinct matchings to find, such as the true and the mirrored one.
    radius : float
        How far apart half of the points of distinct matchings have to lie, in the units of the distances.
    node_limit : int
        For each matching: number of nodes after which its search stops.

    Yields
    ------
    Progress
        About every 0.1 s of work, for some dozens of points.

    Returns
    -------
    list of BoundedMatching
        At most `count`, the best one first.

    Raises
    ------
    MatchError
        If there are too many points for an exact search, or more than samples of Y.

    References
    ----------
    .. [1] D. Raviv, A. Dubrovina, R. Kimmel, "Hierarchical Matching of Non-rigid Shapes", SSVM 2011.
    """
    if candidates is None:
        candidates = flat_candidates(points, len(pair.target.samples))
    return (yield from distinct_matchings_steps(pair.problem(points, candidates), count, radius, node_limit))
