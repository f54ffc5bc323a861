# SPDX-License-Identifier: GPL-3.0-or-later
"""What the manual shows beside the demo pair: cats that lost something, a scan of a cat, a coat of one side."""

from __future__ import annotations

from typing import TYPE_CHECKING

import bmesh
import bpy
import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray

__all__ = [
    "REAR",
    "add_rear_group",
    "cut_leg",
    "cut_rear",
    "cut_tail",
    "leave",
    "paint_left_side",
    "rest_positions",
    "to_scan",
    "vertex_near",
    "weigh_left_leg",
]

REAR = "Rear"
"""Name of the vertex group of a rear half."""

_REST = "hm_rest"
"""Attribute of the demo cats: where each vertex is in the rest pose, facing -Y, with the left on +X."""

_TAIL_FROM, _REAR_FROM, _LEG_BELOW = 0.75, 0.2, 0.5
"""Where tail and rear half begin on the Y axis of the rest pose, and the foreleg on the Z axis."""

_FORELEG_BEFORE, _SHOULDER, _FADING = -0.1, 0.75, 0.3
"""Where the forelegs are on the Y axis, where they end on the Z axis, and over what height their weights fade."""

_KEPT, _NOISE, _HOLES, _HOLE = 0.4, 0.003, 6, 0.025
"""Of a scan: share of the vertices, and noise, number and radius of the holes, in units of its largest extent."""


def rest_positions(cat: bpy.types.Object) -> NDArray[np.float32]:
    """Return where the vertices of a demo cat are in the rest pose, (n, 3)."""
    flat = np.empty(3 * len(cat.data.vertices), np.float32)
    cat.data.attributes[_REST].data.foreach_get("vector", flat)
    return flat.reshape(-1, 3)


def vertex_near(cat: bpy.types.Object, place: tuple[float, float, float]) -> int:
    """Return the vertex of a demo cat that is nearest to a place of the rest pose."""
    return int(np.linalg.norm(rest_positions(cat) - np.array(place), axis=1).argmin())


def cut_tail(cat: bpy.types.Object) -> None:
    """Cut the tail of a demo cat off."""
    _cut(cat, rest_positions(cat)[:, 1] > _TAIL_FROM)


def cut_leg(cat: bpy.types.Object) -> None:
    """Cut the left foreleg of a demo cat off."""
    x, y, z = rest_positions(cat).T
    _cut(cat, (x > 0) & (y < 0) & (z < _LEG_BELOW))


def leave(cat: bpy.types.Object, begin: float, end: float) -> None:
    """Leave of a demo cat only what lies between two places on the Y axis of the rest pose, open where it was cut."""
    along = rest_positions(cat)[:, 1]
    _cut(cat, (along < begin) | (along > end), close=False)


def _cut(cat: bpy.types.Object, lost: NDArray[np.bool_], *, close: bool = True) -> None:
    """Delete vertices, and close the wound if wanted."""
    build = bmesh.new()
    build.from_mesh(cat.data)
    bmesh.ops.delete(build, geom=[vertex for vertex in build.verts if lost[vertex.index]], context="VERTS")
    bmesh.ops.delete(build, geom=[vertex for vertex in build.verts if not vertex.link_faces], context="VERTS")
    if close:
        bmesh.ops.holes_fill(build, edges=[edge for edge in build.edges if edge.is_boundary], sides=0)
    build.to_mesh(cat.data)
    build.free()
    cat.data.update()


def cut_rear(cat: bpy.types.Object) -> None:
    """Leave the front half of a demo cat only."""
    _cut(cat, rest_positions(cat)[:, 1] > _REAR_FROM)


def add_rear_group(cat: bpy.types.Object) -> None:
    """Put the rear half of a demo cat into a vertex group."""
    rear = np.flatnonzero(rest_positions(cat)[:, 1] > _REAR_FROM)
    cat.vertex_groups.new(name=REAR).add(rear.tolist(), 1.0, "REPLACE")


def to_scan(cat: bpy.types.Object) -> None:
    """Make of a demo cat what a scanner would: fewer vertices, all of them a little off, and holes."""
    cat.modifiers.new("Decimate", "DECIMATE").ratio = _KEPT
    shown = cat.evaluated_get(bpy.context.evaluated_depsgraph_get())
    mesh = bpy.data.meshes.new_from_object(shown)
    cat.modifiers.clear()
    cat.data = mesh
    random = np.random.default_rng(1)
    places, normals = (np.empty(3 * len(mesh.vertices), np.float32) for _ in range(2))
    mesh.vertices.foreach_get("co", places)
    mesh.vertex_normals.foreach_get("vector", normals)
    extent = float(np.ptp(places.reshape(-1, 3), axis=0).max())
    noise = random.normal(scale=_NOISE * extent, size=(len(mesh.vertices), 1))
    places = places.reshape(-1, 3) + noise.astype(np.float32) * normals.reshape(-1, 3)
    mesh.vertices.foreach_set("co", places.ravel())
    centres = places[random.choice(len(places), _HOLES, replace=False)]
    far = np.linalg.norm(places[:, None] - centres, axis=2).min(axis=1) > _HOLE * extent
    build = bmesh.new()
    build.from_mesh(mesh)
    bmesh.ops.delete(build, geom=[vertex for vertex in build.verts if not far[vertex.index]], context="VERTS")
    build.to_mesh(mesh)
    build.free()
    mesh.update()


def weigh_left_leg(cat: bpy.types.Object, name: str) -> None:
    """Give a demo cat a vertex group with its left foreleg, which fades out towards the shoulder."""
    x, y, z = rest_positions(cat).T
    weights = np.where((x > 0) & (y < _FORELEG_BEFORE), np.clip((_SHOULDER - z) / _FADING, 0, 1), 0)
    group = cat.vertex_groups.new(name=name)
    for vertex in np.flatnonzero(weights).tolist():
        group.add([vertex], float(weights[vertex]), "REPLACE")


def paint_left_side(cat: bpy.types.Object, name: str) -> None:
    """Give a demo cat a color attribute: stripes of many colours on the left, grey on the right."""
    rest = rest_positions(cat)
    colors = np.full((len(rest), 4), 0.25, np.float32)
    left = rest[:, 0] > 0
    phase = 7.0 * rest[:, 1] + np.array([[0.0], [2.1], [4.2]])
    colors[:, :3] = np.where(left[:, None], 0.5 + 0.45 * np.cos(phase.T + 3.0 * rest[:, 2:]), 0.25)
    colors[:, 3] = 1.0
    attribute = cat.data.attributes.new(name, "FLOAT_COLOR", "POINT")
    attribute.data.foreach_set("color", colors.ravel())
    cat.data.attributes.active_color_name = name
    cat.data.update()
