# SPDX-License-Identifier: GPL-3.0-or-later
"""Actions and poses carried from one rig to another, as scripts do."""

from math import radians

import bpy
import numpy as np
import pytest
from hiermatch.hiermatch_addon.transfers.motion import motion_job
from mathutils import Matrix

from tests.addon.characters import add_action, add_person, match_at_once, posed_vertices
from tests.addon.scenes import mesh_snapshot

carry, pose = bpy.ops.hiermatch.retarget_action, bpy.ops.hiermatch.retarget_pose


@pytest.fixture(autouse=True)
def at_once(monkeypatch):
    """Match without work."""
    match_at_once(monkeypatch)


def curves_of(action):
    """Data path and index -> curve, in any version."""
    if hasattr(action, "slots"):
        bags = [bag for layer in action.layers for strip in layer.strips for bag in strip.channelbags]
        return {(curve.data_path, curve.array_index): curve for bag in bags for curve in bag.fcurves}
    return {(curve.data_path, curve.array_index): curve for curve in action.fcurves}


def worst(source, target, frames):
    """Mean distance of the target's vertices from the source's, in the worst of some frames, by the height."""
    errors = []
    for frame in frames:
        bpy.context.scene.frame_set(frame)
        errors.append(np.linalg.norm(posed_vertices(source) - posed_vertices(target), axis=1).mean())
    return max(errors) / 1.8


@pytest.mark.parametrize(
    ("options", "most"),
    [
        ({"rig": "renamed", "rolls": 0.7}, 2e-3),
        ({"rig": "renamed", "rolls": -1.1, "hanging": True, "mode": "XZY"}, 0.012),
        ({"rig": "fine", "mode": "AXIS_ANGLE"}, 0.012),
        ({"rig": "renamed", "matrix": Matrix.Rotation(radians(90), 4, "X") @ Matrix.Scale(0.01, 4)}, 2e-3),
    ],
    ids=["renamed", "hanging", "fine", "scaled"],
)
def test_the_target_moves_as_the_source_does(options, most):
    source, _ = add_person("A")
    if matrix := options.pop("matrix", None):
        target, _ = add_person("B", **options)
        for obj in (target,):  # as files of other programs are: the armature turned and scaled, its data the other way
            obj.data.transform(matrix.inverted())
            obj.matrix_world = matrix
            for child in obj.children:
                child.matrix_parent_inverse.identity()
                child.data.transform(matrix.inverted())
        bpy.context.view_layer.update()
    else:
        target, _ = add_person("B", **options)
    add_action(source)
    assert carry(source="A", target="B", action="Wave") == {"FINISHED"}
    assert target.animation_data.action.name == "Wave B"
    assert worst(source, target, (1, 11, 21)) < most
    assert worst(source, target, (6, 16)) < max(0.02, most)
    assert source.animation_data.action.name == "Wave"


def test_sparse_keys_stay_sparse_with_their_interpolation():
    source, _ = add_person("A")
    target, made = add_person("B", "renamed", rolls=0.4)
    action = add_action(source)
    for curve in curves_of(action).values():
        curve.keyframe_points[0].interpolation = "LINEAR"
        curve.keyframe_points[1].interpolation = "CONSTANT"
        curve.modifiers.new("CYCLES")
    carry(source="A", target="B")
    curves = curves_of(bpy.data.actions["Wave B"])
    arm = made.names[[origin == frozenset(["forearm.L"]) for origin in made.origins].index(True)]
    curve = curves[f'pose.bones["{arm}"].rotation_quaternion', 1]
    assert [point.co[0] for point in curve.keyframe_points] == [1, 11, 21]
    assert [point.interpolation for point in curve.keyframe_points] == ["LINEAR", "CONSTANT", "BEZIER"]
    assert [modifier.type for modifier in curve.modifiers] == ["CYCLES"]
    still = made.names[[origin == frozenset(["hand.R"]) for origin in made.origins].index(True)]
    assert len(curves[f'pose.bones["{still}"].rotation_quaternion', 0].keyframe_points) == 1
    assert worst(source, target, (1, 6, 15, 21)) < 5e-3


def test_baked_keys_are_few_and_true():
    source, _ = add_person("A")
    target, _ = add_person("B", "renamed")
    add_action(source)
    counts = {}
    for keys in ("REDUCED", "ALL"):
        carry(source="A", target="B", keying=keys)
        counts[keys] = sum(len(curve.keyframe_points) for curve in curves_of(target.animation_data.action).values())
        assert worst(source, target, (1, 4, 9, 17, 21)) < 4e-3
    assert counts["REDUCED"] < 0.6 * counts["ALL"]


def test_what_constraints_do_to_the_source_is_carried_too():
    source, _ = add_person("A")
    target, _ = add_person("B", "renamed")
    add_action(source)
    constraint = source.pose.bones["head"].constraints.new("LIMIT_ROTATION")
    constraint.use_limit_x, constraint.min_x, constraint.max_x = True, 0.5, 0.5
    constraint.owner_space = "LOCAL"
    bpy.context.scene.frame_set(7)
    carry(source="A", target="B", keying="ALL")
    assert bpy.context.scene.frame_current == 7
    assert source.animation_data.action.name == "Wave"
    assert worst(source, target, (1, 6, 21)) < 2e-3


@pytest.mark.parametrize("constrained", [False, True])
@pytest.mark.parametrize("keying", ["AUTO", "REDUCED"])
def test_what_moves_the_object_moves_the_body(keying, constrained):
    """The target stands elsewhere, and stays where it is."""
    source, _ = add_person("A")
    target, made = add_person("B", "renamed", rolls=0.4)
    add_action(source)
    if constrained:
        source.pose.bones["head"].constraints.new("LIMIT_ROTATION")
    source.rotation_mode = "ZYX"
    for frame, place, turn in ((1, (0.5, 0, 0), 0.3), (11, (0.5, -1, 0), 0.3), (21, (0.8, -2, 0), 1.2)):
        source.location, source.rotation_euler = place, (0, 0, turn)
        source.keyframe_insert("location", frame=frame)
        source.keyframe_insert("rotation_euler", frame=frame)
    target.matrix_world = Matrix.Translation((0.5, 0, 0)) @ Matrix.Rotation(0.3, 4, "Z")
    bpy.context.view_layer.update()
    before = target.matrix_world.copy()
    carry(source="A", target="B", keying=keying)
    assert target.matrix_world == before
    # Between sparse keys a body that turns about its hips goes another way than one that turns about its object.
    assert worst(source, target, (1, 11, 21)) < 5e-3
    assert worst(source, target, (6,)) < 0.02
    assert worst(source, target, (16,)) < (0.1 if keying == "AUTO" and not constrained else 0.02)
    still = made.names[[origin == frozenset(["hand.R"]) for origin in made.origins].index(True)]
    curves = curves_of(target.animation_data.action)
    assert len(curves[f'pose.bones["{still}"].rotation_quaternion', 0].keyframe_points) == 1


def test_it_does_not_matter_how_the_object_stands_at_the_moment():
    """What falls over is on the ground in the first frame, whatever frame is shown."""
    source, _ = add_person("A")
    target, _ = add_person("B", "renamed", hanging=True)
    add_action(source)
    for frame, turn in ((1, 0.0), (21, 1.5)):
        source.rotation_euler = (turn, 0, 0)
        source.keyframe_insert("rotation_euler", frame=frame)
    bpy.ops.hiermatch.pair_bones(source="A", target="B")
    values = []
    for frame in (1, 21):
        bpy.context.scene.frame_set(frame)
        carry(source="A", target="B", keying="ALL")
        curves = curves_of(target.animation_data.action)
        values.append([[point.co[1] for point in curve.keyframe_points] for _, curve in sorted(curves.items())])
    np.testing.assert_allclose(values[0], values[1], atol=1e-5)


def test_an_object_that_stays_and_one_that_grows():
    """Curves that stay at a value give no keys, and what scales the object is left out and said."""
    source, _ = add_person("A")
    add_person("B", "renamed")
    add_action(source)
    for frame in range(1, 22):
        source.keyframe_insert("location", frame=frame)
        source.keyframe_insert("rotation_euler", frame=frame)
    carry(source="A", target="B")
    counts = {len(curve.keyframe_points) for curve in curves_of(bpy.data.actions["Wave B"]).values()}
    assert max(counts) == 3
    report = bpy.context.scene.hiermatch_retarget.report
    assert "the size of the object" not in report.notes
    for frame, size in ((1, 2), (21, 3)):
        source.scale = (size, size, size)
        source.keyframe_insert("scale", frame=frame)
    carry(source="A", target="B")
    assert '"Wave" changes the size of the object "A", too. That was left out.' in report.notes


def test_all_actions_go_to_several_targets_and_strips_are_copied():
    source, _ = add_person("A")
    targets = [add_person(name, "renamed")[0] for name in ("B", "C")]
    add_action(source, "Wave")
    track = source.animation_data.nla_tracks.new()
    strip = track.strips.new("Wave", 30, bpy.data.actions["Wave"])
    strip.repeat, strip.blend_type = 2, "ADD"
    bpy.data.actions["Wave"].use_fake_user = True
    add_action(source, "Nod", ["neck", "head"])
    source.animation_data.nla_tracks.new().strips.new("Wave", 30, bpy.data.actions["Wave"]).repeat = 2
    names = [{"name": name} for name in "BC"]
    assert carry(source="A", targets=names, actions="ALL", strips=True) == {"FINISHED"}
    for target in targets:
        assert {f"Wave {target.name}", f"Nod {target.name}"} <= set(bpy.data.actions.keys())
        (copy,) = target.animation_data.nla_tracks[0].strips
        assert copy.action.name == f"Wave {target.name}"
        assert (copy.frame_start, copy.repeat) == (30, 2)


def test_a_rig_that_is_named_twice_gets_an_action_once():
    source, _ = add_person("A")
    add_person("B", "renamed")
    add_action(source)
    for _ in range(2):  # with pairs yet to be found, and with those that are there
        before = set(bpy.data.actions.keys())
        carry(source="A", targets=[{"name": "B"}, {"name": "B Body"}, {"name": "B"}])
        assert len(set(bpy.data.actions.keys()) - before) == 1


def test_the_pose_of_the_moment():
    source, _ = add_person("A")
    target, _ = add_person("B", "renamed", rolls=0.3, hanging=True)
    add_action(source)
    bpy.context.scene.frame_set(14)
    assert pose(source="A", target="B") == {"FINISHED"}
    bpy.context.view_layer.update()
    assert np.linalg.norm(posed_vertices(source) - posed_vertices(target), axis=1).mean() / 1.8 < 0.012
    assert target.animation_data is None


def test_in_place_and_stride():
    source, _ = add_person("A")
    add_person("B", "renamed")
    add_action(source, way=(0.0, 0.0, -0.4))  # the axes of the hips: z is behind
    ways = []
    for options in ({}, {"stride": 0.5}, {"in_place": True}):
        carry(source="A", target="B", **options)
        places = []
        for frame in (1, 21):
            bpy.context.scene.frame_set(frame)
            places.append(posed_vertices(bpy.data.objects["B"])[:, :2].mean(axis=0))
        ways.append(np.linalg.norm(places[1] - places[0]))
    assert ways[0] > 0.5
    assert ways[1] < 0.65 * ways[0]
    assert ways[2] < 0.3 * ways[0]


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


def test_bones_without_a_pair_that_turn_all_else_are_named():
    """Such as a root that the target's own action has laid down."""
    source, _ = add_person("A")
    target, made = add_person("B", "renamed")
    add_action(source)
    bpy.ops.hiermatch.pair_bones(source="A", target="B")
    hips, arm = (made.names[made.origins.index(frozenset([name]))] for name in ("hips", "forearm.L"))
    bpy.ops.hiermatch.remove_bone_pair(source="A", target="B", target_bone=hips)
    for operator in (carry, pose):
        operator(source="A", target="B")
        assert "at rest" not in bpy.context.scene.hiermatch_retarget.report.notes
    target.pose.bones[hips].rotation_quaternion = (0.7, 0.7, 0.0, 0.0)
    for operator in (carry, pose):
        operator(source="A", target="B")
        assert f'hangs on them: "{hips}" of "B"' in bpy.context.scene.hiermatch_retarget.report.notes
    assert arm not in bpy.context.scene.hiermatch_retarget.report.notes


def test_what_is_muted_is_not_carried():
    source, _ = add_person("A")
    target, made = add_person("B", "renamed")
    action = add_action(source)
    for (path, _), curve in curves_of(action).items():
        curve.mute = "forearm.L" in path
    for bone in source.pose.bones:
        bone.matrix_basis = Matrix()
    carry(source="A", target="B")
    forearm, upper = (made.names[made.origins.index(frozenset([name]))] for name in ("forearm.L", "upper_arm.L"))
    bpy.context.scene.frame_set(11)
    assert target.pose.bones[forearm].matrix_basis.to_quaternion().angle < 0.01
    assert target.pose.bones[upper].matrix_basis.to_quaternion().angle > 0.1


@pytest.mark.skipif(bpy.app.version < (4, 4), reason="actions have slots since Blender 4.4")
@pytest.mark.parametrize("keying", ["AUTO", "ALL"])
def test_an_action_that_moves_something_else_as_well_gets_no_more_frames(keying):
    source, _ = add_person("A")
    target, _ = add_person("B", "renamed")
    action = add_action(source)
    slot = action.slots.new("OBJECT", "Camera")
    curve = action.layers[0].strips[0].channelbag(slot, ensure=True).fcurves.new("location", index=0)
    for frame in (-100, 400):
        curve.keyframe_points.insert(frame, 0)
    carry(source="A", target="B", keying=keying)
    assert tuple(target.animation_data.action.frame_range) == (1, 21)


def test_an_armature_alone_gives_motion_through_pairs_that_are_there():
    source, _ = add_person("A")
    add_person("B", "renamed")
    add_action(source)
    bpy.ops.hiermatch.pair_bones(source="A", target="B")
    for part in list(source.children):
        bpy.data.objects.remove(part)
    assert carry(source="A", target="B") == {"FINISHED"}
    bpy.context.scene.hiermatch_bone_pairs.clear()
    with pytest.raises(RuntimeError, match='The armature "A" moves no mesh'):
        carry(source="A", target="B")


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
    assert made == [["Walk;Fast B"], ["Run B", "Walk B", "Walk;Fast B.001"], ["Run B.001"]]
    with pytest.raises(RuntimeError, match='fits the pattern "Jump'):
        carry(source="A", target="B", action="Jump*")


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


def snapshot(target):
    """What must stay as it is after a refusal."""
    return (
        sorted(bpy.data.actions.keys()),
        [list(bone.matrix_basis.to_quaternion()) for bone in target.pose.bones],
        target.animation_data and target.animation_data.action,
        len(bpy.context.scene.hiermatch_bone_pairs),
    )


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
    ],
    ids=["missing", "locked", "gone", "flat"],
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


def test_a_pose_that_has_no_keys_yet_is_carried_from_a_rig_that_plays_an_action():
    source, _ = add_person("A")
    target, _ = add_person("B", "renamed")
    add_action(source)
    bpy.context.scene.frame_set(11)
    source.pose.bones["neck"].rotation_quaternion = (0.8, 0.6, 0, 0)
    bpy.context.view_layer.update()
    assert bpy.ops.hiermatch.retarget_pose(source="A", target="B") == {"FINISHED"}
    bpy.context.view_layer.update()
    name = next(row.target for row in bpy.context.scene.hiermatch_bone_pairs if row.source == "neck")
    turned = [
        (rig.pose.bones[bone].matrix @ rig.data.bones[bone].matrix_local.inverted()).to_quaternion()
        for rig, bone in ((source, "neck"), (target, name))
    ]
    assert turned[0].rotation_difference(turned[1]).angle < 0.05


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


def test_curves_without_keys_move_nothing():
    source, _ = add_person("A")
    add_person("B", "renamed")
    action = add_action(source)
    for curve in curves_of(action).values():
        while len(curve.keyframe_points):
            curve.keyframe_points.remove(curve.keyframe_points[0])
    with pytest.raises(RuntimeError, match='The action "Wave" moves no bone of "A"'):
        carry(source="A", target="B", action="Wave")
    next(iter(curves_of(action).values())).modifiers.new("FNGENERATOR")
    assert carry(source="A", target="B", action="Wave", keying="SOURCE") == {"FINISHED"}


def only(action, channel):
    """Take all curves from an action but those of a channel of bones."""
    for (path, _), curve in curves_of(action).items():
        curve.mute = not path.endswith(f".{channel}")


def test_bones_whose_sizes_an_action_changes_are_named(capfd):
    source, _ = add_person("A")
    target, _ = add_person("B", "renamed")
    action = add_action(source)
    said = 'The sizes that bones of "A" get were left out: "head".'
    head, neck = source.pose.bones["head"], source.pose.bones["neck"]
    for bone in (head, neck):
        for frame in (1, 11):
            bone.keyframe_insert("scale", frame=frame)
    assert carry(source="A", target="B") == {"FINISHED"}
    assert said not in capfd.readouterr().out
    head.scale.y = 1.3
    head.keyframe_insert("scale", frame=11)
    assert carry(source="A", target="B") == {"FINISHED"}
    assert said in capfd.readouterr().out
    only(action, "scale")
    before = snapshot(target)
    with pytest.raises(RuntimeError, match='The action "Wave" moves no bone of "A"'):
        carry(source="A", target="B", action="Wave")
    assert snapshot(target) == before


def test_what_modifiers_do_between_keys_is_carried_too():
    source, _ = add_person("A")
    target, _ = add_person("B", "renamed")
    action = add_action(source)
    for (path, index), curve in curves_of(action).items():
        if "thigh.R" in path and index == 1:
            noise = curve.modifiers.new("NOISE")
            noise.strength, noise.scale = 0.5, 3
    assert carry(source="A", target="B") == {"FINISHED"}
    assert worst(source, target, range(1, 22, 2)) < 2e-3


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


def repeat(curve, mode, **settings):
    modifier = curve.modifiers.new("CYCLES")
    modifier.mode_before = modifier.mode_after = mode
    for name, value in settings.items():
        setattr(modifier, name, value)


@pytest.mark.parametrize("keying", ["SOURCE", "REDUCED", "ALL"])
@pytest.mark.parametrize(
    "go_on",
    [
        lambda path, curve: repeat(curve, "REPEAT_OFFSET" if path.endswith("location") else "REPEAT"),
        lambda path, curve: repeat(curve, "REPEAT") if "thigh" in path else None,
        lambda _path, curve: repeat(curve, "REPEAT", use_restricted_range=True, frame_start=1, frame_end=40),
        lambda path, curve: setattr(curve, "extrapolation", "LINEAR" if path.endswith("location") else "CONSTANT"),
    ],
    ids=["walk", "one", "range", "linear"],
)
def test_beyond_its_keys_each_channel_goes_on_as_what_moves_it(keying, go_on):
    source, _ = add_person("A")
    target, _ = add_person("B", "renamed")
    action = add_action(source)
    hips = source.pose.bones["hips"]
    for frame, turn in ((1, (1, 0, 0, 0)), (11, (0.98, 0.2, 0, 0)), (21, (1, 0, 0, 0))):
        hips.rotation_quaternion = turn
        hips.keyframe_insert("rotation_quaternion", frame=frame)
    for (path, _index), curve in curves_of(action).items():
        go_on(path, curve)
    assert carry(source="A", target="B", keying=keying) == {"FINISHED"}
    assert worst(source, target, [-30, 5, 30, 55]) < 2e-3


def test_bones_that_drivers_turn_are_named(capfd):
    source, _ = add_person("A")
    target, _ = add_person("B", "renamed")
    add_action(source)
    bpy.ops.hiermatch.pair_bones(source="A", target="B")
    name = bpy.context.scene.hiermatch_bone_pairs[3].target
    driver = target.pose.bones[name].driver_add("rotation_quaternion", 1)
    driver.driver.expression = "0.3"
    said = f'Drivers turn "{name}" of "B"'
    assert carry(source="A", target="B") == {"FINISHED"}
    assert said in capfd.readouterr().out
    driver.mute = True
    assert carry(source="A", target="B") == {"FINISHED"}
    assert said not in capfd.readouterr().out
