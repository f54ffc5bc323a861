# SPDX-License-Identifier: GPL-3.0-or-later
"""The shape of a fitted item, as it is written on a copy of it, with what its shape keys do."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from ...common.access import mesh_of
from ..mesh_io import vertex_positions
from ..shape_key_io import key_positions, keys_of

if TYPE_CHECKING:
    import bpy
    from numpy.typing import NDArray

_ON_PLANE = 1e-4
"""How near a vertex is to the plane of a Mirror modifier, in the object's size, to be on it."""


def write_shape(
    obj: bpy.types.Object,
    original: bpy.types.Object,
    world: NDArray[np.float64],
    turned: NDArray[np.float64],
) -> None:
    """Give a fitted copy its shape, and its shape keys what they do to it.

    Parameters
    ----------
    obj, original : bpy.types.Object
        The copy and what it is a copy of.
    world : (n, 3) array of float
        Where its vertices belong in the world.
    turned : (n, 3, 3) array of float
        What offsets of its vertices go through in the world.
    """
    matrix = np.array(obj.matrix_world, np.float64)
    into = np.linalg.inv(matrix)
    local = world @ into[:3, :3].T + into[:3, 3]
    mesh = mesh_of(obj)
    keys = keys_of(obj)
    own = np.array(original.matrix_world, np.float64)[:3, :3]
    planes = mirror_axes(obj)
    rest = vertex_positions(mesh_of(original)).astype(np.float64)
    for axis, limit in planes:
        flat = np.abs(rest[:, axis]) <= limit
        local[flat, axis] = 0.0
    if keys is not None:
        reference = key_positions(keys.reference_key)
        for key in keys.key_blocks:
            offsets = key_positions(key) - reference
            moved = np.einsum("nij,nj->ni", turned, offsets @ own.T) @ into[:3, :3].T
            key.data.foreach_set("co", (local + moved).astype(np.float32).ravel())
    mesh.vertices.foreach_set("co", local.astype(np.float32).ravel())
    mesh.update()


def mirror_axes(obj: bpy.types.Object) -> list[tuple[int, float]]:
    """Return the axes along which a Mirror modifier mirrors about the object's origin, and how near is on the plane."""
    found = []
    size = max(obj.dimensions[axis] for axis in range(3)) or 1.0
    for modifier in obj.modifiers:
        mirror: Any = modifier
        if modifier.type == "MIRROR" and mirror.mirror_object is None:
            limit = max(mirror.merge_threshold if mirror.use_mirror_merge else 0.0, _ON_PLANE * size)
            found += [(axis, limit) for axis in range(3) if mirror.use_axis[axis]]
    return found
