# SPDX-License-Identifier: GPL-3.0-or-later
"""Chains and trees, aligned."""

import numpy as np

from engine import Skeleton
from engine.retarget.motion.tree_alignment import aligned


def tree(parents):
    """A skeleton of which only who hangs on whom matters."""
    points = np.zeros((len(parents), 3))
    return Skeleton(np.array(parents), points, points + np.array([0, 0, 1]))


def chain(count):
    return tree(range(-1, count - 1))


def gains(ours, theirs, reach=0.25):
    """What pairs are worth whose places along a chain are near to one another."""
    return 0.6 - np.abs(np.subtract.outer(ours, theirs)) / reach


def test_the_same_chain_is_aligned_with_itself_even_if_one_place_is_off():
    places = np.arange(5) / 5
    moved = places + np.array([0, 0.102, 0.102, 0.102, 0])  # each nearer to the next one
    assert (aligned(gains(moved, places), chain(5), chain(5), np.ones(5, bool)) == np.arange(5)).all()


def test_five_stand_for_three_and_three_for_five():
    five, three = (np.arange(5) + 0.5) / 5, (np.arange(3) + 0.5) / 3
    fine = aligned(gains(five, three, 0.5), chain(5), chain(3), np.ones(3, bool))
    assert (np.diff(fine) >= 0).all()
    assert set(fine) == {0, 1, 2}
    coarse = aligned(gains(three, five, 0.5), chain(3), chain(5), np.ones(5, bool))
    assert (np.diff(coarse) > 0).all()


def test_what_fits_nothing_stays_alone_and_its_children_do_not():
    worth = np.full((3, 2), -1.0)
    worth[0, 0] = worth[2, 1] = 0.5
    assert aligned(worth, chain(3), chain(2), np.ones(2, bool)).tolist() == [0, -1, 1]


def test_branches_are_not_exchanged_for_a_little_gain():
    # A trunk with two arms of two bones each; the lower bone of the first looks a little more like that of the other.
    arms = tree([-1, 0, 1, 0, 3])
    worth = np.eye(5) - 0.5
    worth[2, 2], worth[2, 4] = 0.3, 0.45
    assert (aligned(worth, arms, arms, np.ones(5, bool)) == np.arange(5)).all()


def test_a_foot_that_hangs_on_the_root_is_found_below_the_leg():
    normal, detached = tree([-1, 0, 1, 2]), tree([-1, 0, 1, 0])
    worth = np.eye(4) - 0.5
    for one, other in ((normal, detached), (detached, normal)):
        assert (aligned(worth, one, other, np.ones(4, bool)) == np.arange(4)).all()


def test_what_is_forbidden_is_never_chosen():
    worth = np.full((2, 2), -np.inf)
    worth[1, 1] = 0.2
    assert aligned(worth, chain(2), chain(2), np.ones(2, bool)).tolist() == [-1, 1]
