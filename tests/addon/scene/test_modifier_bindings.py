# SPDX-License-Identifier: GPL-3.0-or-later
"""Modifiers that were bound to one mesh, and are bound to another."""

import bpy
import numpy as np
from hiermatch.hiermatch_addon.scene.modifier_bindings import bind_again

from tests.addon.rigs import add_rigged, find_armature, pose
from tests.addon.scenes import add_blob
from tests.addon.shape_keys import add_key, positions


def bound(obj, kind, body, operator):
    """Bind a new modifier to a body."""
    modifier = obj.modifiers.new("Bound", kind)
    if kind == "SURFACE_DEFORM":
        modifier.target = body
    else:
        modifier.rest_source = "BIND"
    with bpy.context.temp_override(object=obj, active_object=obj):
        operator(modifier="Bound")
    return modifier


def shown(obj):
    bpy.context.view_layer.update()
    mesh = obj.evaluated_get(bpy.context.evaluated_depsgraph_get()).data
    return np.array([vertex.co for vertex in mesh.vertices])


def test_what_is_not_bound_stays_so():
    blob = add_blob("Blob")
    blob.modifiers.new("Free", "SURFACE_DEFORM").target = add_blob("Other", 12, 8)
    blob.modifiers.new("Thick", "SOLIDIFY")
    assert bind_again(bpy.context, blob, bpy.data.objects["Other"]) == []
    assert not blob.modifiers["Free"].is_bound


def test_surface_deform_follows_another_body_from_its_rest_on():
    """Though that is posed and a shape key is on: both are put back, and move what is bound."""
    body, _ = add_rigged()
    armature = find_armature(body)
    item, first = add_blob("Item", 12, 8), add_blob("First", 16, 10)
    modifier = bound(item, "SURFACE_DEFORM", first, bpy.ops.object.surfacedeform_bind)
    add_key(body, "Swell", 0.3 * positions(body))
    body.data.shape_keys.key_blocks["Swell"].value = 1
    pose(armature)
    modifier.target = body
    assert bind_again(bpy.context, item, body) == []
    assert modifier.is_bound
    assert armature.data.pose_position == "POSE"
    assert not body.show_only_shape_key
    assert np.linalg.norm(shown(item) - positions(item), axis=1).max() > 0.1
    armature.data.pose_position = "REST"
    body.data.shape_keys.key_blocks["Swell"].value = 0
    np.testing.assert_allclose(shown(item), positions(item), atol=1e-3)


def test_corrective_smooth_learns_the_new_form():
    item, body = add_blob("Item", 12, 8), add_blob("Body")
    modifier = bound(item, "CORRECTIVE_SMOOTH", body, bpy.ops.object.correctivesmooth_bind)
    modifier.factor, modifier.iterations = 0.5, 5
    for vertex in item.data.vertices:
        vertex.co.z *= 2
    item.data.update()
    assert np.abs(shown(item) - positions(item)).max() > 0.01
    assert bind_again(bpy.context, item, body) == []
    np.testing.assert_allclose(shown(item), positions(item), atol=1e-4)


def test_what_cannot_be_bound_is_named():
    item, first = add_blob("Item", 12, 8), add_blob("First", 16, 10)
    modifier = bound(item, "SURFACE_DEFORM", first, bpy.ops.object.surfacedeform_bind)
    modifier.target = None
    assert bind_again(bpy.context, item, first) == ["Bound"]
