# SPDX-License-Identifier: GPL-3.0-or-later
"""Places of a rig's joints in another body, and the turns of its bones there."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...geometry.procrustes import across_axes, least_turns, nearest_frame, nearest_orthogonal
from ...mesh.triangle_mesh import TriangleMesh
from ...runtime.arrays import TINY, Floats, Ints, group_means, unit_vectors
from ...runtime.errors import RigError
from .fitted_rig import FittedRig
from .joint_carriers import carriers_of, moved_areas, nearest_on_bones
from .skeleton import Skeleton

_SHORTEST = 0.02
"""Least length of a bone, in units of what its scale makes of its length in the source."""

NEAR_FRAME = np.radians(45.0)
"""A body is turned by one of the frames if its own rotation is not further away."""

_REFLECTIONS = np.eye(3) - 2 * np.einsum("ij,ik->ijk", np.eye(3), np.eye(3))
"""Reflections along the axes: a body in a mirror may be turned by a frame after one of them."""

_LEAST_REACH = 0.05
"""Least part of the body's extent by which a root is away from its middle, and with which it reaches towards it."""

_LEAST_AIM = 1e-4
"""Joints nearer to a bone's head than this, in units of the longest such way, do not turn it."""

_MEDIAN_ROUNDS, _MEDIAN_SHARPNESS = 21, 0.01
"""Rounds of weighting by the inverse difference, and the least difference of two rotations that counts there."""


@dataclass(frozen=True, eq=False)
class PlacedJoints:
    """The bones of a rig in another body.

    Attributes
    ----------
    heads, tails : (b, 3) array of float
        Their ends; no bone is without length.
    normals : (b, 3) array of float
        A direction across each bone that turns with it, such as its local z axis: of length one.
    rotations : (b, 3, 3) array of float
        How each bone is turned against the source, from its ends and its normal.
    """

    heads: Floats
    tails: Floats
    normals: Floats
    rotations: Floats

    def __repr__(self) -> str:
        return f"<PlacedJoints: {len(self.heads)} bones>"


def place_joints(rig: FittedRig, source: TriangleMesh, normals: Floats, frames: Floats | None = None) -> PlacedJoints:
    """Place all bones of a fitted rig in the target.

    A joint between two bones goes to the mean of where both take it.  Bones that move no vertex follow the bone whose
    joint they share, else the nearest one above them that does move some, else the bones around them; one above most
    of the body, such as a root on the ground, stands to the whole body as it did.

    Parameters
    ----------
    rig : FittedRig
        The rig.
    source : TriangleMesh
        The body that it moves, n_x vertices.
    normals : (b, 3) array of float
        For each bone a direction across it in the source, such as its local z axis.
    frames : (k, 3, 3) array of float, optional
        Rotations that the whole body may be turned by: see `standing`.

    Returns
    -------
    PlacedJoints
        In the space of the target.

    Raises
    ------
    RigError
        If no bone moves a vertex, or the arrays do not fit the rig.
    """
    skeleton = rig.skeleton
    if normals.shape != (len(skeleton), 3):
        raise RigError(f"{len(skeleton)} bones need one normal each, but got an array of the shape {normals.shape}.")
    carriers = carriers_of(rig, source)
    count = len(carriers.of_places)
    points = group_means(carriers.places, skeleton.joints, count)  # (k, 3)
    placed = np.zeros((count, 3))
    for place, bone in np.argwhere(carriers.of_places > 0):
        placed[place] += carriers.of_places[place, bone] * _carried(rig, bone, points[place])
    upright = standing(rig, source, frames)
    turns = nearest_orthogonal(np.einsum("bc,cij->bij", carriers.of_turns, rig.rotations), rig.handedness)
    for bone in np.flatnonzero(carriers.anchors >= 0):
        turns[bone] = upright
        placed[carriers.places[bone]] = _rooted(rig, source, upright, bone, carriers.anchors[bone])
    heads, tails = np.split(placed[carriers.places], 2)
    scales = np.exp(carriers.of_turns @ np.log(np.maximum(rig.scales, TINY)))
    axes = skeleton.axes
    free = np.flatnonzero(carriers.free & carriers.moving)
    turns[free] = _aimed(skeleton, heads, turns, moved_areas(rig, source))[free]
    rigid = np.einsum("bij,bj->bi", turns, axes) * scales[:, None]
    loose = carriers.free & ~carriers.moving  # they stay as long as they are
    tails = np.where(loose[:, None], heads + rigid, tails)
    lengths = np.linalg.norm(np.einsum("bij,bj->bi", rig.linear, axes), axis=1)
    tails[free] = heads[free] + unit_vectors(rigid[free]) * lengths[free, None]
    heads, tails = with_lengths(skeleton, heads, tails, rigid, carriers.places)
    rotations = swung(turns, axes, tails - heads)
    across = np.einsum("bij,bj->bi", rotations, across_axes(normals, axes))
    return PlacedJoints(heads, tails, across, rotations)


def standing(rig: FittedRig, source: TriangleMesh, frames: Floats | None = None) -> Floats:
    """Find how the whole body is turned, whatever its limbs do.

    Parameters
    ----------
    rig : FittedRig
        The rig.
    source : TriangleMesh
        The body that it moves.
    frames : (k, 3, 3) array of float, optional
        Rotations that it may well be turned by exactly, such as none at all.

    Returns
    -------
    (3, 3) array of float
        The nearest of the frames, or the median rotation of all bones if none is near.
    """
    middle = _median(rig.rotations, moved_areas(rig, source), rig.handedness)
    if rig.handedness < 0 and frames is not None:
        frames = np.concatenate([frames @ reflection for reflection in _REFLECTIONS])
    return nearest_frame(middle, frames, NEAR_FRAME)


def _aimed(skeleton: Skeleton, heads: Floats, turns: Floats, masses: Floats) -> Floats:
    """Turn bones (b, 3, 3) so that they point to the joints of those that hang on them, as they did, however they end.

    Where a bone ends alone says nothing: importers set that, often a hair's breadth from its head and across the limb.
    """
    below = skeleton.hanging @ masses
    before, after = np.zeros((2, len(skeleton), 3))
    for bone in np.flatnonzero(skeleton.parents >= 0):
        parent = skeleton.parents[bone]
        before[parent] += below[bone] * (skeleton.heads[bone] - skeleton.heads[parent])
        after[parent] += below[bone] * (heads[bone] - heads[parent])
    lengths = np.linalg.norm(before, axis=1)
    far = np.minimum(lengths, np.linalg.norm(after, axis=1)) > _LEAST_AIM * lengths.max(initial=0.0)
    aimed = turns.copy()
    aimed[far] = swung(turns[far], before[far], after[far])
    return aimed


def _median(rotations: Floats, masses: Floats, handedness: float) -> Floats:
    """Find the median (3, 3) by mass of the rotations of bones: limbs tilt no body."""
    apart, middle = np.ones(len(masses)), np.eye(3)
    for _ in range(_MEDIAN_ROUNDS):
        shares = masses / np.maximum(apart, _MEDIAN_SHARPNESS)
        blended = np.einsum("b,bij->ij", shares / shares.sum(), rotations)
        middle = nearest_orthogonal(blended[None], handedness)[0]
        apart = np.linalg.norm(rotations - middle, axis=(1, 2))
    return middle


def root_direction(rig: FittedRig, source: TriangleMesh, root: int) -> Floats:
    """Find the way from the middle of the source's body to a root outside of it, of length one; zero if inside."""
    middle = source.vertex_areas @ source.vertices / source.area
    away = rig.skeleton.heads[root] - middle
    outside = np.linalg.norm(away) > _LEAST_REACH * np.linalg.norm(np.ptp(source.vertices, axis=0))
    return unit_vectors(away) if outside else np.zeros(3)


def _rooted(rig: FittedRig, source: TriangleMesh, upright: Floats, bone: int, anchor: int) -> Floats:
    """Place the head of a root: as far beyond its anchor as before, measured by how far the body reaches that way.

    So a root on the ground stands on the ground, however the legs are bent.
    """
    start = rig.skeleton.heads[anchor]
    away = rig.skeleton.heads[bone] - start
    moved = rig.linear[anchor] @ start + rig.translations[anchor]
    direction = root_direction(rig, source, bone)
    reach = float(((source.vertices - start) @ direction).max())
    new_reach = float(((rig.registered - moved) @ (upright @ direction)).max())
    usable = reach > _LEAST_REACH * np.linalg.norm(np.ptp(source.vertices, axis=0)) and new_reach > 0
    growth = new_reach / reach - rig.scales[anchor] if usable else 0.0
    return moved + upright @ (rig.scales[anchor] * away + growth * (away @ direction) * direction)


def _carried(rig: FittedRig, bone: int, point: Floats) -> Floats:
    """Move a point with a bone: on the bone as its vertices move, and from there on without shear."""
    start = nearest_on_bones(rig.skeleton, point)[bone]
    moved = rig.linear[bone] @ start + rig.translations[bone]
    return moved + rig.scales[bone] * rig.rotations[bone] @ (point - start)


def with_lengths(
    skeleton: Skeleton, heads: Floats, tails: Floats, rigid: Floats, places: Ints
) -> tuple[Floats, Floats]:
    """Give bones that became too short the vectors `rigid` from head to tail; what was connected to them follows."""
    heads, tails = heads.copy(), tails.copy()
    head_places, tail_places = np.split(places, 2)
    lengths = np.linalg.norm(rigid, axis=1)
    usual = float(np.median(lengths[lengths > 0])) if (lengths > 0).any() else 1.0
    for bone in skeleton.order:
        parent = skeleton.parents[bone]
        if parent >= 0 and head_places[bone] == tail_places[parent]:
            heads[bone] = tails[parent]
        if np.linalg.norm(tails[bone] - heads[bone]) > _SHORTEST * max(lengths[bone], _SHORTEST * usual):
            continue
        has_length = lengths[bone] > _SHORTEST * _SHORTEST * usual
        tails[bone] = heads[bone] + (rigid[bone] if has_length else [0, 0, _SHORTEST * usual])
    return heads, tails


def swung(rotations: Floats, before: Floats, after: Floats) -> Floats:
    """Turn rotations (b, 3, 3) by the least angle so that they take vectors (b, 3) to the direction of others."""
    start = unit_vectors(np.einsum("bij,bj->bi", rotations, before))
    return least_turns(start, unit_vectors(after)) @ rotations
