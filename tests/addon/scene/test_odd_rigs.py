# SPDX-License-Identifier: GPL-3.0-or-later
"""The rig fit with rigs and files that are set up unusually."""

from __future__ import annotations

import bpy
import numpy as np

from tests.addon.operators.carrying.test_fit_rig import add_weights, fit, own, shown
from tests.addon.rigs import add_rigged, add_target


def test_a_library_override_is_copied_as_a_rig_of_its_own(tmp_path):
    _, armature = add_rigged()
    path = str(tmp_path / "library.blend")
    bpy.data.libraries.write(path, {armature})
    bpy.ops.wm.read_homefile(use_empty=True)
    source, armature = add_rigged()
    bpy.data.objects.remove(armature)
    with bpy.data.libraries.load(path, link=True) as (there, here):
        here.objects = list(there.objects)
    bpy.context.scene.collection.objects.link(here.objects[0])
    override = here.objects[0].override_create(remap_local_usages=True)
    source.modifiers["Armature"].object = override
    target, _ = add_target(source)
    add_weights(source, target)
    made, _ = fit(source, target)
    assert made.override_library is None
    assert made.library is None
    assert made.data.library is None
    assert override.override_library is not None
    np.testing.assert_allclose(shown(target), own(target), atol=1e-5)


def test_a_second_armature_is_told():
    source, _ = add_rigged()
    _, second = add_rigged("Second")
    target, _ = add_target(source)
    source.modifiers.new("Clothes", "ARMATURE").object = second
    made, report = fit(source, target)
    assert [modifier.object for modifier in target.modifiers] == [made]
    assert any('moved by "Second Rig" as well' in note for note in report.notes)


def test_an_action_of_the_users_own_is_not_replaced():
    source, _ = add_rigged()
    target, _ = add_target(source)
    mine = bpy.data.actions.new("Target Rig Rest")
    for _ in range(2):
        fit(source, target, rest=True, pose="POSED")
    assert mine == bpy.data.actions["Target Rig Rest"]
    assert len(bpy.data.actions) == 2


def test_a_rig_in_pose_mode_stays_in_it():
    source, _ = add_rigged()
    target, _ = add_target(source)
    made, _ = fit(source, target)
    bpy.context.view_layer.objects.active = made
    bpy.ops.object.mode_set(mode="POSE")
    bpy.context.view_layer.objects.active = target
    again, _ = fit(source, target)
    assert again == made
    assert made.mode == "POSE"
    assert bpy.context.view_layer.objects.active == target


def test_a_strip_of_the_source_that_is_being_tweaked_stays_so():
    source, armature = add_rigged()
    target, _ = add_target(source)
    bone = armature.pose.bones["neck"]
    bone.rotation_mode = "XYZ"
    bone.rotation_euler = (0.5, 0, 0)
    bone.keyframe_insert("rotation_euler", frame=1)
    animation = armature.animation_data
    strip = animation.nla_tracks.new().strips.new("Nod", 1, animation.action)
    animation.action, strip.select = None, True
    animation.nla_tracks[0].select = animation.use_tweak_mode = True
    made, _ = fit(source, target)
    assert not made.animation_data.use_tweak_mode
    assert made.animation_data.action is None
    assert not made.animation_data.nla_tracks
    assert animation.use_tweak_mode
    np.testing.assert_allclose(shown(target), own(target), atol=1e-5)
