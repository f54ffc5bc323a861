# SPDX-License-Identifier: GPL-3.0-or-later
"""An artist's story: a rigged cat lends its rig to another mesh in another pose, which is then animated."""

import importlib.util

import numpy as np
import pytest

from tests.stories.blender_session import blender_session

pytestmark = [
    pytest.mark.slow,
    pytest.mark.skipif(importlib.util.find_spec("bpy") is None, reason="Blender as a module is not installed"),
]


@pytest.fixture
def bpy():
    """Blender with the extension and an empty file."""
    with blender_session() as module:
        yield module


def rest_places(obj):
    """Where each vertex is in the rest pose that both cats were cut from: by that the truth is known."""
    places = np.empty(3 * len(obj.data.vertices), np.float32)
    obj.data.attributes["hm_rest"].data.foreach_get("vector", places)
    return places.reshape(-1, 3)


def evaluated(bpy, obj):
    """Vertices as the modifiers show them, in the world."""
    bpy.context.view_layer.update()
    shown = obj.evaluated_get(bpy.context.evaluated_depsgraph_get())
    mesh = shown.to_mesh()
    places = np.array([shown.matrix_world @ vertex.co for vertex in mesh.vertices])
    shown.to_mesh_clear()
    return places


def test_a_walking_cat_gets_the_rig_of_a_standing_one(bpy, tmp_path):
    from hiermatch.hiermatch_addon.scene.armatures import find_armature
    from hiermatch.hiermatch_addon.scene.deform_layer import read_weights
    from scipy.spatial import cKDTree

    # The demo cats, the standing one rigged; the walking one is a bare mesh in other units and axes.  One button.
    bpy.ops.hiermatch.add_demo_pair(source_vertices=1500, target_vertices=1200, rigged=True)
    state = bpy.context.scene.hiermatch
    state.points, state.samples = 32, 128
    source, target = state.source, state.target
    before = evaluated(bpy, target)
    assert bpy.ops.hiermatch.retarget() == {"FINISHED"}
    assert evaluated(bpy, target) == pytest.approx(before, abs=1e-4)

    # The weights are those of the places that the vertices have in rest.
    names = [bone.name for bone in find_armature(source).data.bones]
    weights = [
        read_weights(obj).toarray()[:, [obj.vertex_groups[name].index for name in names]] for obj in (source, target)
    ]
    nearest = cKDTree(rest_places(source)).query(rest_places(target))[1]
    assert np.abs(weights[1] - weights[0][nearest]).sum(axis=1).mean() < 0.15

    # In pose mode a front leg is turned: it moves, and nothing that belongs to the other legs does.
    armature = find_armature(target)
    bone = armature.pose.bones["upper_arm.L"]
    bone.rotation_mode = "XYZ"
    bone.rotation_euler = (-0.8, 0.0, 0.0)
    moved = np.linalg.norm(evaluated(bpy, target) - before, axis=1)
    leg = np.array([name.endswith(".L") and ("arm" in name or "paw" in name or "wrist" in name) for name in names])
    leg &= np.array(["hind" not in name for name in names])
    own = weights[1][:, leg].sum(axis=1)
    assert moved[own > 0.9].mean() > 0.1
    assert moved[own == 0].max() < 1e-4
    bone.rotation_euler = (0.0, 0.0, 0.0)

    # A shape key makes the belly of the right cat rounder.
    key = target.data.shape_keys.key_blocks["Well Fed"]
    key.value = 1.0
    swollen = np.linalg.norm(evaluated(bpy, target) - before, axis=1)
    loin, head = (weights[1][:, names.index(name)] for name in ("loin", "head"))
    belly = loin > 0.9 * loin.max()
    assert swollen[belly].mean() > 0.03
    assert swollen[head > 0.9 * head.max()].max() < 0.01
    key.value = 0.0

    # Saved, opened another day, and the weights alone carried once more: without matching again.
    path = str(tmp_path / "cats.blend")
    bpy.ops.wm.save_as_mainfile(filepath=path)
    bpy.ops.wm.open_mainfile(filepath=path)
    target = bpy.context.scene.hiermatch.target
    target.vertex_groups.clear()
    assert bpy.ops.hiermatch.transfer_weights() == {"FINISHED"}
    again = read_weights(target).toarray()[:, [target.vertex_groups[name].index for name in names]]
    np.testing.assert_allclose(again, weights[1], atol=2e-3)
