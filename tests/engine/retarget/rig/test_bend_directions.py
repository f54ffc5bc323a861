# SPDX-License-Identifier: GPL-3.0-or-later
from __future__ import annotations

import numpy as np
import pytest

from engine import Skeleton
from engine.retarget.rig.bend_directions import kept_bends
from engine.retarget.rig.joint_carriers import joint_places
from tests.shapes import rotation

LIMB = np.array([[0, 0, 0], [0, -0.06, -1.0], [0, 0, -2.0]])


def leg(joints=LIMB):
    return Skeleton(np.arange(-1, len(joints) - 2), joints[:-1], joints[1:])


def bent(joints, turn=None):
    """Joints of the leg after its bends were looked after."""
    before, places = leg(), joint_places(leg())
    turns = np.tile(np.eye(3) if turn is None else turn, (2, 1, 1))
    heads, tails = kept_bends(before, joints[:-1], joints[1:], turns, places)
    np.testing.assert_array_equal(heads[1:], tails[:-1])
    return np.concatenate([heads, tails[-1:]])


@pytest.mark.parametrize("knee", [0.0, 0.03, 0.05])
def test_a_knee_that_is_straight_or_bent_backward_is_bent_forward(knee):
    joints = LIMB.copy()
    joints[1, 1] = knee
    np.testing.assert_allclose(bent(joints)[1], [0, -0.03, -1], atol=1e-9)


def test_what_is_bent_alike_stays():
    joints = LIMB * [1, 0.8, 1.3]
    np.testing.assert_array_equal(bent(joints), joints)


def test_what_is_posed_otherwise_stays():
    joints = LIMB.copy()
    joints[1, 1] = 0.6
    np.testing.assert_array_equal(bent(joints), joints)


def test_direction_goes_with_the_body():
    turn = rotation(np.array([0.0, 0, 1]), 0.5)
    straight = LIMB * [1, 0, 1]
    np.testing.assert_allclose(bent(straight, turn)[1], turn @ [0, -0.03, 0] + [0, 0, -1], atol=1e-9)


def test_straight_limbs_are_left_alone():
    straight = LIMB * [1, 0, 1]
    tree = leg(straight)
    moved = straight + np.array([[0, 0, 0], [0, 0.02, 0], [0, 0, 0]])
    heads, _ = kept_bends(tree, moved[:-1], moved[1:], np.tile(np.eye(3), (2, 1, 1)), joint_places(tree))
    np.testing.assert_array_equal(heads, moved[:-1])
