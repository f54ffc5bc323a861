# SPDX-License-Identifier: GPL-3.0-or-later
"""A technical director's story: a script without a window retargets every file of a folder."""

import importlib.util
import json
import subprocess
import sys
from pathlib import Path

import pytest

from tests.stories.blender_session import blender_session

ROOT = Path(__file__).resolve().parents[2]

pytestmark = [
    pytest.mark.slow,
    pytest.mark.skipif(importlib.util.find_spec("bpy") is None, reason="Blender as a module is not installed"),
]

SCRIPT = """
import json, sys
from pathlib import Path

root, folder, output = (Path(argument) for argument in sys.argv[-3:])
sys.path.insert(0, str(root))
import bpy
from tools.source_extension import registered_extension

registered_extension()
report = {}
for path in sorted(folder.glob("*.blend")):
    try:
        bpy.ops.wm.open_mainfile(filepath=str(path))
        bpy.ops.hiermatch.retarget(source="Source", target="Target", use_uvs=False)
        bpy.ops.wm.save_as_mainfile(filepath=str(output / path.name))
    except RuntimeError as error:
        report[path.name] = str(error)
    else:
        report[path.name] = bpy.context.scene.hiermatch_retarget.report.done
(output / "report.json").write_text(json.dumps(report))
"""


def test_a_folder_of_files_is_retargeted(tmp_path):
    folder, output = tmp_path / "in", tmp_path / "out"
    folder.mkdir()
    output.mkdir()
    with blender_session() as bpy:
        from hiermatch.hiermatch_addon.scene.armatures import find_armature

        from tests.addon.rigs import add_rigged, add_target
        from tests.addon.scenes import DENSE

        # Two good files and a damaged one; in one of them the source has no rig.
        for name, part in (("one", 0.4), ("two", -0.4)):
            bpy.ops.wm.read_homefile(use_empty=True)
            source, _ = add_rigged(resolution=6)
            add_target(source, part=part)
            for setting, value in DENSE.items():
                setattr(bpy.context.scene.hiermatch, setting, value)
            if name == "two":
                source.modifiers.clear()
                source.parent = None
            bpy.ops.wm.save_as_mainfile(filepath=str(folder / f"{name}.blend"))
        (folder / "broken.blend").write_bytes(b"BLENDER nonsense")

        command = [sys.executable, "-c", SCRIPT, str(ROOT), str(folder), str(output)]
        run = subprocess.run(command, check=False, capture_output=True, text=True, cwd=tmp_path)
        assert run.returncode == 0, run.stdout + run.stderr
        report = json.loads((output / "report.json").read_text())
        assert "rig" in report["one.blend"]
        assert "rig" not in report["two.blend"]
        assert "vertex groups" in report["two.blend"]
        assert "broken.blend" in report
        assert not (output / "broken.blend").exists()

        bpy.ops.wm.open_mainfile(filepath=str(output / "one.blend"))
        target = bpy.data.objects["Target"]
        assert find_armature(target) not in (None, find_armature(bpy.data.objects["Source"]))
        assert {"spine", "head", "upper front.L"} <= set(target.vertex_groups.keys())
        bpy.ops.wm.open_mainfile(filepath=str(output / "two.blend"))
        assert find_armature(bpy.data.objects["Target"]) is None
        assert "spine" in bpy.data.objects["Target"].vertex_groups
