# SPDX-License-Identifier: GPL-3.0-or-later
"""Rigs that are linked, overridden, switched off, edited or changed: carried all the same, or refused in a sentence."""

import bpy
import numpy as np
import pytest
from mathutils import Matrix

from tests.addon.characters import add_action, add_person
from tests.addon.motions import snapshot, worst
from tests.addon.scenes import mesh_snapshot

carry, pose = bpy.ops.hiermatch.retarget_action, bpy.ops.hiermatch.retarget_pose


@pytest.mark.parametrize(
    ("spoil", "said"),
    [
        (lambda _source, _target: None, 'There is no action called "Run"'),
        (
            lambda _source, target: target.pose.bones["B03"].__setattr__("lock_rotation", (True, False, False)),
            "is locked",
        ),
        (lambda _source, target: bpy.data.objects.remove(target), 'no object called "B"'),
        (
            lambda source, _target: source.data.transform(Matrix.Scale(0, 4)) or source.__setattr__("scale", (0, 0, 0)),
            "scale of zero",
        ),
        (lambda source, _target: source.__setattr__("scale", (-1, 1, 1)), '"A" is mirrored by its scale'),
        (lambda _source, target: target.__setattr__("scale", (1, -1, 1)), '"B" is mirrored by its scale'),
    ],
    ids=["missing", "locked", "gone", "flat", "mirrored source", "mirrored target"],
)
def test_what_cannot_be_done_is_told_and_changes_nothing(spoil, said):
    source, _ = add_person("A")
    target, _ = add_person("B", "renamed")
    add_action(source)
    spoil(source, target)
    bpy.context.view_layer.update()
    there = "B" in bpy.data.objects
    before = snapshot(target) if there else None
    with pytest.raises(RuntimeError, match=said):
        carry(source="A", target="B", action="Run" if "Run" in said else "Wave")
    assert not there or snapshot(target) == before


def test_an_armature_in_edit_mode_and_an_action_of_others_are_refused():
    source, _ = add_person("A")
    target, _ = add_person("B", "renamed")
    add_action(source)
    bpy.data.actions.new("Empty")
    with pytest.raises(RuntimeError, match='The action "Empty" moves no bone of "A"'):
        carry(source="A", target="B", action="Empty")
    with pytest.raises(RuntimeError, match="both"):
        carry(source="A", target="A Body")
    bpy.data.actions.remove(bpy.data.actions["Wave"])
    with pytest.raises(RuntimeError, match="has no action that moves its bones"):
        carry(source="A", target="B")
    bpy.context.view_layer.objects.active = target
    bpy.ops.object.mode_set(mode="EDIT")
    assert not carry.poll()
    bpy.ops.object.mode_set(mode="OBJECT")


@pytest.mark.parametrize("operator", ["retarget_action", "retarget_pose"])
def test_linked_rigs_are_refused_and_stay_as_they_are(tmp_path, operator):
    target = add_linked_person(tmp_path, "B")
    source, _ = add_person("A")
    add_action(source)
    before = snapshot(target)
    with pytest.raises(RuntimeError, match='"B" is linked from another file'):
        getattr(bpy.ops.hiermatch, operator)(source="A", target="B")
    assert snapshot(target) == before
    assert rename_refused("B", "are linked from another file")


def test_a_library_override_is_animated_and_keeps_that_in_the_file(tmp_path):
    """Characters of productions are linked and overridden: their meshes stay the other file's."""
    target = add_overridden_person(tmp_path, "B")
    source, _ = add_person("A")
    add_action(source)
    before = {obj.name: mesh_snapshot(obj) for obj in bpy.data.objects if obj.type == "MESH" and obj.override_library}
    assert len(before) > 1
    assert bpy.ops.hiermatch.retarget_pose(source="A", target="B") == {"FINISHED"}
    assert carry(source="A", target="B") == {"FINISHED"}
    assert target.animation_data.action.name == "Wave B"
    assert {name: mesh_snapshot(bpy.data.objects[name]) for name in before} == before
    bpy.ops.wm.save_as_mainfile(filepath=str(tmp_path / "shot.blend"))
    bpy.ops.wm.open_mainfile(filepath=str(tmp_path / "shot.blend"))
    (target,) = (obj for obj in bpy.data.objects if obj.type == "ARMATURE" and obj.override_library)
    assert target.animation_data.action.name == "Wave B"
    poses = []
    for frame in target.animation_data.action.frame_range:
        bpy.context.scene.frame_set(int(frame))
        poses.append(np.array([bone.matrix for bone in target.pose.bones]))
    assert np.abs(poses[0] - poses[1]).max() > 0.01


def test_an_override_that_cannot_be_edited_is_refused(tmp_path):
    add_overridden_person(tmp_path, "B", editable=False)
    source, _ = add_person("A")
    add_action(source)
    with pytest.raises(RuntimeError, match="is a library override that cannot be edited"):
        carry(source="A", target="B")


def test_a_linked_rig_may_be_the_source(tmp_path):
    source = add_linked_person(tmp_path, "A", action="Wave")
    target, _ = add_person("B", "renamed")
    before = snapshot(source)
    assert carry(source="A", target="B", action="Wave") == {"FINISHED"}
    assert snapshot(source)[1:3] == before[1:3]
    assert target.animation_data.action.name == "Wave B"
    assert target.animation_data.action.library is None


@pytest.mark.parametrize("which", ["A", "B"])
def test_one_that_is_being_edited_is_named(which):
    source, _ = add_person("A")
    target, _ = add_person("B", "renamed")
    add_action(source)
    bpy.context.view_layer.objects.active = bpy.data.objects[which]
    bpy.ops.object.mode_set(mode="EDIT")
    bpy.context.view_layer.objects.active = bpy.data.objects["B" if which == "A" else "A"]
    before = snapshot(target)
    with pytest.raises(RuntimeError, match=f'The armature "{which}" is in Edit Mode'):
        carry(source="A", target="B", action="Wave")
    assert snapshot(target) == before
    bpy.context.view_layer.objects.active = bpy.data.objects[which]
    bpy.ops.object.mode_set(mode="OBJECT")


def add_linked_person(folder, name, *, action=""):
    """Link a person of another file into the scene, and return its armature."""
    library = library_of(folder, name, action)
    with bpy.data.libraries.load(library, link=True) as (there, here):
        here.objects = list(there.objects)
    for obj in here.objects:
        bpy.context.scene.collection.objects.link(obj)
    bpy.context.view_layer.update()
    return next(obj for obj in here.objects if obj.type == "ARMATURE")


def add_overridden_person(folder, name, *, editable=True):
    """Link a person of another file, make a library override of it, and return its armature."""
    library = library_of(folder, name)
    with bpy.data.libraries.load(library, link=True) as (_, here):
        here.collections = ["Character"]
    scene, layer = bpy.context.scene, bpy.context.view_layer
    here.collections[0].override_hierarchy_create(scene, layer, do_fully_editable=editable)
    layer.update()
    return next(obj for obj in bpy.data.objects if obj.type == "ARMATURE" and obj.override_library)


def library_of(folder, name, action=""):
    """Save a person in a collection in a file, and begin a new one."""
    armature, _ = add_person(name, "renamed" if name == "B" else "plain")
    if action:
        add_action(armature, action)
    character = bpy.data.collections.new("Character")
    bpy.context.scene.collection.children.link(character)
    for obj in list(bpy.context.scene.objects):
        character.objects.link(obj)
    path = str(folder / "library.blend")
    bpy.ops.wm.save_as_mainfile(filepath=path)
    bpy.ops.wm.read_homefile(use_empty=True)
    return path


def rename_refused(name, said):
    """Whether the bones of a rig keep their names, with a sentence."""
    before = list(bpy.data.objects[name].data.bones.keys())
    with pytest.raises(RuntimeError, match=said):
        bpy.ops.hiermatch.rename_bones(target=name, names="UNREAL")
    return list(bpy.data.objects[name].data.bones.keys()) == before


def switch_off(armature):
    """Put a character into a collection that the view layer leaves out."""
    collection = bpy.data.collections.new("Aside")
    bpy.context.scene.collection.children.link(collection)
    for obj in (armature, *armature.children):
        bpy.context.scene.collection.objects.unlink(obj)
        collection.objects.link(obj)
    bpy.context.view_layer.layer_collection.children["Aside"].exclude = True


@pytest.mark.parametrize("which", ["A", "B"])
@pytest.mark.parametrize("off", ["left out", "disabled"])
def test_one_that_blender_does_not_pose_is_carried_all_the_same(which, off):
    """Its poses in the scene all look the same."""
    source, _ = add_person("A")
    target, _ = add_person("B", "renamed")
    source.pose.bones["neck"].constraints.new("LIMIT_ROTATION")  # so that Blender has to evaluate it
    action = add_action(source)
    assert bpy.ops.hiermatch.pair_bones(source="A", target="B") == {"FINISHED"}
    chosen = bpy.data.objects[which]
    if off == "left out":
        switch_off(chosen)
    else:
        chosen.hide_viewport = True
    assert bpy.ops.hiermatch.retarget_action(source="A", target="B", action=action.name) == {"FINISHED"}
    assert chosen.hide_viewport == (off == "disabled")
    assert bpy.data.scenes.keys() == ["Scene"]
    chosen.hide_viewport = False
    bpy.context.view_layer.layer_collection.exclude = False
    for child in bpy.context.view_layer.layer_collection.children:
        child.exclude = False
    assert worst(source, target, range(1, 22, 4)) < 2e-3


def tweak(armature, action):
    """Let an armature tweak a strip of an action."""
    animation = armature.animation_data or armature.animation_data_create()
    animation.action = None
    track = animation.nla_tracks.new()
    track.strips.new("Strip", 31, action).select = True
    animation.nla_tracks.active = track
    animation.use_tweak_mode = True
    assert animation.action == action


def test_an_action_that_is_tweaked_is_carried_and_goes_on_being_tweaked():
    source, _ = add_person("A")
    target, _ = add_person("B", "renamed")
    action = add_action(source)
    source.pose.bones["neck"].constraints.new("LIMIT_ROTATION")
    tweak(source, action)
    assert carry(source="A", target="B", action="Wave") == {"FINISHED"}
    assert target.animation_data.action.name == "Wave B"
    assert target.animation_data.action.frame_range[:] == action.frame_range[:]
    animation = source.animation_data
    assert animation.use_tweak_mode
    assert animation.action == action
    assert animation.use_nla
    animation.use_tweak_mode = False
    assert animation.action is None


@pytest.mark.parametrize("operator", ["retarget_action", "retarget_pose"])
def test_a_target_whose_strip_is_tweaked_is_named(operator):
    source, _ = add_person("A")
    target, _ = add_person("B", "renamed")
    tweak(target, add_action(source))
    before = snapshot(target)
    with pytest.raises(RuntimeError, match='A strip of "B" is being tweaked in the NLA editor'):
        getattr(bpy.ops.hiermatch, operator)(source="A", target="B")
    assert snapshot(target) == before


@pytest.mark.parametrize("which", ["A", "B"])
def test_pairs_whose_bones_are_called_otherwise_by_now_are_named(which):
    source, _ = add_person("A")
    add_person("B", "renamed")
    add_action(source)
    bpy.ops.hiermatch.pair_bones(source="A", target="B")
    assert carry(source="A", target="B") == {"FINISHED"}
    assert "were left out" not in bpy.context.scene.hiermatch_retarget.report.notes
    bone = bpy.data.objects[which].data.bones[5]
    before, bone.name = bone.name, "Bone"
    assert carry(source="A", target="B") == {"FINISHED"}
    assert f'were left out: "{before}". Pair the bones' in bpy.context.scene.hiermatch_retarget.report.notes
    assert bpy.ops.hiermatch.pair_bones(source="A", target="B") == {"FINISHED"}
    assert carry(source="A", target="B") == {"FINISHED"}
    assert "were left out" not in bpy.context.scene.hiermatch_retarget.report.notes
