# SPDX-License-Identifier: GPL-3.0-or-later
"""Test poses bend one joint at a time, and leave nothing behind."""

from __future__ import annotations

import bpy
import numpy as np
import pytest
from hiermatch.hiermatch_addon.scene.posing.exercise import is_exercising
from hiermatch.hiermatch_addon.scene.posing.rest_mesh_io import plays_actions

from tests.addon.operators.carrying.test_fit_rig import add_weights, fit, shown
from tests.addon.rigs import CONTROLS, add_rigged, add_target, pose
from tests.addon.scenes import add_blob
from tests.skeletons import CREATURE_BONES

DEFORMING = set(CREATURE_BONES) - set(CONTROLS)


def state(armature):
    """All that test poses may change for a while."""
    scene = bpy.context.scene
    animation = armature.animation_data
    return {
        "actions": sorted(action.name for action in bpy.data.actions),
        "action": animation.action.name if animation and animation.action else "",
        "nla": animation.use_nla if animation else True,
        "markers": [(marker.name, marker.frame) for marker in scene.timeline_markers],
        "frames": (scene.frame_start, scene.frame_end, scene.frame_current, scene.use_preview_range),
        "pose": [tuple(map(tuple, bone.matrix_basis)) for bone in armature.pose.bones],
        "muted": [one.mute for bone in armature.pose.bones for one in bone.constraints],
        "keys": sorted(armature.keys()),
        "kept": [name for name in scene.keys() if name.startswith("hiermatch_test")],  # noqa: SIM118 - not a dict
    }


@pytest.fixture
def rigged():
    obj, armature = add_rigged()
    armature.animation_data_create().action = bpy.data.actions.new("Walk")
    pose(armature, 0.3)
    armature.pose.bones["head"].constraints.new("COPY_ROTATION").target = obj
    for name, frame in (("Jump", 7), ("neck", 77)):  # the latter as a bone is called
        bpy.context.scene.timeline_markers.new(name, frame=frame)
    bpy.context.scene.frame_set(5)
    return obj, armature


def test_every_joint_is_bent_alone_left_and_right_apart(rigged):
    obj, armature = rigged
    assert bpy.ops.hiermatch.test_poses(target=obj.name) == {"FINISHED"}
    scene = bpy.context.scene
    markers = {marker.name: marker.frame for marker in scene.timeline_markers if marker.frame not in {7, 77}}
    assert set(markers) == DEFORMING
    assert len(set(markers.values())) == len(DEFORMING)
    scene.frame_set(scene.frame_start)
    rest = shown(obj)
    for name, frame in markers.items():
        scene.frame_set(frame)
        bent = {bone.name for bone in armature.pose.bones if bone.matrix_basis.to_quaternion().angle > 1e-3}
        assert bent == {name}
        assert np.linalg.norm(shown(obj) - rest, axis=1).max() > 0.02, name
    scene.frame_set(scene.frame_end)
    np.testing.assert_allclose(shown(obj), rest, atol=1e-5)


@pytest.mark.parametrize("options", [{}, {"remove": True}])
def test_pressed_again_it_leaves_nothing_behind(rigged, options):
    obj, armature = rigged
    before = state(armature)
    bpy.ops.hiermatch.test_poses(target=obj.name)
    assert state(armature) != before
    bpy.context.scene.frame_set(9)
    bpy.ops.hiermatch.test_poses(target=obj.name, **options)
    assert state(armature) == before


@pytest.mark.parametrize("first", ["Source", "Other"])
def test_two_rigs_that_end_one_after_the_other_leave_nothing_behind(rigged, first):
    obj, armature = rigged
    other, _ = add_rigged("Other")
    before, scene = state(armature), bpy.context.scene
    for name in (obj.name, other.name):
        bpy.ops.hiermatch.test_poses(target=name)
    last, both = scene.frame_end, len(scene.timeline_markers)
    assert bpy.ops.hiermatch.test_poses(target=first) == {"FINISHED"}
    assert scene.frame_end == last
    assert both - len(scene.timeline_markers) == len(DEFORMING)
    bpy.ops.hiermatch.test_poses(target=obj.name if first == other.name else other.name)
    assert state(armature) == before


def test_a_scene_gets_its_own_frames_back_whichever_is_shown(rigged):
    obj, armature = rigged
    scene = bpy.context.scene
    before, other = state(armature), bpy.data.scenes.new("Other")
    other.frame_end = 500
    other.collection.objects.link(obj)
    other.collection.objects.link(armature)
    bpy.ops.hiermatch.test_poses(target=obj.name)
    scene.name = "Renamed"
    with bpy.context.temp_override(scene=other, view_layer=other.view_layers[0]):
        assert bpy.ops.hiermatch.test_poses(target=obj.name) == {"FINISHED"}
    assert state(armature) == before
    assert (other.frame_start, other.frame_end) == (1, 500)


def test_all_frames_are_played_in_spite_of_a_preview_range(rigged):
    obj, armature = rigged
    scene = bpy.context.scene
    scene.use_preview_range, scene.frame_preview_start, scene.frame_preview_end = True, 100, 110
    before = state(armature)
    bpy.ops.hiermatch.test_poses(target=obj.name)
    assert not scene.use_preview_range
    bpy.ops.hiermatch.test_poses(target=obj.name)
    assert state(armature) == before
    assert (scene.frame_preview_start, scene.frame_preview_end) == (100, 110)


def test_a_rig_that_is_made_meanwhile_has_nothing_of_them(rigged):
    obj, armature = rigged
    armature.animation_data.action = None
    target, _ = add_target(obj)
    add_weights(obj, target)
    before = state(armature)
    bpy.ops.hiermatch.test_poses(target=obj.name)
    assert not plays_actions(armature)
    made, _ = fit(obj, target)
    assert not made.pose.bones["head"].constraints[0].mute
    assert {name for name in made.keys() if name.startswith("hiermatch")} == {"hiermatch_rig_of"}  # noqa: SIM118
    bpy.ops.hiermatch.test_poses(target=target.name)
    bpy.ops.hiermatch.test_poses(target=target.name)
    assert is_exercising(armature)
    bpy.ops.hiermatch.test_poses(target=obj.name)
    assert state(armature) == before


def test_a_rig_that_is_made_anew_meanwhile_plays_them_no_longer(rigged):
    obj, _ = rigged
    target, _ = add_target(obj)
    add_weights(obj, target)
    made, _ = fit(obj, target)
    pose(made, 0.2)
    before = state(made)
    bpy.ops.hiermatch.test_poses(target=target.name)
    assert fit(obj, target, existing="UPDATE")[0] == made
    assert not is_exercising(made)
    assert state(made) == before


@pytest.mark.parametrize("ended", ["original", "copy", "copy alone"])
def test_a_copy_that_is_made_meanwhile_has_them_no_longer_than_the_rig(rigged, ended):
    _, armature = rigged
    before = state(armature)
    bpy.ops.hiermatch.test_poses(target=armature.name)
    bpy.context.view_layer.objects.active = armature
    for obj in bpy.context.view_layer.objects:
        obj.select_set(obj == armature)
    assert bpy.ops.object.duplicate() == {"FINISHED"}
    copy = bpy.context.view_layer.objects.active
    assert copy != armature
    if ended == "copy alone":
        bpy.data.objects.remove(armature)
        armature = copy
    chosen = armature if ended == "original" else copy
    assert bpy.ops.hiermatch.test_poses(target=chosen.name, remove=True) == {"FINISHED"}
    for rig in {armature, copy}:
        assert not is_exercising(rig)
        assert not [name for name in rig.keys() if name.startswith("hiermatch")]  # noqa: SIM118 - not a dict
        left = state(rig)
        assert {name: left[name] for name in before if name != "actions"} == {
            name: before[name] for name in before if name != "actions"
        }
        assert not [action.name for action in bpy.data.actions if "Test Poses" in action.name and action.users]


def test_to_remove_what_is_not_there_changes_nothing(rigged):
    _, armature = rigged
    before = state(armature)
    assert bpy.ops.hiermatch.test_poses(target=armature.name, remove=True) == {"FINISHED"}
    assert state(armature) == before


def test_bones_and_action_that_are_gone_meanwhile_are_no_matter(rigged):
    obj, armature = rigged
    bpy.ops.hiermatch.test_poses(target=obj.name)
    bpy.data.actions.remove(bpy.data.actions["Walk"])
    armature.animation_data.action.name = "Renamed"
    bpy.context.view_layer.objects.active = armature
    bpy.ops.object.mode_set(mode="EDIT")
    armature.data.edit_bones.remove(armature.data.edit_bones["tail tip"])
    bpy.ops.object.mode_set(mode="OBJECT")
    assert bpy.ops.hiermatch.test_poses(target=obj.name) == {"FINISHED"}
    assert not bpy.data.actions
    assert [marker.name for marker in bpy.context.scene.timeline_markers] == ["Jump", "neck"]


def test_a_strip_that_is_tweaked_is_tweaked_again(rigged):
    obj, armature = rigged
    animation = armature.animation_data
    animation.action = None
    track = animation.nla_tracks.new()
    track.strips.new("Strip", 31, bpy.data.actions.new("Nod")).select = True
    animation.nla_tracks.active = track
    animation.use_tweak_mode = True
    before = state(armature)
    assert before["action"] == "Nod"
    assert bpy.ops.hiermatch.test_poses(target=obj.name) == {"FINISHED"}
    assert bpy.ops.hiermatch.test_poses(target=obj.name, remove=True) == {"FINISHED"}
    assert state(armature) == before
    assert animation.use_tweak_mode
    animation.use_tweak_mode = False
    assert animation.action is None


def test_without_a_rig_it_says_what_to_do():
    add_blob("Ball")
    with pytest.raises(RuntimeError, match='"Ball" has no armature'):
        bpy.ops.hiermatch.test_poses(target="Ball")
    _, armature = add_rigged()
    bpy.data.objects.remove(bpy.data.objects["Source"])
    with pytest.raises(RuntimeError, match="moves a mesh"):
        bpy.ops.hiermatch.test_poses(target=armature.name)


def test_bones_whose_groups_are_empty_are_not_bent(rigged):
    obj, armature = rigged
    armature.data.bones["pole front.L"].use_deform = True
    obj.vertex_groups.new(name="pole front.L").add([0], 0.0, "REPLACE")  # as importers make them for all bones
    assert bpy.ops.hiermatch.test_poses(target=obj.name) == {"FINISHED"}
    assert "pole front.L" not in bpy.context.scene.timeline_markers
