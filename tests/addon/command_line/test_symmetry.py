# SPDX-License-Identifier: GPL-3.0-or-later
"""``blender --command hiermatch symmetry``, run within this process."""

from __future__ import annotations

import json

import bpy
import pytest
from hiermatch.engine import MatchSettings, symmetry_map_steps
from hiermatch.hiermatch_addon.command_line import symmetry
from hiermatch.hiermatch_addon.command_line.program import main
from hiermatch.hiermatch_addon.storage.match_file import load_match
from hiermatch.hiermatch_addon.transfers import symmetrise

from tests.addon.rigs import add_rigged, split_up
from tests.addon.scenes import QUICK, add_blob


@pytest.fixture
def quickly(monkeypatch):
    """Look for symmetries with few points."""
    quick = MatchSettings(**{name: value for name, value in QUICK.items() if name != "dense"})
    for module in (symmetry, symmetrise):
        monkeypatch.setattr(module, "symmetry_map_steps", lambda mesh: symmetry_map_steps(mesh, quick))


@pytest.mark.usefixtures("quickly")
def test_the_map_is_found_and_both_sides_made_alike(tmp_path):
    obj = add_blob("Body")
    count = len(obj.data.vertices)
    obj.vertex_groups.new(name="Arm.L").add(range(30), 1.0, "REPLACE")
    bpy.ops.wm.save_as_mainfile(filepath=str(tmp_path / "body.blend"))
    body, report = str(tmp_path / "body.blend"), tmp_path / "report.json"
    assert main(["symmetry", body, f"--map={tmp_path / 'map.npz'}", f"--report={report}"]) == 0
    found = load_match(tmp_path / "map.npz")
    assert found.kind == "symmetry"
    assert found.counts == (count, count)
    assert json.loads(report.read_text())["match"]["quality"]["sentence"]
    output = tmp_path / "out.blend"
    assert main(["symmetry", body, f"--output={output}", "--symmetrise-side=left"]) == 0
    bpy.ops.wm.open_mainfile(filepath=str(output))
    assert "Arm.R" in bpy.data.objects["Body"].vertex_groups
    assert main(["import", body, body, str(tmp_path / "map.npz"), f"--output={output}"]) == 1


@pytest.mark.usefixtures("quickly")
def test_the_map_is_found_once_for_all_that_is_asked(tmp_path, monkeypatch):
    asked = []
    for module in (symmetry, symmetrise):
        steps = module.symmetry_map_steps
        monkeypatch.setattr(module, "symmetry_map_steps", lambda mesh, steps=steps: asked.append(mesh) or steps(mesh))
    add_blob("Body").vertex_groups.new(name="Arm.L").add(range(30), 1.0, "REPLACE")
    bpy.ops.wm.save_as_mainfile(filepath=str(tmp_path / "body.blend"))
    body, report = tmp_path / "body.blend", tmp_path / "report.json"
    wanted = ["symmetry", str(body), f"--output={tmp_path / 'out.blend'}", f"--map={tmp_path / 'map.npz'}"]
    assert main([*wanted, f"--report={report}", "--strict"]) in (0, 3)
    assert len(asked) == 1
    said = json.loads(report.read_text())
    assert said["match"]["quality"]["sentence"]
    assert said["carried"][0]["done"]
    assert load_match(tmp_path / "map.npz").kind == "symmetry"


@pytest.mark.usefixtures("quickly")
def test_symmetry_tells_of_a_mesh_that_is_hardly_symmetric(tmp_path, monkeypatch, capsys):
    monkeypatch.setattr(symmetrise, "asymmetry_note", lambda name, _: f'"{name}" is hardly symmetric.')
    add_blob("Body").vertex_groups.new(name="Arm.L").add(range(30), 1.0, "REPLACE")
    bpy.ops.wm.save_as_mainfile(filepath=str(tmp_path / "body.blend"))
    output, report = tmp_path / "out.blend", tmp_path / "report.json"
    wanted = ["symmetry", str(tmp_path / "body.blend"), f"--output={output}", f"--report={report}"]
    assert main(wanted) == 0
    assert '"Body" is hardly symmetric.' in capsys.readouterr().err
    assert json.loads(report.read_text())["notes"] == ['"Body" is hardly symmetric.']
    output.unlink()
    assert main([*wanted, "--strict", "--least-confidence=1"]) == 3
    assert json.loads(report.read_text())["doubtful"]
    assert output.exists()


def test_symmetry_is_that_of_one_mesh(tmp_path, capsys):
    source, rig = add_rigged(resolution=4)
    whole, *parts = rig.name, *(part.name for part in split_up(source, lambda centers: centers[:, 0] > 0))
    bpy.ops.wm.save_as_mainfile(filepath=str(tmp_path / "character.blend"))
    assert main(["symmetry", f"{tmp_path / 'character.blend'}:{whole}"]) == 1
    said = capsys.readouterr().err
    assert f'"{whole}" has several meshes' in said
    assert all(f'"{part}"' in said for part in parts)
