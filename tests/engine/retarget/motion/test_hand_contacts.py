# SPDX-License-Identifier: GPL-3.0-or-later
"""Hands near the body."""

import numpy as np

from engine.retarget.motion.hand_contacts import BodyLine, hand_shifts


def line(offset=0.0, share=1.0, count=3):
    """A trunk from z = 0 to 1, in the target moved along x."""
    trunk = np.tile([[0.0, 0, 0], [0, 0, 1]], (count, 1, 1))
    return BodyLine(trunk, trunk + np.array([offset, 0, 0]), share)


def test_a_hand_on_the_body_stays_there_and_one_away_from_it_is_free():
    palms = np.array([[0.1, 0, 0.5], [0.2, 0, 0.7], [0.9, 0, 0.5]])
    shifts = hand_shifts(palms, palms, [line(0.3)], 1.0, np.eye(3))
    assert np.allclose(shifts[:2], [0.3, 0, 0])
    assert np.allclose(shifts[2], 0)


def test_the_distance_is_scaled_and_turned_with_the_body():
    palms = np.tile([0.1, 0, 0.5], (3, 1))
    turn = 2 * np.array([[0.0, -1, 0], [1, 0, 0], [0, 0, 1]])
    shifts = hand_shifts(palms, np.zeros((3, 3)), [line()], 1.0, turn)
    assert np.allclose(shifts, [0, 0.2, 0.5])


def test_two_hands_meet_half_way():
    left, right = np.array([[0.05, 0, 0.0]]), np.array([[-0.05, 0, 0.0]])
    apart = np.array([[0.2, 0, 0.0]]), np.array([[-0.2, 0, 0.0]])
    hands = [np.stack([hand[0], hand[0]])[None] for hand in (left, right, *apart)]
    moved = [
        goal + hand_shifts(palm, goal, [BodyLine(source, target, 0.5)], 1.0, np.eye(3))
        for palm, goal, source, target in ((left, apart[0], hands[1], hands[3]), (right, apart[1], hands[0], hands[2]))
    ]
    assert np.allclose(moved[0] - moved[1], left - right)


def test_without_a_body_nothing_moves():
    assert not hand_shifts(np.zeros((2, 3)), np.ones((2, 3)), [], 1.0, np.eye(3)).any()
