# SPDX-License-Identifier: GPL-3.0-or-later
"""The content of the overlay: read from the lists and from the meshes as they are shown."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, cast

import numpy as np

from ..common.access import mesh_of
from ..properties.panel_state import picked
from ..properties.steering_lists import steered_pair
from ..scene.character import parts_of
from ..scene.mesh_io import vertex_positions
from .overlay_data import Drawing, Marks, Places, Shown, drawing, place

if TYPE_CHECKING:
    import bpy
    from numpy.typing import NDArray

    from ..scene.character import Side


def settings(
    scene: bpy.types.Scene, view_layer: bpy.types.ViewLayer, pending: tuple[str, int] | None
) -> tuple[object, ...] | None:
    """Return what is the same as long as the same is to be shown of the same objects; None if nothing is."""
    owner: Any = scene
    steering, state = owner.hiermatch_steering, owner.hiermatch
    if not steering.show_overlay:
        return None
    return (
        scene.session_uid,
        view_layer.name,
        *(None if chosen is None else chosen.session_uid for chosen in picked(state)),
        *(getattr(state.summary, name) for name in ("key", "prefix", "source", "target", "swapped")),
        steering.revision,
        steering.show_points,
        steering.show_lines,
        steering.show_labels,
        steering.pair_index,
        steering.landmark_index,
        pending,
    )


def signature(scene: bpy.types.Scene) -> tuple[object, ...] | None:
    """Return what is the same as long as the same objects lie in the same places; None if there are none."""
    pair = steered_pair(scene)
    if pair is None:
        return None
    return (
        *(part.session_uid for side in pair for part in parts_of(side)),
        *(part.visible_get() for side in pair for part in parts_of(side)),
        *(tuple(row) for side in pair for part in parts_of(side) for row in cast("Any", part.matrix_world)),
    )


def drawn_objects(scene: bpy.types.Scene) -> frozenset[int]:
    """Return by what numbers Blender knows the objects whose vertices are read for a scene."""
    return frozenset(part.session_uid for side in steered_pair(scene) or () for part in parts_of(side))


def read_drawing(scene: bpy.types.Scene, depsgraph: bpy.types.Depsgraph, pending: tuple[str, int] | None) -> Drawing:
    """Compute what is to be drawn for a scene; nothing while one of the two meshes is hidden or being edited."""
    owner: Any = scene
    steering, pair = owner.hiermatch_steering, steered_pair(scene)
    if pair is None or not all(part.visible_get() for side in pair for part in parts_of(side)):
        return Drawing()
    positions, matrices = zip(*(_shown_side(side, depsgraph) for side in pair), strict=True)
    marks, rows = [], (steering.pairs, steering.landmarks)
    for number, (items, chosen) in enumerate(zip(rows, (steering.pair_index, steering.landmark_index), strict=True)):
        read = _places if number == 0 else _at_vertices
        source, target = (
            place(positions[side], read(items, role), matrices[side]) for side, role in enumerate(("source", "target"))
        )
        marks.append(Marks(source, target, _numbers(items, "number", np.int32), min(chosen, len(items) - 1)))
    side = -1 if pending is None else next((n for n, obj in enumerate(pair) if obj.name == pending[0]), -1)
    if pending is None or side < 0 or pending[1] >= len(positions[side]):  # another pair is picked, or it was edited
        waiting = None
    else:
        vertex = np.full((1, 3), pending[1], np.int64)
        x, y, z = place(positions[side], Places(vertex, np.array([[1.0, 0.0, 0.0]])), matrices[side])[0].tolist()
        waiting = (x, y, z)
    return drawing(
        marks[0],
        _numbers(steering.pairs, "distortion", np.float32),
        marks[1],
        _numbers(steering.landmarks, "use", np.bool_),
        Shown(steering.show_points, steering.show_lines, steering.show_labels),
        pending=waiting,
    )


def _shown_side(side: Side, depsgraph: bpy.types.Depsgraph) -> tuple[NDArray[np.float32], NDArray[np.float64]]:
    """Read where the vertices of a side are and its matrix: of several objects, positions in the world."""
    shown = [_shown(part, depsgraph) for part in parts_of(side)]
    if len(shown) == 1:
        return shown[0]
    world = [positions @ matrix[:3, :3].T + matrix[:3, 3] for positions, matrix in shown]
    return np.concatenate(world).astype(np.float32), np.eye(4)


def _shown(obj: bpy.types.Object, depsgraph: bpy.types.Depsgraph) -> tuple[NDArray[np.float32], NDArray[np.float64]]:
    """Read where the vertices of an object are, with shape keys and modifiers if these keep their number."""
    shown = obj.evaluated_get(depsgraph)
    positions, own = vertex_positions(mesh_of(shown)), mesh_of(obj)
    if len(positions) != len(own.vertices):
        positions = vertex_positions(own)
    return positions, np.array(shown.matrix_world, np.float64)


def _places(items: Any, role: str) -> Places:  # noqa: ANN401 - a collection property
    """Read where matched points are."""
    corners = _numbers(items, f"{role}_corners", np.int32, 3).reshape(-1, 3)
    return Places(corners.astype(np.int64), _numbers(items, f"{role}_weights", np.float32, 3).reshape(-1, 3))


def _at_vertices(items: Any, role: str) -> Places:  # noqa: ANN401 - a collection property
    """Read where landmarks are."""
    vertices = _numbers(items, role, np.int32).astype(np.int64)
    return Places(np.repeat(vertices[:, None], 3, axis=1), np.tile([1.0, 0.0, 0.0], (len(vertices), 1)))


def _numbers(items: Any, name: str, kind: type[np.generic], width: int = 1) -> NDArray[Any]:  # noqa: ANN401
    """Read a property of all rows."""
    values = np.empty(len(items) * width, kind)
    if len(items):
        items.foreach_get(name, values)
    return values
