# SPDX-License-Identifier: GPL-3.0-or-later
"""The panel for clothes says what it will take."""

from __future__ import annotations

from types import SimpleNamespace

import bpy
import pytest
from hiermatch.hiermatch_addon.panels import wear_panel
from hiermatch.hiermatch_addon.transfers.options.wear import WearOptions
from hiermatch.hiermatch_addon.transfers.wearing.fit_colors import FIT_NAMES

from tests.addon.garments import add_item
from tests.addon.panels.test_panels import Layout
from tests.addon.panels.test_panels import context as context  # noqa: PLC0414  (a fixture)
from tests.addon.rigs import add_armature


@pytest.fixture
def bodies(dense_pair):
    """A source and a target that are picked; nothing is selected."""
    state = bpy.context.scene.hiermatch
    state.source, state.target = dense_pair
    bpy.ops.object.select_all(action="DESELECT")
    return dense_pair


def drawn_texts(context, kind="label"):
    drawn = []
    panel = SimpleNamespace(layout=Layout(drawn), bl_idname="HIERMATCH_PT_wear")
    wear_panel.HIERMATCH_PT_wear.draw(panel, context)
    return [entry[1] for entry in drawn if entry[0] == kind]


@pytest.mark.usefixtures("bodies")
def test_options_of_copies_are_not_shown_for_a_shape_key(context):
    options = bpy.context.scene.hiermatch_retarget
    everything = drawn_texts(context, "prop")
    options.wear_result = "KEY"
    shown = drawn_texts(context, "prop")
    options.wear_result = "OBJECT"
    assert shown == ["wear_result", "wear_clearance", "wear_hide", "wear_colors"]
    assert everything == list(WearOptions.__annotations__)


@pytest.mark.usefixtures("bodies")
def test_without_bodies_no_items_are_named(context):
    bpy.context.scene.hiermatch.target = None
    assert "Items" not in drawn_texts(context)


@pytest.mark.usefixtures("bodies")
def test_of_a_body_that_holds_no_mesh_no_items_are_named(context):
    state = bpy.context.scene.hiermatch
    state.source, state.source_collection = None, bpy.data.collections.new("Empty")
    assert "Items" not in drawn_texts(context)


@pytest.mark.usefixtures("bodies")
def test_without_clothes_it_says_what_to_do(context):
    said = " ".join(drawn_texts(context))
    assert "Items" not in said
    assert "Select the clothes of the source" in said


def test_what_is_selected_is_named_and_what_was_fitted_is_not(bodies, context):
    shirt, coat = (add_item(bodies[0], name, 0.02) for name in ("Shirt", "Coat"))
    fitted = add_item(bodies[1], "Shirt Fitted", 0.02)
    fitted["hiermatch_body"] = bodies[1].name
    for obj in (shirt, fitted, *bodies):
        obj.select_set(state=True)
    said = drawn_texts(context)
    assert "Shirt" in said
    assert not {coat.name, fitted.name, *(body.name for body in bodies)} & set(said[said.index("Items") :])


def test_a_fitted_copy_stands_for_its_item(bodies, context):
    shirt = add_item(bodies[0], "Shirt", 0.02)
    fitted, other = (add_item(bodies[1], name, 0.02) for name in ("Shirt Fitted", "Shirt Elsewhere"))
    for copy, body in ((fitted, bodies[1].name), (other, "Somebody")):
        copy["hiermatch_item"], copy["hiermatch_body"] = "Shirt", body
    bpy.context.view_layer.objects.active = fitted
    fitted.select_set(state=True)
    said = drawn_texts(context)
    assert said.count("Shirt") == 2  # among the items, and over how it fits
    assert fitted.name not in said
    shirt["hiermatch_item_name"] = "Shirt"
    shirt.name = "Blouse"
    assert drawn_texts(context).count("Blouse") == 2
    fitted.select_set(state=False)
    other.select_set(state=True)
    assert "Items" not in drawn_texts(context)


def test_a_copy_on_the_source_is_an_item_of_its_own(bodies, context):
    add_item(bodies[1], "Shirt", 0.02)
    worn = add_item(bodies[0], "Shirt on Source", 0.02)
    worn["hiermatch_item"], worn["hiermatch_body"] = "Shirt", bodies[0].name
    bpy.context.view_layer.objects.active = worn
    worn.select_set(state=True)
    said = drawn_texts(context)
    assert said.count(worn.name) == 2
    assert "Shirt" not in said


def test_with_nothing_selected_all_that_hangs_on_the_rig_is_named_up_to_a_number(bodies, context):
    rig = add_armature("Rig")
    items = [add_item(bodies[0], f"Item {letter}", 0.02) for letter in "ABCDEFGH"]
    for obj in (bodies[0], *items):
        obj.modifiers.new("Armature", "ARMATURE").object = rig
    bpy.ops.object.select_all(action="DESELECT")
    said = drawn_texts(context)
    named = [text for text in said if text.startswith("Item ")]
    assert named == [f"Item {letter}" for letter in "ABCDEF"]
    assert "2 more" in said


def test_what_show_fit_has_written_can_be_shown(bodies, context):
    def buttons():
        drawn = []
        panel = SimpleNamespace(layout=Layout(drawn), bl_idname="HIERMATCH_PT_wear")
        wear_panel.HIERMATCH_PT_wear.draw(panel, context)
        return [entry for entry in drawn if entry[0] == "switch"]

    with pytest.raises(RuntimeError, match="Press Wear with Show Fit on"):
        bpy.ops.hiermatch.show_fit(view="PUSHED")
    assert not buttons()
    item = add_item(bodies[1], "Shirt", 0.02)
    item.data.color_attributes.new("Own", "FLOAT_COLOR", "POINT")
    for name in FIT_NAMES.values():
        item.data.color_attributes.new(name, "FLOAT_COLOR", "POINT")
    item.data.attributes.active_color_name = "Own"
    assert buttons() == [("switch", "hiermatch.show", True), *3 * [("switch", "hiermatch.show_fit", False)]]
    for view, name in FIT_NAMES.items():
        assert bpy.ops.hiermatch.show_fit(view=view) == {"FINISHED"}
        assert item.data.attributes.active_color_name == name
    context.space_data.shading.color_type = "VERTEX"
    assert [pressed for *_, pressed in buttons()] == [False, False, False, True]
    assert bpy.ops.hiermatch.show(view="NONE") == {"FINISHED"}
    assert item.data.attributes.active_color_name == "Own"
