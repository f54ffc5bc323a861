# SPDX-License-Identifier: GPL-3.0-or-later
"""An armature that stands in the source, and moves nothing, fitted into the target."""

from __future__ import annotations

import bpy
import numpy as np
import pytest
from hiermatch.hiermatch_addon.scene.armatures import read_skeleton
from mathutils import Matrix, Vector

from tests.addon.characters import add_person, add_skeleton, match_at_once, someone
from tests.addon.scenes import snapshot, weights_of
from tests.people import HANGING, at_rest_in, renamed

fit = bpy.ops.hiermatch.fit_my_rig


@pytest.fixture(autouse=True)
def at_once(monkeypatch):
    """Match without work."""
    match_at_once(monkeypatch)


@pytest.fixture
def standard():
    """Two persons, the second with hanging arms, and a standard armature with other names that stands in the first."""
    add_person("A")
    add_person("B", hanging=True, matrix=Matrix.Translation((2, 0, 0)))
    return add_skeleton("Standard", renamed(someone().rig))


def missed(armature, offset=(2, 0, 0), scale=1.0):
    """Distances of the heads of a fitted armature from where they belong in the second person, in units of height."""
    true = renamed(at_rest_in(someone(), HANGING).rig)
    heads = read_skeleton(armature).heads
    names = [bone.name for bone in armature.data.bones]
    wanted = np.array([true.skeleton.heads[true.names.index(name)] for name in names]) * scale + offset
    return np.linalg.norm(heads - wanted, axis=1) / np.ptp(someone().mesh.vertices[:, 2])


@pytest.mark.usefixtures("standard")
def test_the_joints_are_where_they_belong():
    assert fit(source="A", rig="Standard", target="B") == {"FINISHED"}
    distances = missed(bpy.data.objects["Standard B"])
    assert distances.mean() < 0.008
    assert distances.max() < 0.03
    report = bpy.context.scene.hiermatch_retarget.report
    assert 'the rig "Standard B"' in report.done
    assert "moves nothing yet" in report.remarks
    assert bpy.data.objects["B Body"].modifiers["Armature"].object == bpy.data.objects["B"]  # nobody bound it


def test_what_is_set_on_the_armature_comes_along(standard):
    bpy.context.view_layer.objects.active = standard
    bpy.ops.object.mode_set(mode="EDIT")
    bones = standard.data.edit_bones
    leg = next(bone for bone in bones if bone.parent is not None and (bone.head - bone.parent.tail).length < 1e-6)
    leg.use_connect = True
    control = bones.new("control")
    control.head, control.tail, control.use_deform = leg.tail, leg.tail + Vector((0, -0.2, 0)), False
    name = leg.name
    bpy.ops.object.mode_set(mode="OBJECT")
    bpy.context.view_layer.objects.active = None
    standard.pose.bones[name]["kind"] = "limb"
    constraint = standard.pose.bones[name].constraints.new("IK")
    constraint.target, constraint.subtarget, constraint.chain_count = standard, "control", 1
    fit(source="A", rig="Standard", target="B")
    made = bpy.data.objects["Standard B"]
    assert made.data.bones[name].use_connect
    assert made.pose.bones[name]["kind"] == "limb"
    assert made.pose.bones[name].constraints[0].target == made
    place, end = made.data.bones["control"].head_local, made.data.bones[name].tail_local
    assert (place - end).length < 1e-5  # what stood at the joint stands there again
    assert not made.data.bones["control"].use_deform
    assert standard.pose.bones[name].constraints[0].target == standard


def test_symmetric_bones_stay_symmetric_on_a_symmetric_body():
    add_person("A")
    add_person("B")
    add_skeleton("Standard", someone().rig)
    fit(source="A", rig="Standard", target="B")
    bones = bpy.data.objects["Standard B"].data.bones
    for bone in bones:
        if bone.name.endswith(".L"):
            other = bones[bone.name[:-1] + "R"]
            assert (Vector((-1, 1, 1)) * bone.head_local - other.head_local).length < 1e-5
            assert (Vector((-1, 1, 1)) * bone.tail_local - other.tail_local).length < 1e-5


def test_one_that_is_far_off_is_put_into_the_source_by_its_size(standard):
    standard.matrix_world = Matrix.Translation((-5, 3, 1)) @ Matrix.Scale(7, 4)
    bpy.context.view_layer.update()
    assert fit(source="A", rig="Standard", target="B") == {"FINISHED"}
    assert missed(bpy.data.objects["Standard B"]).mean() < 0.03
    assert "did not stand in" in bpy.context.scene.hiermatch_retarget.report.remarks


@pytest.mark.usefixtures("standard")
def test_it_is_bound_with_the_weights_of_the_source():
    for part in ("B Body", "B Head"):
        bpy.data.objects[part].vertex_groups.clear()
    assert fit(source="A", rig="Standard", target="B", my_rig_bind=True, my_rig_limit=0) == {"FINISHED"}
    made = bpy.data.objects["Standard B"]
    body = bpy.data.objects["B Body"]
    assert [modifier.object for modifier in body.modifiers if modifier.show_viewport] == [made]
    assert body.parent == made
    assert 'no longer moved by its own armature "B"' in bpy.context.scene.hiermatch_retarget.report.remarks
    true = renamed(at_rest_in(someone(), HANGING).rig)
    weights = weights_of(body)
    limbs = [name for name, origin in zip(true.names, true.origins, strict=True) if origin & {"forearm.L", "shin.R"}]
    assert limbs
    for name in limbs:
        assert max(weights[name].values()) > 0.9


@pytest.mark.usefixtures("standard")
def test_one_undo_takes_it_back():
    before = snapshot()
    bpy.ops.ed.undo_push(message="Before")
    fit(source="A", rig="Standard", target="B")
    bpy.ops.ed.undo_push(message="Fit My Rig")
    bpy.ops.ed.undo()
    assert snapshot()["objects"] == before["objects"]


def test_refusals_say_why_and_change_nothing(standard):
    before = snapshot()

    def refused(match, **options):
        with pytest.raises(RuntimeError, match=match):
            fit(**{"source": "A", "rig": "Standard", "target": "B"} | options)
        assert set(bpy.data.objects.keys()) == set(before["objects"])

    refused("Name one as the Rig", rig="")
    refused("no object called", rig="Nobody")
    refused("is not an armature", rig="A Body")
    refused('"A" moves "A"', rig="A")
    refused("moves no mesh", source="Standard", rig="")
    bpy.data.objects["B Body"].vertex_groups.active_index = 0
    standard.matrix_world = Matrix.Rotation(1.5, 4, "Y")
    bpy.context.view_layer.update()
    refused("does not stand in")
    standard.scale = (0, 0, 0)
    bpy.context.view_layer.update()
    refused("scale of zero")
    empty = bpy.data.objects.new("Empty", bpy.data.armatures.new("Empty"))
    bpy.context.scene.collection.objects.link(empty)
    with pytest.raises(RuntimeError, match="has no bones"):
        fit(source="A", rig="Empty", target="B")


def test_without_weights_in_the_source_nothing_is_bound(standard):
    for part in ("A Body", "A Head"):
        bpy.data.objects[part].vertex_groups.clear()
    with pytest.raises(RuntimeError, match="no weights that could be handed"):
        fit(source="A", rig=standard.name, target="B", my_rig_bind=True)
    assert fit(source="A", rig=standard.name, target="B") == {"FINISHED"}


def test_it_waits_for_object_mode(standard):
    bpy.context.view_layer.objects.active = standard
    bpy.ops.object.mode_set(mode="EDIT")
    assert not fit.poll()
    bpy.ops.object.mode_set(mode="OBJECT")


@pytest.mark.usefixtures("standard")
def test_pressed_again_it_updates_the_rig_of_before():
    before = len(bpy.data.objects)
    for bound in (False, True, True):
        assert fit(source="A", rig="Standard", target="B", my_rig_bind=bound) == {"FINISHED"}
        assert len(bpy.data.objects) == before + 1
        assert missed(bpy.data.objects["Standard B"]).mean() < 0.008
    assert "updated" in bpy.context.scene.hiermatch_retarget.report.done
    made, body = bpy.data.objects["Standard B"], bpy.data.objects["B Body"]
    assert [modifier.object for modifier in body.modifiers if modifier.show_viewport] == [made]
    bpy.data.objects.remove(made)
    assert fit(source="A", rig="Standard", target="B") == {"FINISHED"}
    assert "updated" not in bpy.context.scene.hiermatch_retarget.report.done
