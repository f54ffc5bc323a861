# SPDX-License-Identifier: GPL-3.0-or-later
"""Actions for rigs whose deforming bones follow controls: keys go to the controls, whatever they are called."""

from __future__ import annotations

import bpy
import numpy as np
import pytest
from hiermatch.hiermatch_addon.scene.motion import auto_keying

from tests.addon.characters import add_action, add_person, posed_vertices, someone

ops = bpy.ops.hiermatch
LEG = ("thigh.L", "shin.L")


def add_controls(armature, *, locked=()):  # noqa: C901 - one rig
    """Let each bone follow a control at its place, and a leg a chain with a goal instead, as long as a switch is on."""
    bpy.context.view_layer.objects.active = armature
    bpy.ops.object.mode_set(mode="EDIT")
    bones = armature.data.edit_bones
    names = [bone.name for bone in bones]
    numbers = {name: f"c{number:02}" for number, name in enumerate(names)}
    for kind in ("c", "m"):
        for name in names if kind == "c" else LEG:
            own, made = bones[name], bones.new(numbers[name].replace("c", kind))
            made.head, made.tail, made.roll, made.use_deform = own.head, own.tail, own.roll, False
        for name in names if kind == "c" else LEG:
            above = bones[name].parent
            if above is not None:
                follows = kind if above.name in LEG else "c"
                bones[numbers[name].replace("c", kind)].parent = bones[numbers[above.name].replace("c", follows)]
    goal = bones.new("goal")
    goal.head, goal.tail, goal.use_deform = bones["shin.L"].tail, bones["shin.L"].tail + bones["foot.L"].vector, False
    for name in names:
        bones[name].parent = None
    bpy.ops.object.mode_set(mode="OBJECT")
    bpy.context.view_layer.objects.active = None
    pose = armature.pose.bones
    pose["goal"]["by goal"] = 1.0
    for name in names:
        pose[name].lock_rotation = (True, True, True)
        pose[numbers[name]].lock_location = (name != "hips",) * 3
        for kind in ("c", "m") if name in LEG else ("c",):
            constraint = pose[name].constraints.new("COPY_TRANSFORMS")
            constraint.target, constraint.subtarget = armature, numbers[name].replace("c", kind)
            if kind == "m":
                driver = constraint.driver_add("influence").driver
                driver.type = "AVERAGE"
                target = driver.variables.new().targets[0]
                target.id, target.data_path = armature, 'pose.bones["goal"]["by goal"]'
    for name in LEG:
        pose[numbers[name].replace("c", "m")].lock_rotation = (True, True, True)
    solver = pose[numbers["shin.L"].replace("c", "m")].constraints.new("IK")
    solver.target, solver.subtarget, solver.chain_count = armature, "goal", 2
    for name in locked:
        pose[numbers[name]].lock_rotation = (True, True, True)
    bpy.context.view_layer.update()
    return numbers


def keyed(action):
    if hasattr(action, "slots"):
        curves = [
            c for layer in action.layers for strip in layer.strips for bag in strip.channelbags for c in bag.fcurves
        ]
    else:
        curves = action.fcurves
    return {curve.data_path.split('"')[1] for curve in curves}


def test_controls_get_the_keys_and_the_switch_is_set():
    source, _ = add_person("A")
    target, _ = add_person("B", mode="XYZ")
    numbers = add_controls(target)
    add_action(source, angles=["upper_arm.L", "forearm.L", "thigh.L", "shin.L", "spine1"], frames=(1, 7, 13))
    assert ops.retarget_action(source="A", target="B", keying="ALL") == {"FINISHED"}
    action = target.animation_data.action
    assert keyed(action) <= set(numbers.values())
    assert numbers["thigh.L"] in keyed(action)
    assert target.pose.bones["goal"]["by goal"] == 0.0
    assert "by goal (goal)" in bpy.context.scene.hiermatch_retarget.report.remarks
    height = np.ptp(someone().mesh.vertices[:, 2])
    for frame in (1, 4, 7, 13):
        bpy.context.scene.frame_set(frame)
        missed = np.linalg.norm(posed_vertices(target) - posed_vertices(source), axis=1)
        assert missed.mean() < 0.01 * height


def test_what_follows_already_needs_no_switch():
    source, _ = add_person("A")
    target, _ = add_person("B")
    add_controls(target)
    target.pose.bones["goal"]["by goal"] = 0.0
    add_action(source, frames=(1, 5))
    ops.retarget_action(source="A", target="B")
    assert "was set" not in bpy.context.scene.hiermatch_retarget.report.remarks


def test_a_pose_goes_to_the_controls(monkeypatch):
    source, _ = add_person("A")
    target, _ = add_person("B")
    numbers = add_controls(target)
    bpy.context.scene.tool_settings.use_keyframe_insert_auto = True
    monkeypatch.setattr(auto_keying, "_options", lambda _tools: set())
    source.pose.bones["thigh.L"].rotation_quaternion = (0.9, 0.4, 0.1, 0.1)
    source.pose.bones["forearm.R"].rotation_quaternion = (0.9, 0.1, 0.1, 0.4)
    bpy.context.view_layer.update()
    assert ops.retarget_pose(source="A", target="B") == {"FINISHED"}
    bpy.context.view_layer.update()
    missed = np.linalg.norm(posed_vertices(target) - posed_vertices(source), axis=1)
    assert missed.mean() < 0.01 * np.ptp(someone().mesh.vertices[:, 2])
    assert numbers["thigh.L"] in (found := keyed(target.animation_data.action))
    assert found <= set(numbers.values())


@pytest.mark.parametrize("is_keyed", [True, False])
def test_switches_that_have_keys_get_one_with_the_pose(is_keyed, monkeypatch):
    source, _ = add_person("A")
    target, _ = add_person("B")
    add_controls(target)
    goal, scene = target.pose.bones["goal"], bpy.context.scene
    goal.keyframe_insert('["by goal"]' if is_keyed else "location", frame=1)
    scene.frame_set(10)
    scene.tool_settings.use_keyframe_insert_auto = True
    monkeypatch.setattr(auto_keying, "_options", lambda _tools: set())
    source.pose.bones["forearm.R"].rotation_quaternion = (0.9, 0.1, 0.1, 0.4)
    bpy.context.view_layer.update()
    assert ops.retarget_pose(source="A", target="B") == {"FINISHED"}
    for frame, value in ((1, float(is_keyed)), (10, 0.0)):
        scene.frame_set(frame)
        assert goal["by goal"] == value


def test_bones_whose_controls_are_locked_are_named():
    source, _ = add_person("A")
    target, _ = add_person("B")
    add_controls(target, locked=("forearm.R",))
    add_action(source, frames=(1, 5))
    ops.retarget_action(source="A", target="B")
    assert 'No control turns "forearm.R"' in bpy.context.scene.hiermatch_retarget.report.remarks
    assert "forearm.R" not in keyed(target.animation_data.action)


@pytest.mark.parametrize("kind", ["LIMIT_ROTATION", "IK"])
@pytest.mark.parametrize("controlled", [True, False])
def test_bones_with_limits_or_constraints_of_no_influence_get_keys(kind, controlled):
    source, _ = add_person("A")
    target, _ = add_person("B")
    if controlled:
        bpy.context.view_layer.objects.active = target
        bpy.ops.object.mode_set(mode="EDIT")
        control, head = target.data.edit_bones.new("control"), target.data.edit_bones["head"]
        control.head, control.tail, control.roll, control.use_deform = head.head, head.tail, head.roll, False
        control.parent = head.parent
        bpy.ops.object.mode_set(mode="OBJECT")
        follows = target.pose.bones["head"].constraints.new("COPY_ROTATION")
        follows.target, follows.subtarget = target, "control"
    constraint = target.pose.bones["forearm.L"].constraints.new(kind)
    if kind == "IK":
        constraint.target, constraint.subtarget, constraint.chain_count = target, "head", 2
        constraint.influence = 0
    add_action(source, angles=["upper_arm.L", "forearm.L", "head", "forearm.R"])
    assert ops.retarget_action(source="A", target="B") == {"FINISHED"}
    assert "forearm.L" in keyed(target.animation_data.action)
    report = bpy.context.scene.hiermatch_retarget.report
    assert ("Constraints hold" in report.notes) == (kind != "IK" and not controlled)
    assert "No control turns" not in report.remarks
    height = np.ptp(someone().mesh.vertices[:, 2])
    for frame in (1, 6, 11, 21):
        bpy.context.scene.frame_set(frame)
        assert np.linalg.norm(posed_vertices(target) - posed_vertices(source), axis=1).mean() < 0.005 * height


def test_the_target_stands_as_before_until_it_is_written(monkeypatch):
    source, _ = add_person("A")
    target, _ = add_person("B")
    numbers = add_controls(target)
    own = add_action(source, frames=(1, 5))
    ops.pair_bones(source="A", target="B")
    target.pose.bones[numbers["head"]].rotation_quaternion = (0.9, 0.3, 0, 0)
    before = [tuple(bone.rotation_quaternion) for bone in target.pose.bones]

    def fails(*_arguments, **_names):
        raise RuntimeError("broken")

    from hiermatch.hiermatch_addon.transfers.motion import steered_rig

    monkeypatch.setattr(steered_rig, "posed_controls", fails)
    with pytest.raises(RuntimeError, match="broken"):
        ops.retarget_action(source="A", target="B", action=own.name)
    assert [tuple(bone.rotation_quaternion) for bone in target.pose.bones] == before
    assert target.pose.bones["goal"]["by goal"] == 1.0
    assert target.animation_data.action is None
