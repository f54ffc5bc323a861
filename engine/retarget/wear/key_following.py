# SPDX-License-Identifier: GPL-3.0-or-later
"""Shape keys of clothes that follow those of the body: a wide belly, breasts, a squat."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from scipy.sparse import csr_array

from ...mesh.surface_map import SurfaceMap
from ...mesh.triangle_mesh import TriangleMesh
from ...runtime.arrays import Bools, Floats
from ...runtime.background import can_go_beside
from ...runtime.errors import MeshError
from ...runtime.progress import Progress, Steps, within
from .wearing import DressedItem, dressed_steps, fitted_steps
from .worn_item import WornItem

_STILL = 0.001
"""Part of the root of the body's area that a key has to move an item by somewhere for the item to follow: about 1.4 mm
on a human, below which glasses would tremble at each blink."""

_NOTHING = 1e-5
"""Motion in the same unit that is none: what rounding leaves of what a key does not reach."""


@can_go_beside
def follow_keys_steps(
    body: TriangleMesh, offsets: Floats, items: Sequence[WornItem], *, bones: csr_array | None = None
) -> Steps[list[Floats]]:
    """Find what a body's shape keys do to what it wears.

    A body with a key turned on is another body, of the same mesh, to which the items are fitted as `wear_steps` does:
    nothing pokes through then either, what hangs keeps hanging, and buttons stay as they are.

    Parameters
    ----------
    body : TriangleMesh
        The body without keys, m vertices.
    offsets : (k, m, 3) array of float
        By how much each key moves each of its vertices.
    items : sequence of WornItem
        What it wears, where it is then.
    bones : (m, b) csr_array of float, optional
        How much each bone moves each vertex of the body.

    Yields
    ------
    Progress
        After each key's steps.

    Returns
    -------
    list of (k, n, 3) array of float
        For each item by how much each key moves its vertices: zero throughout where it does not follow the key.

    Raises
    ------
    MeshError
        If there is not one offset for each vertex of the body.
    """
    if offsets.ndim != 3 or offsets.shape[1:] != body.vertices.shape:
        raise MeshError(
            f"A body of {body.vertex_count} vertices needs offsets of the shape (k, {body.vertex_count}, 3), but has "
            f"{offsets.shape}."
        )
    unit, count = float(np.sqrt(body.area)), len(offsets)
    found = [np.zeros((count, item.mesh.vertex_count, 3)) for item in items]
    dressed = yield from within(dressed_steps(body, items, bones=bones), 0.0, 0.1)
    search = dressed.skin.search
    below = [search.nearest(one.item.mesh.vertices) for one in dressed.items]
    own = search.nearest(body.vertices)  # not the identity, which loose vertices have no place for
    same = SurfaceMap.from_barycentric(body, own.triangles, own.barycentric)
    for number, moved in enumerate(offsets):
        share = 0.1 + 0.9 * number / count
        yield Progress(share, "Following shape keys")
        lengths = np.linalg.norm(moved, axis=1)
        under = [(place.barycentric * lengths[body.triangles[place.triangles]]).sum(axis=1) for place in below]
        reached = [one for one, most in enumerate(under) if most.max() > _STILL * unit]
        if not reached:
            continue
        worn = tuple(_left_alone(dressed.items[one], under[one] < _NOTHING * unit) for one in reached)
        other = TriangleMesh(body.vertices + moved, body.triangles)
        fitting = fitted_steps(replace(dressed, items=worn), other, same, other.vertices)
        fitted = yield from within(fitting, share, share + 0.9 / count, "Following shape keys")
        for one, result in zip(reached, fitted, strict=True):
            change = result.positions - items[one].mesh.vertices
            size = np.linalg.norm(change, axis=1)
            if size.max() > _STILL * unit:
                found[one][number] = np.where((size > _NOTHING * unit)[:, None], change, 0.0)
    return found


def _left_alone(worn: DressedItem, still: Bools) -> DressedItem:
    """Let some vertices (n,) not be pushed: where nothing moves below them, nothing new can poke through."""
    left = worn.item.left
    return replace(worn, item=replace(worn.item, left=still if left is None else left | still))
