# SPDX-License-Identifier: GPL-3.0-or-later
"""What the panels for steering a match show."""

from __future__ import annotations

from types import SimpleNamespace

import bpy
import pytest
from hiermatch.hiermatch_addon.panels import steering_panels
from hiermatch.hiermatch_addon.properties.freshness import refresh

from tests.addon.panels.test_panels import Layout
from tests.addon.scenes import QUICK, add_pair, snapshot


class ListLayout(Layout):
    """A layout that knows lists and grids, too."""

    def _part(self, *_arguments, **_names):
        return ListLayout(self.drawn)

    row = column = split = box = grid_flow = _part

    def separator(self):
        pass

    def template_list(self, kind, _name, owner, items, _index_owner, index, **_names):
        assert hasattr(bpy.types, kind)
        assert items in owner.bl_rna.properties
        assert index in owner.bl_rna.properties
        self.drawn.append(("list", kind))

    def operator(self, name, **names):
        super().operator(name, **{key: value for key, value in names.items() if key != "depress"})
        self.drawn.append(("pressed", names.get("depress", False)))
        return SimpleNamespace()


@pytest.fixture
def context():
    shading = SimpleNamespace(type="SOLID", color_type="VERTEX")
    return SimpleNamespace(
        scene=bpy.context.scene,
        window_manager=bpy.context.window_manager,
        space_data=SimpleNamespace(shading=shading),
    )


def draw(name, context):
    drawn = []
    getattr(steering_panels, name).draw(SimpleNamespace(layout=ListLayout(drawn)), context)
    return drawn


def operators(drawn):
    return [entry[1] for entry in drawn if entry[0] == "operator"]


@pytest.fixture
def pair():
    bpy.context.scene.hiermatch.source, bpy.context.scene.hiermatch.target = add_pair()
    bpy.ops.hiermatch.match(**QUICK)


def test_without_a_pair(context):
    assert ("label", "Pick Source and Target first") in draw("HIERMATCH_PT_landmarks", context)
    assert ("label", "There is no match yet") in draw("HIERMATCH_PT_pairs", context)


@pytest.mark.usefixtures("pair")
def test_landmarks(context):
    drawn = draw("HIERMATCH_PT_landmarks", context)
    assert ("list", "HIERMATCH_UL_landmarks") in drawn
    assert operators(drawn) == [
        "hiermatch.guide_me",
        "hiermatch.pick_landmarks",
        "hiermatch.add_landmark",
        "hiermatch.mirror_landmarks",
        "hiermatch.save_landmarks",
        "hiermatch.load_landmarks",
        "hiermatch.clear_landmarks",
        "hiermatch.refine",
    ]


@pytest.mark.usefixtures("pair")
@pytest.mark.parametrize("panel", ["HIERMATCH_PT_landmarks", "HIERMATCH_PT_pairs"])
def test_while_the_match_is_refined_there_are_a_bar_and_a_way_out(context, panel):
    running = SimpleNamespace(bl_idname="HIERMATCH_OT_refine", panel="HIERMATCH_PT_match")
    progress = SimpleNamespace(fraction=0.4, label="Measuring", question="")
    context.window_manager = SimpleNamespace(windows=[SimpleNamespace(modal_operators=[running])], hiermatch=progress)
    drawn = draw(panel, context)
    assert ("progress", "Measuring", 0.4) in drawn
    assert operators(drawn)[-1] == "hiermatch.cancel"
    assert "hiermatch.refine" not in operators(drawn)


@pytest.mark.usefixtures("pair")
def test_matched_points(context):
    drawn = draw("HIERMATCH_PT_pairs", context)
    assert ("list", "HIERMATCH_UL_pairs") in drawn
    assert operators(drawn) == ["hiermatch.refine"]


@pytest.mark.usefixtures("pair")
def test_what_is_shown_is_pressed(context):
    drawn = draw("HIERMATCH_PT_overlay", context)
    pressed = [entry[1] for entry in drawn if entry[0] == "pressed"]
    assert [number for number, down in enumerate(pressed) if down] == [1]  # match colors, as the match left them
    context.space_data.shading.color_type = "MATERIAL"
    pressed = [entry[1] for entry in draw("HIERMATCH_PT_overlay", context) if entry[0] == "pressed"]
    assert pressed[0]
    assert not any(pressed[1:])
    shown = {entry[1] for entry in drawn if entry[0] == "prop"}
    assert shown == {"show_overlay", "show_points", "show_lines", "show_labels"}


@pytest.mark.usefixtures("pair")
@pytest.mark.parametrize(("kind", "items"), [("HIERMATCH_UL_landmarks", "landmarks"), ("HIERMATCH_UL_pairs", "pairs")])
def test_rows(context, kind, items):
    bpy.ops.hiermatch.add_landmark(source_vertex=3, target_vertex=5)
    drawn = []
    item = getattr(bpy.context.scene.hiermatch_steering, items)[0]
    getattr(steering_panels, kind).draw_item(None, context, ListLayout(drawn), None, item, 0, None, "")
    assert len(operators(drawn)) == 3


@pytest.mark.usefixtures("pair")
def test_drawing_changes_nothing(context):
    before = snapshot()
    for name in ("HIERMATCH_PT_landmarks", "HIERMATCH_PT_pairs", "HIERMATCH_PT_overlay"):
        draw(name, context)
    assert snapshot() == before


@pytest.mark.usefixtures("pair")
def test_picking_two_meshes_tells_of_the_match_that_they_carry():
    """As after appending them to another file."""
    state = bpy.context.scene.hiermatch
    before = {name: value for name, value in snapshot()["summary"].items() if name != "seconds"}
    state.source = state.target = None
    for name in state.summary.bl_rna.properties.keys():  # noqa: SIM118 - not a dict
        if name not in ("rna_type", "name"):
            state.summary.property_unset(name)
    assert not state.summary.points
    state.source, state.target = bpy.data.objects["Source"], bpy.data.objects["Target"]
    after = snapshot()["summary"]
    assert {name: after[name] for name in before} == before
    assert after["points"] == QUICK["points"]


@pytest.mark.usefixtures("pair")
def test_picking_a_mesh_that_carries_none_leaves_the_summary_but_hides_it():
    state = bpy.context.scene.hiermatch
    before, target = snapshot()["summary"], state.target
    bpy.ops.mesh.primitive_cube_add()
    state.target = bpy.context.object
    assert snapshot()["summary"] == {**before, "hidden": True}
    assert not before["hidden"]
    refresh(bpy.context.scene)
    assert snapshot()["summary"] == {**before, "hidden": True}
    with pytest.raises(RuntimeError, match="There is no match to flip"):
        bpy.ops.hiermatch.flip()
    new, name = state.target, target.name
    target.name, new.name = "Other", name  # a name is none of what carries the match
    refresh(bpy.context.scene)
    assert snapshot()["summary"]["hidden"]
    new.name, target.name = "Cube", name
    refresh(bpy.context.scene)
    state.source = None
    bpy.context.view_layer.objects.active = target
    state.target = target
    assert snapshot()["summary"] == before
