# SPDX-License-Identifier: GPL-3.0-or-later
"""Controls posed so that bones turn as wanted, in few evaluations, and everything as it was before."""

from __future__ import annotations

import bpy
import numpy as np
import pytest
from hiermatch.hiermatch_addon.scene.motion.control_pose_io import Controls, posed_controls
from scipy.spatial.transform import Rotation

from tests.addon.steered import DEFORMING, TURNING, chains

TURNED = Controls(TURNING)


@pytest.mark.parametrize("alone", [(), ("c1",), ("c1", "c2", "c5")])
def test_controls_stand_so_that_all_bones_turn_as_wanted(alone):
    rig = chains(*alone)
    turns = Rotation.random(5 * 6, random_state=3).as_matrix().reshape(5, 6, 3, 3)
    bases, missed = posed_controls(rig, TURNED, turns, np.zeros((5, 6, 3)))
    assert missed.max() < 0.001
    rest = np.array([rig.data.bones[name].matrix_local.to_3x3() for name in DEFORMING])
    for pose, wanted in zip(bases, turns, strict=True):
        for name, basis in zip(TURNED.turning.values(), pose, strict=True):
            rig.pose.bones[name].matrix_basis = basis.T  # Blender takes columns
        bpy.context.view_layer.update()
        found = np.array([rig.pose.bones[name].matrix.to_3x3() for name in DEFORMING])
        np.testing.assert_allclose(found, wanted @ rest, atol=1e-3)


@pytest.fixture
def updates():
    """Names of the scenes that are evaluated."""
    seen = []

    def handler(scene, *_):
        seen.append(scene.name)

    bpy.app.handlers.depsgraph_update_post.append(handler)
    yield seen
    bpy.app.handlers.depsgraph_update_post.remove(handler)


def test_controls_that_carry_each_other_are_posed_in_one_go(updates):
    rig = chains()
    updates.clear()
    turns = Rotation.random(4 * 6, random_state=3).as_matrix().reshape(4, 6, 3, 3)
    posed_controls(rig, TURNED, turns, np.zeros((4, 6, 3)))
    assert 4 <= len(updates) <= 4 + 2  # one for each pose, and to begin and to end


def test_the_scene_that_is_shown_is_not_evaluated(updates):
    rig = chains()
    updates.clear()
    objects = set(bpy.data.objects)
    turns = Rotation.random(2 * 6, random_state=3).as_matrix().reshape(2, 6, 3, 3)
    posed_controls(rig, TURNED, turns, np.zeros((2, 6, 3)))
    assert bpy.context.scene.name not in updates
    assert bpy.data.scenes.keys() == ["Scene"]
    assert set(bpy.data.objects) == objects


def test_what_was_changed_for_a_while_is_put_back_to_the_last_bit():
    rig = chains()
    bone = rig.pose.bones["c1"]
    bone.rotation_quaternion, bone.location, bone.rotation_euler = (-2.0, 0, 0, 0), (0.1, 0.2, 0.3), (7.0, 0, 0)
    before = [(tuple(b.rotation_quaternion), tuple(b.location), tuple(b.rotation_euler)) for b in rig.pose.bones]
    posed_controls(rig, TURNED, np.tile(np.eye(3), (1, 6, 1, 1)), np.zeros((1, 6, 3)))
    after = [(tuple(b.rotation_quaternion), tuple(b.location), tuple(b.rotation_euler)) for b in rig.pose.bones]
    assert after == before
