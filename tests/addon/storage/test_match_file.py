# SPDX-License-Identifier: GPL-3.0-or-later
"""A match in a file of its own, and back."""

from __future__ import annotations

import json
import zipfile
from dataclasses import replace
from pathlib import Path

import bpy
import numpy as np
import pytest
from hiermatch.engine import SettingsError
from hiermatch.hiermatch_addon.common.errors import ObjectError
from hiermatch.hiermatch_addon.storage.match_exchange import apply_match, collect_match
from hiermatch.hiermatch_addon.storage.match_file import load_match, save_match

from tests.addon.scenes import MAP_ATTRIBUTES, QUICK, add_pair, edit_twin, maps_of, mesh_snapshot, snapshot, values_of

SUFFIXES = ["npz", "json"]


def map_values(obj):
    return [values_of(obj.data.attributes[name]).tobytes() for name in MAP_ATTRIBUTES]


@pytest.fixture
def exported(dense_pair, tmp_path):
    """The match of a pair in both kinds of file."""
    match = collect_match(*dense_pair)
    paths = {suffix: tmp_path / f"match.{suffix}" for suffix in SUFFIXES}
    for path in paths.values():
        save_match(match, path)
    return paths


@pytest.mark.parametrize("suffix", SUFFIXES)
def test_what_comes_back_is_what_was_there(dense_pair, exported, suffix):
    before = [mesh_snapshot(obj) for obj in dense_pair]
    kept = maps_of(*dense_pair)
    bpy.ops.hiermatch.clear(object="Source")
    assert "HM Map Weights" not in dense_pair[0].data.attributes
    stored = apply_match(bpy.context, *dense_pair, load_match(exported[suffix]), "HM")
    after = [mesh_snapshot(obj) for obj in dense_pair]
    for one, other in zip(before, after, strict=True):
        assert one["weights"] == other["weights"]
        assert sorted(one["attributes"]) == sorted(other["attributes"])
        assert one["properties"]["hiermatch"]["HM"]["kept"] == other["properties"]["hiermatch"]["HM"]["kept"]
    again = maps_of(*dense_pair)
    assert np.array_equal(again.source_to_target.barycentric, kept.source_to_target.barycentric)
    assert stored.answer.quality is not None


@pytest.mark.parametrize("suffix", SUFFIXES)
def test_what_has_no_partner_travels_too(dense_pair, tmp_path, suffix):
    match = collect_match(*dense_pair)
    alone = np.arange(len(match.maps.of_source.weights)) % 2 == 0
    maps = replace(match.maps, of_source=replace(match.maps.of_source, has_partner=~alone))
    path = tmp_path / f"match.{suffix}"
    save_match(replace(match, maps=maps), path)
    found = load_match(path).maps
    assert (found.of_source.has_partner == ~alone).all()
    assert found.of_target.has_partner.all()


@pytest.mark.parametrize("suffix", SUFFIXES)
def test_the_other_answer_travels_too(dense_pair, tmp_path, suffix):
    bpy.ops.hiermatch.flip(object="Source")
    path = tmp_path / f"flipped.{suffix}"
    save_match(collect_match(*dense_pair), path)
    flipped = map_values(dense_pair[0])
    bpy.ops.hiermatch.clear(object="Source")
    apply_match(bpy.context, *dense_pair, load_match(path), "HM")
    assert map_values(dense_pair[0]) == flipped
    match = load_match(path)
    assert match.stored.chosen == 1
    assert all(maps is not None for maps in match.others)
    bpy.ops.hiermatch.flip(object="Source")
    assert map_values(dense_pair[0]) != flipped


def test_it_fits_meshes_with_other_names_and_poses(dense_pair, exported):
    source, target = dense_pair
    bpy.ops.hiermatch.clear(object="Source")
    source.name, target.location.z = "Renamed", 3
    for vertex in target.data.vertices:
        vertex.co.x *= 1.1
    apply_match(bpy.context, source, target, load_match(exported["npz"]), "New")
    assert collect_match(source, target).stored.names == ("Renamed", "Target")
    assert maps_of(source, target).source_to_target.confidence.max() > 0


def test_the_order_of_the_two_is_the_match_s(dense_pair):
    source, target = dense_pair
    assert collect_match(target, source).stored.names == ("Source", "Target")
    assert [collect_match(*pair).stored.swapped for pair in ((source, target), (target, source))] == [False, True]


def test_it_says_when_it_fits_the_other_way_round(dense_pair, exported):
    before = snapshot()
    with pytest.raises(ObjectError, match="other way round"):
        apply_match(bpy.context, *dense_pair[::-1], load_match(exported["npz"]), "HM")
    assert snapshot() == before


def test_it_refuses_other_meshes(dense_pair, exported):
    source, target = dense_pair
    match = load_match(exported["json"])
    bpy.ops.mesh.primitive_cube_add()
    with pytest.raises(ObjectError, match=r"from a mesh with \d+ vertices, and this one has 8"):
        apply_match(bpy.context, source, bpy.context.object, match, "HM")
    altered = target.copy()
    altered.data = target.data.copy()
    altered.data.flip_normals()
    bpy.context.collection.objects.link(altered)
    with pytest.raises(ObjectError, match="numbered otherwise"):
        apply_match(bpy.context, source, altered, match, "HM")
    unknown = replace(match, stored=replace(match.stored, topologies=("", "")))
    assert apply_match(bpy.context, source, altered, unknown, "Un")


def test_a_match_without_maps_comes_back_as_points(tmp_path):
    source, target = add_pair()
    bpy.ops.hiermatch.match(source="Source", target="Target", **QUICK)
    groups = mesh_snapshot(target)["weights"]
    save_match(collect_match(source, target), tmp_path / "sparse.npz")
    bpy.ops.hiermatch.clear(object="Source")
    stored = apply_match(bpy.context, source, target, load_match(tmp_path / "sparse.npz"), "HM")
    assert mesh_snapshot(target)["weights"] == groups
    assert "HM Match" not in target.data.attributes
    assert any("no dense map" in note for note in stored.notes)


def test_edited_meshes_are_not_exported(dense_pair):
    dense_pair[0].data.vertices[0].co.x += 1
    with pytest.raises(ObjectError, match="out of date"):
        collect_match(*dense_pair)


def test_meshes_without_a_match_are_told(empty_file):
    assert empty_file
    with pytest.raises(ObjectError, match="Match them first"):
        collect_match(*add_pair())


def test_the_npz_is_plain_for_anybody(exported):
    with np.load(exported["npz"], allow_pickle=False) as archive:
        header = json.loads(archive["header"].tobytes())
        corners, weights = archive["source_to_target_corners"], archive["source_to_target_weights"]
    assert (header["format"], header["version"]) == ("hiermatch-match", 1)
    assert corners.shape == weights.shape == (header["source"]["vertices"], 3)
    assert corners.max() < header["target"]["vertices"]
    np.testing.assert_allclose(weights.sum(axis=1), 1, atol=1e-5)
    assert set(json.loads(exported["json"].read_text())) == {"header", "arrays"}


def rewritten(path, change):
    """Change what a JSON match holds."""
    plain = json.loads(path.read_text())
    change(plain["header"], plain["arrays"])
    path.write_text(json.dumps(plain))
    return path


@pytest.mark.parametrize(
    "change",
    [
        lambda _, arrays: arrays["source_to_target_corners"][0].__setitem__(0, 10**6),
        lambda _, arrays: arrays["source_to_target_corners"][0].__setitem__(0, -1),
        lambda _, arrays: arrays["source_to_target_corners"].pop(),
        lambda _, arrays: arrays["source_to_target_weights"][0].__setitem__(0, 7.0),
        lambda _, arrays: arrays["source_to_target_weights"][0].__setitem__(0, "seven"),
        lambda _, arrays: arrays["target_to_source_confidence"].__setitem__(0, 2.0),
        lambda _, arrays: arrays["source_points_corners"][0].__setitem__(1, 0.5),
        lambda _, arrays: arrays["point_distortion"].__setitem__(0, float("nan")),
        lambda _, arrays: arrays.pop("target_points_corners"),
        lambda _, arrays: arrays.update(point_distortion=None),
        lambda header, _: header.update(answers=[]),
        lambda header, _: header.update(answers=3),
        lambda header, _: header.update(source=None),
        lambda header, _: header["written"].update(colour=True),
        lambda header, _: header["answers"][0]["quality"].update(confidence="high"),
        lambda header, arrays: header.clear() or arrays.clear(),
        lambda header, _: header.update(answers=[3]),
        lambda header, _: header.update(written=[1]),
        lambda header, _: header["answers"][0].update(quality=[1]),
        lambda header, _: header["source"].update(vertices=float("inf")),
        lambda header, _: header.update(left_out=[99]),
        lambda header, _: header.update(left_out=[-1]),
        lambda header, _: header["answers"][0].update(distortion=float("nan")),
        lambda header, _: header["answers"][0].update(gap=float("inf")),
        lambda header, _: header["answers"][0]["quality"].update(confidence=float("nan")),
        lambda header, _: header.update(version=99),
        lambda header, _: header.update(format="something else"),
        lambda header, _: header["answers"][0].update(name="n" * 64),
        lambda header, _: header["answers"][0].update(name="the end\0and more"),
        lambda header, _: header["answers"][0]["quality"].update(alternatives=3e9),
        lambda header, _: header.update(notes=["half a character: \ud800"]),
    ],
)
def test_wrong_content_is_told(exported, change):
    with pytest.raises(ObjectError, match=r'"match\.json"'):
        load_match(rewritten(exported["json"], change))


def test_arrays_without_names_are_told(exported):
    plain = json.loads(exported["json"].read_text())
    exported["json"].write_text(json.dumps(plain | {"arrays": [1]}))
    with pytest.raises(ObjectError, match="damaged"):
        load_match(exported["json"])


@pytest.mark.parametrize("suffix", SUFFIXES)
@pytest.mark.parametrize(
    "damage", [lambda b: b[: len(b) // 2], lambda _: b"", lambda _: b"not at all", lambda b: b[::-1]]
)
def test_damaged_files_are_told(exported, suffix, damage):
    path = exported[suffix]
    path.write_bytes(damage(path.read_bytes()))
    with pytest.raises(ObjectError, match="damaged"):
        load_match(path)


def test_objects_in_an_npz_are_never_made(exported, tmp_path):
    evil = tmp_path / "evil.npz"
    np.savez(tmp_path / "object.npz", array=np.array([{}], dtype=object))
    with zipfile.ZipFile(tmp_path / "object.npz") as archive:
        pickled = archive.read("array.npy")
    with zipfile.ZipFile(exported["npz"]) as archive, zipfile.ZipFile(evil, "w") as changed:
        for name in archive.namelist():
            changed.writestr(name, pickled if name == "point_distortion.npy" else archive.read(name))
    with pytest.raises(ObjectError, match="damaged"):
        load_match(evil)


def test_json_of_editors_on_windows_is_read(exported):
    path = exported["json"]
    path.write_text(path.read_text("utf8"), "utf-8-sig")
    assert load_match(path).stored.key == load_match(exported["npz"]).stored.key


@pytest.mark.parametrize("name", ["junk.npy", "point_distortion.npy", "header.npy"])
def test_what_is_larger_than_it_can_be_is_not_unpacked(exported, monkeypatch, name):
    """Such a file of 2 MB may hold 2 GB of zeros."""
    unpacked = []
    read = zipfile.ZipExtFile.read
    monkeypatch.setattr(
        zipfile.ZipExtFile, "read", lambda member, *size: unpacked.append(member.name) or read(member, *size)
    )
    with zipfile.ZipFile(exported["npz"]) as archive:
        members = {member: archive.read(member) for member in archive.namelist()} | {name: bytes(1 << 25)}
    with zipfile.ZipFile(exported["npz"], "w", zipfile.ZIP_DEFLATED) as changed:
        for member, content in members.items():
            changed.writestr(member, content)
    unpacked.clear()
    with pytest.raises(ObjectError, match="damaged"):
        load_match(exported["npz"])
    assert name not in unpacked


def test_names_must_tell_the_kind_and_be_there(dense_pair, tmp_path):
    match = collect_match(*dense_pair)
    with pytest.raises(ObjectError, match=r"\.npz or \.json"):
        save_match(match, tmp_path / "match.txt")
    with pytest.raises(ObjectError, match="cannot be read"):
        load_match(tmp_path / "nowhere.npz")
    (tmp_path / "file").touch()
    with pytest.raises(ObjectError, match="cannot be written"):
        save_match(match, tmp_path / "file" / "match.npz")
    assert [path.name for path in tmp_path.iterdir()] == ["file"]


def test_operators_export_and_import(dense_pair, tmp_path):
    path = str(tmp_path / "match.npz")
    assert bpy.ops.hiermatch.export_match(filepath=path, source="Source", target="Target") == {"FINISHED"}
    maps = map_values(dense_pair[1])
    bpy.ops.hiermatch.clear(object="Source")
    assert bpy.ops.hiermatch.import_match(filepath=path, source="Source", target="Target") == {"FINISHED"}
    assert map_values(dense_pair[1]) == maps
    summary = bpy.context.scene.hiermatch.summary
    assert (summary.source, summary.target, summary.prefix) == ("Source", "Target", "HM")
    assert summary.verdict
    assert not summary.stale
    with pytest.raises(RuntimeError, match="other way round"):
        bpy.ops.hiermatch.import_match(filepath=path, source="Target", target="Source")
    with pytest.raises(RuntimeError, match="no name for a match file"):
        bpy.ops.hiermatch.export_match(filepath=str(tmp_path / "a.txt"), source="Source", target="Target")
    with pytest.raises(RuntimeError, match="Prefix is empty"):
        bpy.ops.hiermatch.import_match(filepath=path, source="Source", target="Target", prefix="")
    before = snapshot()
    for prefix in ("x" * 33, "日本語" * 4):
        with pytest.raises(SettingsError, match="Prefix is too long"):
            apply_match(bpy.context, *dense_pair, load_match(Path(path)), prefix)
    assert snapshot() == before


def test_a_mesh_that_is_edited_through_another_object_is_refused(dense_pair, tmp_path):
    edit_twin(dense_pair[1])
    bpy.context.view_layer.objects.active = dense_pair[0]
    assert bpy.context.mode == "OBJECT"
    with pytest.raises(RuntimeError, match='"Target" shares its mesh with an object in Edit Mode'):
        bpy.ops.hiermatch.export_match(filepath=str(tmp_path / "a.npz"), source="Source", target="Target")


@pytest.mark.usefixtures("dense_pair")
def test_it_is_no_work_for_edit_mode():
    bpy.context.view_layer.objects.active = bpy.data.objects["Source"]
    bpy.ops.object.mode_set(mode="EDIT")
    assert not bpy.ops.hiermatch.export_match.poll()
    bpy.ops.object.mode_set(mode="OBJECT")
    assert bpy.ops.hiermatch.export_match.poll()


@pytest.mark.usefixtures("dense_pair")
def test_without_a_selection_the_match_that_the_panel_shows_is_exported(tmp_path):
    shown, named = (str(tmp_path / f"{name}.npz") for name in ("shown", "named"))
    bpy.ops.object.select_all(action="DESELECT")
    state = bpy.context.scene.hiermatch
    state.source = state.target = None
    assert bpy.ops.hiermatch.export_match(filepath=shown) == {"FINISHED"}
    assert bpy.ops.hiermatch.export_match(filepath=named, source="Source", target="Target") == {"FINISHED"}
    with np.load(shown) as first, np.load(named) as second:
        assert set(first) == set(second)
        assert all(np.array_equal(first[name], second[name]) for name in first)
    with pytest.raises(RuntimeError, match="It is open which mesh is the Source"):
        bpy.ops.hiermatch.export_match(filepath=shown, prefix="Other")
