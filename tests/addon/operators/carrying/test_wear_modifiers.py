# SPDX-License-Identifier: GPL-3.0-or-later
"""Wear and what modifiers of items point to: the body, other items, and things that stand where the Source is."""

from __future__ import annotations

import bpy
import numpy as np
import pytest
from mathutils import Vector

from tests.addon.garments import evaluated, fitted, in_world, wear


def add_empty(place):
    empty = bpy.data.objects.new("Handle", None)
    bpy.context.scene.collection.objects.link(empty)
    empty.location = place
    bpy.context.view_layer.update()
    return empty


def notes():
    return bpy.context.scene.hiermatch_retarget.report.notes


def test_a_hook_does_to_a_copy_what_it_does_to_the_item(dressed_pair):
    _, _, shirt, _ = dressed_pair
    empty = add_empty(in_world(shirt)[0])
    hook = shirt.modifiers.new("Hook", "HOOK")
    hook.object = empty
    hook.vertex_indices_set(range(5))
    hook.matrix_inverse = empty.matrix_world.inverted() @ shirt.matrix_world
    np.testing.assert_allclose(evaluated(shirt), in_world(shirt), atol=1e-5)
    for move in (0.0, 0.2):
        empty.location.z += move
        bpy.context.view_layer.update()
        assert wear("Shirt") == {"FINISHED"}
        copy = fitted("Shirt")
        expected = np.zeros((len(copy.data.vertices), 3))
        expected[:5, 2] = move
        np.testing.assert_allclose(evaluated(copy) - in_world(copy), expected, atol=1e-4)
    assert "Handle" not in notes()


def test_objects_that_geometry_nodes_get_become_those_of_the_other_body(dressed_pair):
    source, target, shirt, _ = dressed_pair
    group = bpy.data.node_groups.new("Cling", "GeometryNodeTree")
    kinds = (("Geometry", "Geometry"), ("Body", "Object"), ("Strength", "Float"))
    _, body, strength = (
        group.interface.new_socket(name, in_out="INPUT", socket_type=f"NodeSocket{kind}").identifier
        for name, kind in kinds
    )
    group.interface.new_socket("Geometry", in_out="OUTPUT", socket_type="NodeSocketGeometry")
    modifier = shirt.modifiers.new("Cling", "NODES")
    modifier.node_group = group
    modifier[body], modifier[strength] = source, 0.25
    assert wear("Shirt") == {"FINISHED"}
    copied = fitted("Shirt").modifiers["Cling"]
    assert copied[body] == target
    assert copied[strength] == 0.25
    assert modifier[body] == source


def test_modifiers_that_use_another_item_use_its_copy(dressed_pair):
    _, _, shirt, coat = dressed_pair
    for obj, other in ((coat, shirt), (shirt, coat)):
        obj.modifiers.new("Near", "VERTEX_WEIGHT_PROXIMITY").target = other
    assert wear("Shirt", "Coat") == {"FINISHED"}
    assert fitted("Coat").modifiers["Near"].target == fitted("Shirt")
    assert fitted("Shirt").modifiers["Near"].target == fitted("Coat")
    assert "still use" not in notes()


def test_what_modifiers_still_use_is_told(dressed_pair):
    _, _, shirt, _ = dressed_pair
    shirt.modifiers.new("Half", "MIRROR").mirror_object = add_empty((0.0, 0.0, 0.0))
    assert wear("Shirt") == {"FINISHED"}
    assert fitted("Shirt").modifiers["Half"].mirror_object.name == "Handle"
    assert 'Modifiers of "Shirt on Target" still use "Handle", as those of the original do.' in notes()


def above(obj, body):
    """How far the vertices of an object are from a body, both as they are seen, on average."""
    depsgraph = bpy.context.evaluated_depsgraph_get()
    into = body.matrix_world.inverted()
    count = len(obj.data.vertices)
    places = [into @ Vector(place) for place in evaluated(obj)[:count]]
    return np.mean([(place - body.closest_point_on_mesh(place, depsgraph=depsgraph)[1]).length for place in places])


@pytest.mark.parametrize("smoothed", [["Source"], ["Target"], ["Source", "Target", "Shirt"]])
def test_clothes_are_as_far_from_bodies_as_both_are_seen(smoothed, dressed_pair):
    source, target, shirt, _ = dressed_pair
    away = above(shirt, source)
    assert wear("Shirt") == {"FINISHED"}
    grown = above(fitted("Shirt"), target) / away
    for name in smoothed:
        bpy.data.objects[name].modifiers.new("Smooth", "SUBSURF").levels = 2
    away = above(shirt, source)
    assert wear("Shirt") == {"FINISHED"}
    assert above(fitted("Shirt"), target) / away == pytest.approx(grown, rel=0.1)


def test_a_shape_key_fits_what_is_seen_of_an_item(dressed_pair):
    _, target, shirt, _ = dressed_pair
    assert wear("Shirt", wear_result="KEY") == {"FINISHED"}
    away = above(shirt, target)
    shirt.modifiers.new("Smooth", "SUBSURF").levels = 2
    for name in ("Source", "Target"):
        bpy.data.objects[name].modifiers.new("Smooth", "SUBSURF").levels = 2
    assert wear("Shirt", wear_result="KEY") == {"FINISHED"}
    assert above(shirt, target) == pytest.approx(away, rel=0.1)
