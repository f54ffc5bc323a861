# SPDX-License-Identifier: GPL-3.0-or-later
"""Manifests: lists of pairs as tables and as JSON."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from hiermatch.hiermatch_addon.command_line.batches.manifest import read_manifest
from hiermatch.hiermatch_addon.command_line.program import make_parser
from hiermatch.hiermatch_addon.common.errors import ObjectError


@pytest.mark.parametrize("delimiter", [",", ";", "\t"])
def test_tables_are_read_as_programs_write_them(tmp_path, delimiter):
    path = tmp_path / "pairs.csv"
    name = "First" if delimiter == "," else "First, of all"
    rows = [["name", "source", "target", "output", "weight-limit", "points"]]
    rows += [[name, "a.blend:Body", "/b/b.fbx", "o/x.fbx|o/x.blend", "4", ""]]
    path.write_text("\ufeff" + "\r\n".join(delimiter.join(row) for row in rows) + "\r\n\r\n", encoding="utf-8")
    (pair,) = read_manifest(path, {"points": "99", "weight_mix": "0.5", "use_modifiers": "True"}, "retarget")
    assert pair.name == name
    assert (pair.source, pair.target) == (str(tmp_path / "a.blend:Body"), "/b/b.fbx")
    assert pair.outputs == (str(tmp_path / "o" / "x.fbx"), str(tmp_path / "o" / "x.blend"))
    assert pair.options == (("points", "99"), ("weight_limit", "4"), ("weight_mix", "0.5"))
    assert pair.arguments()[-3:] == ["--points=99", "--weight-limit=4", "--weight-mix=0.5"]


@pytest.mark.parametrize(
    ("command", "options", "values", "wanted"),
    [
        ("motion", "action,keep_feet", "Walk*,true", {"action": "Walk*", "keep_feet": True}),
        ("my-rig", "rig,my_rig_bind", "metarig,yes", {"rig": "metarig", "my_rig_bind": True}),
    ],
)
def test_other_commands_have_rows_of_their_own(tmp_path, command, options, values, wanted):
    path = tmp_path / "pairs.csv"
    path.write_text(f"source,target,output,command,{options}\na.blend:Body,b.glb,out.glb,{command},{values}\n")
    (pair,) = read_manifest(path, {"points": "32", "weight_limit": "4"}, "match")
    arguments = pair.arguments()
    assert arguments[0] == command
    written = {f"--{name.replace('_', '-')}" + ("" if value is True else f"={value}") for name, value in wanted.items()}
    assert set(arguments[4:]) == {*written, "--points=32"}
    parsed = make_parser().parse_args(arguments)
    assert {name: getattr(parsed, name) for name in wanted} == wanted
    assert parsed.points == 32


def test_json_has_options_for_all(tmp_path):
    path = tmp_path / "pairs.json"
    pairs = [{"source": "a.obj", "target": "b.obj", "map": "m.npz"}]
    pairs += [{"source": "a.obj", "target": "c.obj", "dense": True}]
    path.write_text(json.dumps({"options": {"points": 32, "dense": False}, "pairs": pairs}))
    first, second = read_manifest(path, {}, "match")
    assert first.options == (("dense", "False"), ("points", "32"))
    assert (first.name, first.map) == ("m", str(tmp_path / "m.npz"))
    assert "--no-dense" in first.arguments()
    assert "--dense" in second.arguments()
    path.write_text(json.dumps({"options": {"points": 32, "weight_limit": 3}, "pairs": pairs}))
    assert read_manifest(path, {"points": "16"}, "match")[0].options == (("points", "16"),)
    path.write_text(json.dumps({"options": {"pionts": 32}, "pairs": pairs}))
    with pytest.raises(ObjectError, match="pionts"):
        read_manifest(path, {}, "match")
    path.write_text(json.dumps({"option": {"points": 32}, "pairs": pairs}))
    with pytest.raises(ObjectError, match='it has option beside "options" and "pairs"'):
        read_manifest(path, {}, "match")
    path.write_text(json.dumps({"options": {"command": "wear"}, "pairs": pairs}))
    with pytest.raises(ObjectError, match="has command among the options for all pairs"):
        read_manifest(path, {}, "match")
    path.write_text(json.dumps(pairs[:1]))
    assert len(read_manifest(path, {}, "match")) == 1


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("source,target,pionts\na.obj,b.obj,3\n", "no options: pionts"),
        ("source,target,pairs\na.obj,b.obj,p.json\n", "pairs the bones of each row by itself: remove the column pairs"),
        ("source,output\na.obj,b.obj\n", 'no column "target"'),
        ("a.obj,b.obj,c.blend\n", 'no column "source". Its first line has to name them'),
        ("source,target\na.obj,b.obj,c.obj\n", "another number of columns"),
        ("source,target\na.obj\n", "another number of columns"),
        ("source,target\n", "lists no pairs"),
        ("", "lists no pairs"),
        ("source,target,output\na.obj,b.obj,o.blend\na.obj,c.obj,o.blend\n", "Rows 1 and 2"),
        (
            "source,target,points\na.obj,b.obj,32\na.obj,b.obj,64\n",
            'Rows 1 and 2 .* write the same, "a-b".* or a name if it has none',
        ),
        ("source,target,output\na.obj,b.obj,o.blend\na.obj,c.obj,./new/../o.blend\n", "Rows 1 and 2"),
        (
            "source,target,output\na.obj:A,b.obj,o.blend\nc.obj,b.obj,./a.obj\n",
            'Row 2 .* "[^"]*a.obj", which row 1 reads',
        ),
        ("source,target,output,output\na.obj,b.obj,c.blend,d.blend\n", 'several columns "output"'),
        ("source,target,\na.obj,b.obj,c.blend\n", "line 2 has something in a column that has no name"),
    ],
)
def test_manifests_that_are_none_are_told(tmp_path, text, said):
    path = tmp_path / "pairs.csv"
    path.write_text(text)
    with pytest.raises(ObjectError, match=said):
        read_manifest(path, {}, "match")


@pytest.mark.parametrize("encoding", ["utf-8", "utf-8-sig", "utf-16"])
@pytest.mark.parametrize("end", ["\n", "\r\n", "\r"])
def test_tables_may_be_in_several_encodings_and_have_empty_lines_and_columns(tmp_path, encoding, end):
    path = tmp_path / "pairs.csv"
    lines = ["", "source,target,output,,", "\u5973 1.obj,b.obj,o.blend,,", "  ", ",,,,", "c.obj,b.obj,p.blend,,", ""]
    path.write_bytes(end.join(lines).encode(encoding))
    pairs = read_manifest(path, {}, "match")
    assert [Path(pair.source).name for pair in pairs] == ["\u5973 1.obj", "c.obj"]
    assert all(pair.options == () for pair in pairs)


def test_another_encoding_is_told(tmp_path):
    path = tmp_path / "pairs.csv"
    path.write_bytes("source,target\nh\u00e9ros.obj,b.obj\n".encode("latin-1"))
    with pytest.raises(ObjectError, match='is not in UTF-8; save it again, in a spreadsheet as "CSV UTF-8"'):
        read_manifest(path, {}, "match")


def test_files_about_a_pair_are_called_after_it_and_no_two_alike(tmp_path):
    path = tmp_path / "pairs.json"
    names = ["\u00c4rm 1/2: left-b_c", "\u00c4rm 1/2? left-b_c", 200 * "x"]
    rows = [{"name": name, "source": "a.obj", "target": "b.obj", "output": f"{n}.obj"} for n, name in enumerate(names)]
    path.write_text(json.dumps(rows))
    stems = [pair.stem for pair in read_manifest(path, {}, "match")]
    readable = [stem.rpartition("-")[0] for stem in stems]
    assert readable == ["\u00c4rm_1_2__left-b_c"] * 2 + [60 * "x"]
    assert len(set(stems)) == 3


def test_a_pair_may_read_what_one_before_it_writes(tmp_path):
    path = tmp_path / "pairs.csv"
    path.write_text("source,target,output\na.obj,b.obj,o.blend\no.blend:b,c.obj,p.blend\n")
    assert len(read_manifest(path, {}, "match")) == 2


def test_links_lead_to_the_same_file(tmp_path):
    (tmp_path / "real").mkdir()
    (tmp_path / "link").symlink_to("real", target_is_directory=True)
    path = tmp_path / "pairs.csv"
    path.write_text("source,target,output\na.obj,b.obj,real/o.blend\na.obj,c.obj,link/o.blend\n")
    with pytest.raises(ObjectError, match="Rows 1 and 2 of the manifest write the same"):
        read_manifest(path, {}, "match")


@pytest.mark.parametrize("text", ["{", "3", '{"pairs": 3}', '["a"]', '[{"source": ["a"]}]'])
def test_json_that_is_no_manifest_is_told(tmp_path, text):
    path = tmp_path / "pairs.json"
    path.write_text(text)
    with pytest.raises(ObjectError, match="is no manifest"):
        read_manifest(path, {}, "match")


def test_names_with_commas(tmp_path):
    wanted = ["Shirt, red", "Hat", 'Two "Shoes"']
    path = tmp_path / "pairs.json"
    pair = {"source": "a.blend:A", "target": "b.blend:B", "output": ["o.blend", "o.glb"], "command": "wear"}
    path.write_text(json.dumps([pair | {"items": wanted}]))
    (read,) = read_manifest(path, {}, "match")
    assert [Path(output).name for output in read.outputs] == ["o.blend", "o.glb"]
    assert make_parser().parse_args(read.arguments()).items == wanted
    pair["weight_mix"] = [1]
    path.write_text(json.dumps([pair]))
    with pytest.raises(ObjectError, match="is neither a text nor a number"):
        read_manifest(path, {}, "match")
