# SPDX-License-Identifier: GPL-3.0-or-later
"""The target in a rest pose like the source's: the source's actions play on it, and how it stood is kept."""

from __future__ import annotations

import bpy
import numpy as np
import pytest
from hiermatch.engine.runtime.progress import run
from hiermatch.hiermatch_addon.common.errors import NothingToCarryError
from hiermatch.hiermatch_addon.scene.armature_copy import copy_to
from hiermatch.hiermatch_addon.scene.armatures import find_armature
from hiermatch.hiermatch_addon.scene.rest_action import kept_pose, was_kept
from hiermatch.hiermatch_addon.transfers.options.rig import RigSettings
from hiermatch.hiermatch_addon.transfers.rest_like_source import RestLikeSource
from hiermatch.hiermatch_addon.transfers.rig import RigTransfer
from mathutils import Matrix

from tests.addon.operators.carrying import test_fit_rig
from tests.addon.operators.carrying.test_fit_rig import TURNED, add_weights, own, shown
from tests.addon.rigs import add_rigged, add_target, pose, true_passage, unpose

STEP = {
    "neck": (0.3, 0.2, 0.0),
    "tail": (0.4, 0.0, 0.2),
    "upper front.L": (-0.5, 0.0, 0.1),
    "lower front.L": (0.6, 0.0, 0.0),
    "upper hind.R": (0.7, 0.0, 0.0),
    "lower hind.R": (-0.5, 0.0, 0.0),
}
"""A pose that is not the one in which the target stands."""


def add_action(armature):
    """Give an armature an action of one frame: a step forward, with all limbs."""
    action = bpy.data.actions.new("Step")
    armature.animation_data_create().action = action
    pose(armature, angles=STEP)
    armature.pose.bones["spine"].location = (0.1, 0.3, -0.2)
    for bone in armature.pose.bones:
        bone.rotation_mode = "XYZ"
        bone.keyframe_insert("rotation_euler", frame=1)
        bone.keyframe_insert("location", frame=1)
    return action


def play(armature, action):
    """Let an armature play an action from the beginning, with nothing else of a pose left."""
    unpose(armature)
    animation = armature.animation_data_create()
    animation.action = action
    if hasattr(animation, "action_slot") and action is not None and action.slots:
        animation.action_slot = action.slots[0]
    bpy.context.scene.frame_set(2)
    bpy.context.scene.frame_set(1)


def fit(source, target, **settings):
    """Give the target its rig and the rest pose, on the true way."""
    settings = RigSettings(**settings)
    rig = RigTransfer(settings)
    transfers = [rig, RestLikeSource(settings, rig)]
    for transfer in transfers:
        transfer.read(bpy.context, source, target)
    passage = true_passage(source, target)
    for transfer in transfers:
        run(transfer.steps(passage))
    reports = [transfer.write(bpy.context, source, target) for transfer in transfers]
    bpy.context.view_layer.update()
    return find_armature(target), reports


@pytest.fixture
def pair():
    source, armature = add_rigged()
    target, _ = add_target(source, matrix=TURNED)
    add_weights(source, target)
    action = add_action(armature)
    armature.animation_data.action = None
    unpose(armature)
    armature.animation_data.action = action
    return source, target, action


def test_the_source_s_actions_play_on_the_new_rig(pair):
    source, target, action = pair
    rest, stood = own(source), own(target)
    made, _ = fit(source, target)
    play(find_armature(source), action)
    play(made, action)
    moved, followed = shown(source), shown(target)
    assert np.linalg.norm(moved - rest, axis=1).max() > 0.3  # it is a large step
    turn = np.array(TURNED.to_3x3())
    wanted = moved @ turn.T
    apart = followed - wanted
    apart -= apart.mean(axis=0)  # where the target stands is its own affair
    assert np.linalg.norm(apart, axis=1).max() < 0.03 * np.ptp(wanted, axis=0).max()
    assert np.linalg.norm(followed - stood, axis=1).max() > 0.3


def test_what_the_target_wears_is_left_and_named(pair):
    source, target, _ = pair
    made, *_ = test_fit_rig.fit(source, target)
    vest = target.copy()
    vest.name, vest.data = "Vest on Target", target.data.copy()
    vest["hiermatch_item"], vest["hiermatch_body"] = "Vest", target.name
    bpy.context.scene.collection.objects.link(vest)
    stood = own(vest)
    again, reports = fit(source, target)
    assert again == made
    assert reports[-1].notes == ('What "Target" wears stands as before: "Vest on Target". Fit it again by Wear.',)
    np.testing.assert_allclose(own(vest), stood, atol=1e-5)
    assert fit(source, target)[1][-1].notes == ()


def test_a_step_is_as_long_as_the_body_is_large(pair):
    source, target, action = pair
    made, _ = fit(source, target)
    steps = []
    for armature, obj in ((find_armature(source), source), (made, target)):
        play(armature, None)
        before = shown(obj).mean(axis=0)
        play(armature, action)
        steps.append(np.linalg.norm(shown(obj).mean(axis=0) - before))
    assert steps[1] == pytest.approx(2 * steps[0], rel=0.05)  # it is twice as large


def test_how_the_target_stood_is_kept(pair):
    source, target, _ = pair
    key = target.shape_key_add(name="Basis")
    key = target.shape_key_add(name="Swell")
    key.data[0].co.z += 0.5
    key.value = 0.0
    stood = own(target)
    place = target.matrix_world.copy()
    made, (_, report) = fit(source, target)
    assert report.remarks
    assert np.linalg.norm(own(target) - stood, axis=1).max() > 0.1
    assert np.allclose(target.matrix_world, place, atol=1e-5)
    play(made, kept_pose(made))
    np.testing.assert_allclose(shown(target), stood, atol=2e-4 * np.ptp(stood, axis=0).max())
    target.data.shape_keys.key_blocks["Swell"].value = 1.0
    grown = shown(target)
    assert np.linalg.norm(grown[0] - stood[0]) == pytest.approx(0.5 * 2, rel=0.01)  # in the world it is twice that
    np.testing.assert_allclose(grown[1:], stood[1:], atol=2e-4 * np.ptp(stood, axis=0).max())


def test_a_second_run_keeps_the_first_pose(pair):
    source, target, _ = pair
    stood = own(target)
    made, _ = fit(source, target)
    rest, scale = own(target), made.matrix_world.to_scale()
    again, _ = fit(source, target)
    assert again == made
    np.testing.assert_allclose(own(target), rest, atol=0.03 * np.ptp(stood, axis=0).max())
    assert np.allclose(made.matrix_world.to_scale(), scale)
    play(made, kept_pose(made))
    np.testing.assert_allclose(shown(target), stood, atol=0.05 * np.ptp(stood, axis=0).max())


@pytest.mark.parametrize("spoil", ["renamed", "without its action"])
def test_a_second_run_knows_the_rig_again(pair, spoil):
    source, target, _ = pair
    made, _ = fit(source, target)
    scale, actions = made.matrix_world.to_scale(), set(bpy.data.actions.keys())
    if spoil == "renamed":
        made.name = made.data.name = "Mine"
    else:
        bpy.data.actions.remove(kept_pose(made))
    again, (_, report) = fit(source, target)
    assert again == made
    assert np.allclose(made.matrix_world.to_scale(), scale)  # it has grown with the body once
    assert not report.remarks
    assert set(bpy.data.actions.keys()) <= actions
    copied = copy_to(bpy.context, made, "Other", target)
    assert kept_pose(made) is None or spoil == "renamed"
    assert not was_kept(copied)


@pytest.mark.parametrize(("settings", "wanted"), [({}, False), ({"like_source": "ON"}, True)])
def test_without_actions_it_is_made_on_demand(settings, wanted):
    source, _ = add_rigged()
    target, _ = add_target(source)
    rig = RigTransfer(RigSettings(**settings))
    rig.read(bpy.context, source, target)
    rest = RestLikeSource(RigSettings(**settings), rig)
    if wanted:
        rest.read(bpy.context, source, target)
    else:
        with pytest.raises(NothingToCarryError):
            rest.read(bpy.context, source, target)


@pytest.mark.parametrize("settings", [{"like_source": "OFF"}, {"bind": False}, {"pose": "REST"}])
def test_it_can_be_left_out(pair, settings):
    source, target, _ = pair
    rig = RigTransfer(RigSettings(**settings))
    rig.read(bpy.context, source, target)
    with pytest.raises(NothingToCarryError):
        RestLikeSource(RigSettings(**settings), rig).read(bpy.context, source, target)


def test_what_cannot_be_brought_to_rest_stays_and_is_said(pair):
    source, target, _ = pair
    other = bpy.data.objects.new("Twin", target.data)
    bpy.context.scene.collection.objects.link(other)
    stood = own(target)
    _, (_, report) = fit(source, target)
    assert not report.done
    assert "shares its mesh data" in report.notes[0]
    np.testing.assert_allclose(shown(target), stood, atol=1e-4)


def test_a_mesh_with_a_fake_user_is_shared_with_nobody(pair):
    source, target, _ = pair
    target.data.use_fake_user = True
    _, (_, report) = fit(source, target)
    assert report.done
    assert not report.notes


def test_an_armature_at_another_scale_is_no_matter(pair):
    source, target, action = pair
    find_armature(source).matrix_world = Matrix.Scale(0.01, 4) @ find_armature(source).matrix_world
    bpy.context.view_layer.update()
    made, _ = fit(source, target)
    for armature in (find_armature(source), made):
        play(armature, action)
    moved, followed = shown(source), shown(target)
    turn = np.array(TURNED.to_3x3()) * 100
    apart = followed - moved @ turn.T
    apart -= apart.mean(axis=0)
    assert np.linalg.norm(apart, axis=1).max() < 0.03 * np.ptp(followed, axis=0).max()
