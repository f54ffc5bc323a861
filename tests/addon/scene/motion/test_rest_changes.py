# SPDX-License-Identifier: GPL-3.0-or-later
"""Which bones of a rig went along with the others since they were remembered."""

import numpy as np
import pytest
from hiermatch.hiermatch_addon.scene.motion.rest_changes import change_of_rest
from mathutils import Matrix

TURN = np.array(Matrix.Rotation(2, 3, (1, 2, 3)))
"""What most bones are turned by, beside a scale of 0.01."""

WAY = np.array([3.0, -1, 2])


def bones(points):
    """Bones as long as a tenth that point up from points (n, 3), with the point beside the head to the front."""
    return np.stack([points, points + np.array([0, 0, 0.1]), points + np.array([0, 0.1, 0])], axis=1)


def turned(parts, angle, joint):
    """Bones turned in the plane of the body about a joint."""
    return (parts - joint) @ np.array(Matrix.Rotation(angle, 3, "Y")).T + joint


def rig(fingers):
    """A trunk of 12 bones, and of either arm three and so many fingers."""
    trunk = bones(np.linspace([0, 0, 0], [0, 0, 1.6], 12))
    trunk[6:, :, 0] += 0.2
    arms = [
        bones(
            np.concatenate(
                [np.linspace([0.2, 0, 1.4], [0.8, 0, 1.4], 3), np.linspace([0.8, 0, 1.4], [0.8, 0.14, 1.4], fingers)]
            )
        )
        * [side, 1, 1]
        for side in (1, -1)
    ]
    return trunk, arms


@pytest.mark.parametrize("angle", [0.0, 0.4, 1.5])
def test_arms_of_more_bones_than_the_trunk_do_not_take_it_along(angle):
    trunk, arms = rig(fingers=7)
    now = [trunk, *(turned(arm, side * angle, [0.2 * side, 0, 1.4]) for arm, side in zip(arms, (1, -1), strict=True))]
    before, after = np.concatenate([trunk, *arms]), 0.01 * np.concatenate(now) @ TURN.T + WAY
    linear, translation, held = change_of_rest(before.reshape(-1, 9), after.reshape(-1, 9))
    np.testing.assert_allclose(linear, 0.01 * TURN, atol=1e-8)
    np.testing.assert_allclose(translation, WAY, atol=1e-7)
    assert held[: len(trunk)].all()
    assert held[len(trunk) :].all() == (angle == 0)


def test_turns_of_bones_about_themselves_are_no_matter():
    trunk, arms = rig(fingers=0)
    before = np.concatenate([trunk, *arms])
    after = before.copy()
    angles = np.random.default_rng(0).uniform(0, 2 * np.pi, len(before))
    after[:, 2] = after[:, 0] + 0.1 * np.stack([np.cos(angles), np.sin(angles), 0 * angles], axis=1)
    linear, translation, held = change_of_rest(before.reshape(-1, 9), (after @ TURN.T + WAY).reshape(-1, 9))
    np.testing.assert_allclose(linear, TURN, atol=1e-6)
    np.testing.assert_allclose(translation, WAY, atol=1e-6)
    assert held.all()


def test_bones_in_a_line_know_how_they_were_turned_about_it():
    before = bones(np.linspace([0, 0, 0], [0, 0, 1], 5))
    linear, _, held = change_of_rest(before.reshape(-1, 9), (before @ TURN.T + WAY).reshape(-1, 9))
    np.testing.assert_allclose(linear, TURN, atol=1e-6)
    assert held.all()


def test_what_is_mirrored_did_not_go_along_and_what_is_not_remembered_did():
    trunk, arms = rig(fingers=0)
    before = np.concatenate([trunk, *arms]).reshape(-1, 9)
    before[0] = 0
    mirrored = (before.reshape(-1, 3, 3) * [1, -1, 1] + [0, 0.5, 0]).reshape(-1, 9)
    assert change_of_rest(0 * before, before)[2].all()
    assert change_of_rest(before, mirrored)[2][0]
