# SPDX-License-Identifier: GPL-3.0-or-later
"""The picture of docs/wear.md.

    wear.jpg  a cat in a vest, boots and a hat, and a bare one; the other one in them; and from behind, posed

`tools/screenshots.py` takes it.
"""

from __future__ import annotations

import time
from typing import TYPE_CHECKING

import bmesh
import bpy
import numpy as np
from camera import Caption, seen
from manual_scenes import rest_positions
from mathutils import Matrix, Vector
from page_retargeting import pose
from screen import fold, look_at_selected, set_scene, show_panels, view

if TYPE_CHECKING:
    from collections.abc import Iterator

    from camera import Camera
    from numpy.typing import NDArray

_VEST, _BOOTS, _HAT = (0.75, 0.12, 0.1, 1.0), (0.1, 0.1, 0.13, 1.0), (0.13, 0.2, 0.55, 1.0)
_FUR = (0.8, 0.66, 0.5, 1.0), (0.55, 0.62, 0.75, 1.0)
"""Colours of the items, and of both cats."""

_ROUNDS = 12
"""How often the rims of cloth are smoothed."""

_TURN = 2.4
"""By how much the view is turned to see the dressed cat from its other side, in radians."""


def pictures(camera: Camera) -> Iterator[float | None]:
    """Dress the one cat, fit its clothes to the other one, and pose it in them."""
    set_scene(rigged=True)
    state = bpy.context.scene.hiermatch
    source, target = state.source, state.target
    fold()
    show_panels("Wear")
    space = view()["space_data"]
    space.shading.color_type = "OBJECT"
    source.color, target.color = _FUR
    items = _dress(source)
    for obj in bpy.data.objects:
        if obj.type == "ARMATURE":
            obj.hide_set(state=True)
    _look_at([source, target, *items])
    yield None
    box = seen([source, target, *items])
    caption, rows = Caption(), []
    yield from _captioned("Before", box, caption)
    rows.append([camera.look(box)])
    _wear(source, target, items)
    made = [obj for obj in bpy.data.objects if "hiermatch_body" in obj.keys()]  # noqa: SIM118 - an object is no mapping
    for obj in bpy.data.objects:
        obj.select_set(state=False)
        if obj.type == "ARMATURE":
            obj.hide_set(state=True)
    yield from _captioned("After", box, caption)
    panel = camera.panel()
    rows.append([camera.look(box)])
    for obj in (source, *items):
        obj.hide_set(state=True)
    pose(target)
    looks = []
    for turn, text in ((0.0, "Posed"), (_TURN, "From behind")):
        with bpy.context.temp_override(**view()):
            bpy.ops.view3d.view_orbit(angle=turn, type="ORBITLEFT")
        _look_at([target, *made])
        yield None
        yield from _captioned(text, seen([target, *made]), caption)
        looks.append(camera.look(seen([target, *made])))
    caption.hide()
    camera.save_beside("wear", [*rows, looks], panel)


def _captioned(text: str, box: object, caption: Caption) -> Iterator[float | None]:
    caption.show(text, box)
    yield None


def _look_at(objects: list[bpy.types.Object]) -> None:
    """Turn the view to objects, none of which is selected then."""
    for obj in objects:
        obj.select_set(state=True)
    look_at_selected()
    for obj in objects:
        obj.select_set(state=False)


def _wear(source: bpy.types.Object, target: bpy.types.Object, items: list[bpy.types.Object]) -> None:
    """Press Wear; the panel then tells the processor's time, not that of a machine with other things to do."""
    bpy.context.view_layer.objects.active = items[-1]
    start = time.process_time()
    with bpy.context.temp_override(**view()):
        bpy.ops.hiermatch.wear(source=source.name, target=target.name, items=[{"name": item.name} for item in items])
    bpy.context.scene.hiermatch_retarget.report.seconds = time.process_time() - start


def _dress(cat: bpy.types.Object) -> list[bpy.types.Object]:
    """Give a demo cat a vest, boots and a hat."""
    x, y, z = rest_positions(cat).T
    body = (y > -0.42) & (y < 0.22) & (z > 0.5)
    vest = _cloth(cat, "Vest", body, 0.022, _VEST)
    boots = _cloth(cat, "Boots", (z < 0.2) & (y < 0.75), 0.02, _BOOTS)
    return [vest, boots, _hat(cat, (z > 1.3) & (np.abs(x) < 0.07))]


def _cloth(
    cat: bpy.types.Object, name: str, chosen: NDArray[np.bool_], away: float, color: tuple[float, ...]
) -> bpy.types.Object:
    """Make cloth of the skin at some vertices, so far away from it and bound as it is."""
    cloth = cat.copy()
    cloth.data, cloth.name = cat.data.copy(), name
    bpy.context.scene.collection.objects.link(cloth)
    build = bmesh.new()
    build.from_mesh(cloth.data)
    build.normal_update()
    for vertex in build.verts:
        vertex.co += away * vertex.normal
    lost = [vertex for vertex, kept in zip(build.verts, chosen, strict=True) if not kept]
    bmesh.ops.delete(build, geom=lost, context="VERTS")
    rim = [edge for edge in build.edges if edge.is_boundary]
    for _ in range(_ROUNDS):
        sums = {vertex: Vector() for edge in rim for vertex in edge.verts}
        for first, second in (edge.verts for edge in rim):
            sums[first] += second.co / 2
            sums[second] += first.co / 2
        for vertex, mean in sums.items():
            vertex.co = (vertex.co + mean) / 2
    build.to_mesh(cloth.data)
    build.free()
    return _finished(cloth, color)


def _hat(cat: bpy.types.Object, top: NDArray[np.bool_]) -> bpy.types.Object:
    """Put a pointed hat with a pompon on the top of the head, as a child of the bone."""
    mesh = bpy.data.meshes.new("Hat")
    build = bmesh.new()
    bmesh.ops.create_cone(build, segments=24, cap_ends=False, radius1=0.15, radius2=0.01, depth=0.4)
    bmesh.ops.create_uvsphere(
        build, u_segments=16, v_segments=8, radius=0.045, matrix=Matrix.Translation((0.0, 0.0, 0.2))
    )
    build.to_mesh(mesh)
    build.free()
    mesh.shade_smooth()
    hat = bpy.data.objects.new("Hat", mesh)
    bpy.context.scene.collection.objects.link(hat)
    hat.hiermatch_wear.fit = "RIGID"
    places = np.array([cat.matrix_world @ vertex.co for vertex in cat.data.vertices])[top]
    hat.matrix_world = Matrix.Translation(Vector(places.mean(axis=0)) + Vector((0.0, 0.0, 0.16)))
    rig = next(modifier.object for modifier in cat.modifiers if modifier.type == "ARMATURE")
    stands = hat.matrix_world.copy()
    hat.parent, hat.parent_type, hat.parent_bone = rig, "BONE", "head"
    hat.matrix_world = stands
    bpy.context.view_layer.update()
    return _finished(hat, _HAT)


def _finished(item: bpy.types.Object, color: tuple[float, ...]) -> bpy.types.Object:
    item.data.materials.clear()
    item.color = color
    return item
