# SPDX-License-Identifier: GPL-3.0-or-later
"""Files of all kinds that commands write: what is in them."""

from __future__ import annotations

import resource

import bpy
import numpy as np
import pytest
from hiermatch.hiermatch_addon.command_line.meshes import MeshArgument, load_meshes
from hiermatch.hiermatch_addon.command_line.outputs import save
from hiermatch.hiermatch_addon.common.errors import ObjectError
from hiermatch.hiermatch_addon.scene.armatures import find_armature

from tests.addon.rigs import add_rigged
from tests.addon.scenes import add_blob


def test_textures_of_two_files_in_one_folder_stay_apart(tmp_path):
    obj = add_blob("Body")
    obj.data.uv_layers.new(name="Layout")
    material = bpy.data.materials.new("Skin")
    if material.node_tree is None:  # before Blender 5
        material.use_nodes = True
    nodes = material.node_tree.nodes
    texture = nodes.new("ShaderNodeTexImage")
    texture.image = bpy.data.images.new("Skin", 4, 4)
    material.node_tree.links.new(texture.outputs["Color"], nodes["Principled BSDF"].inputs["Base Color"])
    obj.data.materials.append(material)
    colors = {"first": 0.0, "the second": 1.0}
    for name, color in colors.items():
        for _ in range(2):  # over a former one as well
            texture.image.pixels[:] = [color, color, color, 1.0] * 16
            texture.image.pack()
            save(tmp_path / f"{name}.gltf", obj)
    for name, color in colors.items():
        (back,), _ = load_meshes([MeshArgument(tmp_path / f"{name}.gltf")])
        (image,) = (node.image for node in back.data.materials[0].node_tree.nodes if node.type == "TEX_IMAGE")
        assert image.pixels[0] == pytest.approx(color, abs=0.01)
    assert {path.name for path in tmp_path.glob("*.*")} == {
        f"{name}.{end}" for name in colors for end in ("gltf", "bin")
    }


@pytest.mark.parametrize("hidden", ["hide_set", "hide_viewport", "hide_select"])
def test_what_is_hidden_is_written_all_the_same(hidden, tmp_path):
    source, rig = add_rigged(resolution=4)
    for obj in (source, rig):
        if hidden == "hide_set":
            obj.hide_set(state=True)
        else:
            setattr(obj, hidden, True)
    save(tmp_path / "hidden.glb", source)
    (back,), _ = load_meshes([MeshArgument(tmp_path / "hidden.glb")])
    assert len(back.data.polygons) > 0
    assert find_armature(back) is not None


@pytest.mark.parametrize("suffix", ["fbx", "glb"])
def test_an_armature_that_gave_way_to_another_one_is_not_written(suffix, tmp_path):
    """The exporter of FBX would let both move the mesh."""
    source, rig = add_rigged(resolution=4)
    aside = source.modifiers.new("Old", "ARMATURE")
    aside.object = rig.copy()
    bpy.context.scene.collection.objects.link(aside.object)
    aside.show_viewport = aside.show_render = False
    save(tmp_path / f"rigged.{suffix}", source)
    known = set(bpy.data.objects)
    (back,), _ = load_meshes([MeshArgument(tmp_path / f"rigged.{suffix}")])
    (armature,) = (obj for obj in set(bpy.data.objects) - known if obj.type == "ARMATURE")
    assert [modifier.object for modifier in back.modifiers if modifier.type == "ARMATURE"] == [armature]


def test_what_cannot_be_written_because_its_collection_is_hidden_is_told(tmp_path):
    source, rig = add_rigged(resolution=4)
    shut = bpy.data.collections.new("Shut")
    bpy.context.scene.collection.children.link(shut)
    shut.objects.link(rig)
    bpy.context.scene.collection.objects.unlink(rig)
    child = bpy.context.view_layer.layer_collection.children["Shut"]
    for place, switch in ((shut, "hide_viewport"), (child, "exclude")):
        setattr(place, switch, True)
        with pytest.raises(ObjectError, match=f'"{rig.name}" cannot be written while hidden'):
            save(tmp_path / "hidden.glb", source)
    assert not (tmp_path / "hidden.glb").exists()


@pytest.mark.parametrize("suffix", ["blend", "obj", "ply", "stl", "fbx", "glb", "gltf"])
def test_a_disk_without_room_for_the_end_of_a_file_is_told(suffix, tmp_path):
    path, obj = tmp_path / f"body.{suffix}", add_blob("Body")
    path.write_text("old")
    before = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (5000, before[1]))  # writing stops there as on a full disk
    try:
        with pytest.raises(ObjectError, match="cannot be written"):
            save(path, obj)
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, before)
    assert [path] == list(tmp_path.iterdir())
    assert path.read_text() == "old"
    faces = len(obj.data.polygons)
    save(path, obj)
    (back,), _ = load_meshes([MeshArgument(path)])
    assert len(back.data.polygons) >= faces


@pytest.mark.parametrize("suffix", ["obj", "ply", "stl", "fbx", "glb", "gltf"])
def test_all_kinds_of_files_come_back(suffix, tmp_path):
    obj = add_blob("Body")
    faces, length = len(obj.data.polygons), np.linalg.norm(np.ptp([vertex.co for vertex in obj.data.vertices], axis=0))
    path = tmp_path / f"Body.{suffix}"
    save(path, obj)
    (back,), notes = load_meshes([MeshArgument(path)])
    assert not notes
    assert len(back.data.polygons) >= faces  # some kinds know triangles only
    assert back.dimensions.length == pytest.approx(length, rel=1e-3)


@pytest.mark.parametrize("name", ["body.blend", "body.obj", "body.glb", "body.gltf"])
def test_a_link_stays_one_and_what_it_leads_to_is_written(name, tmp_path):
    (tmp_path / "published").mkdir()
    kept = tmp_path / "published" / name
    kept.write_bytes(b"before")
    link = tmp_path / name
    link.symlink_to(kept)
    save(link, add_blob("Body"))
    assert link.is_symlink()
    (back,), _ = load_meshes([MeshArgument(link)])
    assert len(back.data.polygons) > 0
    assert kept.read_bytes() != b"before"
    assert set(tmp_path.iterdir()) == {kept.parent, link}
