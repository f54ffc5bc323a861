# SPDX-License-Identifier: GPL-3.0-or-later
"""Which pair the lists of landmarks and matched points are about."""

from __future__ import annotations

import bpy
import pytest
from hiermatch.hiermatch_addon.properties import freshness
from hiermatch.hiermatch_addon.properties.steering_lists import steered_pair
from hiermatch.hiermatch_addon.scene.character import parts_of

from tests.addon.scenes import QUICK, add_blob, add_pair


@pytest.fixture
def pair():
    """A pair of which the source is picked by its collection, which the first of two view layers leaves out."""
    source, target = add_pair()
    scene, hero = bpy.context.scene, bpy.data.collections.new("Hero")
    scene.collection.children.link(hero)
    scene.collection.objects.unlink(source)
    hero.objects.link(source)
    second = scene.view_layers.new("Second")
    scene.view_layers[0].layer_collection.children["Hero"].exclude = True
    bpy.context.window.view_layer = second
    scene.hiermatch.source_collection, scene.hiermatch.target = hero, target
    return source, target


def test_what_another_view_layer_leaves_out_is_steered_all_the_same(pair):
    bpy.ops.hiermatch.match(**QUICK)
    scene = bpy.context.scene
    assert len(scene.hiermatch_steering.pairs) == QUICK["points"]
    assert bpy.ops.hiermatch.show(view="MATCH") == {"FINISHED"}
    assert bpy.ops.hiermatch.write_regions() == {"FINISHED"}
    bpy.context.window.view_layer = scene.view_layers[0]
    freshness.refresh(scene)
    assert steered_pair(scene) == pair
    assert len(scene.hiermatch_steering.pairs) == QUICK["points"]


def test_of_several_view_layers_that_have_parts_the_one_that_is_shown_counts(pair):
    extra, more = add_blob("Extra"), bpy.data.collections.new("More")
    scene = bpy.context.scene
    scene.collection.objects.unlink(extra)
    bpy.data.collections["Hero"].children.link(more)
    more.objects.link(extra)
    first = scene.view_layers[0].layer_collection.children["Hero"]
    first.exclude = False
    first.children["More"].exclude = True
    bpy.context.view_layer.update()
    assert parts_of(steered_pair(scene)[0]) == (extra, pair[0])
    with bpy.context.temp_override(window=None):  # as for a timer
        assert parts_of(steered_pair(scene)[0]) == (extra, pair[0])
    bpy.context.window.view_layer = scene.view_layers[0]
    assert steered_pair(scene)[0] == pair[0]
