# SPDX-License-Identifier: GPL-3.0-or-later
"""Clothes that were fitted before: found again, kept aside if they were edited, or worn on the way to the next body."""

from __future__ import annotations

import bpy
import pytest

from tests.addon.garments import add_twin, fitted, made_copies, wear
from tests.addon.scenes import DENSE, QUICK, mesh_snapshot, weights_of


def test_copies_are_found_again_after_renaming(dressed_pair):
    _, target, shirt, _ = dressed_pair
    assert wear("Shirt", "Coat") == {"FINISHED"}
    target.name, shirt.name = "Giant", "Blouse"
    fitted("Coat").name = "My Coat"
    assert wear("Blouse", target="Giant") == {"FINISHED"}
    assert made_copies() == ["Blouse on Giant", "My Coat"]
    assert fitted("Coat", "Giant").name == "My Coat"
    assert [one.name for one in bpy.data.collections if "hiermatch_body" in one] == ["Outfit of Giant"]
    assert not set(fitted("Blouse", "Giant").keys()) & {"hiermatch_item_name", "hiermatch_body_name"}


def test_what_another_body_wears_is_left_alone(dressed_pair):
    _, target, *_ = dressed_pair
    assert wear("Shirt") == {"FINISHED"}
    add_twin(target)
    assert wear("Shirt", target="Twin") == {"FINISHED"}
    assert made_copies() == ["Shirt on Target", "Shirt on Twin"]


@pytest.mark.usefixtures("dressed_pair")
def test_where_copies_are_not_seen_it_is_said():
    assert wear("Shirt") == {"FINISHED"}
    report = bpy.context.scene.hiermatch_retarget.report
    assert "is hidden or left out" not in report.notes
    collection = bpy.context.view_layer.layer_collection.children["Outfit of Target"]
    for hidden, excluded in ((True, False), (False, True)):
        collection.hide_viewport, collection.exclude = hidden, excluded
        assert wear("Shirt") == {"FINISHED"}
        assert 'The collection of "Shirt on Target" is hidden or left out.' in report.notes


def test_a_copy_with_a_long_name_is_kept_aside_under_another_one(dressed_pair):
    _, _, shirt, _ = dressed_pair
    shirt.name = 300 * "S"
    assert wear(shirt.name) == {"FINISHED"}
    (name,) = made_copies()
    bpy.data.objects[name].data.vertices[3].co.z += 0.5
    assert wear(shirt.name) == {"FINISHED"}
    (aside,) = set(made_copies()) - {name}
    assert aside.endswith(" (edited)")
    assert not bpy.data.objects[name].hide_render


def test_a_copy_that_was_edited_is_kept_aside(dressed_pair):
    assert dressed_pair
    assert wear("Shirt", "Coat") == {"FINISHED"}
    fitted("Shirt").data.vertices[3].co.z += 0.5
    where = tuple(fitted("Shirt").data.vertices[3].co)
    assert wear("Shirt", "Coat") == {"FINISHED"}
    assert made_copies() == ["Coat on Target", "Shirt on Target", "Shirt on Target (edited)"]
    kept = bpy.data.objects["Shirt on Target (edited)"]
    assert tuple(kept.data.vertices[3].co) == where
    assert kept.users_collection == fitted("Shirt").users_collection
    assert kept.hide_get()
    assert kept.hide_render
    assert "was edited after it had been fitted" in bpy.context.scene.hiermatch_retarget.report.notes
    assert wear("Shirt", "Coat") == {"FINISHED"}
    assert len(made_copies()) == 3


def thicken(copy):
    copy.modifiers["Thick"].thickness = 0.3


def nudge(copy):
    copy.location.z += 0.2


def tune(copy):
    modifier = copy.modifiers["Nodes"]
    (name,) = (name for name in modifier.keys() if isinstance(modifier[name], float))  # noqa: SIM118 - is no dict
    modifier[name] = 0.75


def aim(copy):
    copy.modifiers["Half"].mirror_object = bpy.data.objects["Plane Here"]


@pytest.mark.parametrize("change", [thicken, nudge, tune, aim])
def test_a_copy_whose_modifier_was_set_or_that_was_moved_is_kept_aside(dressed_pair, change):
    _, target, shirt, _ = dressed_pair
    shirt.modifiers.new("Thick", "SOLIDIFY").thickness = 0.01
    half = shirt.modifiers.new("Half", "MIRROR")
    half.mirror_object, _ = (bpy.data.objects.new(name, None) for name in ("Plane", "Plane Here"))
    half.show_viewport = False
    nodes = bpy.data.node_groups.new("Nodes", "GeometryNodeTree")
    for name in ("Geometry", "Float"):
        nodes.interface.new_socket(name, in_out="INPUT", socket_type=f"NodeSocket{name}")
    shirt.modifiers.new("Nodes", "NODES").node_group = nodes
    shirt.modifiers["Nodes"].show_viewport = False
    assert wear("Shirt") == {"FINISHED"}
    bpy.context.view_layer.update()
    target.location.y += 2  # with all that it wears
    fitted("Shirt").location.y += 2
    bpy.context.view_layer.update()
    assert wear("Shirt") == {"FINISHED"}
    assert made_copies() == ["Shirt on Target"]
    change(fitted("Shirt"))
    thickness, height = fitted("Shirt").modifiers["Thick"].thickness, fitted("Shirt").location.z
    assert wear("Shirt") == {"FINISHED"}
    assert made_copies() == ["Shirt on Target", "Shirt on Target (edited)"]
    kept = bpy.data.objects["Shirt on Target (edited)"]
    assert (kept.modifiers["Thick"].thickness, kept.location.z) == (thickness, height)


@pytest.fixture
def next_pair(dressed_pair):
    """The target of a pair, which wears a shirt by now, and a third body, both picked; the shirt is selected."""
    _, target, *_ = dressed_pair
    assert wear("Shirt") == {"FINISHED"}
    third = target.copy()
    third.data = target.data.copy()
    third.name, third.location.x = "Third", 10
    bpy.context.scene.collection.objects.link(third)
    bpy.context.view_layer.update()
    for name, value in DENSE.items():
        setattr(bpy.context.scene.hiermatch, name, value)
    bpy.context.scene.hiermatch.source, bpy.context.scene.hiermatch.target = target, third
    fitted("Shirt").select_set(state=True)
    return target, third


@pytest.mark.usefixtures("next_pair")
def test_what_was_fitted_to_a_body_is_fitted_from_it_to_the_next():
    assert bpy.ops.hiermatch.wear(refine=False) == {"FINISHED"}
    copy = fitted("Shirt on Target", "Third")
    assert copy.name == "Shirt on Target on Third"
    bpy.ops.object.select_all(action="DESELECT")
    copy.select_set(state=True)
    assert bpy.ops.hiermatch.wear(refine=False) == {"FINISHED"}
    assert fitted("Shirt on Target", "Third").name == "Shirt on Target on Third"
    assert fitted("Shirt", "Target")


@pytest.mark.usefixtures("next_pair")
def test_the_outfit_of_a_body_is_a_collection_of_items():
    bpy.ops.object.select_all(action="DESELECT")
    assert bpy.ops.hiermatch.wear(collection="Outfit of Target", refine=False) == {"FINISHED"}
    assert fitted("Shirt on Target", "Third")


def test_a_match_of_an_item_is_none_of_its_copy(dressed_pair):
    """A character that was matched as a whole carries the match on its clothes as well."""
    _, _, shirt, _ = dressed_pair
    assert bpy.ops.hiermatch.match(source="Shirt", target="Coat", prefix="Of Rig", **QUICK) == {"FINISHED"}
    before = mesh_snapshot(shirt)
    assert "Of Rig.001" in weights_of(shirt)
    assert wear("Shirt") == {"FINISHED"}
    assert mesh_snapshot(shirt) == before
    copy = fitted("Shirt")
    names = (*copy.vertex_groups.keys(), *copy.data.attributes.keys())
    assert not [name for name in names if name.startswith("Of Rig")]
    assert "hiermatch" not in copy.data


def test_where_no_target_is_picked_it_is_said_what_to_pick(dressed_pair):
    source, target, shirt, _ = dressed_pair
    for obj in (source, target, shirt):
        obj.select_set(state=True)
    bpy.context.view_layer.objects.active = source
    with pytest.raises(RuntimeError, match="Pick both bodies as Source and Target, and select the items"):
        bpy.ops.hiermatch.wear(refine=False)
