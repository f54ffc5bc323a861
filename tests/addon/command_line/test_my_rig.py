# SPDX-License-Identifier: GPL-3.0-or-later
"""The subcommand `my-rig`."""

from __future__ import annotations

import json

import bpy
import pytest
from hiermatch.hiermatch_addon.command_line.program import main

from tests.addon.characters import add_person, add_skeleton, match_at_once, someone
from tests.people import renamed


@pytest.fixture
def folder(monkeypatch, tmp_path):
    """A folder with a file of a person in whom a standard armature stands, and one of another person."""
    match_at_once(monkeypatch)
    bpy.ops.wm.read_homefile(use_empty=True)
    add_person("B", hanging=True)
    bpy.ops.wm.save_as_mainfile(filepath=str(tmp_path / "B.blend"))
    bpy.ops.wm.read_homefile(use_empty=True)
    add_person("A")
    add_skeleton("Standard", renamed(someone().rig))
    bpy.ops.wm.save_as_mainfile(filepath=str(tmp_path / "A.blend"))
    return tmp_path


def pair_in(folder):
    return [f"{folder / 'A.blend'}:A", f"{folder / 'B.blend'}:B", "--no-refine"]


def test_the_armature_that_moves_nothing_is_fitted_and_goes_along_into_another_file(folder):
    outputs = [f"--output={folder / name}" for name in ("out.glb", "out.blend")]
    assert main(["my-rig", *pair_in(folder), *outputs, f"--report={folder / 'report.json'}"]) == 0
    report = json.loads((folder / "report.json").read_text())
    assert (report["command"], report["status"]) == ("my-rig", "done")
    assert 'the rig "Standard B"' in report["carried"][0]["done"][0]
    bpy.ops.wm.open_mainfile(filepath=str(folder / "out.blend"))
    assert {"Standard", "Standard B"} <= set(bpy.data.objects.keys())
    bones = set(bpy.data.objects["Standard B"].data.bones.keys())
    bpy.ops.wm.read_homefile(use_empty=True)
    bpy.ops.import_scene.gltf(filepath=str(folder / "out.glb"))
    assert {"B Body", "B Head"} <= set(bpy.data.objects.keys())
    assert bones <= {*bpy.data.objects.keys(), *(bone.name for rig in bpy.data.armatures for bone in rig.bones)}
    assert not {"A Body", "A Head"} & set(bpy.data.objects.keys())


def test_bound_it_moves_the_target_in_another_file(folder):
    options = ["--rig=Standard", "--my-rig-bind", "--my-rig-limit=2", f"--output={folder / 'out.glb'}"]
    assert main(["my-rig", *pair_in(folder), *options]) == 0
    bpy.ops.wm.read_homefile(use_empty=True)
    bpy.ops.import_scene.gltf(filepath=str(folder / "out.glb"))
    body = bpy.data.objects["B Body"]
    (modifier,) = (one for one in body.modifiers if one.type == "ARMATURE")
    assert modifier.object.name == "Standard B"
    assert max(len(vertex.groups) for vertex in body.data.vertices) <= 2


def test_what_cannot_be_done_is_told(folder, capsys):
    output = f"--output={folder / 'out.blend'}"
    source, target, plain = pair_in(folder)
    for files, options, code, said in (
        ((source, target), ["--rig=Nobody"], 1, 'no object called "Nobody"'),
        ((source, target), ["--rig=A"], 1, '"A" moves "A"'),
        ((f"{folder / 'A.blend'}:Standard", target), [], 1, "moves no mesh"),
        ((target, source), [], 1, "There is no armature that moves nothing"),
        ((source, target), ["--my-rig-limit=-1"], 2, "not between 0"),
    ):
        assert main(["my-rig", *files, plain, output, *options]) == code, said
        assert said in capsys.readouterr().err
    bpy.ops.wm.open_mainfile(filepath=str(folder / "A.blend"))
    add_skeleton("Other", renamed(someone().rig))
    bpy.ops.wm.save_as_mainfile(filepath=str(folder / "A.blend"))
    assert main(["my-rig", source, target, plain, output]) == 1
    assert 'Several armatures move nothing: "Other", "Standard". Name one by --rig.' in capsys.readouterr().err
    assert not (folder / "out.blend").exists()
