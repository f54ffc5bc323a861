# SPDX-License-Identifier: GPL-3.0-or-later
"""A mesh in another rest pose: its vertices and shape keys moved back by the bones that moved them."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from scipy.sparse import csr_array

from ....engine import unposed
from ...common.access import mesh_of
from ..armatures import moving_armatures
from ..character import parts_of, vertex_ranges
from ..pair import is_shared
from .pose_state import own_action

if TYPE_CHECKING:
    from collections.abc import Callable

    import bpy
    from numpy.typing import NDArray

    from ....engine import RestPose
    from ..character import Side


def plays_actions(armature: bpy.types.Object) -> bool:
    """Tell whether an armature has an action of its own, or strips of some."""
    animation = armature.animation_data
    tracks = animation.nla_tracks if animation is not None else ()
    return own_action(armature) is not None or any(len(track.strips) for track in tracks)


def why_not_to_rest(side: Side, armature: bpy.types.Object, weights: csr_array) -> str:
    """Say why a side cannot be brought to another rest pose of an armature; empty if it can."""
    others = [other.name for other in moving_armatures(side) if other != armature]
    if others:
        return f'"{side.name}" is moved by the armature "{others[0]}" as well'
    if weights.nnz == 0:
        return f'"{side.name}" has no weights for the bones of "{armature.name}"'
    shared = [part.name for part in parts_of(side) if is_shared(part)]
    if shared:
        return f'"{shared[0]}" shares its mesh data with other objects'
    return ""


def bring_to_rest(side: Side, weights: csr_array, rest: RestPose) -> None:
    """Move the vertices of all parts of a side, and of their shape keys, from the pose that they stand in to rest.

    Parameters
    ----------
    side : bpy.types.Object or Character
        What is moved, in Object Mode.
    weights : (n, b) csr_array of float
        How much each bone moves each vertex, from `bone_weights`.
    rest : RestPose
        How the bones move, in world space.
    """
    for part, own in zip(parts_of(side), vertex_ranges(side), strict=True):
        _bring_part(part, csr_array(weights[own.start : own.stop]), rest)


def _bring_part(obj: bpy.types.Object, weights: csr_array, rest: RestPose) -> None:
    mesh, matrix = mesh_of(obj), np.array(obj.matrix_world, np.float64)
    inverse = np.linalg.inv(matrix)

    def back(positions: NDArray[np.float64]) -> NDArray[np.float64]:
        world = unposed(positions @ matrix[:3, :3].T + matrix[:3, 3], weights, rest)
        return world @ inverse[:3, :3].T + inverse[:3, 3]

    _move(mesh.vertices, back)
    keys = mesh.shape_keys
    for key in keys.key_blocks if keys is not None else ():
        _move(key.data, back)
    mesh.update()


def _move(points: Any, back: Callable[[NDArray[np.float64]], NDArray[np.float64]]) -> None:  # noqa: ANN401 - of two kinds
    """Replace the coordinates of vertices, or of the points of a shape key."""
    flat = np.empty(3 * len(points), np.float32)
    points.foreach_get("co", flat)
    moved = back(flat.reshape(-1, 3).astype(np.float64))
    points.foreach_set("co", np.ascontiguousarray(moved, np.float32).ravel())
