# SPDX-License-Identifier: GPL-3.0-or-later
"""Meshes that a command line names: by files, and by objects in them."""

from __future__ import annotations

from pathlib import Path

import bpy
import pytest
from hiermatch.hiermatch_addon.command_line.meshes import MeshArgument, load_meshes, mesh_argument
from hiermatch.hiermatch_addon.command_line.outputs import save
from hiermatch.hiermatch_addon.common.errors import ObjectError
from hiermatch.hiermatch_addon.scene.armatures import find_armature
from hiermatch.hiermatch_addon.scene.character import Character

from tests.addon.rigs import add_rigged, add_rigged_pair, split_up
from tests.addon.scenes import add_blob


@pytest.mark.parametrize(
    ("text", "path", "name"),
    [
        ("a.blend", "a.blend", ""),
        ("a.blend:Body", "a.blend", "Body"),
        ("some where/a.b.OBJ:ns:Body.001", "some where/a.b.OBJ", "ns:Body.001"),
        ("C:/x/a.fbx", "C:/x/a.fbx", ""),
        ("C:/x/a.fbx:Body.obj", "C:/x/a.fbx", "Body.obj"),
    ],
)
def test_meshes_are_named_by_file_and_object(text, path, name):
    assert mesh_argument(text) == MeshArgument(Path(path), name)


def test_which_mesh_is_meant_must_be_clear(folder, tmp_path):
    with pytest.raises(ObjectError, match=r'holds 2 meshes.*"Source", "Target"'):
        load_meshes([MeshArgument(folder / "pair.blend")])
    with pytest.raises(ObjectError, match='no mesh called "Nobody"'):
        load_meshes([MeshArgument(folder / "pair.blend", "Nobody")])
    add_blob("Small", 8, 6)
    add_blob("Large")
    bpy.ops.wm.obj_export(filepath=str(tmp_path / "two.obj"))
    (largest,), notes = load_meshes([MeshArgument(tmp_path / "two.obj")])
    assert largest.name == "Large"
    assert 'The largest was taken: "Large"' in notes[0]
    (small,), notes = load_meshes([MeshArgument(tmp_path / "two.obj", "Small")])
    assert (small.name, notes) == ("Small", [])
    (tmp_path / "none.obj").write_text("v 0 0 0\n")
    with pytest.raises(ObjectError, match="holds no mesh with faces"):
        load_meshes([MeshArgument(tmp_path / "none.obj")])


def test_a_second_blend_brings_its_rig(folder, tmp_path):
    add_rigged_pair()
    bpy.ops.wm.save_as_mainfile(filepath=str(tmp_path / "rigged.blend"))
    arguments = [MeshArgument(folder / "pair.blend", "Source"), MeshArgument(tmp_path / "rigged.blend", "Source")]
    (plain, rigged), _ = load_meshes(arguments)
    assert (plain.name, rigged.name) == ("Source", "Source.001")
    assert rigged.parent.name in bpy.context.view_layer.objects
    with pytest.raises(ObjectError, match='no object called "Nobody"'):
        load_meshes([arguments[0], MeshArgument(tmp_path / "rigged.blend", "Nobody")])


@pytest.mark.parametrize("other", ["collection", "armature"])
def test_a_mesh_of_exactly_that_name_is_meant_first(other, tmp_path):
    source, rig = add_rigged("Body", resolution=4)
    parts = split_up(source, lambda centers: centers[:, 0] > 0)
    parts[0].name = "Hero"
    if other == "armature":
        rig.name = "Hero.001"
    else:
        held = bpy.data.collections.new("Hero")
        bpy.context.scene.collection.children.link(held)
        for part in parts:
            held.objects.link(part)
    bpy.ops.wm.save_as_mainfile(filepath=str(tmp_path / "hero.blend"))
    (side,), _ = load_meshes([MeshArgument(tmp_path / "hero.blend", "Hero")])
    assert side == bpy.data.objects["Hero"]


def test_one_file_may_be_named_in_several_ways(folder, tmp_path, monkeypatch):
    monkeypatch.chdir(folder)
    (tmp_path / "link").symlink_to(folder, target_is_directory=True)
    for other in ("pair.blend", tmp_path / "link" / "pair.blend", Path("..", folder.name, "pair.blend")):
        found, _ = load_meshes([MeshArgument(folder / "pair.blend", "Source"), MeshArgument(Path(other), "Target")])
        assert [obj.name for obj in found] == ["Source", "Target"]
    paths = [folder / "Source.obj", Path("..", folder.name, "Source.obj")]
    (first, second), _ = load_meshes([MeshArgument(path) for path in paths])
    assert first == second


def test_characters_are_named_by_their_armature_or_collection(tmp_path):
    source, _ = add_rigged(resolution=4)
    parts = split_up(source, lambda centers: centers[:, 0] > 0)
    held = bpy.data.collections.new("Held")
    bpy.context.scene.collection.children.link(held)
    held.objects.link(parts[0])
    held.objects.link(parts[1])
    add_blob("Prop")
    names = tuple(part.name for part in parts)
    path = tmp_path / "character.blend"
    bpy.ops.wm.save_as_mainfile(filepath=str(path))
    (first,), _ = load_meshes([MeshArgument(path, "Source Rig")])
    assert (first.name, tuple(part.name for part in first.parts)) == ("Source Rig", names)
    opened = tmp_path / "other.blend"
    bpy.ops.wm.read_homefile(use_empty=True)
    add_blob("Body")
    bpy.ops.wm.save_as_mainfile(filepath=str(opened))
    for name in ("Source Rig", "Held"):
        (_, second), _ = load_meshes([MeshArgument(opened), MeshArgument(path, name)])
        assert (second.name, tuple(part.name for part in second.parts)) == (name, names)
        assert find_armature(second).name == "Source Rig"
        assert "Prop" not in bpy.data.objects


def test_an_import_of_a_character_is_taken_as_a_whole(tmp_path):
    source, _ = add_rigged(resolution=4)
    parts = split_up(source, lambda centers: centers[:, 0] > 0)
    save(tmp_path / "character.glb", Character("Hero", tuple(parts)))
    (side,), notes = load_meshes([MeshArgument(tmp_path / "character.glb")])
    assert len(side.parts) == 2
    assert "holds a character of 2 meshes" in notes[0]
    (one,), _ = load_meshes([MeshArgument(tmp_path / "character.glb")], whole=False)
    assert one in bpy.context.view_layer.objects.values()


@pytest.mark.parametrize("suffix", ["obj", "fbx", "glb"])
def test_what_is_added_first_keeps_the_names_that_both_files_have(suffix, tmp_path):
    paths = [tmp_path / f"{name}.{suffix}" for name in ("hero", "crowd")]
    for path, size in zip(paths, (12, 16), strict=True):
        bpy.ops.wm.read_homefile(use_empty=True)
        obj = add_blob("Body", size)
        obj.data.materials.append(bpy.data.materials.new("Skin"))
        save(path, obj)
    for name in ("", "Body"):
        for last_first in (False, True):
            (source, target), _ = load_meshes([MeshArgument(path, name) for path in paths], last_first=last_first)
            assert len(source.data.vertices) < len(target.data.vertices)
            kept = target if last_first else source
            assert (kept.name, kept.data.materials[0].name) == ("Body", "Skin")


@pytest.mark.parametrize("suffix", ["obj", "fbx", "glb"])
def test_a_name_is_the_one_in_the_file_whatever_the_scene_has(suffix, tmp_path):
    bodies = [add_blob(name, size) for name, size in (("Body", 12), ("Body.001", 16))]
    save(tmp_path / f"two.{suffix}", bodies[0], along=bodies[1:])
    bpy.data.objects.remove(bodies[1])
    bpy.ops.wm.save_as_mainfile(filepath=str(tmp_path / "one.blend"))
    counts = []
    for name in ("Body", "Body.001"):
        sides, _ = load_meshes([MeshArgument(tmp_path / "one.blend"), MeshArgument(tmp_path / f"two.{suffix}", name)])
        counts.append(len(sides[1].data.vertices))
        assert sides[0].name == "Body"
    assert counts[0] < counts[1]
    with pytest.raises(ObjectError, match=r'no mesh called "Body.002"\. It has "Body", "Body.001"\.$'):
        load_meshes([MeshArgument(tmp_path / "one.blend"), MeshArgument(tmp_path / f"two.{suffix}", "Body.002")])


def test_what_is_imported_is_no_choice_of_the_blend_beside(tmp_path):
    save(tmp_path / "other.obj", add_blob("Other"))
    bpy.data.objects["Other"].name = "Body"
    bpy.ops.wm.save_as_mainfile(filepath=str(tmp_path / "body.blend"))
    paths = [MeshArgument(tmp_path / name) for name in ("body.blend", "other.obj")]
    for order in (1, -1):
        sides, _ = load_meshes(paths[::order])
        assert [side.name for side in sides[::order]] == ["Body", "Other"]


def test_what_an_importer_shows_bones_by_is_no_mesh_of_the_file(tmp_path):
    source, _ = add_rigged(resolution=4)
    save(tmp_path / "one.glb", source)
    (side,), notes = load_meshes([MeshArgument(tmp_path / "one.glb")])
    assert side.name == "Source"
    assert not notes
    with pytest.raises(ObjectError, match=r'no mesh called "Head". It has "Source"\.$'):
        load_meshes([MeshArgument(tmp_path / "one.glb", "Head")])
