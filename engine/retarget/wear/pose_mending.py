# SPDX-License-Identifier: GPL-3.0-or-later
"""Weights of clothes that let the skin poke through when a joint bends, brought closer to those of the skin."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import cached_property

import numpy as np
from scipy.sparse import csr_array, diags_array

from ...mesh.closest_points import ClosestPoints
from ...mesh.connectivity.welded_parts import WeldedParts
from ...mesh.surface_points import interpolation_matrix
from ...mesh.triangle_mesh import TriangleMesh
from ...runtime.arrays import Bools, Floats, Ints, group_largest
from ...runtime.background import can_go_beside
from ...runtime.parallel_map import MOST_SENT, here_steps, shared_steps
from ...runtime.progress import Progress, Steps, within
from ...runtime.worker import call_helpers
from ..rig.skeleton import Skeleton
from ..weights.skin_weights import row_sums
from .contact import Surface
from .joint_bends import joint_bends

_PARTLY = 0.02
"""Part of a vertex that a bone and what hangs on it has to move for the vertex to be looked at, and that it has not."""

_NEAR = 0.03
"""Distance from the skin, in sqrt(area), of what lies on it."""

_DEEPER, _FULLY = 0.006, 0.03
"""How deep in the skin, in the same unit, is poking through, and how deep calls for the weights of the skin
alone: 8 and 40 mm on a human."""

_OUTSIDE = 0.001
"""How far outside, in the same unit, an item lies at rest that has to stay there: not the inside of a shoe."""

_CLEARLY = 0.009
"""By how much less deep, in the same unit, the deepest of all poses has to be with other weights for these to be taken:
12 mm on a human.  Chosen by ``python -m tests.benchmarks.outfits``, whose weights are right."""

_WORSE = 0.002
"""By how much deeper, in the same unit, a neighbor of such vertices may get by taking its share."""

_PARTS = 2
"""Into how many parts the bones are divided, to be tried by as many processes."""

_SMOOTHING = 2
"""How many rings of neighbours share in what is mended."""


@dataclass(frozen=True, eq=False)
class WeightedItem:
    """An item on a body, at rest.

    Attributes
    ----------
    positions : (n, 3) array of float
        Its vertices.
    triangles : (t, 3) array of int
        Its triangles.
    weights : (n, b) csr_array of float
        How much each bone moves each vertex; rows that are empty are left so.
    pieces : (n,) array of int
        The rigid piece that each vertex belongs to, -1 where it bends; all of it does if not given.
    left : (n,) array of bool
        Which vertices stay where they are; none if not given.
    """

    positions: Floats
    triangles: Ints
    weights: csr_array
    pieces: Ints = field(default_factory=lambda: np.empty(0, np.int64))
    left: Bools = field(default_factory=lambda: np.empty(0, bool))

    def __post_init__(self) -> None:
        n = len(self.positions)
        if not len(self.pieces):
            object.__setattr__(self, "pieces", np.full(n, -1))
        if not len(self.left):
            object.__setattr__(self, "left", np.zeros(n, bool))

    @cached_property
    def mesh(self) -> TriangleMesh:
        """Its surface."""
        return TriangleMesh(self.positions, self.triangles)

    @property
    def still(self) -> Bools:
        """Which vertices are not moved one by one: rigid pieces, and what stays, (n,)."""
        return self.left | (self.pieces >= 0)

    def __repr__(self) -> str:
        return f"<WeightedItem: {len(self.positions)} vertices>"


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
    changed: Bools

    def __repr__(self) -> str:
        return f"<MendedWeights: {int(self.changed.sum())} of {len(self.changed)} vertices changed>"


@can_go_beside
def mend_weights_steps(
    items: Sequence[WeightedItem], *, body: TriangleMesh, skin_weights: csr_array, skeleton: Skeleton
) -> Steps[list[MendedWeights]]:
    """Bend each joint and mend the weights of items where the skin pokes through.

    What has the weights of the skin below moves as that does, and nothing pokes through it.  So vertices that get
    deeper into the skin in a pose than they are at rest take part of its weights, and their neighbors less; if that
    does not clearly help, in all poses together, they keep their own.

    Parameters
    ----------
    items : sequence of WeightedItem
        The items.
    body : TriangleMesh
        The body, m vertices.
    skin_weights : (m, b) csr_array of float
        How much each bone moves each of its vertices.
    skeleton : Skeleton
        The bones.

    Yields
    ------
    Progress
        After each joint.

    Returns
    -------
    list of MendedWeights
        The weights of each item.
    """
    call_helpers()
    posed = _PosedBody(body, skin_weights, skeleton)
    tried = [_tried(item, posed) for item in items]
    found = yield from within(_deepest_steps(posed, [(one, one.lying, [one.item.weights]) for one in tried]), 0.0, 0.7)
    lacking = [
        np.where(depths[0] > _DEEPER * posed.unit, (depths[0] / (_FULLY * posed.unit)).clip(0, 1), 0.0)
        for depths in found
    ]
    shares = [_spread(one.parts, lack) for one, lack in zip(tried, lacking, strict=True)]
    ways = [
        (one, one.lying & (share > 0), [one.item.weights, one.mixed(share)])
        for one, share in zip(tried, shares, strict=True)
    ]
    found = yield from within(_deepest_steps(posed, ways), 0.7, 1.0)
    results = []
    for one, lack, (before, after) in zip(tried, lacking, found, strict=True):
        helped = before - after > _CLEARLY * posed.unit
        share = _spread(one.parts, np.where(helped, lack, 0.0))
        share[(after > _DEEPER * posed.unit) & (after - before > _WORSE * posed.unit)] = 0.0
        results.append(MendedWeights(one.mixed(share), share > 0))
    yield Progress(1.0, "Trying poses")
    return results


@dataclass(frozen=True, eq=False)
class _Tried:
    """An item with its parts, the skin's weights below it (n, b), vertices to search from, and what lies on it."""

    item: WeightedItem
    parts: WeldedParts
    of_skin: csr_array
    starts: Ints
    lying: Bools

    def mixed(self, share: Floats) -> csr_array:
        """Weights that are by such a part of each vertex (n,) the skin's."""
        if not share.any():
            return self.item.weights
        return csr_array(diags_array(1 - share) @ self.item.weights + diags_array(share) @ self.of_skin)


class _PosedBody:
    """A body whose joints are bent one by one."""

    is_sent_once = True
    """See `parallel_map.shared_steps`."""

    def __init__(self, body: TriangleMesh, weights: csr_array, skeleton: Skeleton) -> None:
        self.body, self.weights, self.skeleton = body, weights, skeleton
        self.unit = float(np.sqrt(body.area))
        self.search = ClosestPoints(body)
        self.skin = Surface(body, self.search)


def _tried(item: WeightedItem, posed: _PosedBody) -> _Tried:
    """Find how an item lies on the body."""
    body, unit = posed.body, posed.unit
    found = posed.search.nearest(item.positions)
    below = interpolation_matrix(found.barycentric, body.triangles[found.triangles], body.vertex_count)
    starts = found.nearest_vertices(body.triangles)
    rest = posed.skin.clearance(item.positions, starts)
    lying = (row_sums(item.weights) > 0) & rest.known
    lying &= (rest.distances > _OUTSIDE * unit) & (rest.distances < _NEAR * unit)
    parts = WeldedParts.of(item.mesh)
    of_skin = csr_array(diags_array(row_sums(item.weights)) @ below @ posed.weights)
    return _Tried(item, parts, of_skin, starts, lying)


_Ways = Sequence[tuple[_Tried, Bools, list[csr_array]]]
"""Items, which of their vertices are looked at (n,), and the weights that are tried."""


def _deepest_steps(posed: _PosedBody, ways: _Ways) -> Steps[list[Floats]]:
    """Find how deep some vertices (n,) of items get into the skin at most, by each of w weights: (w, n) for each item.

    Those that never do, are not looked at, or that no joint bends have zero.
    """
    used = np.flatnonzero(sum(sum(weights.sum(axis=0) for weights in way[2]) for way in ways) if ways else [])
    share = shared_steps if posed.body.vertex_count <= MOST_SENT else here_steps
    found = yield from share(_deepest_of_steps, (posed, ways), [used[part::_PARTS] for part in range(_PARTS)])
    return [np.max(depths, axis=0) for depths in zip(*found, strict=True)]


def _deepest_of_steps(common: tuple[_PosedBody, _Ways], bones: Ints) -> Steps[list[Floats]]:
    """Do so for some bones."""
    (posed, ways), skeleton = common, common[0].skeleton
    body = posed.body
    deepest = [np.zeros((len(weights), len(chosen))) for _, chosen, weights in ways]
    bends = list(joint_bends(body, posed.weights, skeleton, bones))
    for number, bend in enumerate(bends):
        yield Progress(number / len(bends), "Trying poses")
        parts = [[row_sums(weights[:, bend.hanging]) for weights in way[2]] for way in ways]
        looked = [
            np.flatnonzero(chosen & np.any([(on > _PARTLY) & (on < 1 - _PARTLY) for on in part], axis=0))
            for (_, chosen, _), part in zip(ways, parts, strict=True)
        ]
        if not any(len(places) for places in looked):
            continue
        for rotation in bend.rotations:
            surface = posed.skin.moved(bend.bent(body.vertices, bend.on_skin, rotation))
            for (one, _, _), part, places, depths in zip(ways, parts, looked, deepest, strict=True):
                for way, on in enumerate(part if len(places) else ()):
                    points = bend.bent(one.item.positions[places], on[places], rotation)
                    depth = -surface.clearance(points, one.starts[places]).distances
                    depths[way, places] = np.maximum(depths[way, places], depth)
    return deepest


def _spread(parts: WeldedParts, values: Floats) -> Floats:
    """Let values (n,) fade out over rings of neighbors; vertices that a seam parts have one."""
    result = group_largest(parts.welded, values, parts.welded_count)
    for _ in range(_SMOOTHING):
        around = group_largest(parts.edges.ravel(), result[parts.edges[:, ::-1]].ravel(), len(result))
        result = np.maximum(result, 0.6 * around)
    return np.where(result > 0.01, result, 0.0)[parts.welded]
