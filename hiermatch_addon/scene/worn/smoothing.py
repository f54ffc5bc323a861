# SPDX-License-Identifier: GPL-3.0-or-later
"""The surface that Subdivision shows: it lies inside of the cage that a mesh's own vertices make."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

import numpy as np

from ....engine import TriangleMesh
from ...common.access import mesh_of
from ..character import parts_of, read_surface, vertex_count
from ..mesh_io import TOPOLOGY_MODIFIERS, rest_matrix, vertex_positions, without_modifiers

if TYPE_CHECKING:
    import bpy
    from numpy.typing import NDArray

    from ..character import Side

_SUBDIVISION: Final = "SUBSURF"

_PART: Final = 0.5
"""How far the cage's vertices are taken to where Subdivision shows them, from 0 to 1.  Around a limb of n vertices they
are shown (2 pi / n)^2 / 6 of its radius lower, and faces between them would be another half of that lower on average.
So half of the way the faces lie where the surface is seen, neither above nor below."""


def seen_surface(context: bpy.types.Context, side: Side) -> TriangleMesh:
    """Read a side at rest with its faces where its surface is seen; see `read_surface`."""
    cage = read_surface(side, context.evaluated_depsgraph_get(), use_modifiers=False)
    return moved_mesh(cage, smoothing_offsets(context, side))


def moved_mesh(mesh: TriangleMesh, offsets: NDArray[np.float64]) -> TriangleMesh:
    """Return a mesh with its vertices moved by offsets (n, 3)."""
    return TriangleMesh(mesh.vertices + offsets, mesh.triangles) if offsets.any() else mesh


def smoothing_offsets(context: bpy.types.Context, side: Side, *, posed: bool = False) -> NDArray[np.float64]:
    """Find how far from the vertices of a side the surface is seen that Subdivision makes of it in the world, (n, 3).

    At rest, or as the modifiers that deform it have `posed` it.
    """
    parts = [part for part in parts_of(side) if _is_subdivided(part)]
    if not parts:
        return np.zeros((vertex_count(side), 3))

    def is_off(kind: str) -> bool:
        return kind in TOPOLOGY_MODIFIERS or not posed

    with without_modifiers(context, parts, lambda kind: is_off(kind) and kind != _SUBDIVISION):
        seen = [_vectors(context, part, posed=posed) for part in parts]
    with without_modifiers(context, parts, is_off):
        cages = [_vectors(context, part, posed=posed) for part in parts]
    found = {
        part: _PART * (shown[: len(cage)] - cage)  # of what Subdivision makes the cage's own vertices are the first
        for part, shown, cage in zip(parts, seen, cages, strict=True)
        if len(cage) == len(mesh_of(part).vertices)  # else a driver keeps a modifier on
    }
    return np.concatenate([found.get(part, np.zeros((vertex_count(part), 3))) for part in parts_of(side)])


def _is_subdivided(obj: bpy.types.Object) -> bool:
    """Tell whether Subdivision is shown."""
    return any(modifier.type == _SUBDIVISION and modifier.show_viewport for modifier in obj.modifiers)


def _vectors(context: bpy.types.Context, obj: bpy.types.Object, *, posed: bool) -> NDArray[np.float64]:
    """Read the vertices of an object as it is evaluated now, from its origin in the world, (k, 3)."""
    shown = obj.evaluated_get(context.evaluated_depsgraph_get())
    matrix = np.array(shown.matrix_world if posed else rest_matrix(obj) or shown.matrix_world, np.float64)
    try:
        return vertex_positions(shown.to_mesh()).astype(np.float64) @ matrix[:3, :3].T
    finally:
        shown.to_mesh_clear()
