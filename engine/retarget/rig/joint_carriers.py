# SPDX-License-Identifier: GPL-3.0-or-later
"""Carriers of joints: the bones that take a joint of a rig into another body, also for bones that move no vertex.

Joints at one place stay at one place: a chain stays connected, and a control that stands at an ankle stands at the
ankle.  So joints are grouped by their place first, and each group is carried as one point, by one or several bones.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.spatial import cKDTree

from ...mesh.connectivity.components import joined_components
from ...mesh.triangle_mesh import TriangleMesh
from ...runtime.arrays import TINY, Bools, Floats, Ints, shares_along
from ...runtime.errors import RigError
from .fitted_rig import FittedRig
from .skeleton import Skeleton

_SAME_PLACE = 1e-4
"""Joints closer than this, in units of the skeleton's extent, are at one place."""

_MOVES_NOTHING = 1e-3
"""A bone whose weights sum up to less than this part of a vertex moves nothing."""

_MOST_OF_BODY = 0.5
"""A bone above more than this part of the body turns with the whole of it."""

_NEARNESS = 4
"""With what power of the distance the influence of a bone on a control beside it falls."""


@dataclass(frozen=True, eq=False)
class JointCarriers:
    """Which bones carry which joints.

    Attributes
    ----------
    places : (2 b,) array of int
        For the heads of all bones, and then their tails, the number of their place.
    of_places : (k, b) array of float
        For each place the bones that carry it, in parts that sum to one.
    of_turns : (b, b) array of float
        For each bone the bones that it turns with, in parts that sum to one: itself, if it moves vertices.
    moving : (b,) array of bool
        Which bones move vertices.
    free : (b,) array of bool
        Which bones end where no other bone begins or ends.
    anchors : (b,) array of int
        For a bone above most of the body that itself moves no vertices and shares no joint with one that does: the
        heaviest of those below that do; -1 for all others.
    above : (b,) array of int
        The nearest bone above each that moves vertices; -1 if there is none.
    """

    places: Ints
    of_places: Floats
    of_turns: Floats
    moving: Bools
    free: Bools
    anchors: Ints
    above: Ints


def carriers_of(rig: FittedRig, source: TriangleMesh) -> JointCarriers:
    """Find which bones carry which joints, for a rig of b bones that moves the body `source`.

    Raises
    ------
    RigError
        If no bone moves a vertex, or the rig moves another body.
    """
    skeleton, count = rig.skeleton, len(rig.skeleton)
    masses = moved_areas(rig, source)
    moving = masses > 0
    places = joint_places(skeleton)
    above = skeleton.nearest_above(moving)
    of_turns = np.zeros((count, count))
    anchors = np.full(count, -1)
    below = skeleton.hanging @ masses
    for bone in range(count):
        if moving[bone]:
            of_turns[bone, bone] = 1
            continue
        leader = _joint_leader(skeleton, places, moving, bone)
        leader = above[bone] if leader < 0 else leader
        if leader >= 0:
            of_turns[bone, leader] = 1
            continue
        of_turns[bone] = _nearness(skeleton, moving, skeleton.heads[bone])
        if below[bone] > _MOST_OF_BODY * masses.sum():
            anchors[bone] = _heaviest_moving(skeleton, moving, below, bone)
    of_places = np.zeros((places.max() + 1, count))
    heads, tails = np.split(places, 2)
    for bone in np.flatnonzero(moving):
        of_places[[heads[bone], tails[bone]], bone] = 1
        if above[bone] >= 0:
            of_places[heads[bone], above[bone]] = 1
    for ends in (heads, tails):
        free = ~of_places.any(axis=1)[ends] & ~moving
        np.add.at(of_places, ends[free], of_turns[free])
    free = np.bincount(places)[tails] == 1
    shares = of_places / of_places.sum(axis=1, keepdims=True)
    return JointCarriers(places, shares, of_turns, moving, free, anchors, above)


def moved_areas(rig: FittedRig, source: TriangleMesh) -> Floats:
    """Sum the area that each bone moves, (b,); zero for those that move nothing to speak of."""
    if source.vertex_count != rig.weights.shape[0]:
        raise RigError(f"The rig moves {rig.weights.shape[0]} vertices, but the body has {source.vertex_count}.")
    moving = rig.weights.sum(axis=0) > _MOVES_NOTHING
    masses = np.where(moving, np.maximum(source.vertex_areas @ rig.weights, TINY), 0.0)
    if not moving.any():
        raise RigError("No bone of the rig moves a vertex.")
    return masses


def nearest_on_bones(skeleton: Skeleton, point: Floats) -> Floats:
    """Find the point of each bone that is nearest to a point, (b, 3)."""
    return skeleton.heads + shares_along(point, skeleton.heads, skeleton.axes)[:, None] * skeleton.axes


def joint_places(skeleton: Skeleton) -> Ints:
    """Give each place of heads and then tails a number, (2 b,)."""
    joints = skeleton.joints
    extent = float(np.linalg.norm(np.ptp(joints, axis=0)))
    pairs = cKDTree(joints).query_pairs(_SAME_PLACE * extent, output_type="ndarray")
    # The two ends of a very short bone are not one place.
    pairs = pairs[pairs[:, 1] - pairs[:, 0] != len(skeleton)]
    return joined_components(len(joints), *pairs.T)


def _joint_leader(skeleton: Skeleton, places: Ints, moving: Bools, bone: int) -> int:
    """Find the moving bone that starts where a bone starts, or else that ends there; -1 if there is none.

    Of several, the one whose other end is nearest to the bone's own.
    """
    heads, tails = np.split(places, 2)
    for ends, others in ((heads, skeleton.tails), (tails, skeleton.heads)):
        found = np.flatnonzero(moving & (ends == heads[bone]))
        if len(found):
            return int(found[np.linalg.norm(others[found] - skeleton.tails[bone], axis=1).argmin()])
    return -1


def _heaviest_moving(skeleton: Skeleton, moving: Bools, below: Floats, bone: int) -> np.int64:
    """Go down from a bone, always to the heaviest child, until a bone moves vertices."""
    found = np.int64(bone)
    while not moving[found]:
        children = skeleton.children(int(found))
        found = children[below[children].argmax()]
    return found


def _nearness(skeleton: Skeleton, moving: Bools, point: Floats) -> Floats:
    """Share one among the bones, (b,), by how near each moving bone is to a point."""
    distances = np.linalg.norm(nearest_on_bones(skeleton, point) - point, axis=1)
    distances = np.where(moving, distances, np.inf)
    parts = (max(distances.min(), TINY) / np.maximum(distances, TINY)) ** _NEARNESS
    return parts / parts.sum()
