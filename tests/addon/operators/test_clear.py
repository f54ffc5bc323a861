# SPDX-License-Identifier: GPL-3.0-or-later
"""The operator `hiermatch.clear`."""

from __future__ import annotations

import bpy
import pytest

from tests.addon.scenes import QUICK, add_pair, snapshot, weights_of


@pytest.fixture
def pair():
    return add_pair()


def match(**options):
    bpy.ops.hiermatch.match(source="Source", target="Target", **(QUICK | options))


def test_clears_the_picked_pair_and_the_summary(pair):
    state = bpy.context.scene.hiermatch
    state.source, state.target = pair
    pair[0].vertex_groups.new(name="HM.my own").add([0], 1, "REPLACE")
    before = snapshot()
    match()
    assert bpy.ops.hiermatch.clear() == {"FINISHED"}
    assert snapshot() == before
    assert (state.source, state.target) == pair


def test_clears_what_is_selected(pair):
    match()
    bpy.context.scene.hiermatch.source = bpy.context.scene.hiermatch.target = None
    pair[1].select_set(state=True)
    assert bpy.ops.hiermatch.clear() == {"FINISHED"}
    assert not pair[1].vertex_groups
    assert len(pair[0].vertex_groups) == QUICK["points"]


def test_clears_a_named_object(pair):
    match()
    assert bpy.ops.hiermatch.clear(object="Source") == {"FINISHED"}
    assert not pair[0].vertex_groups
    assert pair[1].vertex_groups


def test_clears_one_prefix_only(pair):
    match()
    match(prefix="Other")
    for obj in pair:
        bpy.ops.hiermatch.clear(object=obj.name, prefix="HM")
        assert {name.split(".")[0] for name in weights_of(obj)} == {"Other"}


def test_clearing_several_results_restores_what_was_shown_before_the_first(pair):
    state = bpy.context.scene.hiermatch
    state.source, state.target = pair
    for name in ("Paint", "Dirt"):
        pair[0].data.color_attributes.new(name, "BYTE_COLOR", "CORNER")
    pair[0].data.attributes.active_color_name = "Dirt"
    before = snapshot()
    match()
    match(prefix="Other")
    assert bpy.ops.hiermatch.clear() == {"FINISHED"}
    assert snapshot() == before


def test_the_summary_stays_until_its_own_match_goes(pair):
    match(prefix="Other")
    match()
    bpy.ops.hiermatch.clear(object=pair[0].name, prefix="Other")
    assert bpy.context.scene.hiermatch.summary.points == QUICK["points"]
    bpy.ops.hiermatch.clear(object=pair[0].name)
    assert bpy.context.scene.hiermatch.summary.points == 0


def test_the_summary_goes_when_a_renamed_object_is_cleared(pair):
    match()
    pair[1].name = "Renamed"
    bpy.ops.hiermatch.clear(object="Renamed")
    assert bpy.context.scene.hiermatch.summary.points == 0


def test_says_why_it_cannot(pair):
    assert pair
    with pytest.raises(RuntimeError, match="nothing here that HierMatch has written"):
        bpy.ops.hiermatch.clear()
    match()
    bpy.context.scene.hiermatch.source = bpy.context.scene.hiermatch.target = None
    assert bpy.ops.hiermatch.clear() == {"CANCELLED"}  # nothing picked or selected
    with pytest.raises(RuntimeError, match='no object called "Nobody"'):
        bpy.ops.hiermatch.clear(object="Nobody")


def test_what_is_linked_is_left_out_and_named(pair, tmp_path, capfd):
    match()
    path = str(tmp_path / "library.blend")
    bpy.ops.wm.save_as_mainfile(filepath=path, copy=True)
    bpy.data.objects.remove(pair[0])
    bpy.data.meshes.remove(bpy.data.meshes["Source"])
    with bpy.data.libraries.load(path, link=True) as (_, into):
        into.objects = ["Source"]
    source = bpy.data.objects["Source"]
    bpy.context.collection.objects.link(source)
    state = bpy.context.scene.hiermatch
    state.source, state.target = source, pair[1]
    with pytest.raises(RuntimeError, match=r'"Source" is linked from "library\.blend"'):
        bpy.ops.hiermatch.clear(object="Source")
    assert bpy.ops.hiermatch.clear() == {"FINISHED"}
    assert not pair[1].vertex_groups
    assert 'Warning: "Source" is linked from "library.blend"' in capfd.readouterr().out
    assert len(source.vertex_groups) == QUICK["points"]


def test_one_undo_brings_it_back(pair):
    match()
    after = snapshot()
    bpy.ops.ed.undo_push(message="Before")
    bpy.ops.hiermatch.clear("EXEC_DEFAULT", True, object=pair[0].name)  # noqa: FBT003
    assert snapshot() != after
    bpy.ops.ed.undo()
    assert snapshot() == after
