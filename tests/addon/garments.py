# SPDX-License-Identifier: GPL-3.0-or-later
"""Clothes for bodies."""

from __future__ import annotations

import bpy
import numpy as np
from mathutils import Vector

from tests.addon.shape_keys import positions


def add_item(body, name, offset):
    """Add cloth to a body: its own faces, so far outside."""
    mesh = body.data.copy()
    mesh.name = name
    for attribute in [one.name for one in mesh.attributes if not one.is_required and not one.is_internal]:
        if attribute in mesh.attributes and attribute != "position":
            mesh.attributes.remove(mesh.attributes[attribute])
    for key in list(mesh.keys()):
        del mesh[key]
    normals = np.array([vertex.normal for vertex in mesh.vertices])
    size = np.ptp(positions(body), axis=0).max()
    moved = positions(body) + offset * size * normals
    mesh.vertices.foreach_set("co", moved.astype(np.float32).ravel())
    obj = bpy.data.objects.new(name, mesh)
    obj.matrix_world = body.matrix_world
    bpy.context.scene.collection.objects.link(obj)
    bpy.context.view_layer.update()
    return obj


def in_world(obj):
    """Where the vertices of an object are in the world, (n, 3)."""
    matrix = np.array(obj.matrix_world)
    return positions(obj) @ matrix[:3, :3].T + matrix[:3, 3]


def evaluated(obj):
    """Where the vertices of an object are in the world as keys and modifiers show them, (n, 3)."""
    bpy.context.view_layer.update()
    made = obj.evaluated_get(bpy.context.evaluated_depsgraph_get())
    matrix = np.array(made.matrix_world)
    return np.array([vertex.co for vertex in made.data.vertices]) @ matrix[:3, :3].T + matrix[:3, 3]


def wear(*items, **options):
    """Press the button Wear with some items, of the Source onto the Target if not said otherwise."""
    named = [{"name": item} for item in items]
    return bpy.ops.hiermatch.wear(
        **({"source": "Source", "target": "Target", "items": named, "refine": False} | options)
    )


def fitted(item, body="Target"):
    """The one copy of an item that was fitted to a body."""
    found = [obj for obj in bpy.data.objects if obj.get("hiermatch_item") == item and obj.get("hiermatch_body") == body]
    assert len(found) == 1
    return found[0]


def depths(obj, body):
    """How far vertices are inside a body, by its nearest face."""
    into = body.matrix_world.inverted()
    found = []
    for point in in_world(obj):
        hit, place, normal, _ = body.closest_point_on_mesh(into @ Vector(point))
        assert hit
        found.append(-(into @ Vector(point) - place).dot(normal))
    return np.array(found)


def made_copies():
    """Names of all that was fitted."""
    return sorted(obj.name for obj in bpy.data.objects if "hiermatch_body" in obj)


def add_twin(body):
    """Add a copy of a body, at the same place."""
    twin = body.copy()
    twin.data = body.data.copy()
    twin.name = "Twin"
    bpy.context.scene.collection.objects.link(twin)
    bpy.context.view_layer.update()
    return twin
