# SPDX-License-Identifier: GPL-3.0-or-later
"""Batches: what is done stays done, and what breaks breaks alone."""

from __future__ import annotations

import csv
import hashlib
import json
import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import bpy
import pytest
from hiermatch.hiermatch_addon.command_line.batches import batch, workers
from hiermatch.hiermatch_addon.command_line.batches.ledger import Ledger, summary_rows
from hiermatch.hiermatch_addon.command_line.batches.manifest import read_manifest, take_shard
from hiermatch.hiermatch_addon.command_line.command import UsageError
from hiermatch.hiermatch_addon.command_line.outputs import save
from hiermatch.hiermatch_addon.command_line.program import main

from tests.addon.scenes import QUICK, add_blob
from tools.source_extension import ROOT

STAND_IN = """
import json, os, pathlib, signal, sys, time
source, target = map(pathlib.Path, sys.argv[2:4])
given = dict(word[2:].split("=", 1) for word in sys.argv[4:] if "=" in word)
with open(os.environ["RUNS"], "a") as runs:
    runs.write(source.stem + "\\n")
if "crash" in source.name:
    os.kill(os.getpid(), signal.SIGKILL)
if "silent" in source.name:
    sys.exit(5)
if "slow" in source.name:
    time.sleep(60)
inputs = [{"path": str(p), "size": p.stat().st_size, "mtime_ns": p.stat().st_mtime_ns} for p in (source, target)]
bad = "bad" in source.name
if not bad:
    pathlib.Path(given["output"]).parent.mkdir(exist_ok=True)
    pathlib.Path(given["output"]).write_text("output")
report = {"format": "hiermatch-report", "key": given["report-key"], "status": "failed" if bad else "done",
          "doubtful": "doubt" in source.name, "error": "It is bad." if bad else "", "inputs": inputs, "seconds": 1.5,
          "match": {"distortion": 0.25, "quality": {"confidence": 0.25 if "doubt" in source.name else 0.75,
                                                    "sentence": "Fine."}},
          "written": [] if bad else [given["output"]]}
pathlib.Path(given["report"]).write_text(json.dumps(report))
sys.exit(1 if bad else 0)
"""
"""Does what a child does, without Blender: what, says the name of the source."""


class Batch:
    """A folder with files and a manifest."""

    def __init__(self, folder):
        self.folder, self.runs = folder, folder / "runs.txt"
        self.manifest = folder / "pairs.csv"

    def write(self, names, header="source,target,output", row="{0}.obj,target.obj,out/{0}.blend"):
        for name in (*names, "target"):
            (self.folder / f"{name}.obj").write_text(name)
        self.manifest.write_text("\n".join([header, *(row.format(name) for name in names)]))

    def run(self, *arguments):
        """Run the batch; return the exit code and which pairs were tried."""
        self.runs.write_text("")
        code = main(["batch", str(self.manifest), *arguments])
        return code, self.runs.read_text().split()

    @property
    def summary(self):
        return self.table("summary")

    def table(self, name):
        path = self.folder / "pairs.csv.hiermatch" / f"{name}.csv"
        with path.open(newline="") as file:
            return {row["name"]: row for row in csv.DictReader(file)}


@pytest.fixture
def stand_in(tmp_path, monkeypatch):
    """A batch whose children are stand-ins."""
    script = tmp_path / "stand_in.py"
    script.write_text(STAND_IN)
    made = Batch(tmp_path)
    environment = {"RUNS": str(made.runs), **os.environ}
    monkeypatch.setattr(workers, "_blender", lambda: ([sys.executable, str(script)], dict(environment)))
    return made


def test_all_pairs_are_done_and_summed_up(stand_in, capsys):
    stand_in.write(["a", "b", "c"])
    assert stand_in.run() == (0, ["a", "b", "c"])
    assert [row["status"] for row in stand_in.summary.values()] == ["done"] * 3
    assert stand_in.summary["b"]["confidence"] == "0.75"
    assert "3 pairs: 3 done." in capsys.readouterr().err
    plain = json.loads((stand_in.folder / "pairs.csv.hiermatch" / "summary.json").read_text())
    assert plain["counts"]["done"] == len(plain["pairs"]) == 3
    assert stand_in.run() == (0, [])


def test_a_summary_tells_of_names_that_are_no_utf_8(stand_in):
    stand_in.write(["a"])
    folder = stand_in.folder / os.fsdecode(b"d\xe9p\xf4t")
    folder.mkdir()
    for name in ("a.obj", "target.obj", "pairs.csv"):
        (stand_in.folder / name).rename(folder / name)
    stand_in.folder, stand_in.manifest = folder, folder / "pairs.csv"
    assert stand_in.run() == (0, ["a"])
    assert stand_in.summary["a"]["status"] == "done"
    plain = json.loads((folder / "pairs.csv.hiermatch" / "summary.json").read_text())
    assert plain["pairs"][0]["source"] == str(folder / "a.obj")


def test_what_breaks_breaks_alone(stand_in, capsys):
    stand_in.write(["a", "bad", "crash", "silent", "b"])
    code, tried = stand_in.run("--jobs=2")
    assert (code, sorted(tried)) == (4, ["a", "b", "bad", "crash", "silent"])
    statuses = {name: row["status"] for name, row in stand_in.summary.items()}
    assert statuses == {"a": "done", "bad": "failed", "crash": "crashed", "silent": "crashed", "b": "done"}
    assert stand_in.summary["bad"]["error"] == "It is bad."
    assert "signal 9" in stand_in.summary["crash"]["error"]
    assert "exit code 5" in stand_in.summary["silent"]["error"]
    assert "bad: failed. It is bad." in capsys.readouterr().err
    assert stand_in.run() == (4, [])
    assert stand_in.run("--retry-failed") == (4, ["bad", "crash", "silent"])


def test_a_pair_has_its_time(stand_in):
    stand_in.write(["slow", "a"])
    assert stand_in.run("--timeout=1") == (4, ["slow", "a"])
    assert stand_in.summary["slow"]["status"] == "timeout"
    assert stand_in.summary["a"]["status"] == "done"


def test_only_what_has_changed_is_done_again(stand_in):
    stand_in.write(["a", "b", "c"])
    stand_in.run()
    (stand_in.folder / "b.obj").write_text("something else")
    assert stand_in.run() == (0, ["b"])
    (stand_in.folder / "out" / "c.blend").unlink()
    assert stand_in.run() == (0, ["c"])
    assert stand_in.run("--points=12") == (0, ["a", "b", "c"])
    report = next((stand_in.folder / "pairs.csv.hiermatch").glob("a-*.json"))
    report.write_text(report.read_text()[:50])
    assert stand_in.run("--points=12") == (0, ["a"])
    (stand_in.folder / "target.obj").write_text("another target")
    assert stand_in.run("--points=12") == (0, ["a", "b", "c"])


def test_what_is_done_is_done_wherever_its_folder_is_mounted(stand_in):
    show = Batch(stand_in.folder / "show")
    show.runs = stand_in.runs
    show.folder.mkdir()
    outside = stand_in.folder / "outside.obj"
    outside.write_text("outside")
    show.write(["a", "b", "bad"], row=f"{{0}}.obj,{outside},out/{{0}}.blend")
    assert show.run() == (4, ["a", "b", "bad"])
    other = Batch(stand_in.folder / "mounted" / "elsewhere")
    other.folder.parent.mkdir()
    show.folder.rename(other.folder)
    other.runs = stand_in.runs
    assert other.run() == (4, [])
    assert [row["status"] for row in other.summary.values()] == ["done", "done", "failed"]
    assert all(Path(row["report"]).is_file() for row in other.summary.values())
    (other.folder / "out" / "b.blend").unlink()
    assert other.run() == (4, ["b"])
    (other.folder / "a.obj").write_text("something else")
    assert other.run() == (4, ["a"])
    outside.write_text("something else")
    assert other.run() == (4, ["a", "b", "bad"])


def test_reports_of_when_all_paths_counted_as_absolute_still_count(stand_in):
    stand_in.write(["a", "b", "bad"])
    stand_in.run("--points=12")
    ledger = Ledger(stand_in.folder / "pairs.csv.hiermatch")
    for pair in read_manifest(stand_in.manifest, {"points": "12"}, "match"):
        paths = [pair.command, pair.source, pair.target, pair.outputs, pair.map]
        key, end = (
            hashlib.blake2b(json.dumps(plain).encode(), digest_size=size).hexdigest()
            for plain, size in (([*paths, pair.options], 16), (paths, 4))
        )
        report = json.loads(ledger.report_path(pair).read_text())
        ledger.report_path(pair).unlink()
        (ledger.folder / f"{pair.name}-{end}.json").write_text(json.dumps(report | {"key": key}))
    assert stand_in.run("--points=12") == (4, [])
    assert [row["status"] for row in stand_in.summary.values()] == ["done", "done", "failed"]
    assert all(Path(row["report"]).is_file() for row in stand_in.summary.values())
    assert stand_in.run("--points=12", "--retry-failed") == (4, ["bad"])
    assert stand_in.run() == (4, ["a", "b", "bad"])
    assert len(list(ledger.folder.glob("*-*.json"))) == 3


@pytest.mark.parametrize(
    "damage",
    [
        {"inputs": 1},
        {"inputs": ["target.obj"]},
        {"match": "good"},
        {"match": {"quality": [0.5]}},
        {"match": {"quality": {"confidence": "high"}}},
        {"match": {"alternatives": 3}},
        {"carried": ["rig"]},
        {"status": ["done"]},
        {"seconds": None, "doubtful": ...},
        ...,
    ],
)
def test_a_damaged_report_counts_as_none(damage, stand_in):
    stand_in.write(["a", "b"])
    assert stand_in.run() == (0, ["a", "b"])
    (path,) = (stand_in.folder / "pairs.csv.hiermatch").glob("a-*.json")
    report = json.loads(path.read_text())
    changed = [] if damage is ... else {name: value for name, value in {**report, **damage}.items() if value is not ...}
    path.write_text(json.dumps(changed))
    assert stand_in.run("--summary") == (0, [])
    assert stand_in.summary["a"]["status"] == "pending"
    assert stand_in.run() == (0, ["a"])
    assert stand_in.summary["a"]["status"] == "done"


def test_rows_may_move_and_be_added(stand_in):
    stand_in.write(["a", "b"])
    stand_in.run()
    stand_in.write(["c", "b", "a"])
    for name in ("a", "b", "target"):
        os.utime(stand_in.folder / f"{name}.obj", ns=(1, 1))
    stand_in.run()
    stand_in.manifest.write_text(stand_in.manifest.read_text().replace("c.obj", "b.obj"))
    assert stand_in.run()[1] == ["b"]


def test_an_interrupted_batch_goes_on(stand_in, monkeypatch):
    stand_in.write(["a", "b", "c"])
    real = batch._close  # noqa: SLF001
    children = []

    def interrupt(pair, *arguments):
        real(pair, *arguments)
        if pair.name == "a":
            raise KeyboardInterrupt

    monkeypatch.setattr(batch, "_close", interrupt)
    started = workers._start  # noqa: SLF001
    monkeypatch.setattr(workers, "_start", lambda *given: children.append(started(*given)) or children[-1])
    (stand_in.folder / "slow.obj").write_text("")
    text = stand_in.manifest.read_text()
    stand_in.manifest.write_text(text.replace("b.obj", "slow.obj"))
    begin = time.monotonic()
    assert stand_in.run("--jobs=2")[0] == 130
    assert time.monotonic() - begin < 30
    assert all(child.process.poll() is not None for child in children)
    assert [row["status"] for row in stand_in.summary.values()] == ["done", "pending", "pending"]
    monkeypatch.setattr(batch, "_close", real)
    stand_in.manifest.write_text(text)
    assert stand_in.run() == (0, ["b", "c"])


def test_shards_are_summed_up_apart_and_together(stand_in):
    stand_in.write(["a", "b", "c", "bad", "e"])
    assert stand_in.run("--shard=1/2") == (0, ["a", "c", "e"])
    assert list(stand_in.table("summary-1-of-2")) == ["a", "c", "e"]
    assert stand_in.run("--summary") == (0, [])
    assert [row["status"] for row in stand_in.summary.values()] == ["done", "pending", "done", "pending", "done"]
    assert stand_in.run("--shard=2/2") == (4, ["b", "bad"])
    assert stand_in.run("--summary") == (4, [])
    assert stand_in.summary["bad"]["status"] == "failed"


def test_a_summary_does_not_ask_for_the_options_again(stand_in):
    stand_in.write(["a", "b"])
    assert stand_in.run("--points=12") == (0, ["a", "b"])
    assert stand_in.run("--summary") == (0, [])
    assert [row["status"] for row in stand_in.summary.values()] == ["done", "done"]


def test_strict_tells_of_doubt(stand_in):
    stand_in.write(["a", "doubt"])
    assert stand_in.run("--strict")[0] == 3
    assert stand_in.run()[0] == 0
    assert stand_in.summary["doubt"]["doubtful"] == "True"


def test_doubt_is_by_the_least_confidence_that_is_given_now(stand_in):
    stand_in.write(["a", "doubt"])
    assert stand_in.run() == (0, ["a", "doubt"])
    for least, doubtful in (("0.8", ["True", "True"]), ("0.2", ["False", "False"]), ("0.5", ["False", "True"])):
        code, tried = stand_in.run("--strict", f"--least-confidence={least}")
        assert (code, tried) == (3 if "True" in doubtful else 0, [])
        assert [row["doubtful"] for row in stand_in.summary.values()] == doubtful
    for percent, doubtful in (("80%", ["True", "True"]), ("20%", ["False", "False"])):
        assert stand_in.run(f"--least-confidence={percent}") == (0, [])
        assert [row["doubtful"] for row in stand_in.summary.values()] == doubtful
    for wrong in ("nan", "inf", "much", "50", "-0.1", "%"):
        assert stand_in.run(f"--least-confidence={wrong}") == (2, [])


def test_a_wrong_value_fails_its_own_row_only(stand_in, capsys):
    stand_in.write(["a", "b"])
    stand_in.manifest.write_text(
        "source,target,output,points,weight_limit,command\n"
        "a.obj,target.obj,a.blend,2,,\na.obj,target.obj,b.blend,12,,\na.obj,target.obj,c.blend,,3,\n"
        "a.obj,target.obj,d.blend,,3,retarget\na.obj,,e.blend,,,\na.obj,target.obj,f.blend,,,conquer\n"
        "a.txt,target.obj,g.blend,,,\na.obj,target.obj,new/../target.obj,,,\n"
    )
    code, tried = stand_in.run()
    assert (code, tried) == (4, ["a", "a"])
    errors = {name: row["error"] for name, row in stand_in.summary.items()}
    assert "not between 3 and 1024" in errors["a"]
    assert "weight_limit is no option of match" in errors["c"]
    assert "empty" in errors["e"]
    assert "must be one of match, retarget" in errors["f"]
    assert "names no file" in errors["g"]
    assert "write over" in errors["target"]
    assert errors["b"] == errors["d"] == ""
    told = capsys.readouterr().err
    assert "c: weight_limit" in told
    assert "known already" not in told
    assert stand_in.run() == (4, [])
    assert "8 of 8 pairs are known already" in capsys.readouterr().err


def test_a_folder_for_reports_that_cannot_be_made_is_told_before_the_work(stand_in, capsys):
    stand_in.write(["a"])
    (stand_in.folder / "file").touch()
    for folder in ("file", "file/reports"):
        assert stand_in.run(f"--work={stand_in.folder / folder}") == (1, [])
        assert "cannot be written" in capsys.readouterr().err


@pytest.mark.parametrize("count", [1, 2, 3, 7, 20])
def test_shards_partition_the_manifest(stand_in, count):
    stand_in.write([f"m{number}" for number in range(9)])
    pairs = read_manifest(stand_in.manifest, {}, "match")
    shards = [take_shard(pairs, (first, count)) for first in range(1, count + 1)]
    assert sorted(pair.number for shard in shards for pair in shard) == list(range(1, 10))
    assert max(map(len, shards)) - min(map(len, shards)) <= 1


@pytest.mark.parametrize(
    ("command", "options"),
    [
        ("motion", ["--keep-feet", "--actions=ALL"]),
        ("my-rig", ["--my-rig-bind", "--rig=metarig"]),
        ("wear", ['--items="Shirt, red",Hat', "--wear-hide=MASK"]),
        ("retarget", ["--weight-limit=4", "--no-refine"]),
    ],
)
def test_options_of_any_command_are_given_for_all_its_pairs(stand_in, monkeypatch, command, options):
    begun = []

    def run_tasks(tasks, *_):
        begun.extend(tasks)
        yield from ()

    monkeypatch.setattr(batch, "run_tasks", run_tasks)
    row = "{0}.obj,target.obj,out/{0}.blend,"
    stand_in.write(["a"], "source,target,output,command", f"{row}{command}\n{row.replace('out/', 'out/matched_')}match")
    stand_in.run(*options, "--points=32")
    own, matched = (task.arguments for task in begun)
    assert {*options, "--points=32"} <= set(own)
    assert "--points=32" in matched
    assert not {*options} & set(matched)


@pytest.mark.parametrize("arguments", [["--shard=0/3"], ["--shard=4/3"], ["--shard=3"], ["--jobs=0"], ["--timeout=-1"]])
def test_wrong_usage_is_told(stand_in, arguments):
    stand_in.write(["a"])
    assert stand_in.run(*arguments) == (2, [])


def test_a_manifest_that_is_not_there_is_told(tmp_path, capsys):
    assert main(["batch", str(tmp_path / "none.csv")]) == 1
    assert "cannot be read" in capsys.readouterr().err


def test_a_pair_without_a_boolean_is_told(stand_in):
    stand_in.write(["a"], "source,target,output,dense", "{0}.obj,target.obj,{0}.blend,maybe")
    (pair,) = read_manifest(stand_in.manifest, {}, "match")
    with pytest.raises(UsageError, match="must be true or false"):
        pair.arguments()
    assert summary_rows(Ledger(stand_in.folder / "nothing"), [pair], 0.5)[0]["status"] == "pending"


FOLLOWING = (
    "source,target,output\nb.obj,target.obj,out/b.obj\n{}\nout/a.obj,target.obj,out/c.obj\nd.obj,target.obj,out/d.obj"
)
"""Of its four rows the third reads what the second writes; the others stand alone."""


def follow(stand_in, second="a.obj,target.obj,out/a.obj"):
    if not stand_in.manifest.exists():
        stand_in.write(["a", "b", "bad", "crash", "d"])
    stand_in.manifest.write_text(FOLLOWING.format(second))


@pytest.mark.parametrize("jobs", [1, 3])
def test_a_row_that_reads_what_another_writes_waits_for_it(stand_in, jobs):
    follow(stand_in)
    code, tried = stand_in.run(f"--jobs={jobs}")
    assert (code, sorted(tried)) == (0, ["a", "a", "b", "d"])  # the third reads out/a.obj
    first = stand_in.folder / "out" / "a.obj"
    assert stand_in.run(f"--jobs={jobs}") == (0, [])
    (stand_in.folder / "a.obj").write_text("something else")
    assert stand_in.run(f"--jobs={jobs}") == (0, ["a", "a"])
    assert first.read_text() == "output"


@pytest.mark.parametrize("second", ["bad.obj,target.obj,out/a.obj", "crash.obj,target.obj,out/a.obj"])
def test_a_row_that_reads_what_came_to_nothing_is_not_begun(stand_in, capsys, second):
    follow(stand_in)
    stand_in.run()
    follow(stand_in, second)
    assert "a" not in stand_in.run("--jobs=3")[1]  # though the file of the former run is there
    assert stand_in.summary["c"]["status"] == "failed"
    assert stand_in.summary["c"]["error"] == 'It was not begun: it reads what "a" writes, and that failed.'
    assert 'c: failed. It was not begun: it reads what "a" writes' in capsys.readouterr().err
    follow(stand_in)
    assert stand_in.run() == (0, ["a"])


@pytest.mark.parametrize(("name", "status"), [("crash", "crashed"), ("slow", "timeout")])
def test_one_that_reads_what_another_writes_may_crash_as_any(stand_in, name, status):
    stand_in.write(["a", name])
    stand_in.manifest.write_text(
        f"source,target,output\na.obj,target.obj,out/a.obj\n{name}.obj,out/a.obj,out/{name}.blend"
    )
    assert stand_in.run("--timeout=2") == (4, ["a", name])
    assert stand_in.summary[name]["status"] == status
    assert stand_in.run("--timeout=2") == (4, [])
    (stand_in.folder / "out" / "a.obj").unlink()
    assert stand_in.run("--timeout=2")[1] == ["a", name]


def test_nor_is_one_that_reads_what_a_row_with_a_wrong_value_would_write(stand_in):
    follow(stand_in, "a.txt,target.obj,out/a.obj")
    assert stand_in.run() == (4, ["b", "d"])
    assert "It was not begun" in stand_in.summary["c"]["error"]
    assert stand_in.run() == (4, [])
    follow(stand_in)
    assert stand_in.run() == (0, ["a", "a"])


def test_rows_that_wait_for_each_other_are_no_shards(stand_in, capsys):
    follow(stand_in)
    assert stand_in.run("--shard=1/2") == (1, [])
    assert "which row 2 writes, and shards do not wait for each other" in capsys.readouterr().err


def test_rows_that_leave_nothing_are_told_before_the_work(stand_in, capsys):
    stand_in.write(["a", "b"])
    stand_in.manifest.write_text(
        "source,target,output,command\na.obj,target.obj,,retarget\nb.obj,target.obj,c.obj,wear"
    )
    assert stand_in.run() == (4, ["b"])
    assert "a-target: output is empty, so nothing would be left of the work. Name the file to write." in (
        capsys.readouterr().err
    )


@pytest.mark.slow
def test_a_batch_of_real_matches_is_killed_and_goes_on(tmp_path):
    save(tmp_path / "target.obj", add_blob("Target"))
    save(tmp_path / "a.obj", add_blob("Source", 18, 12))
    (tmp_path / "damaged.obj").write_bytes(b"\x00\x01\x02")
    # Each takes a second or two, so that it is far from its end when the first result is seen.
    names = ["a", "damaged", *(f"more-{number}" for number in range(12)), "c"]
    for name in names[2:]:
        (tmp_path / f"{name}.obj").write_bytes((tmp_path / "a.obj").read_bytes())
    manifest = tmp_path / "pairs.csv"
    header = f"source,target,output,{','.join(QUICK)}"
    rows = [f"{name}.obj,target.obj,{name}.blend,{','.join(map(str, QUICK.values()))}" for name in names]
    manifest.write_text("\n".join([header, *rows]))
    module = f"{ROOT.name}.hiermatch_addon.command_line"
    command = [sys.executable, "-m", module, "batch", str(manifest)]
    running = subprocess.Popen(
        command, cwd=ROOT.parent, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, start_new_session=True
    )
    try:
        deadline, reports = time.monotonic() + 120, manifest.with_name("pairs.csv.hiermatch")
        while not list(reports.glob("a-*.json")):
            assert time.monotonic() < deadline
            assert running.poll() is None
            time.sleep(0.02)
    finally:
        running.send_signal(signal.SIGINT)
    assert running.wait(120) == 130
    assert running.stdout.read() == b""
    first = (tmp_path / "a.blend").stat().st_mtime_ns
    assert not (tmp_path / "c.blend").exists()
    manifest.write_text("\n".join([header, *rows[:3], rows[-1]]))
    assert main(["batch", str(manifest), "--jobs=2", "--quiet"]) == 4
    assert (tmp_path / "a.blend").stat().st_mtime_ns == first
    with (tmp_path / "pairs.csv.hiermatch" / "summary.csv").open(newline="") as file:
        statuses = {row["name"]: row["status"] for row in csv.DictReader(file)}
    assert statuses == {"a": "done", "damaged": "failed", "more-0": "done", "c": "done"}
    bpy.ops.wm.open_mainfile(filepath=str(tmp_path / "c.blend"))
    assert "HM.001" in bpy.data.objects["Target"].vertex_groups
    assert not [path for path in Path(tmp_path).rglob("*") if "part" in path.name]
