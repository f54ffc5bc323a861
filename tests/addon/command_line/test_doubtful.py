# SPDX-License-Identifier: GPL-3.0-or-later
"""A match that is not to be trusted, on the command line: it ends with a sentence, unless it is accepted."""

from __future__ import annotations

import json

import bpy
import pytest
from hiermatch.hiermatch_addon.command_line.batches import batch
from hiermatch.hiermatch_addon.command_line.program import main
from hiermatch.hiermatch_addon.jobs import verdict

from tests.addon.garments import add_item


@pytest.fixture
def doubtful(dense_pair, tmp_path, monkeypatch):
    """Arguments that name a matched pair whose match nobody should trust, with something to carry and to wear."""
    monkeypatch.setattr(verdict, "DOUBTFUL", 1.1)
    dense_pair[0].data.uv_layers.new(name="Layout")
    closet = bpy.data.collections.new("Closet")
    bpy.context.scene.collection.children.link(closet)
    closet.objects.link(add_item(dense_pair[0], "Shirt", 0.02))
    bpy.ops.wm.save_as_mainfile(filepath=str(tmp_path / "pair.blend"))
    return [f"{tmp_path / 'pair.blend'}:{name}" for name in ("Source", "Target")]


@pytest.mark.parametrize("command", [["retarget"], ["wear", "--collection=Closet"]], ids=lambda words: words[0])
def test_it_fails_with_a_sentence_unless_it_is_accepted(doubtful, command, tmp_path, capsys):
    output, report = tmp_path / "out.blend", tmp_path / "report.json"
    arguments = [command[0], *doubtful, *command[1:], "--no-refine", f"--output={output}", f"--report={report}"]
    arguments.append("--least-confidence=1")
    assert main(arguments) == 1
    said = capsys.readouterr().err
    assert 'The match of "Source" and "Target" is doubtful' in said
    assert "landmarks" in said
    assert not output.exists()
    told = json.loads(report.read_text())
    assert (told["status"], told["doubtful"]) == ("failed", True)
    ((target, done, confidence),) = (one.values() for one in told["carried"])
    assert (target, done) == ("Target", [])
    assert f"Confidence {confidence:.0%}" in said
    assert main([*arguments, "--accept-doubtful"]) == 0
    assert output.exists()
    assert json.loads(report.read_text())["status"] == "done"


@pytest.mark.parametrize(
    ("command", "wish", "accepted"),
    [
        ("retarget", "", True),
        ("wear", "", True),
        ("match", "", False),
        ("retarget", "false", False),
        ("wear", "false", False),
    ],
)
def test_a_batch_accepts_it_unless_the_row_says_no(tmp_path, monkeypatch, command, wish, accepted):
    for name in ("source", "target"):
        (tmp_path / f"{name}.obj").write_text(name)
    manifest = tmp_path / "pairs.csv"
    columns, row = "source,target,output,command", f"source.obj,target.obj,out.blend,{command}"
    if wish:
        columns, row = f"{columns},accept_doubtful", f"{row},{wish}"
    manifest.write_text(f"{columns}\n{row}")
    started = []

    def run_nothing(tasks, *_limits):
        started.extend(tasks)
        yield from ()

    monkeypatch.setattr(batch, "run_tasks", run_nothing)
    main(["batch", str(manifest)])
    (task,) = started
    assert ("--accept-doubtful" in task.arguments) == accepted
