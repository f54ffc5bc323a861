# SPDX-License-Identifier: GPL-3.0-or-later
"""The paper's setups as presets."""

from __future__ import annotations

import bpy
import pytest
from hiermatch.engine.hierarchical.settings import SETUPS
from hiermatch.hiermatch_addon.properties.properties import OPTION_NAMES, setting_of
from hiermatch.hiermatch_addon.properties.setups import current_setup

from tests.addon.scenes import QUICK, add_symmetric_pair


def options():
    return {name: getattr(bpy.context.scene.hiermatch, name) for name in OPTION_NAMES}


@pytest.mark.parametrize("setup", SETUPS)
def test_sets_what_makes_it_and_nothing_else(setup):
    state = bpy.context.scene.hiermatch
    state.points, state.comparison, state.prefix = 33, "BIN_TO_BIN", "Mine"
    before = options()
    assert bpy.ops.hiermatch.use_setup(setup=setup.upper()) == {"FINISHED"}
    name, values = SETUPS[setup]
    assert {setting: setting_of(state, setting) for setting in values} == values
    assert current_setup(state) == name
    after = options()
    assert {option for option in after if after[option] != before[option]} <= set(values)


@pytest.mark.parametrize("setup", SETUPS)
def test_the_panels_button_matches_with_it(setup):
    add_symmetric_pair()
    bpy.ops.hiermatch.use_setup(setup=setup.upper())
    carried = options() | QUICK | {"source": "Source", "target": "Target"}
    assert bpy.ops.hiermatch.match(**carried) == {"FINISHED"}
    summary = bpy.context.scene.hiermatch.summary
    assert summary.points == QUICK["points"]
    assert summary.distortion > 0


def test_the_default_is_the_first():
    assert current_setup(bpy.context.scene.hiermatch) == SETUPS["a"][0]
    assert bpy.ops.hiermatch.use_setup.get_rna_type().properties["setup"].default == "A"


def test_other_settings_are_none_of_them():
    bpy.context.scene.hiermatch.descriptor = "WAVE_KERNEL"
    assert current_setup(bpy.context.scene.hiermatch) is None


def test_each_is_named_and_told_apart():
    items = bpy.ops.hiermatch.use_setup.get_rna_type().properties["setup"].enum_items
    assert [(item.identifier.lower(), item.name) for item in items] == [
        (key, name) for key, (name, _) in SETUPS.items()
    ]
    assert "Metric to Diffusion, Descriptor to Distance Histograms" in items["B"].description
    assert len({item.description for item in items}) == len(SETUPS)


def test_unknown_setups_are_refused():
    with pytest.raises(TypeError, match="not found in"):
        bpy.ops.hiermatch.use_setup(setup="E")


def test_one_undo_takes_it_back():
    bpy.context.scene.hiermatch.metric = "DIFFUSION"
    before = options()
    bpy.ops.ed.undo_push(message="Before")
    bpy.ops.hiermatch.use_setup("EXEC_DEFAULT", True, setup="D")  # noqa: FBT003
    assert options() != before
    bpy.ops.ed.undo()
    assert options() == before
