# SPDX-License-Identifier: GPL-3.0-or-later
"""Limbs of two bones bent so that they end somewhere: inverse kinematics in closed form, for all poses at once."""

from __future__ import annotations

import numpy as np
from scipy.spatial.transform import Rotation

from ...geometry.procrustes import least_turns
from ...runtime.arrays import TINY, Bools, Floats, unit_vectors

_STRAIGHT = 1e-3
"""Sine of the bend below which a limb counts as straight, so that its plane is not known."""

_STRETCHED = 0.9995
"""How far a limb may be stretched that was not so before, in units of its length: short of that knees would snap."""


def bent_limb(joints: Floats, goals: Floats) -> tuple[Floats, Floats]:
    """Turn the two bones of a limb so that it ends at a goal, in the plane in which it is bent.

    Parameters
    ----------
    joints : (f, 3, 3) array of float
        Where the upper bone begins, the lower one begins, and ends.
    goals : (f, 3) array of float
        Where it is to end; if that is too far or too near, it points there.

    Returns
    -------
    upper, lower : (f, 3, 3) arrays of float
        Rotations in space of either bone, to be applied after what it was turned by.
    """
    start, middle, end = np.moveaxis(joints, 1, 0)
    upper, lower = middle - start, end - middle
    lengths = np.linalg.norm(upper, axis=1), np.linalg.norm(lower, axis=1)
    before, after = end - start, goals - start
    reached = np.linalg.norm(before, axis=1)
    most = np.maximum(_STRETCHED * (lengths[0] + lengths[1]), np.minimum(reached, lengths[0] + lengths[1]))
    least = np.abs(lengths[0] - lengths[1]) + (1 - _STRETCHED) * (lengths[0] + lengths[1])
    distance = np.clip(np.linalg.norm(after, axis=1), least, most)
    # The whole limb swings to the goal first, and is then bent around the normal of its plane.
    swing = least_turns(unit_vectors(before), unit_vectors(after))
    normals = np.cross(upper, lower)
    flat = np.linalg.norm(normals, axis=1) <= _STRAIGHT * lengths[0] * lengths[1]
    normals[flat] = _steady_normals(upper, normals, flat)
    axes = unit_vectors(np.einsum("fij,fj->fi", swing, normals))
    bends = []
    for span in (reached, distance):
        safe = np.maximum(span, TINY)
        cosine = (lengths[0] ** 2 + safe**2 - lengths[1] ** 2) / np.maximum(2 * lengths[0] * safe, TINY)
        inner = (lengths[0] ** 2 + lengths[1] ** 2 - safe**2) / np.maximum(2 * lengths[0] * lengths[1], TINY)
        bends.append((np.arccos(cosine.clip(-1, 1)), np.arccos(inner.clip(-1, 1))))
    hip = bends[0][0] - bends[1][0]  # the upper bone lies before the line to the end, seen around the axis
    knee = bends[0][1] - bends[1][1]
    first = _around(axes, hip) @ swing
    return first, _around(axes, hip + knee) @ swing


def needed_drop(joints: Floats, goals: Floats, up: Floats) -> Floats:
    """Find by how much limbs have to begin lower so that they reach their goals, (f,): zero where they do.

    Parameters
    ----------
    joints : (f, 3, 3) array of float
        Where the upper bone begins, the lower one begins, and ends.
    goals : (f, 3) array of float
        Where the limb is to end.
    up : (3,) array of float
        Direction away from the ground, of length one.
    """
    start, middle, end = np.moveaxis(joints, 1, 0)
    length = np.linalg.norm(middle - start, axis=1) + np.linalg.norm(end - middle, axis=1)
    allowed = np.maximum(_STRETCHED * length, np.minimum(np.linalg.norm(end - start, axis=1), length))
    way = goals - start
    down = way @ up
    space = down**2 - (way**2).sum(axis=1) + allowed**2
    drop = -down - np.sqrt(np.maximum(space, 0))
    return np.where(np.linalg.norm(way, axis=1) > allowed * (1 + 1e-9), np.maximum(drop, 0), 0.0)


def _steady_normals(upper: Floats, normals: Floats, flat: Bools) -> Floats:
    """Find normals for poses in which a limb is straight, from the nearest pose in which it is not."""
    known = np.flatnonzero(~flat)
    wanted = np.flatnonzero(flat)
    if len(known):
        after = np.searchsorted(known, wanted).clip(0, len(known) - 1)
        before = (after - 1).clip(0)
        nearer = np.where(abs(known[after] - wanted) <= abs(wanted - known[before]), after, before)
        guess = normals[known[nearer]]
    else:
        guess = np.eye(3)[np.abs(upper[wanted]).argmin(axis=1)]
    along = unit_vectors(upper[wanted])
    return guess - (guess * along).sum(axis=1, keepdims=True) * along


def _around(axes: Floats, angles: Floats) -> Floats:
    """Rotations (f, 3, 3) around axes (f, 3) of length one by angles (f,)."""
    return Rotation.from_rotvec(angles[:, None] * axes).as_matrix()
