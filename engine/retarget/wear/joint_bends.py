# SPDX-License-Identifier: GPL-3.0-or-later
"""Poses that clothes are tried in: each joint of a body bent by itself, and two that hang side by side bent apart."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import combinations

import numpy as np
from scipy.sparse import csr_array
from scipy.spatial.transform import Rotation

from ...mesh.triangle_mesh import TriangleMesh
from ...runtime.arrays import Bools, Floats, Ints, unit_vectors
from ..rig.skeleton import Skeleton
from ..weights.skin_weights import row_sums

ANGLE = float(np.radians(50.0))
"""How far each joint is bent, about two axes and both ways."""

_LARGE_PART = 0.02
"""Part of the body's area that a bone and what hangs on it has to move to be tried: fingers and toes are not, which
shoes and gloves hold."""


@dataclass(frozen=True, eq=False)
class JointBend:
    """A joint, and how it is bent.

    Attributes
    ----------
    bone : int
        The bone that turns in it.
    hanging : (b,) array of bool
        That bone, and all that hang on it.
    head : (3,) array of float
        The joint.
    on_skin : (m,) array of float
        How much these bones move each vertex of the skin.
    rotations : (4, 3, 3) array of float
        How they turn, one way after the other.
    """

    bone: int
    hanging: Bools
    head: Floats
    on_skin: Floats
    rotations: Floats

    def levers(self, points: Floats, share: Floats) -> Floats:
        """Ways from the joint to points (..., 3), so much of each (...) as turns about it."""
        return share[..., None] * (points - self.head)

    def bent(self, points: Floats, share: Floats, rotation: Floats) -> Floats:
        """Move points (..., 3), so much of each (...) turned about the joint."""
        return points + turned(self.levers(points, share), rotation)


@dataclass(frozen=True, eq=False)
class Pose:
    """Joints that are bent at once, of which none hangs on another: j of them, each by a rotation (j, 3, 3)."""

    bends: tuple[JointBend, ...]
    rotations: Floats

    def bent(self, points: Floats, shares: Sequence[Floats]) -> Floats:
        """Move points (k, 3), so much of each (j, k) turned about each joint."""
        moved = points.copy()
        for bend, share, rotation in zip(self.bends, shares, self.rotations, strict=True):
            moved += turned(bend.levers(points, share), rotation)
        return moved

    def turned(self, directions: Floats, shares: Sequence[Floats]) -> Floats:
        """Turn unit vectors (k, 3) along with that, and make them unit vectors again."""
        return unit_vectors(self._blended(directions, shares, self.rotations))

    def brought_back(self, moves: Floats, shares: Sequence[Floats]) -> Floats:
        """Find the moves at rest (k, 3) that become some moves in the pose, nearly."""
        return self._blended(moves, shares, self.rotations.transpose(0, 2, 1))

    def _blended(self, vectors: Floats, shares: Sequence[Floats], rotations: Floats) -> Floats:
        return vectors + sum(
            share[:, None] * turned(vectors, rotation) for share, rotation in zip(shares, rotations, strict=True)
        )


def turned(levers: Floats, rotation: Floats) -> Floats:
    """How far a rotation moves the ends of levers (..., 3)."""
    return levers @ (rotation - np.eye(3)).T


def joint_bends(
    body: TriangleMesh,
    skin_weights: csr_array,
    skeleton: Skeleton,
    bones: Sequence[int] | Ints,
    *,
    angle: float = ANGLE,
) -> Iterator[JointBend]:
    """Yield the bends of some bones that move more of a body than fingers do.

    Parameters
    ----------
    body : TriangleMesh
        The body, m vertices.
    skin_weights : (m, b) csr_array of float
        How much each bone moves each of its vertices.
    skeleton : Skeleton
        The bones.
    bones : sequence of int
        Which of them are asked for.
    angle : float
        How far they are bent, in radians.
    """
    for bone in bones:
        hanging, head = skeleton.hanging[bone], skeleton.heads[bone]
        on_skin = row_sums(skin_weights[:, hanging])
        if on_skin @ body.vertex_areas >= _LARGE_PART * body.area:
            yield JointBend(int(bone), hanging, head, on_skin, _bends(skeleton.tails[bone] - head, angle))


def poses_of(bends: Sequence[JointBend]) -> list[Pose]:
    """Every bend as a pose of its own."""
    return [Pose((bend,), rotation[None]) for bend in bends for rotation in bend.rotations]


def strides(bends: Sequence[JointBend], skeleton: Skeleton) -> list[Pose]:
    """Poses in which two joints that hang on one bone are bent against each other, as legs are in a stride.

    What both move by halves, as they do the middle of a skirt, stays where it is then, while either limb leaves it.
    """
    return [
        Pose((one, other), np.stack([rotation, rotation.T]))
        for one, other in combinations(bends, 2)
        if skeleton.parents[one.bone] == skeleton.parents[other.bone] >= 0
        for rotation in one.rotations
    ]


def _bends(along: Floats, angle: float) -> Floats:
    """Rotations about two axes across a bone, both ways, (4, 3, 3)."""
    along = unit_vectors(along)
    first = unit_vectors(np.cross(along, np.eye(3)[int(np.abs(along).argmin())]))
    axes = np.stack([first, -first, np.cross(along, first), np.cross(first, along)])
    return Rotation.from_rotvec(angle * axes).as_matrix()
