# SPDX-License-Identifier: GPL-3.0-or-later
"""The body below clothes: drawn in by a shape key, or hidden by a mask."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, cast

import numpy as np
from scipy.sparse import csr_array

from ....engine import ClosestPoints, TriangleMesh
from ...common.access import mesh_of, view_layer_of
from ...scene.character import parts_of, vertex_ranges
from ...scene.deform_layer import write_weights
from ...scene.shape_key_io import KeySettings, add_keys, keys_of
from ...scene.worn.fitted_copies import COVERED, ITEM, fitted_to
from ...scene.worn.smoothing import seen_surface

if TYPE_CHECKING:
    from collections.abc import Collection, Sequence

    import bpy
    from numpy.typing import NDArray

    from ...scene.character import Side

_REACH = 0.03
"""How far above the skin, in the root of the body's area, clothes are looked for."""

_STRAIGHT = 0.6
"""Least cosine between the way from the skin to the clothes and the skin's normal."""

_DEPTH = 0.006
"""How far the key draws the skin in, in the same unit: about 8 mm on a human."""


def covered_vertices(
    body: TriangleMesh, items: Sequence[tuple[NDArray[np.float64], NDArray[np.int64]]]
) -> NDArray[np.bool_]:
    """Tell which vertices of a body lie below clothes with all that is around them, (n,).

    Parameters
    ----------
    body : TriangleMesh
        The body.
    items : sequence of tuple
        Vertices and triangles of each item.
    """
    reach = _REACH * float(np.sqrt(body.area))
    covered = np.zeros(body.vertex_count, bool)
    for vertices, triangles in items:
        cloth = TriangleMesh(vertices, triangles)
        low, high = vertices.min(axis=0) - reach, vertices.max(axis=0) + reach
        near = np.flatnonzero(((body.vertices > low) & (body.vertices < high)).all(axis=1))
        if not len(near):
            continue
        found = ClosestPoints(cloth).nearest(body.vertices[near])
        feet = np.einsum("kc,kci->ki", found.barycentric, cloth.vertices[cloth.triangles[found.triangles]])
        away = feet - body.vertices[near]
        distance = np.sqrt(found.squared_distances)
        straight = np.einsum("ki,ki->k", away, body.vertex_normals[near]) >= _STRAIGHT * distance
        covered[near[(distance < reach) & straight]] = True
    # Two rings further in: the rim of what is covered stays, so that no gap shows at hems.
    for _ in range(2):
        tails, heads = body.edges.T
        open_ends = np.zeros(body.vertex_count, bool)
        open_ends[tails[~covered[heads]]] = True
        open_ends[heads[~covered[tails]]] = True
        covered &= ~open_ends
    return covered


def worn_already(
    context: bpy.types.Context, body: Side, made: Collection[bpy.types.Object]
) -> list[tuple[NDArray[np.float64], NDArray[np.int64]]]:
    """Return vertices and triangles of what a body wears beside what was made just now: its other copies in sight."""
    layer = view_layer_of(context)
    worn = [obj for obj in fitted_to(body) if obj not in made and ITEM in cast("Any", obj)]
    meshes = [seen_surface(context, obj) for obj in worn if obj.visible_get(view_layer=layer)]
    return [(mesh.vertices, mesh.triangles) for mesh in meshes]


def cover_body(
    context: bpy.types.Context,
    body: Side,
    items: Sequence[tuple[NDArray[np.float64], NDArray[np.int64]]],
    how: str,
) -> None:
    """Draw the body in below clothes by a shape key ("KEY"), or hide it there by a Mask modifier ("MASK").

    It takes the place of what did so before, in either way.
    """
    mesh = seen_surface(context, body)
    covered = covered_vertices(mesh, items)
    inwards = -_DEPTH * float(np.sqrt(mesh.area)) * mesh.vertex_normals * covered[:, None]
    for part, own in zip(parts_of(body), vertex_ranges(body), strict=True):
        _uncover(part, kept=how if covered[own].any() else "")
        if not covered[own].any():
            continue
        if how == "KEY":
            into = np.linalg.inv(np.array(part.matrix_world, np.float64))[:3, :3]
            keys = keys_of(part)
            before = None if keys is None else keys.key_blocks.get(COVERED)
            settings = KeySettings(COVERED, value=1.0) if before is None else KeySettings.of(before, ())
            add_keys(part, [settings], (inwards[own] @ into.T)[None])
            continue
        write_weights(part, [COVERED], csr_array(covered[own, None].astype(float)))
        modifier: Any = part.modifiers.get(COVERED) or part.modifiers.new(COVERED, "MASK")
        modifier.vertex_group, modifier.invert_vertex_group = COVERED, True
        mesh_of(part).update()


def _uncover(part: bpy.types.Object, *, kept: str) -> None:
    """Take from a part of a body what drew it in below clothes, or hid it there, but for the one that is kept."""
    mask = part.modifiers.get(COVERED)
    if kept != "MASK" and mask is not None and mask.type == "MASK":
        part.modifiers.remove(mask)
        group = part.vertex_groups.get(COVERED)
        if group is not None and not any(getattr(one, "vertex_group", "") == COVERED for one in part.modifiers):
            part.vertex_groups.remove(group)
    keys = keys_of(part)
    drawn = None if keys is None else keys.key_blocks.get(COVERED)
    if kept != "KEY" and drawn is not None:
        part.shape_key_remove(drawn)
