# SPDX-License-Identifier: GPL-3.0-or-later
"""How deep places lie behind a surface, seen from many sides."""

import numpy as np

from engine.retarget.wear.sight_lines import depths_behind
from tests.shapes import icosphere

CELL = 0.12


def ball():
    """Points on a ball of radius one, closer to each other than cells are wide."""
    return icosphere(40)[0]


def test_the_middle_of_a_ball_lies_as_deep_as_its_radius_from_every_side():
    depths = np.array(list(depths_behind(ball(), np.zeros((1, 3)), CELL, 30)))
    assert depths.shape == (30, 1)
    np.testing.assert_allclose(depths, 1.0, atol=0.02)


def test_a_place_above_a_ball_is_before_it_from_above_and_behind_it_from_below():
    above = np.array([[0.0, 0.0, 1.5]])
    depths = np.concatenate(list(depths_behind(ball(), above, CELL, 200)))
    seen = depths[np.isfinite(depths)]
    # Straight through: half above the ball's top, and two and a half behind its bottom.
    assert seen.min() < -0.4
    assert 2.2 < seen.max() < 2.52
    # From the sides nothing is in the way.
    assert np.isneginf(depths).any()


def test_the_order_of_the_points_does_not_matter():
    places = np.random.default_rng(0).standard_normal((20, 3))
    depths = np.array(list(depths_behind(ball(), places, CELL, 12)))
    for depth, again in zip(depths, depths_behind(ball()[::-1], places, CELL, 12), strict=True):
        np.testing.assert_allclose(depth, again, atol=1e-12)
