# SPDX-License-Identifier: GPL-3.0-or-later
"""Actions that are carried over once more: what was made before is replaced, or kept."""

import bpy
import pytest
from hiermatch.hiermatch_addon.transfers.motion import motion_job
from mathutils import Matrix

from tests.addon.characters import add_action, add_person
from tests.addon.motions import curves_of, worst

carry = bpy.ops.hiermatch.retarget_action


def test_the_table_is_kept_and_a_second_run_uses_it(monkeypatch):
    source, _ = add_person("A")
    add_person("B", "renamed")
    add_action(source)
    carry(source="A", target="B")
    assert len(bpy.context.scene.hiermatch_bone_pairs) == 22
    monkeypatch.setattr(motion_job, "pairing_job", None)
    assert carry(source="A", target="B") == {"FINISHED"}


def test_a_bone_whose_pair_was_removed_goes_with_its_parent_in_the_next_run():
    source, _ = add_person("A")
    target, made = add_person("B", "renamed")
    add_action(source)
    carry(source="A", target="B")
    arm, shin = (made.names[made.origins.index(frozenset([name]))] for name in ("forearm.L", "shin.R"))
    bpy.context.scene.frame_set(11)
    turned = {name: target.pose.bones[name].matrix_basis.to_quaternion().angle for name in (arm, shin)}
    assert min(turned.values()) > 0.1
    bpy.ops.hiermatch.remove_bone_pair(source="A", target="B", target_bone=arm)
    carry(source="A", target="B")
    for frame in (1, 11):
        bpy.context.scene.frame_set(frame)
        assert target.pose.bones[arm].matrix_basis == Matrix()
    assert target.pose.bones[shin].matrix_basis.to_quaternion().angle == pytest.approx(turned[shin], abs=1e-4)


def test_what_was_carried_before_is_made_anew_in_its_place():
    """Strips and tracks that play it do so, and none is there twice."""
    source, _ = add_person("A")
    target, _ = add_person("B", "renamed")
    add_action(source)
    source.animation_data.nla_tracks.new().strips.new("Wave", 30, bpy.data.actions["Wave"])
    options = {"source": "A", "target": "B", "action": "Wave", "strips": True}
    carry(**options)
    made, (track,) = target.animation_data.action, target.animation_data.nla_tracks
    track.strips[0].repeat = 3
    before = curves_values(made)
    carry(**options, keying="ALL")
    assert target.animation_data.action == made
    assert set(bpy.data.actions.keys()) == {"Wave", "Wave B"}
    assert curves_values(made) != before
    (track,) = target.animation_data.nla_tracks
    assert (track.strips[0].action, track.strips[0].repeat, track.strips[0].frame_start) == (made, 3, 30)
    assert worst_of_strip(source, target) < 0.012
    carry(**options)
    assert curves_values(made) == before
    assert not bpy.context.scene.hiermatch_retarget.report.notes


@pytest.mark.parametrize(("strips", "assign"), [(False, True), (True, False), (False, False)])
def test_a_rig_that_was_renamed_since_has_its_action_made_anew(strips, assign):
    source, _ = add_person("A")
    target, _ = add_person("B", "renamed")
    other, _ = add_person("C", "renamed")
    add_action(source)
    source.animation_data.nla_tracks.new().strips.new("Wave", 30, bpy.data.actions["Wave"])
    carry(source="A", target="B", action="Wave", strips=strips, assign=assign)
    target.name = "Giant"
    before = curves_values(bpy.data.actions["Wave B"])
    carry(source="A", target="Giant", action="Wave", strips=strips, assign=assign, keying="ALL")
    assert set(bpy.data.actions.keys()) == {"Wave", "Wave B"}
    assert curves_values(bpy.data.actions["Wave B"]) != before
    carry(source="A", target="C", action="Wave")
    assert other.animation_data.action.name == "Wave C"
    carry(source="A", target="Giant", action="Wave", strips=strips, assign=assign)
    assert set(bpy.data.actions.keys()) == {"Wave", "Wave B", "Wave C"}


def curves_values(action):
    """Frames and values of all keys, but for rounding."""
    return {
        which: [(point.co[0], round(point.co[1], 5) + 0.0) for point in curve.keyframe_points]
        for which, curve in curves_of(action).items()
    }


def worst_of_strip(source, target):
    """As `worst`, but of what strips play."""
    played = [rig.animation_data.action for rig in (source, target)]
    for rig in (source, target):
        rig.animation_data.action = None
    found = worst(source, target, (35, 45))
    for rig, action in zip((source, target), played, strict=True):
        rig.animation_data.action = action
    return found


@pytest.mark.parametrize("edit", ["key", "interpolation", "modifier", "range"])
def test_what_was_carried_and_edited_since_is_kept(edit):
    source, _ = add_person("A")
    target, _ = add_person("B", "renamed")
    add_action(source)
    carry(source="A", target="B")
    made = target.animation_data.action
    curve = next(iter(curves_of(made).values()))
    if edit == "key":
        curve.keyframe_points[0].co[1] += 0.1
    elif edit == "interpolation":
        curve.keyframe_points[0].interpolation = "BOUNCE"
    elif edit == "modifier":
        curve.modifiers.new("NOISE")
    else:
        made.use_frame_range, made.frame_end = True, 10
    before = curves_values(made)
    target.animation_data.nla_tracks.new().strips.new("Mine", 30, made)
    carry(source="A", target="B")
    assert (made.name, target.animation_data.action.name) == ("Wave B (edited)", "Wave B")
    assert curves_values(made) == before
    assert target.animation_data.nla_tracks[0].strips[0].action == made
    said = '"Wave B" was edited since it had been made. The edited one is kept as "Wave B (edited)".'
    assert said in bpy.context.scene.hiermatch_retarget.report.notes
    carry(source="A", target="B")
    assert set(bpy.data.actions.keys()) == {"Wave", "Wave B", "Wave B (edited)"}


def test_what_was_carried_and_renamed_or_is_used_by_others_stays():
    source, _ = add_person("A")
    target, _ = add_person("B", "renamed")
    other, _ = add_person("C", "renamed")
    add_action(source)
    carry(source="A", target="B")
    target.animation_data.action.name = "Mine"
    carry(source="A", target="B")
    used = target.animation_data.action
    other.animation_data_create().action = used
    before = curves_values(used)
    for _ in range(2):
        carry(source="A", target="B", keying="ALL")
        assert set(bpy.data.actions.keys()) == {"Wave", "Mine", "Wave B", "Wave B.001"}
    assert (other.animation_data.action, curves_values(used)) == (used, before)
    assert target.animation_data.action.name == "Wave B.001"


def test_what_an_action_made_by_hand_left_stays():
    source, _ = add_person("A")
    target, made = add_person("B", "renamed")
    add_action(source)
    bpy.ops.hiermatch.pair_bones(source="A", target="B")
    arm = made.names[made.origins.index(frozenset(["forearm.L"]))]
    bpy.ops.hiermatch.remove_bone_pair(source="A", target="B", target_bone=arm)
    add_action(target, "By Hand", [arm], hips=made.names[made.origins.index(frozenset(["hips"]))])
    bpy.context.scene.frame_set(11)
    before = target.pose.bones[arm].matrix_basis.copy()
    carry(source="A", target="B", action="Wave")
    bpy.context.scene.frame_set(1)
    assert target.pose.bones[arm].matrix_basis == before
