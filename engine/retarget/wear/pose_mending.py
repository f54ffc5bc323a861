# SPDX-License-Identifier: GPL-3.0-or-later
"""Weights of clothes that let the skin poke through when a joint bends, brought closer to those of the skin."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from scipy.sparse import csr_array, diags_array

from ...mesh.closest_points import ClosestPoints
from ...mesh.triangle_mesh import TriangleMesh
from ...runtime.background import can_go_beside
from ...runtime.progress import Progress
from .contact import Surface

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from ...runtime.progress import Steps
    from ..rig.skeleton import Skeleton

__all__ = ["MendedWeights", "mend_weights_steps"]

_ANGLE = np.radians(50.0)
"""How far each joint is bent, about two axes and both ways."""

_LARGE_PART = 0.02
"""Part of the body's area that a bone and what hangs on it has to move to be tried: fingers and toes are not, which
shoes and gloves hold."""

_PARTLY = 0.02
"""Part of a vertex that a bone and what hangs on it has to move for the vertex to be looked at, and that it has not."""

_NEAR = 0.03
"""Distance from the skin, in sqrt(area), of what lies on it."""

_DEEPER, _FULLY = 0.006, 0.03
"""How deep in the skin, in the same unit, is poking through, and how deep calls for the weights of the skin
alone: 8 and 40 mm on a human."""

_OUTSIDE = 0.001
"""How far outside, in the same unit, an item lies at rest that has to stay there: not the inside of a shoe."""

_ROUNDS = 2
"""How often all poses are tried."""

_SMOOTHING = 2
"""How many rings of neighbours share in what is mended."""


@dataclass(frozen=True, eq=False)
class MendedWeights:
    """Weights that were tried in poses.

    Attributes
    ----------
    weights : (n, b) csr_array of float
        The weights.
    changed : (n,) array of bool
        Which vertices have others than before.
    """

    weights: csr_array
    changed: NDArray[np.bool_]

    def __repr__(self) -> str:
        return f"<MendedWeights: {int(self.changed.sum())} of {len(self.changed)} vertices changed>"


@can_go_beside
def mend_weights_steps(
    positions: NDArray[np.float64],
    triangles: NDArray[np.int64],
    weights: csr_array,
    *,
    body: TriangleMesh,
    skin_weights: csr_array,
    skeleton: Skeleton,
) -> Steps[MendedWeights]:
    """Bend each joint and mend the weights of an item where the skin pokes through.

    What has the weights of the skin below moves as that does, and nothing pokes through it.  So vertices that get
    deeper into the skin in a pose than they are at rest take part of its weights, and their neighbours less.

    Parameters
    ----------
    positions : (n, 3) array of float
        The item on the body, at rest.
    triangles : (t, 3) array of int
        Its triangles.
    weights : (n, b) csr_array of float
        How much each bone moves each vertex; rows that are empty are left so.
    body : TriangleMesh
        The body, m vertices.
    skin_weights : (m, b) csr_array of float
        The same for the body.
    skeleton : Skeleton
        The bones.

    Yields
    ------
    Progress
        After each joint.

    Returns
    -------
    MendedWeights
        The weights.
    """
    unit = float(np.sqrt(body.area))
    item = TriangleMesh(positions, triangles)
    found = ClosestPoints(body).nearest(positions)
    corners = body.triangles[found.triangles]
    below = csr_array(
        (found.barycentric.ravel(), corners.ravel(), np.arange(0, corners.size + 1, 3)),
        shape=(len(positions), body.vertex_count),
    )
    of_skin = csr_array(below @ skin_weights)
    moving = np.asarray(weights.sum(axis=1)).ravel() > 0
    starts = found.nearest_vertices(body.triangles)
    skin = Surface(body)
    rest = skin.clearance(positions, starts)
    lying = moving & (rest.distances > _OUTSIDE * unit) & (rest.distances < _NEAR * unit) & rest.known
    subtrees = _subtrees(skeleton.parents)
    share = np.zeros(len(positions))
    used = np.flatnonzero(np.asarray(weights.sum(axis=0)).ravel() > 0)
    mixed = weights
    for turn in range(_ROUNDS):
        lacking = np.zeros(len(positions))
        for number, bone in enumerate(used):
            yield Progress((turn + number / max(len(used), 1)) / _ROUNDS, "Trying poses")
            hanging = subtrees[bone]
            on_item, on_skin = (np.asarray(both[:, hanging].sum(axis=1)).ravel() for both in (mixed, skin_weights))
            chosen = np.flatnonzero(lying & (on_item > _PARTLY) & (on_item < 1 - _PARTLY))
            if not len(chosen) or on_skin @ body.vertex_areas < _LARGE_PART * body.area:
                continue
            for rotation in _bends(skeleton.tails[bone] - skeleton.heads[bone]):
                head = skeleton.heads[bone]
                surface = skin.moved(_bent(body.vertices, on_skin, head, rotation))
                points = _bent(positions[chosen], on_item[chosen], head, rotation)
                depth = -surface.clearance(points, starts[chosen]).distances
                poking = depth > _DEEPER * unit
                lacking[chosen[poking]] = np.maximum(
                    lacking[chosen[poking]], (depth[poking] / (_FULLY * unit)).clip(0, 1)
                )
        if not lacking.any():
            break
        share = np.maximum(share, _spread(item, lacking))
        mixed = csr_array(diags_array(1 - share) @ weights + diags_array(share) @ of_skin)
    yield Progress(1.0, "Trying poses")
    return MendedWeights(mixed, share > 0)


def _subtrees(parents: NDArray[np.int64]) -> NDArray[np.bool_]:
    """Tell for each bone which bones hang on it, itself as well, (b, b)."""
    count = len(parents)
    hanging = np.eye(count, dtype=bool)
    for bone in range(count):
        above = int(parents[bone])
        while above >= 0:
            hanging[above, bone] = True
            above = int(parents[above])
    return hanging


def _bends(along: NDArray[np.float64]) -> list[NDArray[np.float64]]:
    """Rotations about two axes across a bone, both ways."""
    along = along / max(float(np.linalg.norm(along)), 1e-300)
    first = np.cross(along, np.eye(3)[int(np.abs(along).argmin())])
    first /= max(float(np.linalg.norm(first)), 1e-300)
    axes = (first, -first, np.cross(along, first), np.cross(first, along))
    skews = (np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]]) for x, y, z in axes)
    return [np.eye(3) + np.sin(_ANGLE) * skew + (1 - np.cos(_ANGLE)) * skew @ skew for skew in skews]


def _bent(
    points: NDArray[np.float64], share: NDArray[np.float64], head: NDArray[np.float64], rotation: NDArray[np.float64]
) -> NDArray[np.float64]:
    """Points (k, 3), so much of each (k,) turned about the head of a bone."""
    turned = (points - head) @ rotation.T + head
    moved: NDArray[np.float64] = points + share[:, None] * (turned - points)
    return moved


def _spread(item: TriangleMesh, values: NDArray[np.float64]) -> NDArray[np.float64]:
    """Let values (n,) fade out over rings of neighbours."""
    tails, heads = item.edges.T
    result = values
    for _ in range(_SMOOTHING):
        around = np.zeros(len(values))
        np.maximum.at(around, tails, result[heads])
        np.maximum.at(around, heads, result[tails])
        result = np.maximum(result, 0.6 * around)
    return np.where(result > 0.01, result, 0.0)
