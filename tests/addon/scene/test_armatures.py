# SPDX-License-Identifier: GPL-3.0-or-later
from __future__ import annotations

from itertools import pairwise

import bpy
import numpy as np
import pytest
from hiermatch.hiermatch_addon.scene.armatures import (
    bone_weights,
    find_armature,
    held_vertices,
    read_rig,
    read_skeleton,
    without_held,
)
from hiermatch.hiermatch_addon.scene.binding import bind, unbind
from hiermatch.hiermatch_addon.scene.character import parts_of, side_of, successor, take_place
from mathutils import Matrix

from tests.addon.characters import add_person
from tests.addon.rigs import add_armature, add_rigged, pose
from tests.addon.scenes import add_blob
from tests.skeletons import CONTROLS, creature_bones, creature_weights

IMPORTED = Matrix.Translation((1, 2, 3)) @ Matrix.Rotation(np.pi / 2, 4, "X") @ Matrix.Scale(0.01, 4)
"""What files of other programs often come with."""


def test_the_modifiers_armature_counts_before_the_parent():
    obj, armature = add_rigged()
    other = add_armature("Other")
    obj.parent = other
    assert find_armature(obj) == armature
    obj.modifiers.clear()
    assert find_armature(obj) == other
    obj.parent = None
    assert find_armature(obj) is None


def test_a_modifier_without_an_armature_is_passed_over():
    obj, armature = add_rigged()
    obj.modifiers.new("Empty", "ARMATURE")
    obj.modifiers.move(1, 0)
    assert find_armature(obj) == armature


def test_an_armature_that_was_replaced_means_the_one_in_its_place():
    """Of a character of several objects as well, which is called as the old one; its modifiers are there, but off."""
    old = add_person("Old")[0]
    new = old.copy()
    bpy.context.scene.collection.objects.link(new)
    side = side_of(old, bpy.context.view_layer)
    assert len(parts_of(side)) == 2
    assert find_armature(side) == old
    bind(side, new, side, [])
    assert unbind(side, new, []) == [old]
    assert find_armature(side_of(old, bpy.context.view_layer)) == new


@pytest.mark.parametrize("deleted", [False, True])
def test_an_armature_that_was_replaced_twice_means_the_last_one(deleted):
    old = add_person("Old")[0]
    side = side_of(old, bpy.context.view_layer)
    rigs = [old, old.copy(), old.copy()]
    for before, after in pairwise(rigs):
        bpy.context.scene.collection.objects.link(after)
        bind(side, after, side, [])
        assert unbind(side, after, []) == [before]
    assert [successor(rig) for rig in rigs] == [rigs[2]] * 3
    if deleted:
        bpy.data.objects.remove(rigs.pop(1))
    assert find_armature(side_of(old, bpy.context.view_layer)) == rigs[-1]
    take_place(rigs[-1], old)  # its modifiers were switched on again
    assert {successor(rig) for rig in rigs} == {old}


def test_bones_that_an_importer_made_a_metre_long_end_where_others_hang_on_them():
    """Blender's importer of FBX makes them so under an armature that is scaled by 100."""
    armature, _ = add_person("A")
    before = read_skeleton(armature)
    bpy.context.view_layer.objects.active = armature
    bpy.ops.object.mode_set(mode="EDIT")
    for bone in armature.data.edit_bones:
        bone.length = 1.0
    bpy.ops.object.mode_set(mode="OBJECT")
    found = read_skeleton(armature)
    np.testing.assert_allclose(found.heads, before.heads, atol=1e-6)
    for bone, length in enumerate(np.linalg.norm(found.axes, axis=1)):
        ways = np.linalg.norm(found.heads[found.children(bone)] - found.heads[bone], axis=1)
        assert np.isclose(length, ways.max()) if len(ways) else length < 0.2


def test_a_rig_is_read_as_it_was_made():
    obj, armature = add_rigged()
    rig = read_rig(obj)
    names, parents, heads, tails = creature_bones()
    order = [names.index(name) for name in rig.names]
    assert rig.armature_name == armature.name
    assert sorted(order) == list(range(len(names)))
    np.testing.assert_allclose(rig.skeleton.heads, heads[order], atol=1e-6)
    np.testing.assert_allclose(rig.skeleton.tails, tails[order], atol=1e-6)
    for bone, number in enumerate(order):
        parent = rig.skeleton.parents[bone]
        assert (order[parent] if parent >= 0 else -1) == parents[number]
    rest = np.array([vertex.co for vertex in obj.data.vertices])
    np.testing.assert_allclose(rig.weights.toarray(), creature_weights(rest)[:, order].toarray(), atol=1e-5)


def test_bones_are_read_in_the_world_and_at_rest():
    obj, armature = add_rigged(matrix=IMPORTED)
    before = read_rig(obj)
    pose(armature)
    rig = read_rig(obj)
    np.testing.assert_array_equal(rig.skeleton.heads, before.skeleton.heads)
    bone = armature.data.bones["head"]
    tail = rig.skeleton.tails[rig.names.index("head")]
    np.testing.assert_allclose(tail, IMPORTED @ bone.tail_local, atol=1e-6)
    np.testing.assert_array_equal(read_skeleton(armature).tails, rig.skeleton.tails)


def test_weights_sum_to_one_over_the_bones_that_deform():
    obj, _ = add_rigged()
    obj.vertex_groups.new(name="Selection").add(range(len(obj.data.vertices)), 0.7, "REPLACE")
    obj.vertex_groups.new(name="root").add([0], 1.0, "REPLACE")  # a control, whose weight moves nothing
    for group in obj.vertex_groups:
        group.remove([3])
    rig = read_rig(obj)
    totals = np.asarray(rig.weights.sum(axis=1)).ravel()
    np.testing.assert_allclose(np.delete(totals, 3), 1, atol=1e-6)
    assert totals[3] == 0
    for name in CONTROLS:
        assert rig.weights[:, [rig.names.index(name)]].nnz == 0


def test_there_is_no_rig_without_an_armature_or_weights():
    obj, _ = add_rigged()
    obj.vertex_groups.clear()
    assert read_rig(obj) is None
    obj.vertex_groups.new(name="head")
    assert read_rig(obj) is None
    assert read_rig(add_blob("Blob")) is None
    assert bpy.data.armatures


def test_what_hangs_on_bones_has_weights_of_a_body_only_if_all_of_it_does():
    rig, _ = add_person("A")
    sword = add_blob("Sword", 8, 6)
    sword.parent, sword.parent_type, sword.parent_bone = rig, "BONE", "hand.L"
    bpy.context.view_layer.update()
    names = [bone.name for bone in rig.data.bones]
    side = side_of(rig, bpy.context.view_layer)
    weights = bone_weights(side, rig, names)
    held = held_vertices(side)
    assert held.sum() == len(sword.data.vertices)
    kept = without_held(side, weights)
    assert not kept[np.flatnonzero(held)].nnz
    np.testing.assert_array_equal(kept.toarray()[~held], weights.toarray()[~held])
    assert without_held(sword, bone_weights(sword, rig, names)).nnz == len(sword.data.vertices)
