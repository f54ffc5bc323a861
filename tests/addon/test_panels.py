# SPDX-License-Identifier: GPL-3.0-or-later
"""What the sidebar shows."""

from __future__ import annotations

from types import SimpleNamespace

import bpy
import pytest
from hiermatch.hiermatch_addon import panels
from hiermatch.hiermatch_addon.properties import OPTION_NAMES, SETTING_NAMES

from tests.addon.scenes import QUICK, add_pair, snapshot


class Layout:
    """A layout that notes what is drawn into it."""

    def __init__(self, drawn):
        self.__dict__.update(drawn=drawn)

    def _part(self, *_arguments, **_names):
        return Layout(self.drawn)

    row = column = split = box = _part

    def panel(self, name, *, default_closed):
        self.drawn.append(("panel", name, default_closed))
        return self._part(), self._part()

    def label(self, *, text, **_names):
        self.drawn.append(("label", text))

    def prop(self, owner, name, **_names):
        assert name in owner.bl_rna.properties, name
        self.drawn.append(("prop", name))

    def progress(self, *, text, factor):
        self.drawn.append(("progress", text, factor))

    def operator(self, name, **_names):
        group, operator = name.split(".")
        assert operator in dir(getattr(bpy.ops, group)), name
        self.drawn.append(("operator", name))
        return self.__dict__.setdefault("properties", SimpleNamespace())


@pytest.fixture
def context():
    shading = SimpleNamespace(type="SOLID", color_type="MATERIAL", bl_rna=bpy.types.View3DShading.bl_rna)
    return SimpleNamespace(
        scene=bpy.context.scene,
        view_layer=bpy.context.view_layer,
        window_manager=bpy.context.window_manager,
        region=SimpleNamespace(width=280),
        preferences=SimpleNamespace(system=SimpleNamespace(ui_scale=1.0)),
        space_data=SimpleNamespace(shading=shading),
    )


def draw(context):
    drawn = []
    panel = SimpleNamespace(layout=Layout(drawn))
    panels.HIERMATCH_PT_match.draw(panel, context)
    return drawn


def texts(drawn):
    return " ".join(entry[1] for entry in drawn if entry[0] == "label")


def test_everything_that_can_be_set_is_there(context):
    props = [entry[1] for entry in draw(context) if entry[0] == "prop"]
    assert set(props) >= {"source", "target", *OPTION_NAMES}
    assert len(props) == len(set(props))


def test_all_settings_but_the_points_are_tucked_away(context):
    drawn = draw(context)
    advanced = drawn.index(("panel", "hiermatch_advanced", True))
    for name in SETTING_NAMES:
        assert (drawn.index(("prop", name)) > advanced) == (name != "points")


def test_all_buttons_are_there(context):
    operators = [entry[1] for entry in draw(context) if entry[0] == "operator"]
    assert operators == ["hiermatch.swap", "hiermatch.match", "hiermatch.clear", "hiermatch.add_demo_pair"]


def test_the_button_carries_the_options_of_the_scene(context, monkeypatch):
    carried = SimpleNamespace()
    monkeypatch.setattr(Layout, "operator", lambda *_arguments, **_names: carried)
    context.scene.hiermatch.points = 33
    context.scene.hiermatch.prefix = "Mine"
    draw(context)
    assert {name: getattr(carried, name) for name in OPTION_NAMES} == {
        name: getattr(context.scene.hiermatch, name) for name in OPTION_NAMES
    }
    assert (carried.points, carried.prefix) == (33, "Mine")


def test_it_says_what_to_do_until_there_are_two_meshes(context):
    assert "Pick two meshes" in texts(draw(context))
    pair = add_pair()
    assert "Pick two meshes" in texts(draw(context))
    for obj in pair:
        obj.select_set(state=True)
    assert "Pick two meshes" not in texts(draw(context))
    bpy.ops.object.select_all(action="DESELECT")
    context.scene.hiermatch.source, context.scene.hiermatch.target = pair
    assert "Pick two meshes" not in texts(draw(context))


def test_while_a_match_runs_there_are_a_bar_and_a_way_out(context):
    running = SimpleNamespace(bl_idname="HIERMATCH_OT_match")
    progress = SimpleNamespace(fraction=0.4, label="Measuring")
    context.window_manager = SimpleNamespace(windows=[SimpleNamespace(modal_operators=[running])], hiermatch=progress)
    drawn = draw(context)
    assert ("progress", "Measuring", 0.4) in drawn
    assert ("operator", "hiermatch.cancel") in drawn
    assert ("operator", "hiermatch.match") not in drawn


def test_the_last_result(context):
    add_pair()
    assert "matched" not in texts(draw(context))
    bpy.ops.hiermatch.match(source="Source", target="Target", **QUICK)
    shown = texts(draw(context))
    assert "12 points matched" in shown
    assert "Source Source Target Target" in shown
    assert "optimum proven" in shown
    assert "kept" in shown
    assert ("prop", "color_type") in draw(context)


def test_what_is_not_proven_and_what_is_mirrored(context):
    summary = context.scene.hiermatch.summary
    summary.points, summary.proven, summary.gap, summary.orientation = 5, False, 0.25, -0.8
    summary.notes = "The source has two parts.\nMind the gap."
    shown = texts(draw(context))
    assert "within 25% of the optimum" in shown
    assert "exchanged (-0.80)" in shown
    assert "The source has two parts." in shown
    assert "Mind the gap." in shown


def test_drawing_changes_nothing(context):
    add_pair()
    bpy.ops.hiermatch.match(source="Source", target="Target", **QUICK)
    before = snapshot()
    draw(context)
    assert snapshot() == before
