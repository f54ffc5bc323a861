# SPDX-License-Identifier: GPL-3.0-or-later
"""Where Subdivision shows the surface of a mesh."""

from __future__ import annotations

import bpy
import numpy as np
import pytest
from hiermatch.hiermatch_addon.scene.worn.smoothing import seen_surface, smoothing_offsets
from mathutils import Matrix

from tests.addon.garments import in_world
from tests.addon.shape_keys import positions

AROUND, ALONG, RADIUS = 8, 7, 2.0


def add_tube():
    """An open tube of quads along z, scaled and off the origin."""
    mesh = bpy.data.meshes.new("Tube")
    angles = 2 * np.pi * np.arange(AROUND) / AROUND
    heights, angles = np.meshgrid(np.arange(ALONG), angles, indexing="ij")
    places = np.stack([RADIUS * np.cos(angles), RADIUS * np.sin(angles), heights], axis=-1).reshape(-1, 3)
    numbers = np.arange(len(places)).reshape(ALONG, AROUND)
    corners = numbers[:-1], np.roll(numbers, -1, axis=1)[:-1], np.roll(numbers, -1, axis=1)[1:], numbers[1:]
    mesh.from_pydata(places, [], np.stack(corners, axis=-1).reshape(-1, 4).tolist())
    obj = bpy.data.objects.new("Tube", mesh)
    bpy.context.scene.collection.objects.link(obj)
    obj.matrix_world = Matrix.Translation((3, 0, 0)) @ Matrix.Scale(0.5, 4)
    obj.modifiers.new("Subdivision", "SUBSURF").levels = 2
    bpy.context.view_layer.update()
    return obj


def expected(obj):
    """A cubic B-spline passes a corner of a regular polygon at (4 + 2 cos) / 6 of its radius; half of the way there."""
    shrunk = (4 + 2 * np.cos(2 * np.pi / AROUND)) / 6
    vectors = 0.5 * positions(obj)
    vectors[:, 2] = 0
    return 0.5 * (shrunk - 1) * vectors


def test_faces_lie_where_the_surface_is_seen_on_average():
    tube = add_tube()
    offsets = smoothing_offsets(bpy.context, tube)
    inner = slice(2 * AROUND, -2 * AROUND)
    np.testing.assert_allclose(offsets[inner], expected(tube)[inner], atol=1e-6)
    surface = seen_surface(bpy.context, tube)
    np.testing.assert_allclose(surface.vertices, in_world(tube) + offsets)
    spots = np.random.default_rng(0).dirichlet(np.ones(3), (surface.triangle_count, 50))
    places = np.einsum("fsc,fci->fsi", spots, surface.vertices[surface.triangles])
    radii = np.linalg.norm(places[..., :2] - [3, 0], axis=-1)
    seen = 0.5 * RADIUS * (4 + 2 * np.cos(2 * np.pi / AROUND)) / 6
    cage = 0.5 * RADIUS * np.sinc(1 / AROUND)
    assert abs(radii.mean() - seen) < 0.1 * abs(cage - seen)


@pytest.mark.parametrize("change", [{"show_viewport": False}, {"subdivision_type": "SIMPLE"}, {"levels": 0}])
def test_what_is_not_smoothed_is_its_cage(change):
    tube = add_tube()
    for name, value in change.items():
        setattr(tube.modifiers["Subdivision"], name, value)
    np.testing.assert_allclose(smoothing_offsets(bpy.context, tube), 0.0, atol=1e-6)


def test_keys_poses_and_other_modifiers_do_not_matter_at_rest():
    tube = add_tube()
    before = smoothing_offsets(bpy.context, tube)
    tube.shape_key_add(name="Basis")
    key = tube.shape_key_add(name="Moved")
    key.data.foreach_set("co", np.add(positions(tube), [1, 2, 3]).astype(np.float32).ravel())
    key.value = 1.0
    tube.modifiers.new("Mask", "MASK").vertex_group = tube.vertex_groups.new(name="none").name
    tube.modifiers.new("Bent", "SIMPLE_DEFORM").angle = 1.0
    tube.modifiers.new("Cut", "BUILD")
    np.testing.assert_allclose(smoothing_offsets(bpy.context, tube), before, atol=1e-6)
    assert all(modifier.show_viewport for modifier in tube.modifiers)


def test_it_turns_with_what_poses_it():
    tube = add_tube()
    before = smoothing_offsets(bpy.context, tube)
    hook = bpy.data.objects.new("Hook", None)
    bpy.context.scene.collection.objects.link(hook)
    made = tube.modifiers.new("Hook", "HOOK")
    made.object = hook
    made.vertex_indices_set(range(len(tube.data.vertices)))
    bpy.context.view_layer.update()
    hook.rotation_euler.y = np.pi / 2
    bpy.context.view_layer.update()
    turned = smoothing_offsets(bpy.context, tube, posed=True)
    np.testing.assert_allclose(turned, before @ [[0, 0, -1], [0, 1, 0], [1, 0, 0]], atol=1e-6)
    np.testing.assert_allclose(smoothing_offsets(bpy.context, tube), before, atol=1e-6)
