# SPDX-License-Identifier: GPL-3.0-or-later
"""The picture of docs/symmetric-tools.md.

    symmetrised.jpg  a walking cat with colors and weights on its left; the right side gets the same, in its own pose

`tools/screenshots.py` takes it.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import bpy
from camera import Caption, seen
from manual_scenes import paint_left_side, weigh_left_leg
from screen import fold, set_scene, show_panels, view

if TYPE_CHECKING:
    from collections.abc import Iterator

    from camera import Box, Camera, Pixels

_COAT = "Coat"
_LEGS = ("Foreleg.L", "Foreleg.R")


def pictures(camera: Camera) -> Iterator[float | None]:
    """Paint and weigh one side, and take it to the other."""
    set_scene()
    state = bpy.context.scene.hiermatch
    cat = state.target
    state.source.hide_set(state=True)
    bpy.context.view_layer.objects.active = cat
    paint_left_side(cat, _COAT)
    weigh_left_leg(cat, _LEGS[0])
    fold()
    show_panels("Symmetry")
    view()["space_data"].shading.color_type = "VERTEX"
    yield None
    box = seen([cat])
    colors: list[Pixels] = []
    weights: list[Pixels] = []
    yield from look(camera, box, "Painted on the left", colors)
    yield from look_at_weights(camera, box, _LEGS[0], weights)
    with bpy.context.temp_override(**view()):
        bpy.ops.hiermatch.symmetrise(object=cat.name)
    yield from look(camera, box, "After Symmetrise", colors)
    yield from look_at_weights(camera, box, _LEGS[1], weights)
    camera.save("symmetrised", [colors, weights])


def look_at_weights(camera: Camera, box: Box, group: str, looks: list[Pixels]) -> Iterator[float | None]:
    """Look at the weights of a vertex group of the active object in Weight Paint."""
    groups: Any = bpy.context.view_layer.objects.active.vertex_groups
    groups.active = groups[group]
    with bpy.context.temp_override(**view()):
        bpy.ops.object.mode_set(mode="WEIGHT_PAINT")
    yield from look(camera, box, f"Weights of {group}", looks)
    with bpy.context.temp_override(**view()):
        bpy.ops.object.mode_set(mode="OBJECT")


def look(camera: Camera, box: Box, text: str, looks: list[Pixels]) -> Iterator[float | None]:
    """Look at a part of the viewport, with a text over it."""
    caption = Caption()
    caption.show(text, box)
    yield None
    looks.append(camera.look(box))
    caption.hide()
