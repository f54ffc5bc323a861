# SPDX-License-Identifier: GPL-3.0-or-later
"""``blender --command hiermatch``, run within this process."""

from __future__ import annotations

import argparse
import json
import os
import signal
from pathlib import Path

import bpy
import pytest
from hiermatch.hiermatch_addon import command_line
from hiermatch.hiermatch_addon.command_line import console, match, options, reports
from hiermatch.hiermatch_addon.command_line.command import UsageError
from hiermatch.hiermatch_addon.command_line.meshes import MeshArgument, load_meshes, mesh_argument
from hiermatch.hiermatch_addon.command_line.operator_errors import said_by
from hiermatch.hiermatch_addon.command_line.outputs import save
from hiermatch.hiermatch_addon.command_line.program import main
from hiermatch.hiermatch_addon.common.errors import ObjectError
from hiermatch.hiermatch_addon.properties.properties import OPTION_NAMES
from hiermatch.hiermatch_addon.storage.match_file import load_match

from tests.addon.rigs import add_rigged_pair
from tests.addon.scenes import DENSE, QUICK, add_blob


def flags(settings):
    """Write settings as arguments."""
    words = []
    for name, value in settings.items():
        flag = name.replace("_", "-")
        words.append((f"--{flag}" if value else f"--no-{flag}") if isinstance(value, bool) else f"--{flag}={value}")
    return words


def report_of(path):
    return json.loads(Path(path).read_text(encoding="utf-8"))


def test_match_writes_what_is_wanted(pair, tmp_path, capsys):
    outputs = [tmp_path / "new folder" / "out.blend", tmp_path / "out.ply"]
    arguments = [f"--output={path}" for path in outputs]
    arguments += [f"--map={tmp_path / 'map.npz'}", f"--report={tmp_path / 'report.json'}"]
    assert main(["match", *pair, *arguments, *flags(DENSE)]) == 0
    said = capsys.readouterr()
    assert not said.out.replace("Info: Saved copy", "").count("Done")
    assert "Done: matched 24 points; confidence" in said.err
    report = report_of(tmp_path / "report.json")
    assert (report["format"], report["status"], report["exit_code"], report["error"]) == (
        "hiermatch-report",
        "done",
        0,
        "",
    )
    assert report["match"]["points"] == 24
    assert report["match"]["quality"]["sentence"]
    assert not report["doubtful"]
    assert {Path(path) for path in report["written"]} == {*outputs, tmp_path / "map.npz"}
    assert [one["path"] for one in report["inputs"]] == [pair[0].rpartition(":")[0]]
    assert report["objects"]["target"]["object"] == "Target"
    assert all(path.is_file() for path in outputs)
    assert load_match(tmp_path / "map.npz").maps is not None
    bpy.ops.wm.open_mainfile(filepath=str(outputs[0]))
    assert "HM Map Weights" in bpy.data.objects["Target"].data.attributes
    assert bpy.context.scene.hiermatch.summary.points == 24
    assert {path.name for path in tmp_path.iterdir()} == {"new folder", "out.ply", "map.npz", "report.json"}


def test_a_report_can_go_to_the_output(folder, capsys):
    objs = [str(folder / "Source.obj"), str(folder / "Target.obj")]
    assert main(["match", *objs, "--report=-", "--quiet", *flags(QUICK)]) == 0
    out = capsys.readouterr().out
    assert json.loads(out[out.index("{") :])["match"]["points"] == 12


@pytest.mark.parametrize("command", ["match", "retarget", "export", "motion", "my-rig", "wear"])
def test_the_target_keeps_names_where_no_option_names_things_of_the_source(command, tmp_path):
    for name in ("hero", "crowd"):
        bpy.ops.wm.read_homefile(use_empty=True)
        save(tmp_path / f"{name}.obj", add_blob("Body"))
    report = tmp_path / "report.json"
    arguments = [str(tmp_path / "hero.obj"), str(tmp_path / "crowd.obj"), f"--report={report}"]
    options = {"match": flags(QUICK), "retarget": ["--no-use-uvs"], "export": ["m.npz"]}.get(command, [])
    assert main([command, *arguments, *options]) == (0 if command == "match" else 1)  # there is nothing to carry
    names = {role: told["object"] for role, told in report_of(report)["objects"].items()}
    first, second = ("source", "target") if command in {"motion", "my-rig", "wear"} else ("target", "source")
    assert names == {first: "Body", second: "Body.001"}


def test_a_report_tells_of_names_that_are_no_utf_8(folder, tmp_path):
    named = tmp_path / os.fsdecode(b"h\xe9ro.obj")
    named.write_bytes((folder / "Source.obj").read_bytes())
    output, report = tmp_path / os.fsdecode(b"\xe9.stl"), tmp_path / "report.json"
    arguments = [str(named), str(folder / "Target.obj"), f"--output={output}", f"--report={report}"]
    assert main(["match", *arguments, *flags(QUICK)]) == 0
    told = report_of(report)
    assert (told["inputs"][0]["path"], told["written"]) == (str(named), [str(output)])
    assert output.is_file()


def test_a_report_that_nobody_takes_is_told():
    kept, (taken, given) = os.dup(1), os.pipe()
    os.close(taken)
    os.dup2(given, 1)
    try:
        with pytest.raises(ObjectError, match="The standard output cannot be written"):
            console.Console(quiet=True, own_process=True).result("{}")
    finally:
        os.dup2(kept, 1)


def test_strict_tells_of_a_doubtful_match(pair, tmp_path):
    arguments = [*pair, "--strict", "--least-confidence=100%", f"--report={tmp_path / 'r.json'}", *flags(DENSE)]
    assert main(["match", *arguments]) == 3
    assert report_of(tmp_path / "r.json")["doubtful"]
    assert report_of(tmp_path / "r.json")["status"] == "done"


@pytest.mark.parametrize(
    ("arguments", "code", "said"),
    [
        (["--help"], 0, ""),
        (["match", "--help"], 0, ""),
        ([], 2, "COMMAND"),
        (["conquer"], 2, "conquer"),
        (["match", "a.obj"], 2, "TARGET"),
        (["match", "a.txt", "b.obj"], 2, "names no file that ends with"),
        (["match", "a.obj", "b.obj", "--points=2"], 2, "not between 3 and 1024"),
        (["match", "a.obj", "b.obj", "--points=many"], 2, "no whole number"),
        (["match", "a.obj", "b.obj", "--linear-weight=nan"], 2, "not between"),
        (["match", "a.obj", "b.obj", "--least-confidence=50"], 2, '"50" is not from 0 to 1; for one half, write 0.5'),
        (["match", "a.obj", "b.obj", "--least-confidence=-1%"], 2, "not from 0 to 1"),
        (["match", "a.obj", "b.obj", "--solver=magic"], 2, "none of hierarchical, flat, gmds"),
        (["match", "a.obj", "b.obj", "--output=a.txt"], 2, "does not end with"),
        (["match", "a.obj", "b.obj", "--map=a.txt"], 2, "does not end with .npz, .json"),
        (["export", "a.obj", "b.obj", "a.txt"], 2, "does not end with .npz, .json"),
        (["match", "a.obj", "b.obj", f"--prefix={40 * 'x'}"], 2, "longer"),
        (["match", "a.obj", "b.obj", "--poi=12"], 2, "unrecognized"),
        (["match", "a.obj", "b.obj"], 1, 'There is no file "a.obj"'),
        (["match", "a.obj", "b.obj", "--prefix="], 1, "Prefix is empty"),
        (["import", "a.obj", "b.obj", "m.npz", "--output=o.blend"], 1, "cannot be read"),
    ],
)
def test_wrong_usage_is_told(arguments, code, said, capsys):
    assert main(arguments) == code
    assert said in capsys.readouterr().err


def test_damaged_files_are_told_and_reported(folder, tmp_path, capsys):
    for suffix in ("blend", "obj", "ply", "stl", "glb", "fbx"):
        path = tmp_path / f"damaged.{suffix}"
        path.write_bytes(b"\x00\x01 nothing that could be read")
        report = tmp_path / f"{suffix}.json"
        assert main(["match", str(path), str(folder / "Target.obj"), f"--report={report}", "--quiet"]) == 1, suffix
        assert f"damaged.{suffix}" in capsys.readouterr().err
        assert report_of(report)["status"] == "failed"
        assert f"damaged.{suffix}" in report_of(report)["error"]
        assert "Traceback" not in report_of(report)["error"]


def test_of_an_operator_that_breaks_down_only_what_happened_last_is_told():
    calls = 'File "/x/io.py", line 109, in load_glb\n    a, b = unpack(content)\n           ^^^^^^\n'
    said = f"Error: Python: Traceback (most recent call last):\n  {calls}struct.error: too short\nLocation: /y/ops.py:1"
    assert said_by(RuntimeError(said)) == "Blender's add-on for such files broke down (struct.error: too short)."
    assert said_by(RuntimeError("Error: No\nspace.\n")) == "No space."


def test_it_is_told_at_once_if_nothing_is_to_be_written(pair, tmp_path, capsys):
    assert main(["match", *pair, *flags(QUICK)]) == 0
    assert "Nothing will be written" in capsys.readouterr().err
    assert main(["match", *pair, *flags(QUICK), f"--report={tmp_path / 'r.json'}"]) == 0
    assert "Nothing will be written" not in capsys.readouterr().err


def test_interruption_is_told(pair, tmp_path, monkeypatch):
    def interrupted(*_):
        raise KeyboardInterrupt

    monkeypatch.setattr(match, "drive", interrupted)
    output, report = tmp_path / "out.blend", tmp_path / "report.json"
    assert main(["match", *pair, f"--output={output}", f"--report={report}"]) == 130
    assert report_of(report)["status"] == "interrupted"
    assert not output.exists()


@pytest.mark.skipif(not hasattr(signal, "SIGHUP"), reason="this system has no terminals that hang up")
@pytest.mark.parametrize("ignored", [False, True])
def test_a_closed_terminal_interrupts_unless_it_is_not_to_matter(ignored, pair, tmp_path, monkeypatch):
    def hang_up(*_):
        os.kill(os.getpid(), signal.SIGHUP)
        raise ObjectError("Nobody was interrupted.")

    monkeypatch.setattr(match, "drive", hang_up)
    before = signal.signal(signal.SIGHUP, signal.SIG_IGN if ignored else signal.SIG_DFL)
    try:
        assert main(["match", *pair, f"--report={tmp_path / 'report.json'}"]) == (1 if ignored else 130)
    finally:
        signal.signal(signal.SIGHUP, before)
    assert report_of(tmp_path / "report.json")["status"] == ("failed" if ignored else "interrupted")


def test_a_bug_is_reported_and_not_swallowed(pair, tmp_path, monkeypatch):
    def broken(*_):
        raise ZeroDivisionError

    monkeypatch.setattr(match, "drive", broken)
    with pytest.raises(ZeroDivisionError):
        main(["match", *pair, f"--report={tmp_path / 'report.json'}"])
    assert "ZeroDivisionError" in report_of(tmp_path / "report.json")["error"]


def test_outputs_that_cannot_be_written_are_told_before_the_work(pair, tmp_path, capsys, monkeypatch):
    (tmp_path / "file").touch()
    (tmp_path / "folder.blend").mkdir()
    monkeypatch.setattr(match, "load_pair", None)
    places = ["file/out.blend", "file/new/out.obj", "folder.blend"]
    wanted = [f"--output={tmp_path / name}" for name in places]
    for written in (*wanted, f"--map={tmp_path / 'file' / 'map.npz'}", f"--report={tmp_path / 'file' / 'report.json'}"):
        assert main(["match", *pair, written, *flags(QUICK)]) == 1
        assert "cannot be written" in capsys.readouterr().err
    theirs = tmp_path / "theirs"
    theirs.mkdir()
    access = os.access
    monkeypatch.setattr(os, "access", lambda at, mode: access(at, mode) and (mode, Path(at)) != (os.W_OK, theirs))
    assert main(["match", *pair, f"--output={theirs / 'new' / 'out.blend'}", f"--report={tmp_path / 'r.json'}"]) == 1
    assert "cannot be written" in capsys.readouterr().err
    assert "cannot be written" in report_of(tmp_path / "r.json")["error"]
    assert not (theirs / "new").exists()


@pytest.mark.parametrize(
    ("arguments", "is_lost"),
    [
        ("Source.obj Target.obj --output=Source.obj", True),
        ("Source.obj Target.obj --output=./Target.obj", False),
        ("Source.obj Target.obj --report=Target.obj", True),
        ("Target.obj Target.obj --output=Target.obj", True),
        ("pair.blend Target.obj --output=pair.blend", False),
        ("pair.blend other.blend --output=other.blend", True),
        ("Source.obj pair.blend --output=pair.blend", False),
        ("pair.blend pair.blend --report=pair.blend", True),
    ],
)
def test_nothing_is_written_over_what_is_read(arguments, is_lost, tmp_path, capsys, monkeypatch):
    def stop(*_arguments):
        raise ObjectError("Far enough.")

    for name in ("Source.obj", "Target.obj", "pair.blend", "other.blend"):
        (tmp_path / name).write_text(name)
    monkeypatch.setattr(match, "load_pair", stop)
    monkeypatch.chdir(tmp_path)
    report = "" if "report" in arguments else " --report=report.json"
    assert main(f"match {arguments}{report}".split()) == 1
    assert not report or report_of("report.json")["status"] == "failed"
    Path("report.json").unlink(missing_ok=True)
    said = capsys.readouterr().err
    assert ("is read as well, and would be lost" in said) == is_lost
    assert ("Far enough" in said) == (not is_lost)
    assert {path.name: path.read_text() for path in tmp_path.iterdir()} == {
        name: name for name in ("Source.obj", "Target.obj", "pair.blend", "other.blend")
    }


@pytest.mark.parametrize(
    "arguments",
    [
        "match Source.obj Target.obj --map=x.json --report=x.json",
        "match Source.obj Target.obj --map=x.json --report=new/../x.json",
        "match Source.obj Target.obj --output=x.obj --output=./x.obj",
        "export Source.obj Target.obj x.json --report=x.json",
        "motion Source.obj Target.obj --write-pairs=x.json --report=x.json",
    ],
)
def test_two_results_do_not_go_into_one_file(arguments, tmp_path, capsys, monkeypatch):
    for name in ("Source.obj", "Target.obj", "x.json"):
        (tmp_path / name).write_text(name)
    monkeypatch.chdir(tmp_path)
    assert main(arguments.split()) == 1
    assert "is to be written twice" in capsys.readouterr().err
    assert {path.name: path.read_text() for path in tmp_path.iterdir()} == {
        name: name for name in ("Source.obj", "Target.obj", "x.json")
    }


def test_a_former_report_does_not_stand_for_two_results_in_one_file(pair, tmp_path, capsys):
    report = tmp_path / "report.json"
    report.write_text('{"status": "done"}')
    assert (
        main(["match", *pair, *(f"--output={tmp_path / name}" for name in ("x.obj", "./x.obj")), f"--report={report}"])
        == 1
    )
    assert "is to be written twice" in capsys.readouterr().err
    assert report_of(report)["status"] == "failed"
    assert "is to be written twice" in report_of(report)["error"]


@pytest.mark.parametrize("name", ["out.blend", "out.obj", "map.npz"])
def test_files_that_are_read_only_are_not_replaced(name, pair, tmp_path, capsys, monkeypatch):
    """As those are that a pipeline has published; who may replace all, as root may, is let be one who may not."""
    path = tmp_path / name
    path.write_text("published")
    path.chmod(0o444)
    access = os.access
    monkeypatch.setattr(os, "access", lambda at, mode: access(at, mode) and (mode, Path(at)) != (os.W_OK, path))
    wanted = f"--map={path}" if name == "map.npz" else f"--output={path}"
    for checked in (reports.check_place, lambda _path: None):
        monkeypatch.setattr(reports, "check_place", checked)
        assert main(["match", *pair, wanted, *flags(QUICK)]) == 1
        assert f'{name}" cannot be written' in capsys.readouterr().err
    assert path.read_text() == "published"


def test_outputs_that_turn_out_not_to_be_written_are_told(pair, tmp_path, capsys, monkeypatch):
    (tmp_path / "file").touch()
    monkeypatch.setattr(reports, "check_place", lambda _path: None)
    for name in ("out.blend", "out.obj"):
        assert main(["match", *pair, f"--output={tmp_path / 'file' / name}", *flags(QUICK)]) == 1
        assert "cannot be written" in capsys.readouterr().err


def test_export_and_import(pair, folder, tmp_path):
    blend, exported, back = (tmp_path / name for name in ("matched.blend", "match.json", "back.blend"))
    assert main(["match", *pair, f"--output={blend}", *flags(DENSE)]) == 0
    assert main(["export", f"{blend}:Source", f"{blend}:Target", str(exported)]) == 0
    objs = [str(folder / "Source.obj"), str(folder / "Target.obj")]
    report = tmp_path / "report.json"
    assert main(["import", *objs, str(exported), f"--output={back}", f"--report={report}"]) == 0
    assert report_of(report)["match"]["points"] == 24
    assert len(report_of(report)["inputs"]) == 3
    bpy.ops.wm.open_mainfile(filepath=str(back))
    assert "HM Map Weights" in bpy.data.objects["Source"].data.attributes


@pytest.mark.slow
def test_retarget_carries_the_rig_into_another_file(tmp_path):
    add_rigged_pair()
    bpy.ops.wm.save_as_mainfile(filepath=str(tmp_path / "rigged.blend"))
    save(tmp_path / "Target.obj", bpy.data.objects["Target"])
    bpy.data.objects.remove(bpy.data.objects["Target"])
    bpy.ops.wm.save_as_mainfile(filepath=str(tmp_path / "source.blend"))
    report = tmp_path / "report.json"
    arguments = [str(tmp_path / "source.blend"), str(tmp_path / "Target.obj")]
    arguments += [f"--output={tmp_path / name}" for name in ("out.fbx", "out.glb", "out.blend")]
    assert (
        main(["retarget", *arguments, "--weight-limit=2", f"--report={report}", *flags(QUICK | {"points": 24})[:-1]])
        == 0
    )
    done = report_of(report)["carried"][0]["done"]
    assert any("vertex groups" in said for said in done)
    assert any("bones" in said for said in done)
    bpy.ops.wm.open_mainfile(filepath=str(tmp_path / "out.blend"))
    target = bpy.data.objects["Target"]
    assert max(len(vertex.groups) for vertex in target.data.vertices) <= 24 + 2  # the match's own groups beside
    for name in ("out.fbx", "out.glb"):
        bpy.ops.wm.read_homefile(use_empty=True)
        (obj,), _ = load_meshes([MeshArgument(tmp_path / name, "Target")])
        assert any(modifier.type == "ARMATURE" for modifier in obj.modifiers)
        assert "upper front.L" in obj.vertex_groups
        assert not [layer for layer in obj.data.color_attributes if layer.name.startswith("HM")]


def test_every_option_of_the_operators_is_there():
    assert set(options.option_names("match")) == set(OPTION_NAMES)
    parser = options.Parser()
    options.add_options(parser, "match")
    parsed = parser.parse_args([])
    assert not options.given_options("match", parsed)
    defaults = options.chosen_options("match", {})
    rna = bpy.ops.hiermatch.match.get_rna_type().properties
    assert all(getattr(defaults, name) == rna[name].default for name in OPTION_NAMES)
    given = options.given_options("match", parser.parse_args(["--solver=GMDS", "--no-dense", "--diffusion-time=0.1"]))
    scene = bpy.context.scene.hiermatch
    scene.diffusion_time = 0.1
    assert given == {"solver": "GMDS", "dense": False, "diffusion_time": scene.diffusion_time}


@pytest.mark.parametrize(
    ("command", "what"),
    [
        ("retarget", "the target with its armature into a"),
        ("symmetry", "the mesh with its armature into a"),
        ("motion", "the target with its armature and new clips into a"),
        ("my-rig", "the target with its armature, and the fitted rig, into a"),
        ("wear", "the target with its armature and outfit into a"),
    ],
)
def test_help_says_what_is_written(command, what, capsys):
    assert main([command, "--help"]) == 0
    assert what in " ".join(capsys.readouterr().out.split())


def test_help_says_what_choices_mean_and_in_what_angles_are(capsys):
    assert main(["motion", "--help"]) == 0
    said = " ".join(capsys.readouterr().out.split())
    assert "At which frames the new action gets keys. auto: At the source's keys if these are few, else" in said
    assert "By how much reduced keys may change a rotation. In radians. (default: 0.0035)" in said


@pytest.mark.parametrize("command", ["match", "retarget", "motion", "my-rig", "wear", "symmetry", "batch"])
def test_lines_of_help_are_not_too_long(command, capsys):
    assert main([command, "--help"]) == 0
    _, *lines = capsys.readouterr().out.splitlines()  # the first says how it is used
    assert max(len(line) for line in lines) <= 120


def test_table_values_become_arguments():
    assert options.to_arguments("match", "points", " 12 ") == ["--points=12"]
    assert options.to_arguments("match", "dense", "No") == ["--no-dense"]
    assert options.to_arguments("match", "dense", "1") == ["--dense"]
    assert options.to_arguments("match", "alternative", "2") == ["--alternative=2"]
    assert options.to_arguments("match", "exclude_source", "-eyes") == ["--exclude-source=-eyes"]
    assert options.to_arguments("match", "points", "") == []


def test_whole_numbers_may_be_written_as_tables_write_them():
    parser = options.Parser()
    options.add_options(parser, "match")
    (points,) = options.to_arguments("match", "points", "64.0")
    assert options.given_options("match", parser.parse_args([points, "--node-limit=16777217"])) == {
        "points": 64,
        "node_limit": 16777217,
    }
    for wrong in ("64.5", "inf", "nan", "many"):
        with pytest.raises(UsageError, match=f'"{wrong}" is no whole number'):
            parser.parse_args([f"--points={wrong}"])


def test_progress_is_plain_where_there_is_no_terminal(capsys):
    shown = console.Console(quiet=False, own_process=False)
    for fraction in (0.0, 0.01, 0.02, 0.5, 0.51):
        shown.progress(fraction, "Doing")
    assert capsys.readouterr().err.splitlines() == ["[  0%] Doing", "[ 50%] Doing"]
    console.Console(quiet=True, own_process=False).progress(0.3, "Doing")
    assert not capsys.readouterr().err


def test_progress_is_one_line_on_a_terminal(capsys, monkeypatch):
    monkeypatch.setattr("os.isatty", lambda _: True)
    shown = console.Console(quiet=False, own_process=False)
    shown.progress(0.1, "Doing")
    shown.progress(0.2, "Doing")
    shown.error("It went wrong.")
    lines = capsys.readouterr().err.split("\r")
    assert [line.strip() for line in lines] == ["", "[ 10%] Doing", "[ 20%] Doing", "", "hiermatch: It went wrong."]


def test_the_command_is_registered_and_runs(monkeypatch):
    assert command_line.COMMAND == "hiermatch"
    monkeypatch.setattr(
        "hiermatch.hiermatch_addon.command_line.program.main",
        lambda arguments, *, own_process: (list(arguments), own_process),
    )
    assert command_line.run_command(["match"]) == (["match"], True)


def test_argument_errors_are_argparse_s():
    with pytest.raises(argparse.ArgumentTypeError):
        mesh_argument("body")
