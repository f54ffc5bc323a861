# SPDX-License-Identifier: GPL-3.0-or-later
"""The subcommand `motion`."""

from __future__ import annotations

import json

import bpy
import numpy as np
import pytest
from hiermatch.hiermatch_addon.command_line.program import main
from hiermatch.hiermatch_addon.scene.motion.action_curves import every_curve

from tests.addon.characters import add_action, add_person, match_at_once


@pytest.fixture
def folder(monkeypatch, tmp_path):
    """A folder with a file of two persons, and one for each of them; bodies are matched without work."""
    match_at_once(monkeypatch)
    for name, rig in (("A", "plain"), ("B", "renamed")):
        bpy.ops.wm.read_homefile(use_empty=True)
        armature, _ = add_person(name, rig)
        if name == "A":
            for action in ("Walk", "Walk Fast", "Nod"):
                add_action(armature, action).use_fake_user = True
        bpy.ops.wm.save_as_mainfile(filepath=str(tmp_path / f"{name}.blend"))
    bpy.ops.wm.open_mainfile(filepath=str(tmp_path / "A.blend"))
    add_person("B", "renamed")
    bpy.ops.wm.save_as_mainfile(filepath=str(tmp_path / "both.blend"))
    return tmp_path


def clips_of(path):
    """Names of the animations in a .glb, and the armatures."""
    bpy.ops.wm.read_homefile(use_empty=True)
    bpy.ops.import_scene.gltf(filepath=str(path))
    return {action.name for action in bpy.data.actions}, [
        obj.name for obj in bpy.data.objects if obj.type == "ARMATURE"
    ]


def test_actions_by_a_pattern_go_to_another_rig_of_the_same_file(folder):
    both = str(folder / "both.blend")
    outputs = [f"--output={folder / name}" for name in ("out.glb", "out.blend")]
    code = main(["motion", f"{both}:A", f"{both}:B", "--action=Walk*", *outputs, f"--report={folder / 'report.json'}"])
    assert code == 0
    report = json.loads((folder / "report.json").read_text())
    assert (report["command"], report["status"]) == ("motion", "done")
    assert report["carried"][0]["done"][-1] == "2 actions"
    assert report["match"]["quality"]["confidence"] == 0.9
    clips, rigs = clips_of(folder / "out.glb")
    assert clips == {"Walk B", "Walk Fast B"}
    assert rigs == ["B"]
    bpy.ops.wm.open_mainfile(filepath=str(folder / "out.blend"))
    assert {"Walk", "Nod", "Walk B", "Walk Fast B"} <= set(bpy.data.actions.keys())
    assert bpy.data.objects["B"].animation_data is None  # the tracks are for the other file only


@pytest.mark.parametrize("plays", [True, False])
@pytest.mark.parametrize("named", ["Walk", "Nod; Walk"])
def test_an_action_is_the_one_of_the_source_s_file_if_the_target_s_has_one_of_that_name(named, plays, folder):
    bpy.ops.wm.open_mainfile(filepath=str(folder / "A.blend"))
    bpy.ops.export_scene.gltf(filepath=str(folder / "A.glb"), export_animation_mode="ACTIONS")
    bpy.ops.wm.read_homefile(use_empty=True)
    bpy.ops.import_scene.gltf(filepath=str(folder / "A.glb"))
    bpy.data.batch_remove(bpy.data.actions[:])
    bpy.data.objects["A"].name = "B"  # whose bones have the same names
    add_action(bpy.data.objects["B"], "Walk", frames=(1, 31, 61)).use_fake_user = True
    if not plays:
        bpy.data.objects["B"].animation_data_clear()
    bpy.ops.wm.save_as_mainfile(filepath=str(folder / "moving.blend"))
    arguments = [str(folder / "A.glb"), str(folder / "moving.blend"), f"--action={named}"]
    assert main(["motion", *arguments, f"--output={folder / 'out.blend'}"]) == 0
    bpy.ops.wm.open_mainfile(filepath=str(folder / "out.blend"))
    made = [action for action in bpy.data.actions if action.name.startswith("Walk") and action.name.endswith(" B")]
    assert [round(action.frame_range[1]) for action in made] == [21]


def test_what_is_carried_again_in_its_place_is_a_clip_again(folder):
    arguments = ["motion", *(f"{folder / 'both.blend'}:{name}" for name in "AB"), "--action=Walk*"]
    assert main([*arguments, f"--output={folder / 'both.blend'}"]) == 0
    assert main([*arguments, f"--output={folder / 'out.glb'}"]) == 0
    assert clips_of(folder / "out.glb")[0] == {"Walk B", "Walk Fast B"}


def moving_clips(path):
    """Names of the clips in an .fbx whose bones move."""
    bpy.ops.wm.read_homefile(use_empty=True)
    bpy.ops.import_scene.fbx(filepath=str(path))
    moving = (
        action.name
        for action in bpy.data.actions
        if any(np.ptp([key.co[1] for key in curve.keyframe_points]) > 0.01 for curve in every_curve(action))
    )
    return {name.rpartition("|")[2] for name in moving}


@pytest.mark.parametrize("how", ["solo", "off"])
def test_clips_move_whatever_the_nla_editor_of_the_target_silences(folder, how):
    both = folder / "both.blend"
    bpy.ops.wm.open_mainfile(filepath=str(both))
    rig = bpy.data.objects["B"]
    rig.pose.bones[-1].keyframe_insert("location", frame=1)
    idle, rig.animation_data.action = rig.animation_data.action, None
    track = rig.animation_data.nla_tracks.new()
    track.strips.new("Idle", 1, idle)
    track.is_solo, rig.animation_data.use_nla = how == "solo", how != "off"
    bpy.ops.wm.save_as_mainfile(filepath=str(both))
    arguments = ["motion", f"{both}:A", f"{both}:B", "--action=Walk*"]
    assert main([*arguments, f"--output={folder / 'out.fbx'}", f"--output={folder / 'out.blend'}"]) == 0
    assert {"Walk B", "Walk Fast B"} <= moving_clips(folder / "out.fbx")
    bpy.ops.wm.open_mainfile(filepath=str(folder / "out.blend"))
    animation = bpy.data.objects["B"].animation_data
    assert [(track.is_solo, track.name) for track in animation.nla_tracks] == [(how == "solo", "NlaTrack")]
    assert animation.use_nla == (how != "off")


@pytest.mark.parametrize("strip", [False, True])
def test_clips_in_an_fbx_leave_the_object_as_large_as_it_is(strip, folder):
    """Actions that came from an FBX have keys of the object, too, which the carried ones have not."""
    both = folder / "both.blend"
    bpy.ops.wm.open_mainfile(filepath=str(both))
    rig = bpy.data.objects["B"]
    rig.scale = (2, 2, 2)
    rig.keyframe_insert("scale", frame=1)
    rig.pose.bones[-1].keyframe_insert("location", frame=1)
    if strip:
        idle, rig.animation_data.action = rig.animation_data.action, None
        rig.animation_data.nla_tracks.new().strips.new("Idle", 1, idle)
    bpy.ops.wm.save_as_mainfile(filepath=str(both))
    assert main(["motion", f"{both}:A", f"{both}:B", "--action=Walk*", f"--output={folder / 'out.fbx'}"]) == 0
    assert {"Walk B", "Walk Fast B"} <= moving_clips(folder / "out.fbx")
    sizes = [
        curve.evaluate(5) for action in bpy.data.actions for curve in every_curve(action) if curve.data_path == "scale"
    ]
    assert len(sizes) == 9
    assert np.allclose(sizes, 2)


def test_files_of_one_character_each_need_no_names_and_the_action_is_played(folder):
    arguments = [str(folder / f"{name}.blend") for name in "AB"]
    options = ["--in-place", "--keying=all", f"--output={folder / 'out.blend'}"]
    assert main(["motion", *arguments, "--action=Nod", *options]) == 0
    bpy.ops.wm.open_mainfile(filepath=str(folder / "out.blend"))
    action = bpy.data.objects["B"].animation_data.action
    assert action.name == "Nod B"
    assert len({obj.name for obj in bpy.data.objects if obj.type == "MESH"}) == 4


def test_pairs_in_a_file_are_enough_for_an_armature_without_a_mesh(folder, capsys):
    both, pairs = str(folder / "both.blend"), folder / "pairs.json"
    assert main(["motion", f"{both}:A", f"{both}:B", "--action=Nod", f"--write-pairs={pairs}", "--quiet"]) == 0
    assert len(json.loads(pairs.read_text())["pairs"]) == 22
    bpy.ops.wm.open_mainfile(filepath=str(folder / "A.blend"))
    for part in list(bpy.data.objects["A"].children):
        bpy.data.objects.remove(part)
    bpy.ops.wm.save_as_mainfile(filepath=str(folder / "bare.blend"))
    arguments = [str(folder / "bare.blend"), str(folder / "B.blend"), "--action=Nod", f"--output={folder / 'out.glb'}"]
    assert main(["motion", *arguments]) == 1
    assert 'The armature "A" moves no mesh' in capsys.readouterr().err
    assert main(["motion", *arguments, f"--pairs={pairs}"]) == 0
    assert clips_of(folder / "out.glb") == ({"Nod B"}, ["B"])
    before, report = pairs.read_text(), folder / "report.json"
    for other in (f"--report={pairs}", f"--write-pairs={pairs}"):
        assert main(["motion", *arguments, f"--pairs={pairs}", other]) == 1
        assert "is read as well, and would be lost" in capsys.readouterr().err
        assert pairs.read_text() == before
    onto = [*arguments[:3], f"--output={folder / 'B.blend'}", f"--pairs={pairs}", f"--report={report}"]
    assert main(["motion", *onto]) == 1  # the file that is opened is another one
    arguments[1] = str(folder / "out.glb")
    assert main(["motion", *arguments, f"--pairs={pairs}", f"--report={report}"]) == 0
    assert str(pairs) in [one["path"] for one in json.loads(report.read_text())["inputs"]]


def test_a_stored_match_may_be_doubtful_as_well(folder, monkeypatch):
    match_at_once(monkeypatch, confidence=0.4)
    arguments = [f"{folder / 'both.blend'}:{name}" for name in "AB"]
    assert main(["match", *arguments, f"--output={folder / 'both.blend'}"]) == 0
    report = folder / "report.json"
    wanted = [f"--output={folder / 'out.glb'}", "--strict", f"--report={report}"]
    assert main(["motion", *arguments, "--action=Nod", *wanted]) == 3
    assert json.loads(report.read_text())["carried"][0]["confidence"] == 0.4


def test_what_cannot_be_done_is_told(folder, capsys, monkeypatch):
    both = str(folder / "both.blend")
    output = f"--output={folder / 'out.glb'}"
    for names, options, code, said in (
        ("AB", ["--action=Jump"], 1, 'There is no action called "Jump"'),
        ("AB", ["--action=Jump*"], 1, 'fits the pattern "Jump*"'),
        ("BA", [], 1, '"B" has no action that moves its bones'),
        ("AA", [], 1, 'Source and Target are both "A"'),
        ("AB", [f"--pairs={folder / 'none.json'}"], 1, "cannot be read"),
        ("AB", [f"--output={folder / 'out.obj'}"], 2, "does not end with .blend, .fbx, .glb, .gltf"),
    ):
        assert main(["motion", *(f"{both}:{name}" for name in names), output, *options]) == code
        assert said in capsys.readouterr().err
    match_at_once(monkeypatch, confidence=0.1)
    arguments = ["motion", f"{both}:A", f"{both}:B", "--action=Nod", output]
    assert main(arguments) == 1
    assert "is doubtful, and nothing was written" in capsys.readouterr().err
    assert not (folder / "out.glb").exists()
    assert main([*arguments, "--accept-doubtful", "--strict"]) == 3
    assert (folder / "out.glb").exists()
