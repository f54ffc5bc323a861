# SPDX-License-Identifier: GPL-3.0-or-later
"""Bones of clothes, hair and accessories that move no body: they go where the items go."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from scipy.spatial import cKDTree

from ...geometry.procrustes import nearest_rotations
from ...mesh.connectivity.edge_chains import way_to_root
from ...runtime.arrays import TINY, Bools, Floats, Ints
from ...runtime.errors import RigError
from .worn_item import FittedItem

_NEIGHBOURS = 32
"""Vertices of items that take a joint along."""


def bones_of_items(parents: Ints, on_body: Bools, on_items: Bools) -> list[int]:
    """Find the bones that items have for themselves, parents first.

    Parameters
    ----------
    parents : (b,) array of int
        The parent of each bone, -1 for one without.
    on_body, on_items : (b,) array of bool
        Which bones move the body, and which move items.

    Returns
    -------
    list of int
        Bones that move an item, they or what hangs on them, while neither moves the body.
    """
    above = [way_to_root(parents, bone) for bone in range(len(parents))]
    body, items = (
        {one for bone in np.flatnonzero(moving) for one in above[int(bone)]} for moving in (on_body, on_items)
    )
    return sorted(items - body, key=lambda bone: (len(above[bone]), bone))


def moved_with_items(points: Floats, items: Sequence[tuple[Floats, FittedItem]]) -> tuple[Floats, Floats]:
    """Move joints with the items around them.

    Joints that were in one place stay in one.

    Parameters
    ----------
    points : (k, 3) array of float
        Where they were.
    items : sequence of tuple
        For each item its vertices before (n, 3), and how it was fitted.

    Returns
    -------
    positions : (k, 3) array of float
        Where they come to be.
    rotations : (k, 3, 3) array of float
        How the items turned around each.

    Raises
    ------
    RigError
        If there is no vertex that could take them along.
    """
    if not sum(len(before) for before, _ in items):
        raise RigError("Bones of clothes can only go along with items that have vertices.")
    before = np.concatenate([vertices for vertices, _ in items])
    after, rotations, scales = (
        np.concatenate([getattr(fitted, name) for _, fitted in items]) for name in ("positions", "rotations", "scales")
    )
    count = min(_NEIGHBOURS, len(before))
    distances, near = (found.reshape(len(points), count) for found in cKDTree(before).query(points, count))
    width = np.maximum(distances[:, -1:], TINY)
    weights = np.exp(-2 * (distances**2 - distances[:, :1] ** 2) / width**2)
    weights /= weights.sum(axis=1, keepdims=True)
    linear = scales[near, None, None] * rotations[near]
    away = np.einsum("kpij,kpj->kpi", linear, points[:, None] - before[near])
    positions = np.einsum("kp,kpi->ki", weights, after[near] + away)
    return positions, nearest_rotations(np.einsum("kp,kpij->kij", weights, linear))
