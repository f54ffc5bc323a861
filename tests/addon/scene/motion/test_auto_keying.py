# SPDX-License-Identifier: GPL-3.0-or-later
"""Keys that poses get while Auto Keying is on."""

import bpy
import pytest
from hiermatch.hiermatch_addon.scene.motion.auto_keying import key_automatically

from tests.addon.characters import add_action, add_person, match_at_once
from tests.addon.motions import curves_of

ROTATION, LOCATION = 'pose.bones["neck"].rotation_quaternion', 'pose.bones["hips"].location'


@pytest.fixture
def rig():
    """An armature, and Auto Keying is on."""
    armature, _ = add_person("B")
    bpy.context.scene.tool_settings.use_keyframe_insert_auto = True
    edit = bpy.context.preferences.edit
    before = edit.use_keyframe_insert_available
    edit.use_keyframe_insert_available = False  # which is another default in Blender 5.2
    yield armature
    edit.use_keyframe_insert_available = before


def keyed(armature, scene=None):
    """Set keys for a bone that was turned and one that was moved; return the paths, with frames."""
    assert key_automatically(scene or bpy.context.scene, armature, ["neck"], ["hips"])
    animation = armature.animation_data
    curves = {} if animation is None or animation.action is None else curves_of(animation.action)
    return {
        (path, tuple(point.co[0] for point in curve.keyframe_points)) for (path, _), curve in curves.items() if curve
    }


def test_keys_are_set_at_the_frame_of_the_moment(rig):
    bpy.context.scene.frame_set(7)
    bpy.context.scene.tool_settings.keyframe_type = "EXTREME"
    assert keyed(rig) == {(ROTATION, (7,)), (LOCATION, (7,))}
    curve = curves_of(rig.animation_data.action)[ROTATION, 0]
    assert (curve.group.name, curve.keyframe_points[0].type) == ("neck", "EXTREME")
    bpy.context.scene.frame_set(9)
    bpy.context.scene.tool_settings.use_keyframe_insert_auto = False
    assert keyed(rig) == {(ROTATION, (7,)), (LOCATION, (7,))}


@pytest.mark.parametrize("name", ["replace", "available"])
def test_only_what_has_keys_gets_some(rig, name):
    tools, edit = bpy.context.scene.tool_settings, bpy.context.preferences.edit
    if name == "replace":
        tools.auto_keying_mode = "REPLACE_KEYS"
    else:
        edit.use_keyframe_insert_available = True
    assert keyed(rig) == set()
    assert rig.animation_data is None
    rig.pose.bones["hips"].keyframe_insert("location", frame=3)
    rig.pose.bones["hips"].location = 1, 2, 3  # what would change nothing is not needed
    assert keyed(rig) == {(LOCATION, (3,) if name == "replace" else (1, 3))}


@pytest.mark.parametrize(
    ("name", "paths"),
    [
        ("Location", {LOCATION}),
        ("Rotation", {ROTATION}),
        ("Location & Rotation", {LOCATION, ROTATION}),
        ("Delta Location", set()),
        ("Scale", set()),
        ("Whole Character", {LOCATION, ROTATION}),
        ("Available", set()),
    ],
)
def test_an_active_keying_set_says_which(rig, name, paths):
    scene = bpy.context.scene
    scene.tool_settings.use_keyframe_insert_keyingset = True
    scene.keying_sets_all.active = next(each for each in scene.keying_sets_all if each.bl_label == name)
    assert {path for path, _ in keyed(rig)} == paths


def test_a_keying_set_of_the_users_own_says_which(rig):
    scene = bpy.context.scene
    scene.tool_settings.use_keyframe_insert_keyingset = True
    mine = scene.keying_sets.new(idname="mine", name="Mine")
    mine.paths.add(rig, LOCATION)
    scene.keying_sets_all.active = mine
    assert keyed(rig) == {(LOCATION, (1,))}


def test_an_action_of_another_file_gets_none(rig, tmp_path):
    action = add_action(rig)
    bpy.data.libraries.write(str(tmp_path / "other.blend"), {action})
    with bpy.data.libraries.load(str(tmp_path / "other.blend"), link=True) as (_, wanted):
        wanted.actions = ["Wave"]
    rig.animation_data.action = wanted.actions[0]
    assert not key_automatically(bpy.context.scene, rig, ["neck"], ["hips"])


def test_retarget_pose_keys_the_bones_that_it_sets(rig, monkeypatch):
    match_at_once(monkeypatch)
    source, _ = add_person("A", "renamed")
    bones = bpy.context.scene.hiermatch_bone_pairs
    bpy.ops.hiermatch.pair_bones(source="A", target="B")
    add_action(source, angles=[row.source for row in bones][2:5], hips=bones[0].source)
    bpy.context.scene.frame_set(11)
    assert bpy.ops.hiermatch.retarget_pose(source="A", target="B") == {"FINISHED"}
    curves = curves_of(rig.animation_data.action)
    turned = {path for path, _ in curves if path.endswith("rotation_quaternion")}
    assert turned == {f'pose.bones["{row.target}"].rotation_quaternion' for row in bones}
    assert {path for path, _ in curves} - turned == {LOCATION}
    assert {point.co[0] for curve in curves.values() for point in curve.keyframe_points} == {11}
    before = rig.pose.bones["hips"].location.copy()
    assert before.length > 0.1
    bpy.context.scene.frame_set(1)
    assert rig.pose.bones["hips"].location == before
