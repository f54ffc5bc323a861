# SPDX-License-Identifier: GPL-3.0-or-later
"""Bones that stand for one another, in groups."""

import numpy as np

from engine import Skeleton
from engine.retarget.motion.segments import Segments


def tree(parents):
    points = np.zeros((len(parents), 3))
    return Skeleton(np.array(parents), points, points + np.array([0, 0, 1]))


def test_a_chain_of_two_that_stands_for_three_is_one_segment():
    sources, targets = np.array([0, 0, 1, 2]), np.array([0, 1, 1, 3])
    segments = Segments.of(sources, targets, tree([-1, 0, 1]), tree([-1, 0, 1, 2]))
    assert [part.tolist() for part in segments.targets] == [[0, 1], [3]]
    assert [part.tolist() for part in segments.sources] == [[0, 1], [2]]
    assert segments.parents.tolist() == [-1, 0]  # past a bone without a partner
    assert segments.single.tolist() == [False, True]
    assert segments.below(0).tolist() == [1]


def test_what_hangs_elsewhere_in_the_target_is_held_as_in_the_source():
    pairs = np.arange(4)
    normal, detached = tree([-1, 0, 1, 2]), tree([-1, 0, 1, 0])
    segments = Segments.of(pairs, pairs, normal, detached)
    assert segments.parents.tolist() == [-1, 0, 1, 2]
    assert segments.carried.tolist() == [True, True, True, False]
    assert Segments.of(pairs, pairs, detached, normal).carried.all()


def test_without_pairs_there_are_none():
    nothing = np.zeros(0, np.int64)
    assert len(Segments.of(nothing, nothing, tree([-1]), tree([-1]))) == 0
