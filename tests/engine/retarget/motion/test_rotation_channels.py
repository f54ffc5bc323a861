# SPDX-License-Identifier: GPL-3.0-or-later
"""Rotations as channels and back, without jumps."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from engine import RigError, rotation_channels, rotation_matrices

MODES = ("QUATERNION", "AXIS_ANGLE", "XYZ", "XZY", "YXZ", "YZX", "ZXY", "ZYX")


def turning(count=200):
    """Rotations that go on and on, more than twice around, through all kinds of directions."""
    times = np.linspace(0, 1, count)
    first = Rotation.from_rotvec(times[:, None] * 14 * np.array([0.6, 0.0, 0.8]))
    return (first * Rotation.from_rotvec(times[:, None] * [0.0, 2.0, 0.3])).as_matrix()


@pytest.mark.parametrize("mode", MODES)
def test_there_and_back_without_jumps(mode):
    matrices = turning()
    channels = rotation_channels(matrices, mode)
    assert np.allclose(rotation_matrices(channels, mode), matrices)
    values = channels if mode != "AXIS_ANGLE" else channels[:, :1]
    assert np.abs(np.diff(values, axis=0)).max() < 1.0


def test_the_order_of_angles_is_that_in_which_they_are_applied():
    angles = np.radians([[90.0, 0, 90]])
    assert np.allclose(rotation_matrices(angles, "XYZ")[0] @ [0, 1, 0], [0, 0, 1])  # around x first
    assert np.allclose(rotation_matrices(angles, "ZYX")[0] @ [0, 1, 0], [-1, 0, 0])


def test_a_quaternion_may_have_any_length_and_none():
    assert np.allclose(rotation_matrices(np.array([[3.0, 0, 0, 3], [0, 0, 0, 0]]), "QUATERNION")[1], np.eye(3))


def test_rest_is_no_rotation_about_some_axis():
    assert np.allclose(rotation_channels(np.eye(3)[None], "AXIS_ANGLE"), [[0, 0, 1, 0]])


@pytest.mark.parametrize("mode", ["QUATERNION", "AXIS_ANGLE", "XYZ"])
def test_no_frames_have_no_channels(mode):
    assert rotation_channels(np.zeros((0, 3, 3)), mode).shape == (0, 3 if mode == "XYZ" else 4)


def test_unknown_modes_are_refused():
    with pytest.raises(RigError, match="cannot be kept in 3 channels"):
        rotation_matrices(np.zeros((1, 3)), "XXZ")
