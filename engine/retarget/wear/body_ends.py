# SPDX-License-Identifier: GPL-3.0-or-later
"""Ends of a body that has no skin below its clothes, as characters for games are made: boots without feet in them."""

from __future__ import annotations

from itertools import product

import numpy as np
from scipy.sparse import csr_array

from ...mesh.connectivity.components import joined_components
from ...mesh.connectivity.welded_parts import WeldedParts
from ...mesh.triangle_mesh import TriangleMesh
from ...runtime.arrays import TINY, Floats, Ints, group_sums, unit_vectors
from ..rig.skeleton import Skeleton
from ..weights.skin_weights import row_sums
from .contact import Surface

_SHARE = 0.25
"""Least part of an item, by area, that lies beyond the rims of holes."""

_FAR = 1.5
"""How far beyond a rim half of that lies at least, in radii of the hole.  What covers a hole, as hair does on an open
skull, lies within one of its radii.  Of the parts of seven characters for games, taken out in turn, limbs have 2.3 to
8.8, and what covers holes 0.3 to 1.0."""

_GAP = 0.03
"""How far apart parts are that do not hang together, in the root of the area: 4 cm on a person.  A sleeve is nearer to
the hand in it, and without it nothing is near to the hand."""

_FOREIGN = 0.25
"""How much of the body, as a part of what they move of the item, bones move at most that are the item's own: a foot's
move some of the ankle."""

_MOSTLY = 0.5
"""Part of the item that such bones move at least, which hang on ends: of shoes 0.56 to 0.72."""

_NARROW = 0.8
"""How far all of what is connected at a joint lies in one direction from it, 0 to 1, for that to be the end of a limb.
Above the shoes of three characters for games it is 0.90 to 0.97, below hair that alone moves with the neck 0.43."""

_AT_JOINT = 1.5
"""How many times as far from a joint as the nearest place others are that count as there, too."""

_PIECE = 0.01
"""Least part of the area of a piece of the body: a hand has 2 %."""


def continues_body(body: TriangleMesh, item: TriangleMesh) -> bool:
    """Tell whether an item stands for a part that a body lacks.

    Either the body falls apart without it, or it is cut open, and the item goes on from there.

    Parameters
    ----------
    body : TriangleMesh
        The body without the item.
    item : TriangleMesh
        What it wears.
    """
    if _holds_together(body, item):
        return True
    sewn = WeldedParts.of(body).closed
    found = Surface(sewn).clearance(item.vertices)
    beyond, away = ~found.known, np.abs(found.distances)
    if item.vertex_areas[beyond].sum() < _SHARE * item.area:
        return False
    return bool((away > _FAR * _hole_radii(sewn)[found.vertices])[beyond].mean() > 1 / 2)


def ends_at_joint(
    body: TriangleMesh, item: TriangleMesh, weights: tuple[csr_array, csr_array], skeleton: Skeleton
) -> bool:
    """Tell whether an item is the end of a limb, such as a shoe without a foot in it below a leg that is closed there.

    It is if bones move it that move nothing else, and what else there is around their joints is a limb that ends.

    Parameters
    ----------
    body : TriangleMesh
        The body without the item.
    item : TriangleMesh
        What it wears.
    weights : pair of (n, b) csr_array of float
        How much each bone moves the vertices of either.
    skeleton : Skeleton
        The bones.
    """
    with_children = skeleton.hanging
    on_body, on_item = (
        with_children @ (part.T @ mesh.vertex_areas) for part, mesh in zip(weights, (body, item), strict=True)
    )
    own = (on_item > 0) & (on_body < _FOREIGN * on_item)
    roots = np.flatnonzero(own & ~(own[skeleton.parents] & (skeleton.parents >= 0)))
    closed = WeldedParts.of(body).closed
    at_ends = 0.0
    for bone in roots:
        joint, moved = skeleton.heads[bone], row_sums(weights[1][:, with_children[bone]]) > 1 / 2
        if moved.any():
            reach = np.linalg.norm(item.vertices[moved] - joint, axis=1).max()
            at_ends += on_item[bone] * (_narrowness(closed, joint, float(reach)) > _NARROW)
    return at_ends > _MOSTLY * item.area


def _narrowness(mesh: TriangleMesh, joint: Floats, reach: float) -> float:
    """Find how far all of a surface that is connected within a distance from a joint lies in one direction from it."""
    away = mesh.vertices - joint
    distances = np.linalg.norm(away, axis=1)
    near = (distances < reach)[mesh.triangles].all(axis=1)
    if not near.any():
        return 0.0
    triangles = mesh.triangles[near]
    labels = joined_components(mesh.vertex_count, triangles[:, [0, 1]].ravel(), triangles[:, [1, 2]].ravel())
    used = np.unique(triangles)
    areas = np.bincount(labels[used], mesh.vertex_areas[used], int(labels.max()) + 1)
    at_joint = used[distances[used] <= _AT_JOINT * distances[used].min()]
    largest = labels[at_joint][areas[labels[at_joint]].argmax()]
    chosen = used[(labels[used] == largest) & (distances[used] > reach / 2)]
    if not len(chosen):
        return 0.0
    weights = mesh.vertex_areas[chosen]
    return float(np.linalg.norm(weights @ unit_vectors(away[chosen])) / max(weights.sum(), TINY))


def _hole_radii(mesh: TriangleMesh) -> Floats:
    """Find how wide the holes are, (n,): for each vertex on a rim its root mean square distance from the centre."""
    edges = mesh.boundary_edges
    holes = joined_components(mesh.vertex_count, edges[:, 0], edges[:, 1])
    rim = np.unique(edges)
    places, owners = mesh.vertices[rim], holes[rim]
    sizes = np.bincount(owners, minlength=int(holes.max()) + 1).clip(min=1)
    centres = group_sums(owners, places, len(sizes)) / sizes[:, None]
    squares = sum(group_sums(owners, (places - centres[owners]) ** 2, len(sizes)).T)
    return np.sqrt(squares / sizes)[holes]


def _holds_together(body: TriangleMesh, item: TriangleMesh) -> bool:
    """Tell whether a body is in more pieces without an item, as head and hands without a jacket."""
    gap = _GAP * float(np.sqrt(body.area + item.area))
    own, count = WeldedParts.of(body), body.vertex_count
    alone = _near_parts(body.vertices, own.vertex_labels, gap)
    added = np.full(item.vertex_count, own.part_count)
    points = np.concatenate([body.vertices, item.vertices])
    together = _near_parts(points, np.concatenate([own.vertex_labels, added]), gap)[:count]
    areas = np.bincount(alone, body.vertex_areas)
    large = (areas >= _PIECE * areas.sum())[alone]
    return len(np.unique(together[large])) < len(np.unique(alone[large]))


def _near_parts(points: Floats, parts: Ints, gap: float) -> Ints:
    """Join parts that come near to each other: the number of the piece that each point (k,) of a part belongs to."""
    cells = np.floor((points - points.min(axis=0)) / gap).astype(np.int64) + 1
    size = cells.max() + 2
    keys = (cells[:, 0] * size + cells[:, 1]) * size + cells[:, 2]
    order = np.unique(np.stack([keys, parts], axis=1), axis=0)
    first, second = [], []
    for step in product((-1, 0, 1), repeat=3):
        wanted = order[:, 0] + (step[0] * size + step[1]) * size + step[2]
        at = np.searchsorted(order[:, 0], wanted)
        there = at < len(order)
        there[there] = order[at[there], 0] == wanted[there]
        first.append(order[there, 1])
        second.append(order[at[there], 1])
    # Of several parts in one cell the first stands for all.
    same = order[1:, 0] == order[:-1, 0]
    first.append(order[1:][same, 1])
    second.append(order[:-1][same, 1])
    return joined_components(int(parts.max()) + 1, np.concatenate(first), np.concatenate(second))[parts]
