# SPDX-License-Identifier: GPL-3.0-or-later
"""Landmarks as tests add, read and edit them."""

from __future__ import annotations

import bmesh
import bpy
from hiermatch.hiermatch_addon.storage.landmarks import add_landmarks, find_landmarks


def add_third(pair):
    """Add a mesh with landmarks 1 to 3 in common with the source, of which the pair has removed number 2."""
    other = pair[1].copy()
    other.data = pair[1].data.copy()
    bpy.context.collection.objects.link(other)
    for target in (pair[1], other):
        add_landmarks(pair[0], target, [(70, 30), (80, 40), (90, 50)])
    bpy.ops.hiermatch.remove_landmark(number=2)
    return other


def add(source_vertex, target_vertex):
    return bpy.ops.hiermatch.add_landmark(source_vertex=source_vertex, target_vertex=target_vertex)


def found(pair):
    return [(one.number, one.source, one.target) for one in find_landmarks(*pair)]


def listed():
    return [(one.number, one.source, one.target) for one in bpy.context.scene.hiermatch_steering.landmarks]


def edit(*objects):
    bpy.ops.object.select_all(action="DESELECT")
    for obj in objects:
        obj.select_set(state=True)
    bpy.context.view_layer.objects.active = objects[0]
    bpy.ops.object.mode_set(mode="EDIT")


def select(obj, vertices):
    edited = bmesh.from_edit_mesh(obj.data)
    for vertex in edited.verts:
        vertex.select = vertex.index in vertices
    bmesh.update_edit_mesh(obj.data)
