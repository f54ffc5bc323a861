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
    turns = random_turns(5)
    bases, missed, seen = posed_controls(rig, TURNED, turns, np.zeros((5, 6, 3)))
    assert missed.max() < 0.001
    assert seen.tolist() == [True, False, False, False, True]
    check(rig, bases, turns)


def check(rig, bases, turns):
    """Assert that the bones turn as wanted with these transforms of the controls."""
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


def random_turns(count):
    return Rotation.random(count * 6, random_state=3).as_matrix().reshape(count, 6, 3, 3)


@pytest.mark.parametrize("alone", [(), ("c1",)])
def test_of_a_long_motion_few_poses_are_looked_at(updates, alone):
    rig = chains(*alone)
    updates.clear()
    bases, missed, seen = posed_controls(rig, TURNED, random_turns(81), np.zeros((81, 6, 3)))
    assert np.flatnonzero(seen).tolist() == [0, 16, 32, 48, 64, 80]
    assert len(updates) <= 6 + 3  # to begin and to end, and once more to learn what carries a limb
    assert missed.max() < 0.001
    check(rig, bases, random_turns(81))


def half_carried(rig, influence):
    """Let a bone that carries "c2" turn only so far as "c0" does, and for the rest with "c1" that it hangs on."""
    bpy.context.view_layer.objects.active = rig
    bpy.ops.object.mode_set(mode="EDIT")
    bones = rig.data.edit_bones
    between = bones.new("between")
    between.head, between.tail, between.parent = bones["c2"].head, bones["c2"].tail, bones["c1"]
    bones["c2"].parent = between
    bpy.ops.object.mode_set(mode="OBJECT")
    follows = rig.pose.bones["between"].constraints.new("COPY_ROTATION")
    follows.target, follows.subtarget, follows.influence = rig, "c0", influence
    return follows


@pytest.mark.parametrize("influence", [0.3, 0.5, 1.0])
def test_what_goes_part_of_the_way_with_another_control_is_known_after_one_pose(influence):
    rig = chains()
    half_carried(rig, influence)
    bases, missed, seen = posed_controls(rig, TURNED, random_turns(33), np.zeros((33, 6, 3)))
    assert seen.sum() == 3
    assert missed.max() < 0.001
    check(rig, bases, random_turns(33))


def test_where_controls_are_held_otherwise_each_pose_is_looked_at():
    rig = chains()
    half_carried(rig, 0.0)
    limit = rig.pose.bones["between"].constraints.new("LIMIT_ROTATION")
    limit.use_limit_x, limit.min_x, limit.max_x, limit.owner_space = True, 1.4, 1.8, "POSE"
    turns = np.tile(np.eye(3), (49, 6, 1, 1))
    turns[17:] = random_turns(32)
    bases, missed, seen = posed_controls(rig, TURNED, turns, np.zeros((49, 6, 3)))
    assert missed.max() < 0.001
    check(rig, bases, turns)
    assert np.flatnonzero(~seen).tolist() == list(range(1, 16))  # at rest


def test_the_scene_that_is_shown_is_not_evaluated(updates):
    rig = chains()
    updates.clear()
    objects = set(bpy.data.objects)
    posed_controls(rig, TURNED, random_turns(2), np.zeros((2, 6, 3)))
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
