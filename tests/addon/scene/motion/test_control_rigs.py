# SPDX-License-Identifier: GPL-3.0-or-later
"""Which control turns which bone, from what followed each of them."""

from __future__ import annotations

import itertools

import bpy
import pytest
from hiermatch.hiermatch_addon.scene.motion.control_pose_io import Controls
from hiermatch.hiermatch_addon.scene.motion.control_rigs import (
    Candidates,
    candidates_of,
    chosen_controls,
    tried_controls,
    with_carrier,
)

from tests.addon.steered import DEFORMING, TURNING, chains

TREE = {"hips": "", "spine": "hips", "thigh": "hips", "half": "thigh"}
CONTROLS = ("torso", "far", "c thigh", "c half")
FOLLOWS, ASTRAY = 0.01, 0.5


@pytest.fixture
def armature():
    """Bones that deform, each on the one above, and controls."""
    data = bpy.data.armatures.new("Rig")
    rig = bpy.data.objects.new("Rig", data)
    bpy.context.scene.collection.objects.link(rig)
    bpy.context.view_layer.objects.active = rig
    bpy.ops.object.mode_set(mode="EDIT")
    for number, name in enumerate((*TREE, *CONTROLS)):
        bone = data.edit_bones.new(name)
        bone.head, bone.tail = (number, 0, 0), (number, 0, 1)
    for name, parent in TREE.items():
        data.edit_bones[name].parent = data.edit_bones.get(parent)
    bpy.ops.object.mode_set(mode="OBJECT")
    bpy.context.view_layer.objects.active = None
    return rig


def tried(**followers):
    """What followed each control: for hips, spine, thigh and half how far each was turned otherwise, and moved."""
    found = {((), name.replace("_", " ")): dict(zip(TREE, each, strict=True)) for name, each in followers.items()}
    return Candidates(tuple(TREE), CONTROLS, (), {name: set() for name in TREE}, found)


def test_a_control_that_turns_the_bone_above_as_well_is_not_its_own(armature):
    still = (ASTRAY, 0.0)
    chosen = chosen_controls(
        armature,
        tried(
            far=(still, still, (FOLLOWS, 0.9), (FOLLOWS, 0.1)),  # by chance the half turns nearly around its joint
            c_thigh=(still, still, (0.0, 0.0), (FOLLOWS, 0.9)),
        ),
    )
    assert chosen.turning == {"thigh": "c thigh"}
    assert "half" not in chosen.lost  # it goes with the thigh


def test_of_two_the_one_that_leaves_the_bone_above_alone_is_its_own(armature):
    still = (ASTRAY, 0.0)
    chosen = chosen_controls(
        armature,
        tried(
            far=((FOLLOWS, 2.0), (FOLLOWS, 2.0), (FOLLOWS, 0.9), (FOLLOWS, 0.04)),
            c_thigh=(still, still, (0.0, 0.0), (FOLLOWS, 0.9)),
            c_half=(still, still, still, (FOLLOWS, 0.0)),
        ),
    )
    assert chosen.turning["half"] == "c half"


def test_what_carries_the_body_is_posed_by_the_bone_that_it_carries(armature):
    far = (FOLLOWS, 0.9)
    found = tried(torso=(far, (FOLLOWS, 0.1), far, far), c_thigh=((ASTRAY, 0), (ASTRAY, 0), (0.0, 0.0), far))
    chosen = with_carrier(armature, found, chosen_controls(armature, found), ["hips"])
    assert chosen.placed == ("hips",)
    assert next(bone for bone, control in chosen.turning.items() if control == "torso") == "hips"


def test_controls_of_different_limbs_are_tried_together_with_the_same_result():
    rig = chains()
    found = candidates_of(rig, DEFORMING)
    groups = found.together(found.free)
    assert sorted(itertools.chain(*groups)) == sorted(found.free)
    assert len(groups) == 3
    tried_controls(rig, found, groups, ())
    single = candidates_of(rig, DEFORMING)
    tried_controls(rig, single, [[name] for name in single.free], ())
    assert chosen_controls(rig, found) == chosen_controls(rig, single) == Controls(TURNING)
    for key, followers in single.followers.items():
        assert {name: error for name, (error, _) in found.followers[key].items()} == pytest.approx(
            {name: error for name, (error, _) in followers.items()}, abs=1e-4
        )


def test_controls_that_a_driver_ties_together_are_tried_one_by_one():
    rig = chains()
    driver = rig.pose.bones["d4"].constraints[0].driver_add("influence").driver
    target = driver.variables.new().targets[0]
    target.id, target.data_path = rig, 'pose.bones["c0"].rotation_quaternion[0]'
    found = candidates_of(rig, DEFORMING)
    assert not any({"c0", other} <= set(group) for group in found.together(found.free) for other in ("c3", "c4"))
    assert any("c5" in group and len(group) == 2 for group in found.together(found.free))
