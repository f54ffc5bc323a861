# SPDX-License-Identifier: GPL-3.0-or-later
"""Poses that clothes are tried in: each joint of a body bent by itself."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

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
    hanging : (b,) array of bool
        The bone that turns in the joint, and all that hang on it.
    head : (3,) array of float
        The joint.
    on_skin : (m,) array of float
        How much these bones move each vertex of the skin.
    rotations : (4, 3, 3) array of float
        How they turn, one way after the other.
    """

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
            yield JointBend(hanging, head, on_skin, _bends(skeleton.tails[bone] - head, angle))


def _bends(along: Floats, angle: float) -> Floats:
    """Rotations about two axes across a bone, both ways, (4, 3, 3)."""
    along = unit_vectors(along)
    first = unit_vectors(np.cross(along, np.eye(3)[int(np.abs(along).argmin())]))
    axes = np.stack([first, -first, np.cross(along, first), np.cross(first, along)])
    return Rotation.from_rotvec(angle * axes).as_matrix()
