# SPDX-License-Identifier: GPL-3.0-or-later
"""The table of pairs of bones: made, changed by hand, kept in files."""

import json
import re

import bpy
import pytest
from hiermatch.hiermatch_addon.jobs import match_job, running

from tests.addon.characters import add_person, match_at_once, someone

ops = bpy.ops.hiermatch


def table():
    """The pairs of names."""
    return {(row.source, row.target) for row in bpy.context.scene.hiermatch_bone_pairs}


@pytest.fixture
def rigs():
    """Two persons with different rigs, and of the second's bones the origins."""
    add_person("A")
    _, made = add_person("B", "renamed", rolls=0.5, hanging=True)
    return {name: next(iter(origin)) for name, origin in zip(made.names, made.origins, strict=True)}


def test_meshes_of_a_character_are_taken_together_and_paired_right(rigs):
    assert ops.pair_bones(source="A", target="B") == {"FINISHED"}
    assert {(source, rigs[target]) for source, target in table()} == {(name, name) for name in someone().rig.names}
    assert all(0.3 < row.score <= 1 for row in bpy.context.scene.hiermatch_bone_pairs)
    report = bpy.context.scene.hiermatch_retarget.reports["HIERMATCH_PT_motion"]
    assert re.fullmatch(r'Found for "B": \d+ paired bones', report.done)


def test_locked_pairs_stay_and_bones_without_a_source_stay_alone(rigs):
    place = {origin: name for name, origin in rigs.items()}
    ops.add_bone_pair(source="A", target="B", source_bone="head", target_bone=place["neck"])
    ops.add_bone_pair(source="A", target="B", target_bone=place["hand.L"])
    ops.pair_bones(source="A", target="B")
    found = {(source, rigs[target]) for source, target in table()}
    assert {("head", "neck"), ("", "hand.L")} <= found
    assert ("neck", "neck") not in found
    assert ("hand.L", "hand.L") not in found
    ops.clear_bone_pairs(source="A", target="B")
    assert {(source, rigs[target]) for source, target in table()} == {("head", "neck"), ("", "hand.L")}
    ops.remove_bone_pair(source="A", target="B", target_bone=place["neck"])
    ops.clear_bone_pairs(source="A", target="B", locked=True)
    assert not table()


@pytest.mark.usefixtures("rigs")
def test_the_table_goes_to_a_file_and_back(tmp_path):
    ops.pair_bones(source="A", target="B")
    before, path = table(), tmp_path / "pairs.json"
    turns = [tuple(row.turn) for row in bpy.context.scene.hiermatch_bone_pairs]
    assert ops.export_bone_pairs(source="A", target="B", filepath=str(path)) == {"FINISHED"}
    ops.clear_bone_pairs(source="A", target="B")
    assert ops.import_bone_pairs(source="A", target="B", filepath=str(path)) == {"FINISHED"}
    assert table() == before
    assert [tuple(row.turn) for row in bpy.context.scene.hiermatch_bone_pairs] == turns
    assert all(row.is_seen for row in bpy.context.scene.hiermatch_bone_pairs)
    read = json.loads(path.read_text())
    read["pairs"][0]["target"] = "Wing"
    path.write_text(json.dumps(read))
    ops.import_bone_pairs(source="A", target="B", filepath=str(path))
    assert len(table()) == len(before) - 1


@pytest.mark.usefixtures("rigs")
def test_files_of_something_else_are_refused(tmp_path):
    path = tmp_path / "pairs.json"
    ops.pair_bones(source="A", target="B")
    before = table()
    for text in ("nothing", json.dumps({"format": "Other"}), json.dumps([1])):
        path.write_text(text)
        with pytest.raises(RuntimeError, match="holds no pairs of bones"):
            ops.import_bone_pairs(source="A", target="B", filepath=str(path))
    assert table() == before
    with pytest.raises(RuntimeError, match="cannot be read"):
        ops.import_bone_pairs(source="A", target="B", filepath=str(tmp_path / "missing.json"))
    with pytest.raises(RuntimeError, match=r"No bones of .* are paired"):
        ops.export_bone_pairs(source="B", target="A", filepath=str(path))


@pytest.mark.usefixtures("rigs")
def test_it_is_saved_in_the_file(tmp_path):
    ops.pair_bones(source="A", target="B")
    before = table()
    bpy.ops.wm.save_as_mainfile(filepath=str(tmp_path / "scene.blend"))
    bpy.ops.wm.open_mainfile(filepath=str(tmp_path / "scene.blend"))
    assert table() == before
    assert bpy.context.scene.hiermatch_bone_pairs[0].source_rig == bpy.data.objects["A"]


@pytest.mark.usefixtures("rigs")
def test_what_is_no_rig_is_refused():
    mesh = bpy.data.objects.new("Stone", bpy.data.meshes.new("Stone"))
    bpy.context.scene.collection.objects.link(mesh)
    with pytest.raises(RuntimeError, match='"Stone" has no armature'):
        ops.pair_bones(source="A", target="Stone")
    for obj in bpy.data.objects["B"].children:
        obj.modifiers.clear()
        obj.parent = None
    bpy.context.view_layer.update()
    with pytest.raises(RuntimeError, match='"B" moves no mesh'):
        ops.pair_bones(source="A", target="B")
    with pytest.raises(RuntimeError, match='has no bone called "Wing"'):
        ops.add_bone_pair(source="A", target="B", source_bone="head", target_bone="Wing")
    assert not table()


def test_two_armatures_that_are_selected_need_no_names(rigs):
    for name in "BA":
        bpy.data.objects[name].select_set(state=True)
        bpy.context.view_layer.objects.active = bpy.data.objects[name]
    assert ops.pair_bones() == {"FINISHED"}
    assert len(table()) == len(rigs)


def test_a_collection_several_objects_and_the_picked_ones_are_taken_as_match_takes_them(rigs):
    held = bpy.data.collections.new("Figure")
    bpy.context.scene.collection.children.link(held)
    for obj in (bpy.data.objects["B"], *bpy.data.objects["B"].children):
        held.objects.link(obj)
    assert ops.pair_bones(source="A Body + A Head", target="Figure") == {"FINISHED"}
    whole = table()
    assert len(whole) == len(rigs)
    ops.clear_bone_pairs(source="A", target="Figure")
    assert not table()
    state = bpy.context.scene.hiermatch
    state.source, state.target_collection = bpy.data.objects["A"], held
    state.target = None
    assert ops.pair_bones() == {"FINISHED"}
    assert table() == whole


def test_parts_that_were_matched_are_enough(rigs, monkeypatch):
    bpy.ops.hiermatch.match(source="A Body", target="B Body")
    monkeypatch.setattr(match_job, "match_steps", None)
    assert ops.pair_bones(source="A", target="B") == {"FINISHED"}
    found = {(source, rigs[target]) for source, target in table()}
    assert ("thigh.L", "thigh.L") in found
    assert all(source == origin for source, origin in found)


@pytest.mark.usefixtures("rigs")
def test_of_a_doubtful_match_it_is_said_what_hangs_on_bones_and_may_be_hidden(monkeypatch):
    match_at_once(monkeypatch, confidence=0.1)
    for rig in ("A", "B"):  # they are numbered alike
        bpy.data.objects[f"{rig} Head"].parent_type = "BONE"
        bpy.data.objects[f"{rig} Head"].parent_bone = bpy.data.objects[rig].data.bones[0].name
    with pytest.raises(RuntimeError, match=r'What hangs on single bones of "A": "A Head"\. Hide what "B"'):
        ops.pair_bones(source="A", target="B")
    # So it is by Match alone.
    ops.match(source="A", target="B")
    said = 'What hangs on single bones of "A": "A Head". Hide what "B" has not, such as weapons, and match again.'
    assert bpy.context.scene.hiermatch.summary.notes == said
    match_at_once(monkeypatch)
    ops.match(source="A", target="B")
    assert not bpy.context.scene.hiermatch.summary.notes


@pytest.mark.usefixtures("rigs")
def test_a_doubtful_match_pairs_nothing_unless_it_is_accepted(monkeypatch):
    match_at_once(monkeypatch, confidence=0.1)
    with pytest.raises(RuntimeError, match="is doubtful, and nothing was written"):
        ops.pair_bones(source="A", target="B")
    assert not table()
    assert ops.pair_bones(source="A", target="B", accept_doubtful=True) == {"FINISHED"}
    assert table()


@pytest.mark.usefixtures("rigs")
def test_it_is_offered_while_an_armature_is_posed():
    bpy.context.view_layer.objects.active = bpy.data.objects["B"]
    bpy.ops.object.mode_set(mode="POSE")
    assert ops.pair_bones(source="A", target="B") == {"FINISHED"}
    assert table()
    bpy.ops.object.mode_set(mode="OBJECT")


@pytest.mark.parametrize("name", [f"{what}_bone_pair" for what in ("add", "remove")] + ["clear_bone_pairs"])
def test_while_something_runs_buttons_say_so(monkeypatch, name):
    monkeypatch.setattr(running, "running_panel", lambda _manager: "HIERMATCH_PT_match")
    with pytest.raises(RuntimeError, match="HierMatch is at work"):
        getattr(ops, name)()
