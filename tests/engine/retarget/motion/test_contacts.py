# SPDX-License-Identifier: GPL-3.0-or-later
"""Feet that stand."""

import numpy as np

from engine.retarget.motion.contacts import contacts_of, grounded_lifts, held_shifts

UP = np.array([0.0, 0.0, 1.0])
RATE = 30


def stepping():
    """Ankle and ball of a foot that stands for a second, steps forward, and stands again: (f, 2, 3)."""
    stand, swing = 30, 15
    x = np.concatenate([np.zeros(stand), 0.7 * np.linspace(0, 1, swing), np.full(stand, 0.7)])
    z = np.concatenate([np.zeros(stand), 0.15 * np.sin(np.pi * np.linspace(0, 1, swing)), np.zeros(stand)])
    ball = np.stack([x, 0 * x, z], axis=1)
    return np.stack([ball + np.array([-0.1, 0, 0.08]), ball], axis=1)


def test_standing_is_low_and_slow_and_swinging_is_not():
    touching = contacts_of(stepping(), UP, 0.9, RATE)
    assert touching[:28].all()
    assert touching[47:].all()
    assert not touching[33:42].any()


def test_a_foot_may_have_stood_before_the_motion_begins_and_after_it_ends():
    assert contacts_of(stepping()[:48], UP, 0.9, 100)[-2:].all()
    assert contacts_of(stepping()[27:], UP, 0.9, 100)[:2].all()
    assert not contacts_of(stepping()[31:44], UP, 0.9, 100).any()


def test_units_and_the_frame_rate_do_not_matter():
    points = stepping()
    expected = contacts_of(points, UP, 0.9, RATE)
    assert (contacts_of(100 * points, UP, 90, RATE) == expected).all()
    assert (contacts_of(points[::2], UP, 0.9, RATE / 2)[2:13] == expected[::2][2:13]).all()


def test_a_foot_that_slides_is_held_while_it_stands_and_let_go_smoothly():
    points = stepping()
    touching = contacts_of(points, UP, 0.9, RATE)
    sliding = points + 0.002 * np.arange(len(points))[:, None, None] * [1, 0.5, 0]
    shifts = held_shifts(sliding, touching, sliding @ UP, UP, RATE)
    held = sliding + shifts[:, None]
    for part in (slice(0, 28), slice(47, None)):
        assert np.ptp(held[part, 1], axis=0).max() < 1e-9
    assert np.abs(np.diff(shifts, axis=0)).max() < 0.02
    assert np.abs(shifts[:28]).max() < 0.035  # to the middle of where it was


def test_a_shift_fades_before_a_foot_stands_and_after_and_is_never_more_than_while_it_does():
    points = np.zeros((50, 2, 3))
    touching = np.zeros((50, 2), bool)
    touching[15:22] = touching[25:35] = True
    shifts = held_shifts(points, touching, points @ UP + 0.05, UP, RATE) @ UP
    np.testing.assert_allclose(shifts[15:35], 0.05)
    assert (np.diff(shifts[:16]) >= 0).all()
    assert (np.diff(shifts[34:]) <= 0).all()
    assert np.abs(np.diff(shifts)).max() < 0.02
    assert shifts[0] == shifts[-1] == 0


def test_the_height_is_the_one_wanted():
    points = stepping()
    touching = contacts_of(points, UP, 0.9, RATE)
    shifts = held_shifts(points + 0.05 * UP, touching, points @ UP, UP, RATE)
    assert np.allclose((points[:28, 1] + 0.05 * UP + shifts[:28]) @ UP, 0, atol=1e-3)


def test_from_heel_to_ball_nothing_jumps():
    points = stepping()
    touching = np.zeros((len(points), 2), bool)
    touching[:20, 0] = touching[15:30, 1] = True
    sliding = points + 0.002 * np.arange(len(points))[:, None, None] * [1, 0, 0]
    shifts = held_shifts(sliding, touching, sliding @ UP, UP, RATE)
    assert np.abs(np.diff(shifts[:30], axis=0)).max() < 0.0025


def test_what_never_stands_is_not_shifted():
    points = stepping()
    assert not held_shifts(points, np.zeros((len(points), 2), bool), points @ UP, UP, RATE).any()


def test_a_foot_near_the_ground_is_brought_to_its_height_without_standing():
    wanted = np.array([[0.0, 0.0], [0.02, 0.0], [0.5, 0.5]])
    heights = wanted + np.array([[0.05], [-0.03], [0.1]])
    lifts = grounded_lifts(heights, wanted, np.zeros(2), 1.0)
    assert np.isclose(lifts[0], -0.05)
    assert np.isclose(lifts[1], 0.03)  # neither point is below the ground
    assert lifts[2] == 0  # high above the ground it is left alone


def test_it_does_not_matter_where_the_ground_is():
    random = np.random.default_rng(1)
    wanted, heights = random.uniform(-0.1, 0.4, (50, 2)), random.uniform(-0.4, 0.4, (50, 2))
    level = np.array([0.0, 0.02])
    there = grounded_lifts(heights + 7, wanted + 7, level + 7, 1.0)
    np.testing.assert_allclose(there, grounded_lifts(heights, wanted, level, 1.0), atol=1e-12)


def test_no_point_of_a_foot_goes_through_the_ground_unless_the_source_s_does():
    random = np.random.default_rng(0)
    wanted, heights = random.uniform(-0.1, 0.4, (50, 2)), random.uniform(-0.4, 0.4, (50, 2))
    after = heights + grounded_lifts(heights, wanted, np.array([0.0, 0.02]), 1.0)[:, None]
    assert (after >= np.minimum(wanted, [0.0, 0.02]) - 1e-12).all()
