# SPDX-License-Identifier: GPL-3.0-or-later
"""Picked vertices: by a selection, by empties, or by a click into the viewport."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, cast

import numpy as np

from ...common.access import mesh_of, view_layer_of
from ...common.errors import ObjectError
from ...scene.character import parts_of, vertex_ranges
from ...scene.mesh_io import vertex_positions
from ...storage.landmark_layer import selected_vertices

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    import bpy
    from mathutils import Vector
    from numpy.typing import NDArray

    from ...scene.character import Side

_OFF = 0.1
"""How far from where the surface was hit the nearest vertex may be, in diagonals of the mesh's bounding box."""

_RINGS = 3
"""On so many circles around a click is looked for what was meant."""


@dataclass(frozen=True)
class Hit:
    """Where a ray meets one of some meshes first.

    Attributes
    ----------
    obj : bpy.types.Object
        The object that is hit.
    vertex : int
        The vertex that is nearest to the place.
    """

    obj: bpy.types.Object
    vertex: int


def selected_pair(source: Side, target: Side) -> tuple[int, int]:
    """Return the vertex that is selected on each of two meshes in Edit Mode.

    Raises
    ------
    ObjectError
        If it is not one on each.
    """
    vertices = []
    for obj in (source, target):
        parts = [(part, own.start) for part, own in zip(parts_of(obj), vertex_ranges(obj), strict=True)]
        edited = [(part, start) for part, start in parts if part.mode == "EDIT"]
        if not edited:
            raise ObjectError(
                f'"{obj.name}" is not in Edit Mode. Select both meshes, enter Edit Mode, and select one vertex on each.'
            )
        selected = [start + vertex for part, start in edited for vertex in selected_vertices(part)]
        if len(selected) != 1:
            raise ObjectError(
                f'{len(selected) or "No"} vertices of "{obj.name}" are selected. Select exactly one vertex on each of '
                "the two meshes."
            )
        vertices += selected
    return vertices[0], vertices[1]


def selected_empties(context: bpy.types.Context) -> list[bpy.types.Object]:
    """Return the empties that are selected."""
    return [obj for obj in view_layer_of(context).objects.selected if obj.type == "EMPTY"]


def vertices_at_empties(context: bpy.types.Context, source: Side, target: Side) -> tuple[int, int]:
    """Return the vertices that are nearest to two selected empties, each on the mesh that it is near to.

    Raises
    ------
    ObjectError
        If not exactly two are selected.
    """
    empties = selected_empties(context)
    if len(empties) != 2:
        raise ObjectError(
            "It is open which vertices correspond. Select one vertex on each mesh in Edit Mode, or two empties near "
            "the surfaces in Object Mode, or click on them with Pick Landmarks."
        )
    places = np.array([empty.matrix_world.translation for empty in empties], np.float64)
    found = [
        _nearest(np.concatenate([shown_positions(context, part) for part in parts_of(side)]), places)
        for side in (source, target)
    ]
    (on_source, far_source), (on_target, far_target) = found
    if far_source[0] + far_target[1] <= far_source[1] + far_target[0]:
        return int(on_source[0]), int(on_target[1])
    return int(on_source[1]), int(on_target[0])


def places_around(reach: float) -> Iterator[tuple[float, float]]:
    """Give the places within a distance at which to look for what was meant by a click, the nearest first."""
    yield 0.0, 0.0
    for ring in range(1, _RINGS + 1):
        for angle in np.arange(8 * ring) * np.pi / (4 * ring):
            yield float(np.cos(angle)) * reach * ring / _RINGS, float(np.sin(angle)) * reach * ring / _RINGS


def cast_ray(
    context: bpy.types.Context,
    objects: Sequence[bpy.types.Object],
    origin: Vector,
    direction: Vector,
    viewport: bpy.types.SpaceView3D | None = None,
) -> Hit | None:
    """Find the vertex that is meant by a click: the nearest one to where a ray in world space meets the meshes first.

    What is hidden, or not in Local View in the viewport if there is one, is not met.

    Raises
    ------
    ObjectError
        If modifiers show the mesh too far away from its own vertices, as Mirror does with one half.
    """
    depsgraph = context.evaluated_depsgraph_get()
    best: tuple[float, bpy.types.Object, Vector] | None = None
    for obj in objects:
        if not obj.visible_get(view_layer=view_layer_of(context), **({"viewport": viewport} if viewport else {})):
            continue
        shown = obj.evaluated_get(depsgraph)
        inverse = shown.matrix_world.inverted_safe()
        start = inverse @ origin
        hit, place, _, _ = cast("Any", shown).ray_cast(start, (inverse @ (origin + direction) - start).normalized())
        if hit:
            world = shown.matrix_world @ place
            distance = (world - origin).length
            if best is None or distance < best[0]:
                best = distance, obj, world
    if best is None:
        return None
    _, obj, world = best
    positions = shown_positions(context, obj)
    vertices, distances = _nearest(positions, np.array([world], np.float64))
    if distances[0] > _OFF * float(np.linalg.norm(np.ptp(positions, axis=0))):
        if any(modifier.type == "MIRROR" and modifier.show_viewport for modifier in obj.modifiers):
            raise ObjectError(
                f'That place of "{obj.name}" is shown by its Mirror modifier. Click on the half that is a mesh, or '
                "apply the modifier first."
            )
        raise ObjectError(
            f'The modifiers of "{obj.name}" show it far away from its own vertices. Disable them in the viewport, or '
            "select a vertex on each mesh in Edit Mode."
        )
    return Hit(obj, int(vertices[0]))


def shown_positions(context: bpy.types.Context, obj: bpy.types.Object) -> NDArray[np.float64]:
    """Return where the vertices of a mesh are in the world, (n, 3).

    That is where shape keys and modifiers show them, unless these change how many vertices there are.
    """
    shown = obj.evaluated_get(context.evaluated_depsgraph_get())
    positions = vertex_positions(mesh_of(shown))
    if len(positions) != len(mesh_of(obj).vertices):
        positions = vertex_positions(mesh_of(obj))
    matrix = np.array(shown.matrix_world, np.float64)
    return positions.astype(np.float64) @ matrix[:3, :3].T + matrix[:3, 3]


def _nearest(
    positions: NDArray[np.float64], places: NDArray[np.float64]
) -> tuple[NDArray[np.int64], NDArray[np.float64]]:
    """Find the nearest of some positions (n, 3) to each of a few places (k, 3), and how far away it is, (k,) each."""
    distances = np.array([np.linalg.norm(positions - place, axis=1) for place in places])
    return distances.argmin(axis=1), distances.min(axis=1)
