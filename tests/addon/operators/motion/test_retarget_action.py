# SPDX-License-Identifier: GPL-3.0-or-later
"""Actions and poses carried from one rig to another, as scripts do."""

from math import radians

import bpy
import numpy as np
import pytest
from hiermatch.hiermatch_addon.scene.motion.action_curves import assign_action
from hiermatch.hiermatch_addon.transfers.motion import motion_job
from mathutils import Matrix

from tests.addon.characters import add_action, add_person, posed_vertices
from tests.addon.motions import curves_of, worst

carry, pose = bpy.ops.hiermatch.retarget_action, bpy.ops.hiermatch.retarget_pose


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


@pytest.mark.parametrize("constrained", [False, True])
def test_bones_that_are_moved_on_what_they_hang_on_are_moved_so(capfd, constrained):
    """Jaws, lids and stretched arms of many rigs are."""
    source, _ = add_person("A")
    target, made = add_person("B", "renamed", rolls=0.7)
    add_action(source)
    head = source.pose.bones["head"]
    for frame, way in ((1, 0.0), (11, 0.1), (21, -0.05)):
        head.location = (way, way, 0.3 * way)
        head.keyframe_insert("location", frame=frame)
    if constrained:
        source.pose.bones["neck"].constraints.new("LIMIT_ROTATION")
    assert carry(source="A", target="B", action="Wave") == {"FINISHED"}
    assert worst(source, target, (1, 11, 21)) < 2e-3
    name = made.names[next(number for number, origin in enumerate(made.origins) if "head" in origin)]
    path = f'pose.bones["{name}"].location'
    assert (path, 0) in curves_of(target.animation_data.action)
    # Retarget Pose does so, too, and a bone that is connected cannot be moved.
    said = f'do not move away from what they hang on, as those of the source do: "{name}" of "B"'
    assert said not in capfd.readouterr().out
    bpy.context.scene.frame_set(11)
    pose(source="A", target="B")
    assert np.linalg.norm(target.pose.bones[name].location) > 0.1
    target.animation_data_clear()
    bpy.context.view_layer.objects.active = target
    bpy.ops.object.mode_set(mode="EDIT")
    target.data.edit_bones[name].use_connect = True
    bpy.ops.object.mode_set(mode="OBJECT")
    carry(source="A", target="B", action="Wave")
    assert (path, 0) not in curves_of(target.animation_data.action)
    assert said in capfd.readouterr().out


@pytest.mark.parametrize("position", ["POSE", "REST"])
def test_what_constraints_do_to_the_source_is_carried_too(position):
    """Whether the source is shown at rest or not."""
    source, _ = add_person("A")
    target, _ = add_person("B", "renamed")
    add_action(source)
    constraint = source.pose.bones["head"].constraints.new("LIMIT_ROTATION")
    constraint.use_limit_x, constraint.min_x, constraint.max_x = True, 0.5, 0.5
    constraint.owner_space = "LOCAL"
    bpy.context.scene.frame_set(7)
    source.data.pose_position = position
    armatures = set(bpy.data.armatures)
    carry(source="A", target="B", keying="ALL")
    assert source.data.pose_position == position
    assert set(bpy.data.armatures) == armatures
    source.data.pose_position = "POSE"
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


def carried_by(kind, source, empty):
    """Let an object that is moved carry an armature in some way."""
    if kind == "parent":
        source.parent = empty
    elif kind == "constraint":
        source.constraints.new("COPY_LOCATION").target = empty
    elif kind == "driver":
        driver = source.driver_add("location", 1).driver
        variable = driver.variables.new()
        variable.name, driver.expression = "way", "way"
        variable.targets[0].id, variable.targets[0].data_path = empty, "location[1]"
    for frame, way in ((1, 0), (11, -0.5), (21, -2)):
        moved, channel = (source, "delta_location") if kind == "delta" else (empty, "location")
        setattr(moved, channel, (0, way, 0))
        moved.keyframe_insert(channel, frame=frame)


@pytest.mark.parametrize("keying", ["AUTO", "SOURCE", "ALL"])
@pytest.mark.parametrize("kind", ["parent", "constraint", "driver", "delta"])
def test_whatever_moves_the_object_moves_the_body(keying, kind):
    source, _ = add_person("A")
    target, _ = add_person("B", "renamed")
    add_action(source)
    empty = bpy.data.objects.new("Empty", None)
    bpy.context.scene.collection.objects.link(empty)
    carried_by(kind, source, empty)
    assert carry(source="A", target="B", action="Wave", keying=keying) == {"FINISHED"}
    assert worst(source, target, (1, 4, 9, 11, 16, 21)) < 5e-3


def test_what_hangs_on_something_that_stays_is_carried_by_few_keys():
    source, _ = add_person("A")
    target, _ = add_person("B", "renamed")
    add_action(source)
    source.parent = bpy.data.objects.new("Empty", None)
    bpy.context.scene.collection.objects.link(source.parent)
    assert carry(source="A", target="B") == {"FINISHED"}
    assert {len(curve.keyframe_points) for curve in curves_of(target.animation_data.action).values()} == {1, 3}


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


def test_of_a_long_name_so_much_is_kept_that_the_rigs_name_fits_behind_it():
    """Actions from FBX are called "Armature|Armature|Walk" and longer."""
    source, _ = add_person("A")
    target, _ = add_person("B", "renamed")
    action = add_action(source)
    action.name = 60 * "Rig|Walk"
    assert carry(source="A", target="B") == {"FINISHED"}
    name = target.animation_data.action.name
    assert name.endswith(" B")
    assert name[:50] == action.name[:50]


def test_an_action_does_not_leave_bones_where_another_one_had_them():
    """Sources of FBX have keys of all places in all actions: one moves an arm away, and the next one brings it back."""
    source, _ = add_person("A")
    target, made = add_person("B", "renamed")
    moved = target.pose.bones[made.names[made.origins.index(frozenset({"upper_arm.L"}))]]
    for name, far in (("Reach", 0.1), ("Wave", 0.0)):
        add_action(source, name)
        for frame, part in ((1, 0), (21, 1)):
            source.pose.bones["upper_arm.L"].location = (0, part * far, 0)
            source.pose.bones["upper_arm.L"].keyframe_insert("location", frame=frame)
        bpy.data.actions[name].use_fake_user = True
    assert carry(source="A", target="B", actions="ALL") == {"FINISHED"}
    for name, far in (("Reach", 0.1), ("Wave", 0.0)):
        assign_action(source, bpy.data.actions[name])
        assign_action(target, bpy.data.actions[f"{name} B"])
        bpy.context.scene.frame_set(21)
        assert np.isclose(moved.location.length, far, atol=1e-3)
        assert worst(source, target, (1, 11, 21)) < 0.01


@pytest.mark.parametrize("operator", [carry, pose])
def test_a_rig_that_is_renamed_meanwhile_gets_its_motion(monkeypatch, operator):
    source, _ = add_person("A")
    target, _ = add_person("B", "renamed")
    add_action(source)
    bpy.context.scene.frame_set(11)
    finish = motion_job.MotionJob.finish

    def finish_later(job, context):
        target.name = "Giant"
        return finish(job, context)

    monkeypatch.setattr(motion_job.MotionJob, "finish", finish_later)
    before = posed_vertices(target)
    assert operator(source="A", target="B") == {"FINISHED"}
    target.name = "B"
    bpy.context.scene.frame_set(11)
    bpy.context.view_layer.update()
    assert np.abs(posed_vertices(target) - before).max() > 0.1


def test_a_rig_that_is_named_twice_gets_an_action_once():
    source, _ = add_person("A")
    add_person("B", "renamed")
    add_action(source)
    for _ in range(2):  # with pairs yet to be found, and with those that are there
        before = set(bpy.data.actions.keys()) - {"Wave B"}
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


@pytest.mark.parametrize("local", [True, False])
@pytest.mark.parametrize("rooted", [True, False])
def test_places_are_kept_in_the_axes_that_a_bone_has_for_them(local, rooted):
    """Without Local Location these are the axes of its parent."""
    source, _ = add_person("A")
    target, made = add_person("B", "renamed", rolls=0.4)
    hips = made.names[made.origins.index(frozenset(["hips"]))]
    if rooted:
        bpy.context.view_layer.objects.active = target
        bpy.ops.object.mode_set(mode="EDIT")
        root = target.data.edit_bones.new("root")
        root.head, root.tail, root.roll, root.use_deform = (0, 0, 0), (0.1, 0.3, 0), 0.3, False
        target.data.edit_bones[hips].parent = root
        bpy.ops.object.mode_set(mode="OBJECT")
    target.data.bones[hips].use_local_location = local
    add_action(source, way=(0.3, 0.2, 0.1))
    assert carry(source="A", target="B") == {"FINISHED"}
    assert worst(source, target, (1, 11, 21)) < 5e-3
    target.animation_data_clear()
    bpy.context.scene.frame_set(11)
    assert pose(source="A", target="B") == {"FINISHED"}
    bpy.context.view_layer.update()
    assert np.linalg.norm(posed_vertices(source) - posed_vertices(target), axis=1).mean() / 1.8 < 5e-3


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
