# SPDX-License-Identifier: GPL-3.0-or-later
"""Weights carried from object to object: which groups, which are left alone, and what is written."""

from __future__ import annotations

from dataclasses import replace

import bpy
import numpy as np
import pytest
from hiermatch.engine import SurfaceMap, run
from hiermatch.hiermatch_addon.common.errors import ObjectError
from hiermatch.hiermatch_addon.jobs.transfer import Passage
from hiermatch.hiermatch_addon.scene.attribute_io import read_values
from hiermatch.hiermatch_addon.scene.deform_layer import read_weights, write_weights
from hiermatch.hiermatch_addon.storage.vertex_maps import MapPair
from hiermatch.hiermatch_addon.transfers.options.weights import WeightOptions, WeightSettings, weight_settings
from hiermatch.hiermatch_addon.transfers.weight_groups import chosen_groups, deforming_bones, locked_groups
from hiermatch.hiermatch_addon.transfers.weights import WeightTransfer
from scipy.sparse import csr_array

from tests.addon.rigs import add_rigged, add_target, find_armature, true_passage
from tests.addon.scenes import add_blob, mesh_snapshot, weights_of


@pytest.fixture
def pair():
    """A rigged creature, and the same in a pose without a rig."""
    source, _ = add_rigged()
    return source, add_target(source)[0]


def carry(source, target, passage=None, **settings):
    """Carry weights over: the report."""
    transfer = WeightTransfer(WeightSettings(**settings))
    transfer.read(bpy.context, source, target)
    run(transfer.steps(true_passage(source, target) if passage is None else passage))
    return transfer.write(bpy.context, source, target)


def dense(obj, names=None):
    """Weights (n, g) of an object's groups of these names."""
    names = [group.name for group in obj.vertex_groups] if names is None else names
    return read_weights(obj).toarray()[:, [obj.vertex_groups.find(name) for name in names]]


def names_of(obj):
    return [group.name for group in obj.vertex_groups]


def torn_passage(source, target):
    """The true way, but three vertices of a leg lie on the tail; and these vertices."""
    passage = true_passage(source, target)
    mesh, good = passage.pair.source, passage.pair.target_to_source
    leg, tail = (
        np.argsort(np.linalg.norm(mesh.vertices - point, axis=1))[:3]
        for point in ([0.45, 0.2, -0.8], [-1.25, 0.0, 0.15])
    )
    triangles, barycentric = good.triangles.copy(), good.barycentric.copy()
    triangles[leg], barycentric[leg] = good.triangles[tail], good.barycentric[tail]
    back = SurfaceMap.from_barycentric(mesh, triangles, barycentric)
    pair = MapPair(mesh, passage.pair.target, passage.pair.source_to_target, back)
    return Passage(pair), leg


def test_what_has_no_counterpart_stays_as_it_is_if_wanted(pair):
    source, target = pair
    passage = true_passage(source, target)
    alone = passage.pair.target.vertices[:, 0] < 0
    back = replace(passage.pair.target_to_source, has_partner=~alone)
    passage = replace(passage, pair=replace(passage.pair, target_to_source=back))
    carry(source, target, passage, alone="LEAVE")
    found = dense(target)
    assert (found[alone] == 0).all()
    np.testing.assert_allclose(found[~alone].sum(axis=1), 1, atol=1e-5)
    carry(source, target, passage, alone="MAP")
    np.testing.assert_allclose(dense(target).sum(axis=1), 1, atol=1e-5)


def test_all_weights_arrive_in_the_order_of_the_source(pair):
    source, target = pair
    report = carry(source, target, clean=0.0)
    assert names_of(target) == names_of(source)
    np.testing.assert_allclose(dense(target), dense(source), atol=1e-6)
    assert report.done == f"{len(source.vertex_groups)} vertex groups"
    assert not report.notes


def test_the_source_does_not_change(pair):
    source, target = pair
    before = mesh_snapshot(source)
    carry(source, target)
    assert mesh_snapshot(source) == before


def test_what_else_the_target_has_stays(pair):
    source, target = pair
    n = len(target.data.vertices)
    write_weights(target, ["mine", "neck"], csr_array(np.full((n, 2), 0.5)))
    target.vertex_groups.active_index = 1
    carry(source, target)
    assert names_of(target)[:2] == ["mine", "neck"]
    assert names_of(target)[2:] == [name for name in names_of(source) if name != "neck"]
    assert target.vertex_groups.active_index == 1
    np.testing.assert_allclose(dense(target, ["mine"]), 0.5)
    np.testing.assert_allclose(dense(target, names_of(source)).sum(axis=1), 1, atol=1e-5)


@pytest.mark.parametrize("settings", [{}, {"groups": "DEFORM"}, {"mode": "ADD"}, {"mix": 0.5}])
def test_groups_of_bones_that_move_nothing_of_the_source_give_way(pair, settings):
    source, target = pair
    source.vertex_groups.remove(source.vertex_groups["tail tip"])
    everywhere = np.ones((len(target.data.vertices), 1))
    write_weights(target, ["tail tip", "Mask"], csr_array(np.hstack([everywhere, everywhere])))
    report = carry(source, target, **settings)
    bones = [bone.name for bone in find_armature(source).data.bones if bone.name in target.vertex_groups]
    replaced = "mode" not in settings and "mix" not in settings
    moved = dense(source).any(axis=1)
    np.testing.assert_allclose(dense(target, bones)[moved | (not replaced)].sum(axis=1), 1, atol=1e-5)
    assert dense(target, ["tail tip"]).any() != replaced
    assert any('were emptied: "tail tip"' in note for note in report.notes) == replaced
    assert (dense(target, ["Mask"]) == 1).all()
    assert report.done == f"{len(source.vertex_groups)} vertex groups"


def test_groups_of_other_bones_stay(pair):
    """Those of a rig that was replaced, for whoever takes it back."""
    source, target = pair
    armature = find_armature(source)
    armature.data.bones["tail tip"].name = "Other"
    source.vertex_groups.remove(source.vertex_groups["Other"])
    write_weights(target, ["tail tip"], csr_array(np.ones((len(target.data.vertices), 1))))
    assert not carry(source, target).notes
    assert (dense(target, ["tail tip"]) == 1).all()


def test_locked_groups_are_left_alone_and_keep_their_share(pair):
    source, target = pair
    n = len(target.data.vertices)
    write_weights(target, ["neck"], csr_array(np.full((n, 1), 0.25)))
    target.vertex_groups["neck"].lock_weight = True
    report = carry(source, target)
    np.testing.assert_array_equal(dense(target, ["neck"]), 0.25)
    assert '"neck"' in report.notes[0]
    others = dense(target).sum(axis=1) - 0.25
    only_neck = dense(source, ["neck"])[:, 0] > 1 - 1e-6
    np.testing.assert_allclose(others[~only_neck], 0.75, atol=1e-5)
    assert report.done == f"{len(source.vertex_groups) - 1} vertex groups"


def test_if_all_are_locked_nothing_can_be_carried(pair):
    source, target = pair
    carry(source, target)
    for group in target.vertex_groups:
        group.lock_weight = True
    with pytest.raises(ObjectError, match="Unlock"):
        carry(source, target)


def test_the_groups_to_carry_can_be_chosen(pair):
    source, _ = pair
    source.vertex_groups.new(name="mask")
    bones = [name for name in names_of(source) if name != "mask"]
    assert chosen_groups(source, "ALL") == [*bones, "mask"]
    assert chosen_groups(source, "DEFORM") == bones
    source.vertex_groups.active_index = 2
    assert chosen_groups(source, "ACTIVE") == [names_of(source)[2]]
    armature = source.parent
    for bone in armature.pose.bones:
        owner = bone if hasattr(bone, "select") else bone.bone
        owner.select = bone.name in ("neck", "tail", "root")
    assert chosen_groups(source, "SELECTED") == ["neck", "tail"]
    assert "root" not in deforming_bones(source)
    assert deforming_bones(source) == set(bones)
    assert locked_groups(source) == set()


def test_what_a_match_wrote_is_not_carried(pair):
    source, target = pair
    source.vertex_groups.new(name="HM 1")
    source.data["hiermatch"] = {"HM": {"written": {"HM 1": "group"}}}
    assert "HM 1" not in chosen_groups(source, "ALL")
    source.vertex_groups.active_index = source.vertex_groups.find("HM 1")
    with pytest.raises(ObjectError, match="one of a match"):
        chosen_groups(source, "ACTIVE")
    target.data["hiermatch"] = {"HM": {"written": {"neck": "group"}}}
    report = carry(source, target)
    assert "neck" not in target.vertex_groups
    assert '"neck"' in report.notes[0]


def test_nothing_to_carry_is_told(pair):
    source, target = pair
    for bone in source.parent.pose.bones:
        (bone if hasattr(bone, "select") else bone.bone).select = False
    with pytest.raises(ObjectError, match="No bone"):
        chosen_groups(source, "SELECTED")
    with pytest.raises(ObjectError, match="no vertex groups"):
        carry(target, source)
    target.vertex_groups.new(name="a")
    with pytest.raises(ObjectError, match="no armature"):
        chosen_groups(target, "DEFORM")


def test_others_give_way_to_one_group(pair):
    source, target = pair
    n = len(target.data.vertices)
    half = csr_array(np.tile([0.5, 0.5], (n, 1)))
    write_weights(target, ["spine", "mine"], half)
    source.vertex_groups.active_index = source.vertex_groups.find("neck")
    carry(source, target, groups="ACTIVE", clean=0.0)
    neck = dense(source, ["neck"])[:, 0]
    np.testing.assert_allclose(dense(target, ["neck"])[:, 0], neck, atol=1e-6)
    np.testing.assert_allclose(dense(target, ["spine"])[:, 0], 1 - neck, atol=1e-6)
    np.testing.assert_allclose(dense(target, ["mine"]), 0.5)
    write_weights(target, ["spine", "mine"], half)
    carry(source, target, groups="ACTIVE", clean=0.0, normalise=False)
    np.testing.assert_allclose(dense(target, ["spine"]), 0.5)


def test_the_other_side_of_a_carried_group_is_there_for_a_mirror(pair):
    source, target = pair
    source.vertex_groups.active_index = source.vertex_groups.find("upper hind.L")
    carry(source, target, groups="ACTIVE")
    assert names_of(target) == ["upper hind.L", "upper hind.R"]
    assert not weights_of(target)["upper hind.R"]


def test_masks_are_no_bones(pair):
    source, target = pair
    n = len(source.data.vertices)
    write_weights(source, ["mask"], csr_array(np.full((n, 1), 0.7)))
    carry(source, target, limit=1)
    np.testing.assert_allclose(dense(target, ["mask"]), 0.7, atol=1e-6)
    bones = [name for name in names_of(source) if name != "mask"]
    np.testing.assert_allclose(dense(target, bones).max(axis=1), 1, atol=1e-6)


def test_without_an_armature_masks_are_told_by_their_sums(pair):
    source, target = pair
    source.modifiers.clear()
    source.parent = None
    carry(source, target, limit=1)
    np.testing.assert_allclose(dense(target).max(axis=1), 1, atol=1e-6)
    n = len(source.data.vertices)
    write_weights(source, ["mask"], csr_array(np.full((n, 1), 0.7)))
    carry(source, target, clean=0.0)
    np.testing.assert_allclose(dense(target), dense(source), atol=1e-6)


def test_mixing_and_adding(pair):
    source, target = pair
    n = len(target.data.vertices)
    write_weights(target, ["spine"], csr_array(np.ones((n, 1))))
    carry(source, target, mix=0.25, clean=0.0)
    spine = source.vertex_groups.find("spine")
    expected = 0.25 * dense(source)
    expected[:, spine] += 0.75
    np.testing.assert_allclose(dense(target, names_of(source)), expected, atol=1e-6)
    carry(source, target, mode="ADD", clean=0.0)
    summed = np.minimum(expected + dense(source), 1)
    summed /= summed.sum(axis=1, keepdims=True)
    np.testing.assert_allclose(dense(target, names_of(source)), summed, atol=1e-6)


def test_torn_vertices_are_filled_in_marked_and_told(pair):
    source, target = pair
    passage, astray = torn_passage(source, target)
    report = carry(source, target, passage, mark=True, prefix="P")
    assert abs(dense(target) - dense(source))[astray].max() < 0.3
    assert f'of "{target.name}" were taken from their neighbors' in report.notes[0]
    attribute = target.data.attributes["P Rejected"]
    colors = np.empty(4 * len(target.data.vertices), np.float32)
    attribute.data.foreach_get("color", colors)
    red = colors.reshape(-1, 4)[:, 1] < 0.5
    assert red[astray].all()
    assert red.sum() < 3 * len(astray)
    assert target.data.attributes.active_color_name == "P Rejected"
    carry(source, target, mark=True, prefix="P")
    assert len(target.data.color_attributes) == 1


def test_clear_takes_the_mark_away_and_shows_what_was_shown_before(pair):
    source, target = pair
    target.data.color_attributes.new("Own", "BYTE_COLOR", "CORNER")
    carry(source, target, mark=True)
    assert "HM Rejected" in target.data.attributes
    assert bpy.ops.hiermatch.clear(object=target.name) == {"FINISHED"}
    assert target.data.color_attributes.keys() == ["Own"]
    assert target.data.attributes.active_color_name == "Own"


def test_without_filling_the_map_is_believed(pair):
    source, target = pair
    passage, astray = torn_passage(source, target)
    report = carry(source, target, passage, fill=False)
    assert abs(dense(target) - dense(source))[astray].max() > 0.5
    assert not report.notes
    assert read_values(target.data, "HM Rejected", "FLOAT") is None


@pytest.mark.parametrize("other", ["group", "attribute"])
def test_what_has_the_name_of_the_mark_is_not_overwritten(pair, other):
    source, target = pair
    if other == "group":
        target.vertex_groups.new(name="HM Rejected")
    else:
        target.data.attributes.new("HM Rejected", "FLOAT", "POINT")
    before = mesh_snapshot(target)
    with pytest.raises(ObjectError, match="Rename it"):
        carry(source, target, mark=True)
    assert mesh_snapshot(target) == before


def test_a_shared_mesh_is_refused(pair):
    source, target = pair
    other = bpy.data.objects.new("Other", target.data)
    bpy.context.scene.collection.objects.link(other)
    with pytest.raises(ObjectError, match="shares its mesh"):
        carry(source, target)


def test_options_make_the_settings():
    class Options(bpy.types.PropertyGroup, WeightOptions):
        __annotations__ = WeightOptions.__annotations__

    bpy.utils.register_class(Options)
    bpy.types.Scene.weights_of_test = bpy.props.PointerProperty(type=Options)
    try:
        options = bpy.context.scene.weights_of_test
        made, default = weight_settings(options), WeightSettings()
        assert made.clean == pytest.approx(default.clean)
        assert {**vars(made), "clean": 0} == {**vars(default), "clean": 0}
        assert weight_settings(options, "Mine").prefix == "Mine"
        for name in WeightOptions.__annotations__:
            about = options.bl_rna.properties[name]
            assert about.name
            assert about.description
            assert not about.description.endswith(".")
    finally:
        del bpy.types.Scene.weights_of_test
        bpy.utils.unregister_class(Options)


def joined_piece(obj):
    """Join a ball to an object, and return its vertices."""
    count = len(obj.data.vertices)
    piece = add_blob("Piece", 8, 6)
    bpy.ops.object.select_all(action="DESELECT")
    for each in (piece, obj):
        each.select_set(state=True)
    bpy.context.view_layer.objects.active = obj
    bpy.ops.object.join()
    return np.arange(count, len(obj.data.vertices))


def test_a_group_says_which_loose_pieces_are_rigid():
    """A strap across two bones bends with them, unless one of its vertices is in the group with weight 1."""
    source, _ = add_rigged(resolution=4)
    strap = joined_piece(source)
    for number, share in zip(strap.tolist(), np.linspace(0.2, 0.9, len(strap)).tolist(), strict=True):
        source.vertex_groups["spine"].add([number], share, "REPLACE")
        source.vertex_groups["chest"].add([number], 1 - share, "REPLACE")
    target = add_target(source, part=0.0)[0]
    names = ["spine", "chest"]
    carry(source, target)
    np.testing.assert_allclose(dense(target, names)[strap], dense(source, names)[strap], atol=1e-5)
    target.vertex_groups.new(name="Rigid").add([int(strap[3])], 1.0, "REPLACE")
    carry(source, target)
    np.testing.assert_array_equal(dense(target, names)[strap], np.tile([1, 0], (len(strap), 1)))
    np.testing.assert_allclose(dense(target, names)[: strap[0]], dense(source, names)[: strap[0]], atol=1e-5)


def test_a_piece_is_rigid_as_on_the_source_unless_the_group_or_the_option_says_no():
    source, _ = add_rigged(resolution=4)
    eye = joined_piece(source)
    source.vertex_groups["head"].add(eye.tolist(), 1.0, "REPLACE")
    target = add_target(source, part=0.0)[0]
    passage = true_passage(source, target)
    back = passage.pair.target_to_source
    triangles = back.triangles.copy()
    triangles[eye[:4]] = back.triangles[0]  # some of its vertices go astray
    stray = SurfaceMap.from_barycentric(passage.pair.source, triangles, back.barycentric)
    passage = replace(passage, pair=replace(passage.pair, target_to_source=stray))
    whole = np.ones(len(eye))
    carry(source, target, passage, fill=False)
    np.testing.assert_array_equal(dense(target, ["head"])[eye, 0], whole)
    carry(source, target, passage, fill=False, rigid=False)
    assert dense(target, ["head"])[eye[:4], 0].max() < 0.5
    target.vertex_groups.new(name="Rigid").add([int(eye[-1])], 0.0, "REPLACE")
    carry(source, target, passage, fill=False)
    assert dense(target, ["head"])[eye[:4], 0].max() < 0.5
