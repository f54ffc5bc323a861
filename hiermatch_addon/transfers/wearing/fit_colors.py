# SPDX-License-Identifier: GPL-3.0-or-later
"""Colors of fitted clothes: how they lie on the body, as color attributes."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

import numpy as np

from ...common.access import mesh_of
from ...scene.mesh_io import add_colors

if TYPE_CHECKING:
    import bpy

    from ....engine import FittedItem

FIT_ITEMS: Final = (
    ("DISTANCE", "Distance to Skin", "Show how far clothes are from the skin, from white to dark red; blue is inside"),
    ("PUSHED", "Pushed", "Show how far clothes were pushed out of the skin, from white (not at all) to dark red"),
    ("UNCERTAIN", "Uncertain", "Show where the fit is uncertain, from white (nowhere) to dark red"),
)
"""Identifier, name and description of what the colors show."""

FIT_NAMES: Final = {identifier: name for identifier, name, _ in FIT_ITEMS}
"""For each what its color attribute is called."""


def carriers_of_fit(view_layer: bpy.types.ViewLayer) -> list[bpy.types.Object]:
    """Return the meshes in a view layer that carry these colors."""
    meshes = [obj for obj in view_layer.objects if obj is not None and obj.type == "MESH"]
    return [obj for obj in meshes if _carries(mesh_of(obj))]


def drop_colors(obj: bpy.types.Object) -> None:
    """Take these colors from a copy, which show how its original fitted."""
    mesh = mesh_of(obj)
    for name in FIT_NAMES.values() if _carries(mesh) else ():
        mesh.attributes.remove(mesh.attributes[name])


def _carries(mesh: bpy.types.Mesh) -> bool:
    """Tell whether a mesh carries all of these colors."""
    return all(name in mesh.color_attributes for name in FIT_NAMES.values())


def write_colors(obj: bpy.types.Object, fitted: FittedItem) -> None:
    """Write color attributes: distance to the skin, how far each vertex was pushed, and where it is uncertain."""
    unit = max(float(np.quantile(np.abs(fitted.clearance), 0.95)), 1e-12)
    pushed = fitted.pushed / max(float(fitted.pushed.max(initial=0.0)), 1e-12)
    shown = ((fitted.clearance / unit).clip(0, 1), pushed, 1 - fitted.confidence.clip(0, 1))
    inside = fitted.clearance < 0
    mesh = mesh_of(obj)
    for name, values in zip(FIT_NAMES.values(), shown, strict=True):
        colors = np.ones((len(values), 4), np.float32)
        # From white over orange to dark red; what is inside the skin is blue.
        colors[:, 0], colors[:, 1], colors[:, 2] = 1 - 0.5 * values**2, 1 - 0.9 * values, (1 - values) ** 2
        if name == FIT_NAMES["DISTANCE"]:
            colors[inside] = (0.05, 0.1, 0.9, 1.0)
        if name in mesh.attributes:
            mesh.attributes.remove(mesh.attributes[name])
        add_colors(mesh, name, colors)
