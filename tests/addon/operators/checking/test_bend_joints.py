# SPDX-License-Identifier: GPL-3.0-or-later
"""Test poses bend one joint at a time, and leave nothing behind."""

from __future__ import annotations

import bpy
import numpy as np
import pytest

from tests.addon.operators.carrying.test_fit_rig import shown
from tests.addon.rigs import CONTROLS, add_rigged, pose
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
        "frames": (scene.frame_start, scene.frame_end, scene.frame_current),
        "pose": [tuple(map(tuple, bone.matrix_basis)) for bone in armature.pose.bones],
        "muted": [one.mute for bone in armature.pose.bones for one in bone.constraints],
        "keys": sorted(armature.keys()),
    }


@pytest.fixture
def rigged():
    obj, armature = add_rigged()
    armature.animation_data_create().action = bpy.data.actions.new("Walk")
    pose(armature, 0.3)
    armature.pose.bones["head"].constraints.new("COPY_ROTATION").target = obj
    bpy.context.scene.timeline_markers.new("Jump", frame=7)
    bpy.context.scene.frame_set(5)
    return obj, armature


def test_every_joint_is_bent_alone_left_and_right_apart(rigged):
    obj, armature = rigged
    assert bpy.ops.hiermatch.test_poses(target=obj.name) == {"FINISHED"}
    scene = bpy.context.scene
    markers = {marker.name: marker.frame for marker in scene.timeline_markers if marker.name != "Jump"}
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
    assert [marker.name for marker in bpy.context.scene.timeline_markers] == ["Jump"]


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
