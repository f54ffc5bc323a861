# SPDX-License-Identifier: GPL-3.0-or-later
"""Flat quadratic matching: all points at once, exactly, by branch and bound.

This is the method without a hierarchy, which hierarchical matching is measured against (the paper's figure 4).  With
about forty points it begins to take long to prove the optimum.
"""

from __future__ import annotations

from ..exact.branch_and_bound import LARGEST


def flat_candidates(points: int, samples: int) -> int:
    """Choose how many of the samples of Y to offer: twice as many as points, as far as an exact search allows.

    Never less than the points, which have to find room.
    """
    return min(samples, max(points, min(2 * points, LARGEST // points)))
