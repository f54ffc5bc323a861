# SPDX-License-Identifier: GPL-3.0-or-later
"""Bones that get the names of a standard, and everything that knows them by name."""

from __future__ import annotations

from types import SimpleNamespace

import bpy
import numpy as np
import pytest
from hiermatch.hiermatch_addon.operators.motion.rename_bones import HIERMATCH_OT_rename_bones
from hiermatch.hiermatch_addon.transfers.motion.name_tables import NAME_TABLES

from tests.addon.characters import add_action, add_person, match_at_once, posed_vertices
from tests.addon.motions import curves_of
from tests.addon.panels.test_panels import Layout
from tests.addon.scenes import weights_of

rename = bpy.ops.hiermatch.rename_bones

TRUE = {
    "hips": "hips",
    "head": "head",
    "left_upper_arm": "upper_arm.L",
    "left_lower_arm": "forearm.L",
    "left_hand": "hand.L",
    "right_upper_leg": "thigh.R",
    "right_lower_leg": "shin.R",
    "right_foot": "foot.R",
}


def bones(name="B"):
    return set(bpy.data.objects[name].data.bones.keys())


def test_fingers_are_called_as_vrm_does():
    names = NAME_TABLES["VRM"]
    assert [names[f"left_thumb_{part}"] for part in (1, 2, 3)] == [
        "leftThumbMetacarpal",
        "leftThumbProximal",
        "leftThumbDistal",
    ]
    assert [names[f"right_little_{part}"] for part in (1, 2, 3)] == [
        "rightLittleProximal",
        "rightLittleIntermediate",
        "rightLittleDistal",
    ]


@pytest.mark.parametrize("standard", NAME_TABLES)
def test_whatever_bones_are_called_joints_tell_what_they_are(standard):
    _, made = add_person("B", "renamed", rolls=0.4)
    places = {
        next(iter(o)): bpy.data.objects["B"].data.bones[n].head_local.copy()
        for n, o in zip(made.names, made.origins, strict=True)
    }
    assert rename(target="B", names=standard) == {"FINISHED"}
    for what, origin in TRUE.items():
        found = bpy.data.objects["B"].data.bones[NAME_TABLES[standard][what]]
        assert (found.head_local - places[origin]).length < 1e-6


def test_vertex_groups_actions_and_pairs_follow(monkeypatch):
    match_at_once(monkeypatch)
    add_person("A")
    armature, _ = add_person("B")
    bpy.ops.hiermatch.pair_bones(source="A", target="B")
    turns = {row.target: tuple(row.turn) for row in bpy.context.scene.hiermatch_bone_pairs}
    first = add_action(armature, "Played")
    other = add_action(armature, "Resting")
    first.use_fake_user = True
    armature.animation_data.action = other
    bpy.context.scene.frame_set(11)
    before = [posed_vertices(armature)]
    armature.animation_data.action = first
    bpy.context.scene.frame_set(11)
    before.append(posed_vertices(armature))
    body = bpy.data.objects["B Body"]
    weights = weights_of(body)["forearm.L"]
    mask, body.shape_key_add(name="Basis").vertex_group = body.modifiers.new("Mask", "MASK"), "forearm.L"
    mask.vertex_group, mask.show_viewport = "forearm.L", False
    assert rename(target="B", names="UNREAL") == {"FINISHED"}
    assert mask.vertex_group == body.data.shape_keys.key_blocks[0].vertex_group == "lowerarm_l"
    assert weights_of(bpy.data.objects["B Body"])["lowerarm_l"] == weights
    for action, wanted in zip((other, first), before, strict=True):
        armature.animation_data.action = action
        bpy.context.scene.frame_set(1)
        bpy.context.scene.frame_set(11)
        np.testing.assert_allclose(posed_vertices(armature), wanted, atol=1e-5)
    rows = {row.target: row for row in bpy.context.scene.hiermatch_bone_pairs}
    assert tuple(rows["lowerarm_l"].turn) == turns["forearm.L"]
    assert rows["lowerarm_l"].is_seen
    assert rows["lowerarm_l"].source == "forearm.L"


def test_from_one_standard_to_another_and_exchanged_names():
    armature, _ = add_person("B")
    rename(target="B", names="MIXAMO")
    left, right = (armature.data.bones[f"mixamorig:{side}Arm"] for side in ("Left", "Right"))
    place = left.head_local.copy()
    left.name = "passing"
    right.name = "mixamorig:LeftArm"
    left.name = "mixamorig:RightArm"
    assert rename(target="B", known="MIXAMO", names="UNREAL") == {"FINISHED"}
    assert (armature.data.bones["upperarm_r"].head_local - place).length < 1e-6  # the table goes by names
    rename(target="B", names="UNREAL")
    assert (armature.data.bones["upperarm_l"].head_local - place).length < 1e-6  # joints do not


def test_as_the_bones_of_the_source_are_called(monkeypatch):
    match_at_once(monkeypatch)
    add_person("A")
    _, made = add_person("B", "renamed", hanging=True)
    origins = {name: next(iter(o)) for name, o in zip(made.names, made.origins, strict=True)}
    with pytest.raises(RuntimeError, match="Pair their bones first"):
        rename(source="A", target="B", names="SOURCE")
    bpy.ops.hiermatch.pair_bones(source="A", target="B")
    heads = {origins[bone.name]: bone.head_local.copy() for bone in bpy.data.objects["B"].data.bones}
    assert rename(source="A", target="B", names="SOURCE") == {"FINISHED"}
    assert all(
        (bpy.data.objects["B"].data.bones[name].head_local - place).length < 1e-6 for name, place in heads.items()
    )


@pytest.mark.parametrize("edited", [False, True])
def test_names_alone_are_no_edit_of_what_was_carried(monkeypatch, edited):
    match_at_once(monkeypatch)
    source, _ = add_person("A")
    target, _ = add_person("B", "renamed")
    add_action(source)
    bpy.ops.hiermatch.retarget_action(source="A", target="B")
    made = target.animation_data.action
    if edited:
        next(iter(curves_of(made).values())).keyframe_points[0].co[1] += 0.1
    rename(source="A", target="B", names="SOURCE")
    bpy.ops.hiermatch.retarget_action(source="A", target="B")
    assert ("Wave B (edited)" in bpy.data.actions) == edited
    assert (target.animation_data.action == made) != edited


def test_refusals_change_nothing():
    armature, _ = add_person("B")
    armature.data.bones["toe.L"].name = "thigh_l"
    before = bones()
    with pytest.raises(RuntimeError, match="has a name of that standard"):
        rename(target="B", known="MIXAMO", names="VRM")
    group = bpy.data.objects["B Body"].vertex_groups.new(name="upperarm_l")
    with pytest.raises(RuntimeError, match="other vertex groups"):
        rename(target="B", names="UNREAL")
    bpy.data.objects["B Body"].vertex_groups.remove(group)
    assert bones() == before
    with pytest.raises(RuntimeError, match="no object"):
        rename(target="Nobody")


@pytest.mark.parametrize("by", ["action", "strip"])
def test_an_action_that_moves_another_armature_is_not_taken_from_it(by):
    armature, other = add_person("B")[0], add_person("C")[0]
    action = add_action(armature, "Walk")
    animation = other.animation_data_create()
    player = animation if by == "action" else animation.nla_tracks.new().strips.new("Walk", 1, action)
    player.action = action
    if hasattr(action, "slots"):
        player.action_slot = action.slots[0]
    bpy.context.scene.frame_set(11)
    before, moved = bones(), posed_vertices(other)
    with pytest.raises(RuntimeError, match='"C" plays "Walk" as well'):
        rename(target="B", names="UNREAL")
    assert bones() == before
    armature.animation_data.action = action.copy()
    assert rename(target="B", names="UNREAL") == {"FINISHED"}
    bpy.context.scene.frame_set(1)
    bpy.context.scene.frame_set(11)
    np.testing.assert_allclose(posed_vertices(other), moved, atol=1e-5)


@pytest.mark.skipif(bpy.app.version < (4, 4), reason="actions have slots from Blender 4.4 on")
def test_other_slots_of_an_action_are_no_matter():
    armature, other = add_person("B")[0], add_person("C")[0]
    action = add_action(armature, "Walk")
    animation = other.animation_data_create()
    animation.action, animation.action_slot = action, action.slots.new("OBJECT", "C")
    other.pose.bones["forearm.L"].keyframe_insert("rotation_quaternion", frame=1)
    assert rename(target="B", names="UNREAL") == {"FINISHED"}
    assert [path for path in {path for path, _ in curves_of(action)} if "forearm.L" in path]


@pytest.mark.parametrize("held", ["switched off", "parent", "same bones"])
def test_groups_that_blender_would_rename_are_looked_at_however_a_mesh_is_held(held):
    armature, _ = add_person("B")
    body = bpy.data.objects["B Body"]
    if held == "switched off":
        body.modifiers["Armature"].show_viewport = body.modifiers["Armature"].show_render = False
    elif held == "parent":
        body.modifiers.clear()
        body.parent_type = "ARMATURE"
    else:
        body.parent = body.modifiers["Armature"].object = bpy.data.objects.new("Twin", armature.data)
    body.vertex_groups.new(name="upperarm_l")
    before = bones(), weights_of(body)
    with pytest.raises(RuntimeError, match="other vertex groups"):
        rename(target="B", names="UNREAL")
    assert (bones(), weights_of(body)) == before
    body.vertex_groups.remove(body.vertex_groups["upperarm_l"])
    assert rename(target="B", names="UNREAL") == {"FINISHED"}
    assert weights_of(body)["upperarm_l"] == before[1]["upper_arm.L"]


@pytest.mark.parametrize(("names", "shown"), [("VRM", ["names", "known"]), ("SOURCE", ["names"])])
def test_a_button_asks_first_what_the_bones_are_called_and_known_by(names, shown):
    asked, drawn = [], []
    window_manager = SimpleNamespace(invoke_props_dialog=lambda operator: asked.append(operator) or {"RUNNING_MODAL"})
    operator = SimpleNamespace(names=names, layout=Layout(drawn), bl_rna=rename.get_rna_type())
    context = SimpleNamespace(window_manager=window_manager)
    assert HIERMATCH_OT_rename_bones.invoke(operator, context, None) == {"RUNNING_MODAL"}
    assert asked == [operator]
    HIERMATCH_OT_rename_bones.draw(operator, context)
    assert drawn == [("prop", name) for name in shown]


def test_what_is_no_person_is_said():
    data = bpy.data.armatures.new("Snake")
    snake = bpy.data.objects.new("Snake", data)
    bpy.context.scene.collection.objects.link(snake)
    bpy.context.view_layer.objects.active = snake
    bpy.ops.object.mode_set(mode="EDIT")
    above = None
    for number in range(6):
        bone = data.edit_bones.new(f"s{number}")
        bone.head, bone.tail, bone.parent = (0, number, 0.1), (0, number + 1, 0.1), above
        above = bone
    bpy.ops.object.mode_set(mode="OBJECT")
    with pytest.raises(RuntimeError, match="does not stand on two legs"):
        rename(target="Snake")


def test_it_says_which_mode_it_waits_for():
    bpy.context.view_layer.objects.active = add_person("B")[0]
    bpy.ops.object.mode_set(mode="EDIT")
    with pytest.raises(RuntimeError, match="Switch to Object Mode first"):
        rename(target="B")
    bpy.ops.object.mode_set(mode="POSE")
    assert rename.poll()
