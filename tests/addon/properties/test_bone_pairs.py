# SPDX-License-Identifier: GPL-3.0-or-later
"""Pairs of bones of rigs whose rest pose is another one by now."""

import bpy
import numpy as np
import pytest
from mathutils import Matrix

from tests.addon.characters import add_action, add_person, match_at_once
from tests.addon.motions import worst

ops = bpy.ops.hiermatch

FRAMES = (1, 11, 21)

SPACES = {
    "scaled": Matrix.Scale(0.01, 4),
    "turned": Matrix.Rotation(np.pi / 2, 4, "X"),
    "moved, turned and scaled": Matrix.Translation((3, 1, 2)) @ Matrix.Rotation(2, 4, (1, 2, 3)) @ Matrix.Scale(7, 4),
}


@pytest.fixture(autouse=True)
def at_once(monkeypatch):
    """Match without work."""
    match_at_once(monkeypatch)


def put_in(armature, matrix):
    """Give an armature and what it moves another space, in which all look as they did."""
    for obj in (armature, *armature.children):
        obj.data.transform(matrix.inverted())
    armature.matrix_world = matrix
    bpy.context.view_layer.update()


def apply(armature):
    """Apply the transforms of an armature and of what it moves, at rest."""
    played = armature.animation_data and armature.animation_data.action
    armature.animation_data_clear()
    for bone in armature.pose.bones:
        bone.matrix_basis.identity()
    for obj in bpy.context.scene.objects:
        obj.select_set(obj in (armature, *armature.children))
    bpy.context.view_layer.objects.active = armature
    bpy.ops.object.transform_apply(location=True, rotation=True, scale=True)
    if played:
        armature.animation_data_create().action = played
        armature.animation_data.action_slot = played.slots[0]


@pytest.mark.parametrize("what", SPACES)
@pytest.mark.parametrize("applied", ["A", "B"])
def test_what_was_seen_goes_along_when_transforms_are_applied(capfd, applied, what, tmp_path):
    source, _ = add_person("A")
    target, _ = add_person("B", "fine")
    put_in(bpy.data.objects[applied], SPACES[what])
    add_action(source, angles=["hips", "spine1", "upper_arm.L", "thigh.R"], way=(0, 0, 0))
    assert ops.retarget_action(source="A", target="B") == {"FINISHED"}
    before = worst(source, target, FRAMES)
    ops.export_bone_pairs(source="A", target="B", filepath=str(tmp_path / "pairs.json"))
    apply(bpy.data.objects[applied])
    assert ops.retarget_action(source="A", target="B", action="Wave") == {"FINISHED"}
    assert worst(source, target, FRAMES) < before + 1e-3
    # So it does in pairs that are read from a file.
    ops.import_bone_pairs(source="A", target="B", filepath=str(tmp_path / "pairs.json"))
    assert ops.retarget_action(source="A", target="B", action="Wave") == {"FINISHED"}
    assert worst(source, target, FRAMES) < before + 1e-3
    assert "The rest pose has changed" not in capfd.readouterr().out


@pytest.mark.parametrize("applied", [False, True])
def test_bones_that_lie_otherwise_than_when_they_were_paired_go_by_how_they_lie(capfd, applied):
    source, _ = add_person("A")
    target, _ = add_person("B")
    add_action(source, angles=["hips", "spine1", "upper_arm.L", "thigh.R"])
    ops.pair_bones(source="A", target="B")
    for side, angle in (("L", 0.8), ("R", -0.8)):
        bone = target.pose.bones[f"upper_arm.{side}"]
        joint = Matrix.Translation(bone.head)
        bone.matrix = joint @ Matrix.Rotation(angle, 4, "Y") @ joint.inverted() @ bone.matrix
    bpy.context.view_layer.update()
    for part in target.children:
        bpy.context.view_layer.objects.active = part
        bpy.ops.object.modifier_apply(modifier="Armature")
        part.modifiers.new("Armature", "ARMATURE").object = target
    bpy.context.view_layer.objects.active = target
    bpy.ops.object.mode_set(mode="POSE")
    bpy.ops.pose.armature_apply(selected=False)
    bpy.ops.object.mode_set(mode="OBJECT")
    if applied:  # a transform of all comes on top
        target.matrix_world = SPACES["moved, turned and scaled"] @ Matrix.Scale(1 / 7, 4)
        apply(target)
    assert ops.retarget_action(source="A", target="B") == {"FINISHED"}
    arm = '"upper_arm.L", "forearm.L", "hand.L" and 3 more of "B"'
    assert f"these go by how they lie now: {arm}" in capfd.readouterr().out
    if not applied:
        assert worst(source, target, FRAMES) < 0.01
    # Weights say so, too.
    assert ops.transfer_paired_weights(source="A", target="B") == {"FINISHED"}
    assert "The rest pose has changed" in capfd.readouterr().out
