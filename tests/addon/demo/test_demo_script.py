# SPDX-License-Identifier: GPL-3.0-or-later
"""The script behind `make demo`."""

from __future__ import annotations

import re
import struct
import subprocess
import sys

import bpy
import numpy as np
import pytest

from tools import demo_truth
from tools.source_extension import ROOT


def run_demo(*arguments):
    command = [sys.executable, str(ROOT / "tools" / "demo.py"), *map(str, arguments)]
    return subprocess.run(command, capture_output=True, text=True, check=False, timeout=600)


@pytest.fixture(scope="module")
def demo(tmp_path_factory):
    folder = tmp_path_factory.mktemp("demo") / "new" / "folder"
    return folder, run_demo("--output", folder, "--points", 40, "--width", 160, "--samples", 1)


@pytest.mark.slow
def test_it_succeeds_with_a_picture_and_a_file(demo):
    folder, done = demo
    assert done.returncode == 0, done.stderr
    header = (folder / "demo.png").read_bytes()[:24]
    assert header.startswith(b"\x89PNG")
    assert struct.unpack(">II", header[16:24]) == (160, 90)
    assert (folder / "demo.blend").is_file()


@pytest.mark.slow
def test_it_shows_progress_and_prints_a_table(demo):
    _, done = demo
    percents = [int(number) for number in re.findall(r"^ +(\d+)%", done.stdout, re.MULTILINE)]
    assert len(percents) > 2
    assert percents == sorted(percents)
    rows = dict(re.findall(r"^  (\S.*?)  +(.+)$", done.stdout, re.MULTILINE))
    assert rows["Points matched"] == "40"
    assert {"Distortion", "Coarse match", "Error, worst"} <= rows.keys()
    assert 0 < float(rows["Error, mean"].split()[0]) < 0.1
    assert sum(name.startswith("Seconds, ") for name in rows) > 2


@pytest.mark.slow
def test_the_file_holds_the_match_and_the_marked_points(demo):
    folder, _ = demo
    bpy.ops.wm.open_mainfile(filepath=str(folder / "demo.blend"))
    state = bpy.context.scene.hiermatch
    errors = demo_truth.match_errors(state.source, state.target, bpy.context.evaluated_depsgraph_get())
    assert len(errors.direct) == 40
    colors = []
    for cat in (state.source, state.target):
        assert "HM Match" in cat.data.color_attributes
        beads = bpy.data.objects[f"{cat.name} Points"].data
        flat = np.empty(4 * len(beads.vertices), np.float32)
        beads.attributes["Color"].data.foreach_get("color", flat)
        colors.append(flat)
    assert (colors[0] == colors[1]).all()
    assert bpy.context.scene.camera


@pytest.mark.slow
def test_failure_is_one_sentence_and_an_exit_code(tmp_path):
    occupied = tmp_path / "file"
    occupied.write_text("not a folder", encoding="utf8")
    done = run_demo("--output", occupied / "demo")
    assert done.returncode == 1
    assert done.stderr.strip().splitlines()[-1].startswith("The demo failed. ")
    assert "Traceback" not in done.stderr
