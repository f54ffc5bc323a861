# SPDX-License-Identifier: GPL-3.0-or-later
"""Weights, bones and armatures of what `hiermatch.wear` fits."""

from __future__ import annotations

from types import SimpleNamespace

import bpy
import numpy as np
import pytest
from hiermatch.engine import ClosestPoints, Progress, TriangleMesh
from hiermatch.hiermatch_addon.transfers.wearing import item_motion
from mathutils import Vector
from scipy.sparse import csr_array
from scipy.spatial.distance import pdist

from tests.addon.garments import add_item, fitted, in_world, wear
from tests.addon.rigs import add_armature


def test_all_that_the_armature_moves_gets_the_weights_of_the_other_rig(dressed_pair):
    source, target, shirt, _ = dressed_pair
    rigs = [add_armature("Rig A"), add_armature("Rig B")]
    for bone in rigs[1].data.bones:
        bone.name = f"other {bone.name}"
    for obj, rig, name in ((source, rigs[0], "neck"), (shirt, rigs[0], "neck"), (target, rigs[1], "other neck")):
        obj.vertex_groups.new(name=name).add(range(len(obj.data.vertices)), 1.0, "REPLACE")
        obj.modifiers.new("Armature", "ARMATURE").object = rig
    assert wear(wear_poses=False) == {"FINISHED"}
    copy = fitted("Shirt")
    assert [obj.get("hiermatch_item") for obj in bpy.data.objects if "hiermatch_body" in obj] == ["Shirt"]
    assert copy.modifiers["Armature"].object == rigs[1]
    assert "other neck" in copy.vertex_groups
    assert "neck" not in copy.vertex_groups
    weights = [vertex.groups[0].weight for vertex in copy.data.vertices]
    np.testing.assert_allclose(weights, 1, atol=1e-3)


def test_tight_cloth_moves_as_the_skin_just_below_it(dressed_pair):
    """Not as that which the map says, where cloth has come to lie beside it."""
    source, target, *_ = dressed_pair
    tights = add_item(source, "Tights", 0.004)
    rigs = [add_armature("Rig A"), add_armature("Rig B")]
    for bone in rigs[1].data.bones:
        bone.name = f"other {bone.name}"
    bind(source, rigs[0])
    bind(tights, rigs[0])
    skin = in_world(target)
    waves = 0.5 + 0.5 * np.sin(30 * skin[:, 2] / np.ptp(skin[:, 2]))
    for name, weights in (("other neck", waves), ("other tail", 1 - waves)):
        group = target.vertex_groups.new(name=name)
        for number, weight in enumerate(weights):
            group.add([number], weight, "REPLACE")
    target.modifiers.new("Armature", "ARMATURE").object = rigs[1]
    assert wear("Tights", wear_poses=False) == {"FINISHED"}
    copy = fitted("Tights")
    target.data.calc_loop_triangles()
    surface = TriangleMesh(skin, np.array([triangle.vertices[:] for triangle in target.data.loop_triangles]))
    found = ClosestPoints(surface).nearest(in_world(copy))
    tight = np.sqrt(found.squared_distances) < 0.01 * np.sqrt(surface.area)
    neck = copy.vertex_groups["other neck"].index
    weights = [sum(one.weight for one in vertex.groups if one.group == neck) for vertex in copy.data.vertices]
    assert tight.sum() > 30
    below = found.interpolate(surface.triangles, waves[:, None])[:, 0]
    np.testing.assert_allclose(np.array(weights)[tight], below[tight], atol=0.01)


def test_a_posed_body_may_have_modifiers_that_add_and_hide_vertices(dressed_pair):
    """What its armature does not move lies on the body as it is posed."""
    source, _, shirt, _ = dressed_pair
    rig = add_armature("Rig")
    source.vertex_groups.new(name="neck").add(range(len(source.data.vertices)), 1.0, "REPLACE")
    source.modifiers.new("Armature", "ARMATURE").object = rig
    rig.pose.bones["neck"].location = (0.0, 0.0, 1.5)
    bpy.context.view_layer.update()
    shirt.matrix_world = rig.pose.bones["neck"].matrix @ rig.data.bones["neck"].matrix_local.inverted()
    bpy.context.view_layer.update()
    assert wear("Shirt", wear_fit_rig=False) == {"FINISHED"}
    expected = in_world(fitted("Shirt"))
    source.modifiers.new("Smooth", "SUBSURF").subdivision_type = "SIMPLE"
    mask = source.modifiers.new("Hidden", "MASK")
    mask.vertex_group = source.vertex_groups.new(name="nothing").name
    bpy.context.view_layer.update()
    assert wear("Shirt", wear_fit_rig=False) == {"FINISHED"}
    np.testing.assert_allclose(in_world(fitted("Shirt")), expected, atol=1e-5)
    assert all(modifier.show_viewport for modifier in source.modifiers)


def test_bones_of_an_item_come_along_onto_the_other_rig(dressed_pair):
    source, target, shirt, coat = dressed_pair
    rigs = [add_armature("Rig A"), add_armature("Rig B")]
    for bone in rigs[1].data.bones:
        bone.name = f"other {bone.name}"
    bpy.context.view_layer.objects.active = rigs[0]
    bpy.ops.object.mode_set(mode="EDIT")
    middle = Vector(in_world(source).mean(axis=0))
    for name, parent, low in (("skirt", "neck", 0.0), ("skirt end", "skirt", 0.2), ("unused", "neck", 0.0)):
        made = rigs[0].data.edit_bones.new(name)
        made.parent = rigs[0].data.edit_bones[parent]
        made.head, made.tail = middle - Vector((0, 0, low)), middle - Vector((0, 0, low + 0.2))
        made.use_connect = name == "skirt end"
    bpy.ops.object.mode_set(mode="OBJECT")
    for obj, rig, names in (
        (source, rigs[0], ["neck"]),
        (shirt, rigs[0], ["neck", "skirt end"]),
        (coat, rigs[0], ["neck"]),
        (target, rigs[1], ["other neck"]),
    ):
        for name in names:
            obj.vertex_groups.new(name=name).add(range(len(obj.data.vertices)), 1 / len(names), "REPLACE")
        obj.modifiers.new("Armature", "ARMATURE").object = rig
    before = rigs[1].data.bones.keys()
    for _ in range(2):  # again in place
        assert wear("Shirt", "Coat") == {"FINISHED"}
        bones = rigs[1].data.bones
        assert sorted(bones.keys()) == sorted([*before, "skirt", "skirt end"])
        assert bones["skirt"].parent.name == "other neck"
        assert bones["skirt end"].parent.name == "skirt"
        assert bones["skirt end"].use_connect
        points = in_world(target)
        head = np.array(rigs[1].matrix_world @ bones["skirt"].head_local)
        assert (points.min(axis=0) < head).all()
        assert (head < points.max(axis=0)).all()
        groups = {group.name: group.index for group in fitted("Shirt").vertex_groups}
        assert {"other neck", "skirt end"} <= set(groups)
        assert "neck" not in groups
        weights = [{one.group: one.weight for one in vertex.groups} for vertex in fitted("Shirt").data.vertices]
        np.testing.assert_allclose([each[groups["skirt end"]] for each in weights], 0.5, atol=1e-3)
        np.testing.assert_allclose([each[groups["other neck"]] for each in weights], 0.5, atol=1e-3)
        assert "skirt end" not in fitted("Coat").vertex_groups
    assert (
        '2 bones of the items were added to the rig of "Target"' in bpy.context.scene.hiermatch_retarget.report.remarks
    )


def bind(obj, rig):
    for name in ("neck", "tail"):
        obj.vertex_groups.new(name=name).add(range(len(obj.data.vertices)), 0.5, "REPLACE")
    obj.modifiers.new("Armature", "ARMATURE").object = rig


def hang(obj, rig):
    """Let an object hang on a bone as a whole, where it stands."""
    stood = obj.matrix_world.copy()
    obj.parent, obj.parent_type, obj.parent_bone = rig, "BONE", "neck"
    bpy.context.view_layer.update()
    obj.matrix_world = stood


@pytest.mark.parametrize(("fit", "bends"), [("AUTO", False), ("LOOSE", True)])
def test_what_hangs_on_a_bone_cannot_bend_and_is_not_bent_unless_it_is_asked_for(dressed_pair, fit, bends):
    """As swords and helmets do, which are far too large to be found by themselves."""
    source, target, shirt, _ = dressed_pair
    rigs = [add_armature("Rig A"), add_armature("Rig B")]
    bind(source, rigs[0])
    bind(target, rigs[1])
    hang(shirt, rigs[0])
    shirt.hiermatch_wear.fit = fit
    assert wear("Shirt", wear_poses=False) == {"FINISHED"}
    before, after = (pdist(in_world(obj)) for obj in (shirt, fitted("Shirt")))
    assert (np.ptp(after / before) > 0.01) == bends


def test_an_item_that_hangs_on_a_bone_is_moved_by_it_alone_and_fitted_at_rest(dressed_pair):
    """As helmets and glasses are in files for games."""
    source, target, shirt, _ = dressed_pair
    rigs = [add_armature("Rig A"), add_armature("Rig B")]
    bind(source, rigs[0])
    bind(target, rigs[1])
    hang(shirt, rigs[0])
    found = []
    for turn in (0.0, 1.2):
        rigs[0].pose.bones["neck"].rotation_mode = "XYZ"
        rigs[0].pose.bones["neck"].rotation_euler = (turn, 0.0, turn)
        bpy.context.view_layer.update()
        assert wear("Shirt", wear_poses=False) == {"FINISHED"}
        copy = fitted("Shirt")
        neck = copy.vertex_groups["neck"].index
        weights = [{one.group: one.weight for one in vertex.groups} for vertex in copy.data.vertices]
        assert {each[neck] for each in weights} == {1.0}
        assert "tail" not in copy.vertex_groups
        assert copy.modifiers["Armature"].object == rigs[1]
        found.append(in_world(copy))
    np.testing.assert_allclose(found[1], found[0], atol=1e-3)
    for bone in rigs[1].data.bones:
        bone.name = f"other {bone.name}"
    assert wear("Shirt", wear_poses=False) == {"FINISHED"}
    assert "neck" not in fitted("Shirt").vertex_groups


def test_weights_that_are_mended_for_poses_keep_to_the_limit(dressed_pair, monkeypatch):
    source, target, shirt, _ = dressed_pair
    rigs = [add_armature("Rig A"), add_armature("Rig B")]
    for obj, rig in ((source, rigs[0]), (shirt, rigs[0]), (target, rigs[1])):
        obj.vertex_groups.new(name="neck").add(range(len(obj.data.vertices)), 1.0, "REPLACE")
        obj.modifiers.new("Armature", "ARMATURE").object = rig

    def spread_out(items, **_):
        yield Progress(0.5, "Weights")
        shapes = [item.weights.shape for item in items]
        return [
            SimpleNamespace(weights=csr_array(np.full(shape, 1 / shape[1])), changed=np.ones(shape[0], bool))
            for shape in shapes
        ]

    monkeypatch.setattr(item_motion, "mend_weights_steps", spread_out)
    assert wear("Shirt", wear_limit=2) == {"FINISHED"}
    copy = fitted("Shirt")
    bones = {group.index for group in copy.vertex_groups if group.name in rigs[1].data.bones}
    weights = [[one.weight for one in vertex.groups if one.group in bones] for vertex in copy.data.vertices]
    assert {sum(weight > 0 for weight in each) for each in weights} == {2}
    np.testing.assert_allclose([sum(each) for each in weights], 1, atol=1e-5)
    shirt.modifiers.remove(shirt.modifiers["Armature"])
    shirt.parent, shirt.parent_type, shirt.parent_bone = rigs[0], "BONE", "neck"
    bpy.context.view_layer.update()
    shirt.matrix_world = source.matrix_world
    assert wear("Shirt") == {"FINISHED"}  # what hangs on a bone moves as one
    assert not {"tail", "spine"} & set(fitted("Shirt").vertex_groups.keys())


def test_a_body_that_gets_another_rig_wears_its_clothes_with_that_the_next_time(dressed_pair):
    source, target, shirt, _ = dressed_pair
    rigs = [add_armature("Rig A"), add_armature("Rig B")]
    for obj, rig in ((source, rigs[0]), (shirt, rigs[0]), (target, rigs[1])):
        obj.vertex_groups.new(name="neck").add(range(len(obj.data.vertices)), 1.0, "REPLACE")
        obj.modifiers.new("Armature", "ARMATURE").object = rig
    assert wear("Shirt", target="Rig B", wear_poses=False) == {"FINISHED"}
    body = fitted("Shirt", target.name)["hiermatch_body"]
    bpy.ops.hiermatch.retarget(source="Source", target="Rig B", refine=False, rest_pose_like_source="OFF")
    made = target.modifiers[0].object
    assert made not in rigs
    remarks = bpy.context.scene.hiermatch_retarget.report.remarks
    assert f'still moved by "Rig B": "{fitted("Shirt", body).name}"' in remarks
    assert rigs[1].visible_get()  # as long as it moves something
    for name in ("Rig B", target.name):
        assert wear("Shirt", target=name, wear_poses=False) == {"FINISHED"}
        armatures = [one.object for one in fitted("Shirt", body).modifiers if one.type == "ARMATURE"]
        assert armatures == [made]
