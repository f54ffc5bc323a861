# SPDX-License-Identifier: GPL-3.0-or-later
"""Symmetry of a rig in a symmetric body: joints of both sides are mirror images of each other, to the last digit."""

from __future__ import annotations

import numpy as np
from scipy.spatial import cKDTree

from ...mesh.closest_points import ClosestPoints
from ...mesh.mirror_planes import MirrorPlane
from ...mesh.triangle_mesh import TriangleMesh
from ...runtime.arrays import Floats, Ints, evenly, unit_vectors
from .skeleton import Skeleton

_SAME = 1e-3
"""How far mirrored joints may be from each other in the source, in units of the rig's extent."""

_SYMMETRIC = 5e-3
"""How far the mirrored target may be from itself on the mean, in units of its extent: a body that an artist mirrored is
nearer than 0.001, one with a bent arm further than 0.02."""

_SAMPLES = 2000
"""Vertices of the target that are compared with their mirror images."""

_OWN_ANGLE, _OWN_PLACE = np.radians(5.0), 0.02
"""How far the plane between the joints may be turned, and, in units of the extent, moved against one of the space that
the target was made in: that one is meant then."""

_AS_GOOD = 1.5
"""How many times as far the mirrored target may be from itself by that plane."""

Joints = tuple[Floats, Floats, Floats]
"""Heads, tails and normals of bones, (b, 3) each."""


def mirrored_joints(skeleton: Skeleton, target: TriangleMesh, placed: Joints, space: Floats | None = None) -> Joints:
    """Make bones symmetric that were so, if the body is symmetric as well.

    Parameters
    ----------
    skeleton : Skeleton
        The bones as they were, b.
    target : TriangleMesh
        The body that they are in now.
    placed : Joints
        The bones as they are now.
    space : (4, 4) array of float, optional
        The space that the target was made in, in the world: most symmetric bodies are so in a plane of their own axes.

    Returns
    -------
    Joints
        The same bones, symmetric where all of this holds; else as they were.
    """
    partners = _partners(skeleton)
    if partners is None:
        return placed
    heads, tails, across = placed
    plane = _plane(heads, tails, partners, target, np.eye(4) if space is None else space)
    if plane is None:
        return placed
    heads, tails = ((ends + plane.reflected(ends[partners])) / 2 for ends in (heads, tails))
    # Axes across may be mirrored, or turned about as well, as rolls want it.
    other = plane.reflected_directions(across[partners])
    alike = (across * other).sum(axis=1)
    across = np.where(np.abs(alike)[:, None] > np.sqrt(0.5), across + np.sign(alike)[:, None] * other, across)
    along = unit_vectors(tails - heads)
    return heads, tails, unit_vectors(across - (across * along).sum(axis=1, keepdims=True) * along)


def _partners(skeleton: Skeleton) -> Ints | None:
    """Find the mirror image of each bone, (b,), itself in the middle; None if the rig is not symmetric."""
    ends = np.concatenate([skeleton.heads, skeleton.tails], axis=1)  # (b, 6)
    joints = ends.reshape(-1, 3) - ends.reshape(-1, 3).mean(axis=0)  # a plane of symmetry goes through their middle
    extent = float(np.linalg.norm(np.ptp(joints, axis=0)))
    tree = cKDTree(joints.reshape(-1, 6))
    for axis in np.concatenate([np.linalg.eigh(joints.T @ joints)[1].T, np.eye(3)]):
        distances, found = tree.query((joints - 2 * np.outer(joints @ axis, axis)).reshape(-1, 6))
        if distances.max() < _SAME * extent and np.abs(joints @ axis).max() > _SAME * extent:
            return found.astype(np.int64)
    return None


def _plane(heads: Floats, tails: Floats, partners: Ints, target: TriangleMesh, space: Floats) -> MirrorPlane | None:
    """Find the plane in which the target is symmetric; None if it is not."""
    ends, mirrored = np.concatenate([heads, tails]), np.concatenate([heads[partners], tails[partners]])
    if not (ends != mirrored).any():
        return None
    between = MirrorPlane.between(ends, mirrored, np.ones(len(ends)))
    points, search = target.vertices[evenly(target.vertex_count, _SAMPLES)], ClosestPoints(target)
    extent = float(np.linalg.norm(np.ptp(target.vertices, axis=0)))

    def missed(plane: MirrorPlane) -> float:
        """Tell how far the mirrored target is from itself on the mean, in units of its extent."""
        return float(np.sqrt(search.nearest(plane.reflected(points)).squared_distances).mean()) / extent

    found = missed(between)
    axes = unit_vectors(space[:3, :3].T)
    own = MirrorPlane(space[:3, 3], axes[np.abs(axes @ between.axis).argmax()])
    turned, moved = abs(own.axis @ between.axis), abs((between.middle - own.middle) @ own.axis)
    if turned > np.cos(_OWN_ANGLE) and moved < _OWN_PLACE * extent and missed(own) < max(_AS_GOOD * found, _SAME):
        return own
    return between if found < _SYMMETRIC else None
