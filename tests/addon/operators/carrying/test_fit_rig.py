# SPDX-License-Identifier: GPL-3.0-or-later
from __future__ import annotations

import bpy
import numpy as np
import pytest
from hiermatch.engine import HierMatchError, fit_rig
from hiermatch.engine.runtime.progress import run
from hiermatch.hiermatch_addon.jobs.transfer import Passage
from hiermatch.hiermatch_addon.operators.checking.rig_operator import meant_armature
from hiermatch.hiermatch_addon.scene.armatures import find_armature, moving_armatures, read_rig, read_skeleton
from hiermatch.hiermatch_addon.scene.binding import bind
from hiermatch.hiermatch_addon.scene.character import side_of
from hiermatch.hiermatch_addon.scene.mesh_io import read_mesh
from hiermatch.hiermatch_addon.scene.motion.action_curves import played_action
from hiermatch.hiermatch_addon.transfers.options.rig import RigSettings
from hiermatch.hiermatch_addon.transfers.rig import RigTransfer
from mathutils import Matrix

from tests.addon.motions import curves_of
from tests.addon.rigs import CONTROLS, POSE, add_mesh, add_rigged, add_target, pose, true_passage
from tests.addon.scene.test_armatures import IMPORTED
from tests.addon.scenes import add_blob, localised

MIRRORED = Matrix.Translation((4, 0, 0)) @ Matrix.Scale(-1, 4, (0, 1, 0))
TURNED = Matrix.Translation((3, 1, 0)) @ Matrix.Rotation(0.7, 4, "Z") @ Matrix.Scale(2, 4)


def fit(source, target, **settings):
    """Give the target its rig, on the true way; return its armature and the report."""
    transfer = RigTransfer(RigSettings(**settings))
    transfer.read(bpy.context, source, target)
    run(transfer.steps(true_passage(source, target)))
    report = transfer.write(bpy.context, source, target)
    bpy.context.view_layer.update()
    return target.modifiers["Armature"].object if "Armature" in target.modifiers else None, report


def add_weights(source, target):
    """Give the target, numbered as the source, the same weights."""
    for group in source.vertex_groups:
        target.vertex_groups.new(name=group.name)
    for vertex in source.data.vertices:
        for element in vertex.groups:
            target.vertex_groups[element.group].add([vertex.index], element.weight, "REPLACE")


def shown(obj):
    """Vertices in the world, with modifiers."""
    bpy.context.view_layer.update()
    return read_mesh(obj, bpy.context.evaluated_depsgraph_get(), use_modifiers=True).vertices


def own(obj):
    return read_mesh(obj, bpy.context.evaluated_depsgraph_get(), use_modifiers=False).vertices


def missed(armature, joints, names=None):
    """Largest distance of a joint from where it belongs."""
    skeleton = read_skeleton(armature)
    return max(
        np.linalg.norm(got - true)
        for bone, head, tail in zip(armature.data.bones, skeleton.heads, skeleton.tails, strict=True)
        for got, true in zip((head, tail), joints[bone.name], strict=True)
        if bone.name not in (CONTROLS if names is None else names)
    )


def add_ik(armature):
    """Let a leg follow its control, with a pole; at rest it stays where it is."""
    constraint = armature.pose.bones["lower front.L"].constraints.new("IK")
    constraint.target = constraint.pole_target = armature
    constraint.subtarget, constraint.pole_subtarget = "target front.L", "pole front.L"
    constraint.chain_count = 2

    def moved(angle):
        constraint.pole_angle = angle
        bpy.context.view_layer.update()
        return moved_by(armature, "upper front.L")

    constraint.pole_angle = min(np.linspace(-np.pi, np.pi, 361), key=moved)
    bpy.context.view_layer.update()
    return constraint


def moved_by(armature, name):
    """How far the tail of a bone is from where it rests."""
    return (armature.pose.bones[name].tail - armature.data.bones[name].tail_local).length


@pytest.mark.parametrize("matrix", [None, IMPORTED], ids=["plain", "imported"])
def test_joints_go_where_the_pose_took_them(matrix):
    source, armature = add_rigged(matrix=matrix)
    size = 1 if matrix is None else 0.01
    target, joints = add_target(source, matrix=TURNED)
    made, report = fit(source, target)
    assert missed(made, joints) < 0.02 * 2 * size
    assert made.name == "Target Rig"
    assert "17 bones" in report.done
    assert made.matrix_world.to_3x3() == armature.matrix_world.to_3x3()


def test_across_a_map_to_the_mirror_image_they_do_as_well():
    source, _ = add_rigged()
    target, joints = add_target(source, matrix=MIRRORED)
    pair, rig = true_passage(source, target).pair, read_rig(source)
    maps = pair.source_to_target, pair.target_to_source
    fitted = fit_rig(pair.source, pair.target, *maps, weights=rig.weights, skeleton=rig.skeleton, refine=False)
    transfer = RigTransfer(RigSettings())
    transfer.read(bpy.context, source, target)
    run(transfer.steps(Passage(pair, fitted, rig.names)))
    transfer.write(bpy.context, source, target)
    assert missed(target.modifiers["Armature"].object, joints) < 0.02


def test_rolls_turn_with_the_bones():
    source, armature = add_rigged()
    target, _ = add_target(source)
    pose(armature)
    true = {bone.name: bone.matrix.to_3x3() for bone in armature.pose.bones}
    made, _ = fit(source, target)
    for name, matrix in true.items():
        if name not in CONTROLS:
            got = made.data.bones[name].matrix_local.to_3x3()
            assert (got.inverted() @ matrix).to_quaternion().angle < 0.1, name


def test_a_modifier_whose_armature_was_deleted_is_used_again():
    source, _ = add_rigged()
    target, joints = add_target(source)
    made, _ = fit(source, target)
    target.modifiers.new("Smooth", "SMOOTH")
    bpy.data.objects.remove(made)
    made, _ = fit(source, target)
    assert [modifier.type for modifier in target.modifiers] == ["ARMATURE", "SMOOTH"]
    assert target.modifiers[0].object == made
    assert missed(made, joints) < 0.02


def test_no_vertex_moves_when_the_target_is_bound():
    source, armature = add_rigged()
    source.modifiers["Armature"].use_deform_preserve_volume = True
    target, _ = add_target(source, matrix=TURNED)
    add_weights(source, target)
    target.modifiers.new("Smooth", "SMOOTH").show_viewport = False
    before = own(target)
    made, report = fit(source, target)
    np.testing.assert_allclose(shown(target), before, atol=1e-5)
    np.testing.assert_allclose(own(target), before, atol=1e-6)
    assert [modifier.name for modifier in target.modifiers] == ["Armature", "Smooth"]
    assert target.modifiers[0].use_deform_preserve_volume
    assert target.parent == made
    assert not report.notes
    pose(made, 1.0, {"head": (0.5, 0, 0)})
    assert np.abs(shown(target) - before).max() > 0.1
    assert armature.pose.bones["head"].matrix_basis == Matrix()


@pytest.mark.parametrize(
    ("before", "after"),
    [
        ("SUBSURF", "ARMATURE SUBSURF"),
        ("MIRROR SUBSURF", "MIRROR ARMATURE SUBSURF"),
        ("WELD MIRROR ARMATURE SOLIDIFY MIRROR", "WELD MIRROR ARMATURE ARMATURE SOLIDIFY MIRROR"),
    ],
)
def test_the_modifier_stands_where_armatures_do(before, after):
    source, armature = add_rigged()
    target, _ = add_target(source)
    for kind in before.split():
        modifier = target.modifiers.new(kind.title(), kind)
        if kind == "ARMATURE":
            modifier.object = armature.copy()
    bind(target, armature, source)
    assert [modifier.type for modifier in target.modifiers] == after.split()
    assert next(one for one in target.modifiers if one.type == "ARMATURE").object == armature


def test_the_source_in_a_pose_with_animation_is_no_hindrance():
    source, armature = add_rigged()
    target, joints = add_target(source)
    pose(armature, 1.0, {"spine": (0.4, 0.2, 0.0)})
    armature.pose.bones["spine"].keyframe_insert("rotation_euler", frame=1)
    armature.location.x += 1
    armature.keyframe_insert("location", frame=1)
    armature.location.x -= 1
    bpy.context.view_layer.update()
    made, _ = fit(source, target)
    assert missed(made, joints) < 0.02
    assert made.animation_data is None or made.animation_data.action is None
    assert armature.animation_data.action is not None


def test_constraints_and_drivers_point_to_the_copy():
    source, armature = add_rigged()
    add_ik(armature)
    follow = armature.pose.bones["head"].constraints.new("ARMATURE")
    follow.targets.new().target = armature
    follow.targets[0].subtarget = "neck"
    outside = add_blob("Outside")
    look = armature.pose.bones["tail tip"].constraints.new("COPY_LOCATION")
    look.target, look.influence = outside, 0
    driver = armature.pose.bones["tail"].driver_add("rotation_euler", 0).driver
    variable = driver.variables.new()
    variable.targets[0].id, variable.targets[0].data_path = armature, 'pose.bones["head"].rotation_euler.x'
    driver.expression = "var"
    target, _ = add_target(source)
    made, report = fit(source, target)
    bones = made.pose.bones
    assert bones["lower front.L"].constraints[0].target == made
    assert bones["lower front.L"].constraints[0].pole_target == made
    assert bones["head"].constraints[0].targets[0].target == made
    assert bones["tail tip"].constraints[0].target == outside
    assert made.animation_data.drivers[0].driver.variables[0].targets[0].id == made
    assert armature.animation_data.drivers[0].driver.variables[0].targets[0].id == armature
    assert armature.pose.bones["lower front.L"].constraints[0].target == armature
    assert any("Outside" in note for note in report.notes)


def test_a_leg_with_ik_and_a_pole_stays_at_rest():
    source, armature = add_rigged()
    constraint = add_ik(armature)
    assert moved_by(armature, "upper front.L") < 0.01
    constraint.mute = True
    target, _ = add_target(source, sizes={"upper front.L": 1.3})
    constraint.mute = False
    add_weights(source, target)
    before = own(target)
    made, report = fit(source, target)
    assert moved_by(made, "upper front.L") < 0.01
    np.testing.assert_allclose(shown(target), before, atol=0.02)
    made.pose.bones["lower front.L"].constraints[0].pole_angle += 1
    bpy.context.view_layer.update()
    assert moved_by(made, "upper front.L") > 0.03
    assert not any("away from rest" in note for note in report.notes)


def test_constraints_that_were_neutral_stay_so():
    source, armature = add_rigged()
    child = armature.pose.bones["pole front.L"].constraints.new("CHILD_OF")
    child.target, child.subtarget = armature, "target front.L"
    child.inverse_matrix = armature.data.bones["target front.L"].matrix_local.inverted()
    target, _ = add_target(source, matrix=TURNED)
    made, report = fit(source, target)
    assert moved_by(made, "pole front.L") < 1e-3
    assert not any("away from rest" in note for note in report.notes)


def test_lengths_in_constraints_grow_with_the_bones():
    source, armature = add_rigged()
    stretch = armature.pose.bones["tail tip"].constraints.new("STRETCH_TO")
    stretch.target, stretch.subtarget, stretch.rest_length = armature, "pole front.L", 0.5
    stretch.mute = True
    limit = armature.pose.bones["head"].constraints.new("LIMIT_DISTANCE")
    limit.target, limit.distance, limit.mute = armature, 3.0, True
    target, _ = add_target(source, matrix=Matrix.Scale(2, 4))
    made, _ = fit(source, target)
    assert made.pose.bones["tail tip"].constraints[0].rest_length == pytest.approx(1.0, rel=0.05)
    assert made.pose.bones["head"].constraints[0].distance == pytest.approx(6.0, rel=0.05)
    assert (stretch.rest_length, limit.distance) == (0.5, 3.0)


def test_ranges_of_locations_grow_with_the_bones_whose_axes_they_are_in():
    source, armature = add_rigged()
    for name, space in (("head", "LOCAL"), ("neck", "WORLD")):
        limit = armature.pose.bones[name].constraints.new("LIMIT_LOCATION")
        limit.owner_space, limit.use_max_z, limit.max_z, limit.mute = space, True, 0.2, True
    mapped = armature.pose.bones["tail"].constraints.new("TRANSFORM")
    mapped.target, mapped.subtarget, mapped.map_to, mapped.mute = armature, "head", "ROTATION", True
    mapped.target_space = mapped.owner_space = "LOCAL"
    mapped.from_max_x, mapped.to_max_x, mapped.to_max_x_rot = 0.1, 0.1, 0.5
    target, _ = add_target(source, matrix=Matrix.Scale(2, 4))
    made = fit(source, target)[0].pose.bones
    assert made["head"].constraints[0].max_z == pytest.approx(0.4, rel=0.05)
    assert made["neck"].constraints[0].max_z == pytest.approx(0.2)
    found = made["tail"].constraints[0]
    assert (found.from_max_x, found.to_max_x, found.to_max_x_rot) == pytest.approx((0.2, 0.1, 0.5), rel=0.05)


def test_constraints_that_move_bones_at_rest_are_told():
    source, armature = add_rigged()
    armature.pose.bones["tail"].constraints.new("COPY_LOCATION").target = add_blob("Outside")
    target, _ = add_target(source)
    _, report = fit(source, target)
    assert any('"tail"' in note and "away from rest" in note for note in report.notes)


def test_hierarchy_and_settings_of_bones_are_kept():
    source, armature = add_rigged()
    bones = armature.data.bones
    bones["tail"].use_inherit_rotation = False
    bones["head"].inherit_scale = "NONE"
    bones["neck"].bbone_segments = 4
    armature.data.collections.new("Legs").assign(bones["upper hind.L"])
    bones["chest"].color.palette = "THEME01"
    armature.pose.bones["head"]["mood"] = 0.5
    armature.pose.bones["head"].custom_shape = add_blob("Shape")
    armature.data.pose_position = "REST"
    armature.data.pose_position = "POSE"
    target, _ = add_target(source)
    made, _ = fit(source, target)
    assert made.data != armature.data
    for bone in bones:
        other = made.data.bones[bone.name]
        assert (other.parent.name if other.parent else None) == (bone.parent.name if bone.parent else None)
        for member in ("use_connect", "use_deform", "use_inherit_rotation", "inherit_scale", "bbone_segments"):
            assert getattr(other, member) == getattr(bone, member)
    assert made.data.collections["Legs"].bones.keys() == ["upper hind.L"]
    assert made.data.bones["chest"].color.palette == "THEME01"
    assert made.pose.bones["head"]["mood"] == 0.5
    assert made.pose.bones["head"].custom_shape == bpy.data.objects["Shape"]


def test_selection_and_mode_stay_and_the_armature_is_where_the_target_is():
    source, armature = add_rigged()
    target, _ = add_target(source)
    group = bpy.data.collections.new("Cast")
    bpy.context.scene.collection.children.link(group)
    group.objects.link(target)
    bpy.context.scene.collection.objects.unlink(target)
    source.select_set(state=True)
    armature.select_set(state=True)
    bpy.context.view_layer.objects.active = target
    made, _ = fit(source, target)
    assert {obj.name for obj in bpy.context.selected_objects} == {source.name, armature.name}
    assert bpy.context.view_layer.objects.active == target
    assert made.mode == armature.mode == "OBJECT"
    assert made.users_collection == (group,)


def test_a_second_run_updates_the_armature_of_the_first():
    source, _ = add_rigged()
    target, joints = add_target(source)
    first, _ = fit(source, target)
    first.name = "Mine"
    first.pose.bones["head"]["kept"] = 1
    skeleton = read_skeleton(first)
    bpy.context.view_layer.objects.active = first
    bpy.ops.object.mode_set(mode="EDIT")
    first.data.edit_bones["head"].tail.z += 1
    bpy.ops.object.mode_set(mode="OBJECT")
    bpy.context.view_layer.objects.active = None
    first.hide_set(state=True)
    second, report = fit(source, target)
    assert second == first
    assert "updated" in report.done
    assert first.hide_get()
    assert second.pose.bones["head"]["kept"] == 1
    np.testing.assert_allclose(read_skeleton(second).tails, skeleton.tails, atol=1e-5)
    assert len(bpy.data.armatures) == 2
    assert missed(second, joints) < 0.02
    fit(source, target, existing="KEEP")
    assert len(bpy.data.armatures) == 3


def test_a_second_run_switches_the_rig_on_again_in_the_place_of_the_own_one():
    source, _ = add_rigged()
    target, _ = add_target(source)
    add_weights(source, target)
    other = own_rig(target)
    made, _ = fit(source, target)
    for modifier in target.modifiers:  # as somebody does who wants the own rig back, for a while
        modifier.show_viewport = modifier.show_render = modifier.object == other
    fit(source, target)
    assert [modifier.object for modifier in target.modifiers if modifier.show_viewport] == [made]
    assert [modifier.object for modifier in target.modifiers if modifier.show_render] == [made]


def test_one_step_back_undoes_it_all():
    source, _ = add_rigged()
    target, _ = add_target(source)
    add_weights(source, target)
    bpy.context.view_layer.update()
    bpy.ops.ed.undo_push(message="Before")
    fit(source, target, rest=True)
    bpy.ops.ed.undo_push(message="Fit Rig")
    bpy.ops.ed.undo()
    assert len(bpy.data.armatures) == 1
    assert not bpy.data.actions
    target = bpy.data.objects["Target"]
    assert not target.modifiers
    assert target.parent is None
    bpy.ops.ed.redo()
    assert len(bpy.data.armatures) == 2
    assert bpy.data.objects["Target"].modifiers[0].object == bpy.data.objects["Target Rig"]


def own_rig(target):
    """Give a target a rig of its own that stands in a pose."""
    body, other = add_rigged("Other")
    bpy.data.objects.remove(body)
    target.modifiers.new("Mine", "ARMATURE").object = other
    target.parent = other
    pose(other)
    return other


def test_another_armature_of_the_target_is_left_alone():
    source, _ = add_rigged()
    target, _ = add_target(source)
    other = own_rig(target)
    place = own(target)
    _, report = fit(source, target, replace=False)
    assert target.parent == other
    assert [modifier.name for modifier in target.modifiers] == ["Armature", "Mine"]
    assert any("Other Rig" in note and "as well" in note for note in report.notes)
    assert moving_armatures(target)[1:] == [other]
    assert other.visible_get()
    np.testing.assert_allclose(own(target), place, atol=1e-6)


def test_the_new_rig_takes_the_place_of_the_target_s_own():
    source, _ = add_rigged()
    target, joints = add_target(source)
    add_weights(source, target)
    other = own_rig(target)
    place = own(target)
    made, report = fit(source, target)
    assert missed(made, joints) < 0.02
    assert moving_armatures(target) == [made]
    assert target.parent == made
    np.testing.assert_allclose(shown(target), place, atol=1e-4)  # its own rig's pose moves it no more
    (note,) = report.notes
    assert note.startswith('"Other Rig" had "Target" posed. That pose was left out')
    assert any("no longer moved" in remark and "Other Rig" in remark for remark in report.remarks)
    assert not other.visible_get()
    assert meant_armature(bpy.context, "Other Rig") == made  # what is picked in the panel still means the target
    assert side_of(other, bpy.context.view_layer) == target


def test_the_rig_of_a_target_in_an_overridden_collection_is_put_beside_it(tmp_path):
    source, _ = add_rigged()
    target, joints = add_target(source)
    made, _ = fit(source, localised(target, tmp_path))
    assert list(made.users_collection) == [bpy.context.scene.collection]
    assert missed(made, joints) < 0.02


def test_an_own_rig_that_moves_more_than_the_target_stays_in_view():
    source, _ = add_rigged()
    target, _ = add_target(source)
    other = own_rig(target)
    hair = add_mesh("Hair", np.eye(3), np.array([[0, 1, 2]]))
    hair.modifiers.new("Armature", "ARMATURE").object = other
    fit(source, target)
    assert other not in moving_armatures(target)
    assert other.visible_get()
    assert meant_armature(bpy.context, "Other Rig") == other


def test_a_part_that_hangs_on_a_bone_of_its_own_rig_stays_where_it_stands_at_rest():
    source, _ = add_rigged()
    target, _ = add_target(source)
    _, other = add_rigged("Other")
    stands = target.matrix_world.copy()
    target.parent, target.parent_type, target.parent_bone = other, "BONE", "neck"
    bpy.context.view_layer.update()
    target.matrix_world = stands
    bpy.context.view_layer.update()
    place = own(target)
    pose(other)
    fit(source, target)
    assert target.parent_type == "OBJECT"
    np.testing.assert_allclose(own(target), place, atol=1e-5)
    pose(other, part=0.3)
    np.testing.assert_allclose(own(target), place, atol=1e-5)


def test_without_binding_the_target_stays_as_it_is():
    source, _ = add_rigged()
    target, _ = add_target(source)
    fit(source, target, bind=False)
    assert not target.modifiers
    assert target.parent is None
    assert "Target Rig" in bpy.data.objects


@pytest.mark.parametrize("show", [False, True])
def test_the_rest_pose_undoes_the_pose(show):
    source, armature = add_rigged()
    target, _ = add_target(source)
    add_weights(source, target)
    before = own(target)
    made, report = fit(source, target, rest=True, rest_shown=show)
    action = bpy.data.actions["Target Rig Rest"]
    assert action.use_fake_user
    assert action.name in report.done
    if not show:
        np.testing.assert_allclose(shown(target), before, atol=1e-5)
        assert played_action(made) is None
        made.animation_data_create().action = action
        if hasattr(action, "slots"):
            made.animation_data.action_slot = action.slots[0]
        bpy.context.scene.frame_set(1)
    posed = shown(target)
    relaxed = own(source) + np.array([4.0, 0, 0])
    # Not as exact as the inverse: what is blended when it is posed is blended again on the way back.
    away = posed - relaxed
    assert np.linalg.norm(away - np.median(away, axis=0), axis=1).mean() < 0.05
    for name in POSE:
        at = made.matrix_world.to_3x3() @ made.pose.bones[name].matrix.to_3x3()
        assert (at.inverted() @ armature.data.bones[name].matrix_local.to_3x3()).to_quaternion().angle < 0.02


@pytest.mark.parametrize("what", ["left", "renamed", "edited", "edited and renamed"])
def test_a_rest_pose_that_the_user_made_his_own_is_not_replaced(what):
    source, _ = add_rigged()
    target, _ = add_target(source)
    add_weights(source, target)
    made, _ = fit(source, target, rest=True)
    first = bpy.data.actions["Target Rig Rest"]
    keys = {path: len(curve.keyframe_points) for path, curve in curves_of(first).items()}
    strip = made.animation_data_create().nla_tracks.new().strips.new("Idle", 1, first)
    if "edited" in what:
        next(iter(curves_of(first).values())).keyframe_points.insert(40, 0.5)
    if "renamed" in what:
        first.name = "My Idle"
    edited = sum(len(curve.keyframe_points) for curve in curves_of(first).values())
    _, report = fit(source, target, rest=True)
    names = {"left": "Target Rig Rest", "edited": "Target Rig Rest (edited)"}
    assert strip.action == first
    assert first.name == names.get(what, "My Idle")
    assert sum(len(curve.keyframe_points) for curve in curves_of(first).values()) == edited
    assert set(bpy.data.actions) == {first, bpy.data.actions["Target Rig Rest"]}
    now = curves_of(bpy.data.actions["Target Rig Rest"])
    assert {path: len(curve.keyframe_points) for path, curve in now.items()} == keys
    assert any('is kept as "Target Rig Rest (edited)"' in note for note in report.notes) == (what == "edited")


def test_no_rest_pose_is_made_of_a_body_at_rest():
    source, _ = add_rigged()
    target, _ = add_target(source, part=0.0, sizes={"head": 1.4})
    made, report = fit(source, target, rest=True)
    assert not bpy.data.actions
    assert any("already" in note for note in report.notes)
    fit(source, target, rest=True, pose="POSED")
    assert bpy.data.actions[f"{made.name} Rest"]


def test_missing_weights_are_told():
    source, _ = add_rigged()
    target, _ = add_target(source)
    _, report = fit(source, target)
    assert any("no weights" in note for note in report.notes)


def test_the_operator_makes_the_transfer_of_its_options():
    properties = bpy.ops.hiermatch.fit_rig.get_rna_type().properties
    settings = RigSettings()
    for name in ("existing", "bind", "rest", "rest_shown", "pose"):
        assert properties[f"rig_{name}"].default == getattr(settings, name)
        assert properties[f"rig_{name}"].description


def test_sources_without_a_rig_are_refused():
    target, source = add_blob("Target"), add_blob("Source")
    transfer = RigTransfer(RigSettings())
    with pytest.raises(HierMatchError, match="has no armature"):
        transfer.read(bpy.context, source, target)
    rigged, _ = add_rigged("Rigged")
    rigged.vertex_groups.clear()
    with pytest.raises(HierMatchError, match="Bind the Source"):
        transfer.read(bpy.context, rigged, target)
    assert find_armature(target) is None
