# SPDX-License-Identifier: GPL-3.0-or-later
"""What a body wears that has no skin below it, and is its surface there."""

from __future__ import annotations

import bmesh
import bpy
import numpy as np
import pytest
from hiermatch.hiermatch_addon.scene.character import Character, joined, parts_of, read_surface, whole
from hiermatch.hiermatch_addon.scene.worn.garments import undressed
from mathutils import Vector

from tests.addon.garments import depths, fitted, in_world, wear
from tests.addon.rigs import add_armature


def cut_off(body, name):
    """Cut off all but the upper end of a body, as an object of its own."""
    half = body.copy()
    half.data, half.name = body.data.copy(), name
    bpy.context.scene.collection.objects.link(half)
    height = np.quantile(in_world(body)[:, 2], 0.9)
    for obj, upper in ((body, True), (half, False)):
        build = bmesh.new()
        build.from_mesh(obj.data)
        faces = [f for f in build.faces if ((obj.matrix_world @ f.calc_center_median()).z > height) != upper]
        bmesh.ops.delete(build, geom=faces, context="FACES")
        build.to_mesh(obj.data)
        build.free()
    bpy.context.view_layer.update()
    return half


def test_an_item_without_skin_below_it_is_part_of_the_body_as_well(dressed_pair):
    source, target, _, _ = dressed_pair
    boots = cut_off(source, "Boots")
    before = in_world(boots).copy()
    assert wear("Boots", source="Source + Boots", accept_doubtful=True) == {"FINISHED"}
    report = bpy.context.scene.hiermatch_retarget.report
    assert '"Boots" counts as part of the body as well: "Source" has no skin below it.' in report.remarks
    copy = fitted("Boots")
    assert depths(copy, target).max() < 1e-4
    assert np.ptp(in_world(copy)[:, 2]) > 0.6 * np.ptp(in_world(target)[:, 2])
    np.testing.assert_array_equal(in_world(boots), before)
    with pytest.raises(RuntimeError, match='"Boots" is the body itself, picked as the Source'):
        wear("Boots", "Source", source="Source + Boots")


def test_of_layers_over_nothing_the_inner_one_stands_for_the_body(dressed_pair):
    source, _, _, _ = dressed_pair
    made = []
    for name, low, high, size in (("Head", 2, 3, 1), ("Legs", -3, -2, 1), ("Vest", -2, 2, 1), ("Cloak", -2, 2, 1.2)):
        bpy.ops.mesh.primitive_cylinder_add(radius=size, depth=high - low, location=(9, 0, (low + high) / 2))
        made.append(bpy.context.object)
        made[-1].name = name
    depsgraph = bpy.context.evaluated_depsgraph_get()
    body = joined("Doll", made)
    worn = undressed(body, ["Vest", "Cloak"], depsgraph)
    assert [part.name for part in parts_of(worn)] == ["Head", "Legs", "Vest"]
    assert undressed(source, ["Shirt"], depsgraph) is source


def test_a_skirt_is_no_skin_where_there_are_legs_in_it(dressed_pair):
    del dressed_pair
    bpy.ops.mesh.primitive_cone_add(
        vertices=24, radius1=0.95, radius2=0.65, depth=1.9, end_fill_type="NOTHING", location=(9, 0, 1.25)
    )
    made = [bpy.context.object]
    for name, x, low, high, size in (
        ("Trunk", 0, 2.2, 5, 0.65),
        ("Leg.L", 0.45, -2, 1.2, 0.33),
        ("Leg.R", -0.45, -2, 1.2, 0.33),
    ):
        bpy.ops.mesh.primitive_cylinder_add(radius=size, depth=high - low, location=(9 + x, 0, (low + high) / 2))
        made.append(bpy.context.object)
        made[-1].name = name
    made[0].name = "Skirt"
    bpy.ops.object.select_all(action="DESELECT")
    for obj in made:  # faces as small as those of clothes
        obj.select_set(state=True)
        build = bmesh.new()
        build.from_mesh(obj.data)
        bmesh.ops.subdivide_edges(build, edges=build.edges, cuts=6, use_grid_fill=True)
        build.to_mesh(obj.data)
        build.free()
    bpy.context.view_layer.update()
    depsgraph = bpy.context.evaluated_depsgraph_get()
    body = undressed(joined("Doll", made), ["Skirt"], depsgraph)
    assert set(parts_of(body)) == set(made)
    seen, every = (read_surface(side, depsgraph, use_modifiers=False) for side in (body, whole(body)))
    assert seen.vertex_count == every.vertex_count
    assert every.triangle_count == read_surface(joined("Doll", made), depsgraph, use_modifiers=False).triangle_count
    left_out = np.array(sorted(body.left_out))
    assert seen.triangle_count == every.triangle_count - len(left_out)
    middles = every.vertices[every.triangles[left_out]].mean(axis=1)
    assert np.linalg.norm(middles[:, :2] - [9, 0], axis=1).min() > 0.6  # none of the legs
    assert middles[:, 2].min() < 0.5
    assert middles[:, 2].max() < 2.0
    bare = undressed(joined("Doll", made), [], depsgraph)
    assert not bare.left_out


def test_a_match_that_knows_what_hangs_is_used_as_it_is(dressed_pair, monkeypatch):
    """As one that was made by the button Match, before."""
    source, target, _, _ = dressed_pair
    hanging = frozenset(range(len(source.data.polygons) // 2))
    worn = Character(source.name, (source,), hanging)
    monkeypatch.setattr("hiermatch.hiermatch_addon.operators.carrying.wear.undressed", lambda *_: worn)
    assert read_surface(worn, bpy.context.evaluated_depsgraph_get(), use_modifiers=False).triangle_count > 0
    assert wear("Shirt") == {"FINISHED"}
    assert depths(fitted("Shirt"), target).max() < 1e-4


def test_shoes_below_closed_legs_are_part_of_a_body_with_a_rig(dressed_pair):
    del dressed_pair
    rig = add_armature("Doll Rig")
    foot, above = rig.data.bones["head"], "neck"
    joint = rig.matrix_world @ foot.head_local
    made = []
    for name, height, moved_by in (("Leg", 1.0, above), ("Shoe", -0.3, foot.name)):
        bpy.ops.mesh.primitive_uv_sphere_add(location=joint + Vector((0, 0, height)))
        obj = bpy.context.object
        obj.name, obj.scale = name, (0.2, 0.2, height if height > 0 else 0.25)
        obj.vertex_groups.new(name=moved_by).add(range(len(obj.data.vertices)), 1.0, "REPLACE")
        obj.modifiers.new("Armature", "ARMATURE").object = rig
        made.append(obj)
    bpy.context.view_layer.update()
    depsgraph = bpy.context.evaluated_depsgraph_get()
    body = joined("Doll", made)
    assert parts_of(undressed(body, ["Shoe"], depsgraph)) == tuple(made)
    made[1].vertex_groups[0].name = above
    assert parts_of(undressed(body, ["Shoe"], depsgraph)) == (made[0],)
