# SPDX-License-Identifier: GPL-3.0-or-later
"""Clothes for bodies."""

from __future__ import annotations

import bpy
import numpy as np

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
