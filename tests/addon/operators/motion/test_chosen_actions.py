# SPDX-License-Identifier: GPL-3.0-or-later
"""Which actions are carried over, and what is said of those that are not."""

import bpy
import pytest

from tests.addon.characters import add_action, add_person

carry = bpy.ops.hiermatch.retarget_action


def test_actions_are_named_by_patterns():
    source, _ = add_person("A")
    add_person("B", "renamed")
    for name in ("Walk", "Walk;Fast", "Nod", "Run"):
        add_action(source, name).use_fake_user = True
    made = []
    for text in ("Walk;Fast", "Walk*;Run", "R?n"):
        before = set(bpy.data.actions.keys())
        carry(source="A", target="B", action=text)
        made.append(sorted(set(bpy.data.actions.keys()) - before))
        for name in made[-1]:
            bpy.data.actions.remove(bpy.data.actions[name])
    assert made == [["Walk;Fast B"], ["Run B", "Walk B", "Walk;Fast B"], ["Run B"]]
    there = '"Nod", "Run", "Walk" and 1 more'
    with pytest.raises(RuntimeError, match=f'fits the pattern "Jump.". Its actions are {there}'):
        carry(source="A", target="B", action="Jump*")
    there = '"Walk", "Walk;Fast", "Nod" and 1 more'  # first those that may be meant
    with pytest.raises(RuntimeError, match=f'no action called "walk". Those of "A" are {there}'):
        carry(source="A", target="B", action="Run;walk")


def test_without_a_name_the_only_action_is_meant_and_what_others_play_is_theirs():
    source, _ = add_person("A")
    target, _ = add_person("B")  # its bones have the same names
    add_action(source, "Wave").use_fake_user = True
    source.animation_data_clear()
    add_action(target, "Dance")
    assert carry(source="A", target="B", assign=False) == {"FINISHED"}
    assert set(bpy.data.actions.keys()) == {"Wave", "Dance", "Wave B"}
    bpy.data.actions.remove(bpy.data.actions["Wave B"])
    add_action(source, "Nod").use_fake_user = True
    source.animation_data_clear()
    with pytest.raises(RuntimeError, match=r'plays no action\. Name one of .*: "Nod", "Wave"'):
        carry(source="A", target="B")
    assert carry(source="A", target="B", actions="ALL") == {"FINISHED"}
    assert {"Wave B", "Nod B"} <= set(bpy.data.actions.keys())
    assert "Dance B" not in bpy.data.actions


def test_what_moves_more_bones_of_another_rig_is_none_of_the_sources_actions():
    """Actions from FBX are played by nobody, and most rigs have a bone that is called "head"."""
    source, _ = add_person("A")
    target, made = add_person("B", "renamed")
    target.pose.bones[made.names[made.origins.index(frozenset({"head"}))]].name = "head"
    own = [bone.name for bone in target.pose.bones if "head" not in bone.name]
    add_action(target, "Idle", ["head", *own[3:6]], hips=own[0]).use_fake_user = True
    target.animation_data_clear()
    for name in ("Walk", "Nod"):
        add_action(source, name).use_fake_user = True
    source.animation_data_clear()
    assert carry(source="A", target="B", actions="ALL") == {"FINISHED"}
    assert set(bpy.data.actions.keys()) == {"Idle", "Walk", "Nod", "Walk B", "Nod B"}
    assert carry(source="A", target="B", action="Idle") == {"FINISHED"}  # named, it is carried all the same
    assert "Idle B" in bpy.data.actions


def test_an_action_that_is_played_and_moves_no_bone_is_named():
    source, _ = add_person("A")
    add_person("B", "renamed")
    for name in ("Wave", "Walk"):
        add_action(source, name).use_fake_user = True
    source.animation_data.action = bpy.data.actions.new("Slide")
    source.keyframe_insert("location", frame=1)
    with pytest.raises(
        RuntimeError, match=r'"A" plays "Slide", which moves none of its bones\. Name .* "Walk", "Wave"'
    ):
        carry(source="A", target="B")


def test_actions_that_move_only_the_object_are_named_if_they_are_meant():
    source, _ = add_person("A")
    add_person("B", "renamed")
    wave = add_action(source, "Wave")
    source.animation_data_clear()
    source.keyframe_insert("location", frame=1)
    source.location.x = 2
    source.keyframe_insert("location", frame=11)
    slide, animation = source.animation_data.action, source.animation_data
    slide.name = "Slide"
    animation.action = None
    report = bpy.context.scene.hiermatch_retarget.report
    for options in ({"actions": "ALL"}, {"action": "Wave", "strips": True}):
        carry(source="A", target="B", **options)
        assert "Slide" not in report.notes
    animation.nla_tracks.new().strips.new("Slide", 1, slide)
    animation.nla_tracks.new().strips.new("Wave", 1, wave)
    said = 'Actions that move only the object "A", and none of its bones, were left out: "Slide".'
    for options in ({"actions": "ALL"}, {"action": "Wave", "strips": True}):
        carry(source="A", target="B", **options)
        assert said in report.notes
    carry(source="A", target="B", action="Wave")
    assert "Slide" not in report.notes


def test_exchanged_source_and_target_are_told():
    source, _ = add_person("A")
    add_person("B", "renamed")
    add_action(source)
    for options in ({}, {"actions": "ALL"}, {"action": "W*"}):
        with pytest.raises(RuntimeError, match=r'"B" has no action .*, but there are some of "A"\. Exchange Source'):
            carry(source="B", target="A", **options)


def test_what_was_carried_over_is_not_carried_again():
    source, _ = add_person("A")
    add_person("B")  # its bones have the same names
    for name in ("Wave", "Walk", "Nod"):
        add_action(source, name).use_fake_user = True
    source.animation_data_clear()
    for options in ({"actions": "ALL"}, {"actions": "ALL"}, {"action": "W*"}):
        assert carry(source="A", target="B", **options) == {"FINISHED"}
        assert len(bpy.data.actions) == 6
    bpy.data.objects["B"].name = "Bea"  # what was made for it stays its own
    for action in list(bpy.data.actions):
        if not action.name.endswith(" B"):
            bpy.data.actions.remove(action)
    assert carry(source="Bea", target="A", actions="ALL") == {"FINISHED"}
    assert {"Nod B A", "Walk B A", "Wave B A"} <= set(bpy.data.actions.keys())
