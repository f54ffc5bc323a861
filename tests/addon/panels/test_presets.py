# SPDX-License-Identifier: GPL-3.0-or-later
"""Presets: those that come with the extension, and those that are saved."""

from __future__ import annotations

from pathlib import Path
from types import SimpleNamespace

import bpy
import pytest
from hiermatch.engine import MatchSettings
from hiermatch.engine.hierarchical.settings import SETUPS
from hiermatch.hiermatch_addon.panels.match_panels import HIERMATCH_PT_match
from hiermatch.hiermatch_addon.panels.preset_menu import (
    MATCH_NAMES,
    RETARGET_NAMES,
    HIERMATCH_OT_add_preset,
    HIERMATCH_PT_presets,
)
from hiermatch.hiermatch_addon.properties.properties import OPTION_NAMES, match_settings
from hiermatch.hiermatch_addon.properties.setups import current_setup

from tests.addon.scenes import QUICK, add_pair
from tools.source_extension import ROOT

BUILT_IN = sorted((ROOT / "hiermatch_addon" / "presets" / "hiermatch").glob("*.py"))
OF_USES = {"_Default", "Fast_Preview", "Two-Legged_Characters", "Creatures", "Scans"}


def name(path):
    return path.stem


def options():
    scene = bpy.context.scene
    groups = ((scene.hiermatch, MATCH_NAMES), (scene.hiermatch_retarget, RETARGET_NAMES))
    return {(group.bl_rna.identifier, name): getattr(group, name) for group, names in groups for name in names}


def use(path):
    assert bpy.ops.script.execute_preset(filepath=str(path), menu_idname="HIERMATCH_PT_presets") == {"FINISHED"}


@pytest.fixture
def folder(tmp_path, monkeypatch):
    """Where presets are saved, instead of the user's own folder."""
    monkeypatch.setenv("BLENDER_USER_SCRIPTS", str(tmp_path))
    wanted = tmp_path / "presets" / "hiermatch"
    wanted.mkdir(parents=True)
    found = bpy.utils.user_resource("SCRIPTS", path="presets/hiermatch")
    assert Path(found) == wanted
    return wanted


def test_blender_finds_them():
    assert {name(path) for path in BUILT_IN} == OF_USES | {title.replace(" ", "_") for title, _ in SETUPS.values()}
    for path in BUILT_IN:
        assert bpy.utils.preset_find(path.stem, HIERMATCH_PT_presets.preset_subdir) == str(path)


def test_they_go_with_the_extension(extension):
    extension.unregister()
    try:
        assert bpy.utils.preset_find("Scans", "hiermatch") is None
    finally:
        extension.register()
    assert bpy.utils.preset_find("Scans", "hiermatch")


@pytest.mark.parametrize("path", BUILT_IN, ids=name)
def test_each_makes_valid_settings_of_its_own(path):
    scene = bpy.context.scene
    untouched = options()
    use(path)
    assert isinstance(match_settings(scene.hiermatch), MatchSettings)
    assert (options() == untouched) == (path.stem in ("_Default", "Geodesic_Histograms"))


@pytest.mark.parametrize("path", BUILT_IN, ids=name)
def test_what_was_set_before_makes_no_difference(path):
    scene = bpy.context.scene
    use(path)
    fresh = options()
    scene.hiermatch.samples, scene.hiermatch.solver, scene.hiermatch_retarget.weight_limit = 777, "FLAT", 3
    use(path)
    assert options() == fresh


@pytest.mark.parametrize("title", [title for title, _ in SETUPS.values()])
def test_those_of_the_paper_are_its_setups(title):
    use(next(path for path in BUILT_IN if path.stem == title.replace(" ", "_")))
    assert current_setup(bpy.context.scene.hiermatch) == title


@pytest.mark.parametrize("path", BUILT_IN, ids=name)
def test_they_hold_options_and_nothing_else(path):
    assigned = [
        line.split(" = ")[0] for line in path.read_text("utf8").splitlines() if line.startswith(("match.", "r"))
    ]
    for owner, _, option in (line.partition(".") for line in assigned if "." in line):
        assert option in {"match": MATCH_NAMES, "retarget": RETARGET_NAMES}[owner]


def test_what_belongs_to_a_pair_stays():
    add_pair()
    state = bpy.context.scene.hiermatch
    state.prefix, state.exclude_source, state.source = "Mine", "Hat", bpy.data.objects["Source"]
    use(BUILT_IN[0])
    assert (state.prefix, state.exclude_source, state.source.name) == ("Mine", "Hat", "Source")
    assert set(OPTION_NAMES) - set(MATCH_NAMES) == {"prefix", "exclude_source", "exclude_target"}


def test_nothing_that_can_be_set_is_forgotten():
    rna = bpy.context.scene.hiermatch_retarget.bl_rna.properties
    own = (prop for prop in rna if prop.identifier not in ("rna_type", "name"))
    shown = {prop.identifier for prop in own if prop.type not in ("POINTER", "COLLECTION")}
    assert shown - {"action", "bone_pair", "rig"} == set(RETARGET_NAMES)  # these are of a scene


def test_a_saved_one_comes_back(folder):
    scene = bpy.context.scene
    untouched = options()
    scene.hiermatch.points, scene.hiermatch.metric, scene.hiermatch.diffusion_time = 33, "DIFFUSION", 0.25
    scene.hiermatch_retarget.key_names, scene.hiermatch_retarget.use_uvs = 'Smile, "Wide"', False
    changed = options()
    assert bpy.ops.hiermatch.add_preset(name="My Cats") == {"FINISHED"}
    assert [path.name for path in folder.iterdir()] == ["My_Cats.py"]
    use(next(path for path in BUILT_IN if path.stem == "Geodesic_Histograms"))
    assert options() == untouched
    use(folder / "My_Cats.py")
    assert options() == changed


def test_one_of_an_older_version_leaves_new_options_at_their_defaults(folder):
    untouched = options()
    old = folder / "Old.py"
    old.write_text("import bpy\nbpy.context.scene.hiermatch.points = 64\n", "utf8")
    bpy.context.scene.hiermatch.samples = 99
    use(old)
    assert options() == untouched


def test_saved_ones_can_be_removed_and_built_in_ones_not_overwritten(folder):
    bpy.ops.hiermatch.add_preset(name="Mine")
    assert bpy.ops.hiermatch.add_preset(name="Mine", remove_name=True) == {"FINISHED"}
    assert not list(folder.iterdir())
    assert bpy.ops.hiermatch.add_preset(name="Scans") == {"CANCELLED"}
    assert not list(folder.iterdir())


def test_the_operator_writes_all_options():
    scene = "bpy.context.scene"
    owners = {f"{scene}.hiermatch": MATCH_NAMES, f"{scene}.hiermatch_retarget": RETARGET_NAMES}
    expected = [f"{owner}.{option}" for owner, names in owners.items() for option in names]
    assert list(HIERMATCH_OT_add_preset.preset_values) == expected


def test_the_way_back_comes_first():
    """As Blender sorts them and writes their names."""
    names = [
        bpy.path.display_name(path.name, title_case=False)
        for path in sorted(BUILT_IN, key=lambda one: one.stem.lower())
    ]
    assert names[0] == "Default"


def test_the_menu_is_in_the_header():
    drawn = []
    layout = SimpleNamespace(popover=lambda **names: drawn.append(names["panel"]))
    HIERMATCH_PT_match.draw_header_preset(SimpleNamespace(layout=layout), bpy.context)
    assert drawn == ["HIERMATCH_PT_presets"]


def test_the_fast_one_matches():
    add_pair()
    use(next(path for path in BUILT_IN if path.stem == "Fast_Preview"))
    state = bpy.context.scene.hiermatch
    carried = {option: getattr(state, option) for option in OPTION_NAMES} | {"points": QUICK["points"]}
    assert bpy.ops.hiermatch.match(source="Source", target="Target", **carried) == {"FINISHED"}
    assert state.summary.points == QUICK["points"]
