# SPDX-License-Identifier: GPL-3.0-or-later
"""The pictures of docs/steering.md.

    half-a-cat.jpg    a match with the front half of a cat: of the rear half, nothing is found
    leave-out.jpg     the same with the rear half left out
    pick.jpg          a landmark is picked by two clicks; the status bar and the panel after them
    pairs.jpg         the matched points with lines between partners, and their list
    refine.jpg        a paw of the source, and of the target before and after Refine with one landmark

`tools/screenshots.py` takes them.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import bpy
from camera import Box, Caption, place_of, seen
from manual_scenes import REAR, add_rear_group, cut_leg, cut_rear, vertex_near
from mathutils import Vector
from screen import fold, set_scene, show_panels, view
from window_events import click, key, press

if TYPE_CHECKING:
    from collections.abc import Iterator

    from camera import Camera, Pixels

_NOSE = (0.0, -1.1, 1.15)
_RIGHT_TOES = (-0.1, -0.6, 0.03)
_HIP = (-0.15, 0.4, 0.8)
"""Places of a demo cat in the rest pose."""


def pictures(camera: Camera) -> Iterator[float | None]:
    """Go through the ways to correct a match, one after the other."""
    yield from leave_out(camera)
    yield from pick(camera)
    yield from refine(camera)


def leave_out(camera: Camera) -> Iterator[float | None]:
    """Match a cat to the front half of one, and leave the rear half out."""
    state = start()
    cut_rear(state.target)
    add_rear_group(state.source)
    fold("hiermatch_regions")
    show_panels("HierMatch")
    match_and_show("MATCH")
    yield None
    camera.take_with_panel("half-a-cat", [state.source, state.target])
    state.exclude_source = REAR
    match_and_show("MATCH", exclude_source=REAR)
    yield None
    camera.take_with_panel("leave-out", [state.source, state.target])
    state.exclude_source = ""


def pick(camera: Camera) -> Iterator[float | None]:
    """Name the nose of both cats by clicks."""
    state = start()
    fold()
    show_panels("HierMatch", "Landmarks")
    yield None
    bottom = status_bar()
    press(bpy.ops.hiermatch.pick_landmarks)
    yield None
    rows = []
    for cat in (state.source, state.target):
        click(*place_of(cat.matrix_world @ cat.data.vertices[vertex_near(cat, _NOSE)].co))
        yield None
        look = camera.look(seen([state.source, state.target]))
        status, panel = camera.look(bottom), camera.panel()
        rows += [[look, panel[: len(look)]], [status]]
    key("RET")
    yield None
    camera.save("pick", rows)


def refine(camera: Camera) -> Iterator[float | None]:
    """Match a cat that lost a leg, and set the toes of the other one right."""
    state = start()
    cut_leg(state.target)
    show_panels("HierMatch", "Matched Points")
    match_and_show("MATCH")
    steering: Any = bpy.context.scene.hiermatch_steering
    steering.show_overlay = True
    yield None
    camera.take_with_panel("pairs", [state.source, state.target])
    steering.show_overlay = False
    show("CHECKER")
    toes = [vertex_near(cat, _RIGHT_TOES) for cat in (state.source, state.target)]
    looks: list[Pixels] = []
    yield from look_at_paw(camera, state.source, toes[0], "The source", looks)
    yield from look_at_paw(camera, state.target, toes[1], "The target", looks)
    with bpy.context.temp_override(**view()):
        bpy.ops.hiermatch.add_landmark(source_vertex=toes[0], target_vertex=toes[1])
        bpy.ops.hiermatch.refine()
    show("CHECKER")
    yield from look_at_paw(camera, state.target, toes[1], "After Refine", looks)
    camera.save("refine", [looks])


def look_at_paw(
    camera: Camera, cat: bpy.types.Object, vertex: int, text: str, looks: list[Pixels]
) -> Iterator[float | None]:
    """Look at a vertex from near, with a text over it."""
    eye = view()["space_data"].region_3d
    eye.view_location = cat.matrix_world @ cat.data.vertices[vertex].co
    heading = cat.matrix_world.to_3x3() @ (cat.data.vertices[vertex].co - cat.data.vertices[vertex_near(cat, _HIP)].co)
    eye.view_rotation = Vector((heading.x, heading.y, 0.5 * heading.length)).to_track_quat("Z", "Y")
    eye.view_distance = 0.3 * cat.dimensions.length
    yield None
    x, y = place_of(eye.view_location)
    box, caption = Box(x - 180, y - 100, x + 180, y + 240), Caption()
    caption.show(text, box)
    yield None
    looks.append(camera.look(box))
    caption.hide()


def start() -> Any:  # noqa: ANN401 - a property group
    """Begin anew with the demo pair."""
    set_scene()
    bpy.context.scene.hiermatch_steering.show_overlay = False
    return bpy.context.scene.hiermatch


def status_bar() -> Box:
    """Return where the status bar is."""
    window = view()["window"]
    return Box(0, 0, min(window.width, 1000), 22)


def match_and_show(name: str, **options: object) -> None:
    """Match the pair without a pause, and show it in colors."""
    with bpy.context.temp_override(**view()):
        bpy.ops.hiermatch.match(**options)
    bpy.context.scene.hiermatch.summary.seconds = 0.0  # it says nothing about other machines: the panel leaves it out
    show(name)


def show(name: str) -> None:
    """Press one of the buttons under Show."""
    with bpy.context.temp_override(**view()):
        bpy.ops.hiermatch.show(view=name)
