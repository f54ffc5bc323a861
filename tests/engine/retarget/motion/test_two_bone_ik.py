# SPDX-License-Identifier: GPL-3.0-or-later
"""Limbs bent to where they are to end."""

import numpy as np
import pytest

from engine.retarget.motion.two_bone_ik import bent_limb, needed_drop


@pytest.fixture
def limbs():
    """Random limbs, (f, 3, 3)."""
    random = np.random.default_rng(0)
    joints = np.zeros((50, 3, 3))
    joints[:, 1] = random.normal(size=(50, 3))
    joints[:, 2] = joints[:, 1] + random.normal(size=(50, 3))
    return joints + random.normal(size=(50, 1, 3))


def applied(joints, upper, lower):
    """Where middle and end are afterwards."""
    middle = joints[:, 0] + np.einsum("fij,fj->fi", upper, joints[:, 1] - joints[:, 0])
    return middle, middle + np.einsum("fij,fj->fi", lower, joints[:, 2] - joints[:, 1])


def test_the_end_gets_to_its_goal_and_bones_keep_their_lengths(limbs):
    lengths = np.linalg.norm(np.diff(limbs, axis=1), axis=2)
    reach = np.random.default_rng(1).uniform(0.2, 0.9, len(limbs))
    least, most = np.abs(lengths[:, 0] - lengths[:, 1]), lengths.sum(axis=1)
    way = np.random.default_rng(2).normal(size=(len(limbs), 3))
    way *= ((least + reach * (most - least)) / np.linalg.norm(way, axis=1))[:, None]
    upper, lower = bent_limb(limbs, limbs[:, 0] + way)
    _, end = applied(limbs, upper, lower)
    assert np.allclose(end, limbs[:, 0] + way)
    for turn in (upper, lower):
        assert np.allclose(turn @ np.swapaxes(turn, 1, 2), np.eye(3))
        assert np.allclose(np.linalg.det(turn), 1)


def test_a_goal_where_it_ends_anyway_turns_nothing(limbs):
    upper, lower = bent_limb(limbs, limbs[:, 2])
    assert np.allclose(upper, np.eye(3), atol=1e-6)
    assert np.allclose(lower, np.eye(3), atol=1e-6)


def test_it_bends_in_its_own_plane(limbs):
    goals = limbs[:, 0] + 0.7 * (limbs[:, 2] - limbs[:, 0])
    lengths = np.linalg.norm(np.diff(limbs, axis=1), axis=2)
    near = np.linalg.norm(goals - limbs[:, 0], axis=1) > np.abs(lengths[:, 0] - lengths[:, 1])
    middle, _ = applied(limbs, *bent_limb(limbs, goals))
    normals = np.cross(limbs[:, 1] - limbs[:, 0], limbs[:, 2] - limbs[:, 0])
    assert np.allclose(np.einsum("fi,fi->f", normals, middle - limbs[:, 0])[near], 0, atol=1e-9)
    side = np.einsum("fi,fi->f", np.cross(middle - limbs[:, 0], limbs[:, 2] - limbs[:, 0]), normals)
    assert (side[near] > 0).all()  # the knee stays on its side


def test_what_is_out_of_reach_is_pointed_at():
    straight = np.array([[[0.0, 0, 1], [0, 0.01, 0.5], [0, 0, 0]]])
    goal = np.array([[3.0, 0, 1]])
    _, end = applied(straight, *bent_limb(straight, goal))
    assert np.allclose(end / np.linalg.norm(end - [0, 0, 1]), [[1, 0, 1]], atol=1e-2)


def test_a_straight_limb_can_be_bent_too():
    straight = np.array([[[0.0, 0, 1], [0, 0, 0.5], [0, 0, 0]]] * 3)
    goals = np.array([[0.0, 0, 0.2]] * 3)
    _, end = applied(straight, *bent_limb(straight, goals))
    assert np.allclose(end, goals)


def test_the_drop_is_just_what_is_needed():
    joints = np.array([[[0.0, 0, 1], [0, 0.1, 0.5], [0, 0, 0]]] * 2)
    goals = np.array([[0.6, 0.0, 0.0], [0.1, 0, 0.1]])
    up = np.array([0.0, 0, 1])
    drop = needed_drop(joints, goals, up)
    length = np.linalg.norm(np.diff(joints[0], axis=0), axis=1).sum()
    assert np.isclose(np.linalg.norm(goals[0] - joints[0, 0] + drop[0] * up), 0.9995 * length)
    assert drop[1] == 0
