# SPDX-License-Identifier: GPL-3.0-or-later
"""The rest pose of a body that was delivered in another pose: the rotations of its bones undone, their lengths kept."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.sparse import csr_array

from ...mesh.connectivity.edge_chains import way_to_root
from ...mesh.triangle_mesh import TriangleMesh
from ...runtime.arrays import Floats, Ints
from ...runtime.errors import RigError
from ..weights.skin_weights import row_sums
from .bone_fit import skinned
from .fitted_rig import FittedRig
from .joint_carriers import carriers_of, moved_areas
from .joint_placement import PlacedJoints, root_direction, standing

_LARGE_PART = 0.01
"""A bone is judged by its angle if it moves more than this part of the body: that of a finger is mostly noise."""

_POSED_ANGLE = np.radians(40.0)
"""A body is posed if a bone is bent more than this against the source: other proportions bend them by up to 25 degrees
as well, and the mildest walk by more than 55."""

_LEAST_DETERMINANT = 0.05
"""Blended transforms that shrink space more than this are not inverted."""


@dataclass(frozen=True, eq=False)
class RestPose:
    """How the bones of a rig move from the pose that a body was delivered in to rest.

    Attributes
    ----------
    posed_heads : (b, 3) array of float
        Heads of the bones as delivered.
    heads : (b, 3) array of float
        Heads at rest.
    turns : (b, 3, 3) array of float
        How each bone turns.
    """

    posed_heads: Floats
    heads: Floats
    turns: Floats

    def __repr__(self) -> str:
        return f"<RestPose: {len(self.heads)} bones>"


def bend_angles(rig: FittedRig, source: TriangleMesh, placed: PlacedJoints) -> Floats:
    """Find by what angle the large bones of a body are bent against those above, in addition to the source.

    Parameters
    ----------
    rig : FittedRig
        The rig.
    source : TriangleMesh
        The body that it moves.
    placed : PlacedJoints
        Its bones in the target.

    Returns
    -------
    (b,) array of float
        Angles in radians; zero for bones that move little of the body, and where no bone above moves any.
    """
    judged, above = _large_bones(rig, source)
    relative = np.einsum("bji,bjk->bik", placed.rotations[above], placed.rotations[judged])
    angles = np.zeros(len(rig.skeleton))
    angles[judged] = np.arccos(((np.trace(relative, axis1=1, axis2=2) - 1) / 2).clip(-1, 1))
    return angles


def _large_bones(rig: FittedRig, source: TriangleMesh) -> tuple[Ints, Ints]:
    """Find bones (k,) that move much of the body, and the moving bones (k,) above them: all that have one."""
    areas, above = moved_areas(rig, source), carriers_of(rig, source).above
    large = np.flatnonzero((areas > _LARGE_PART * areas.sum()) & (above >= 0))
    return large, above[large]


def is_posed(rig: FittedRig, source: TriangleMesh, placed: PlacedJoints) -> bool:
    """Tell whether the target is in another pose than the source, not just of another build."""
    return bool(bend_angles(rig, source, placed).max(initial=0.0) > _POSED_ANGLE)


def rest_pose(rig: FittedRig, source: TriangleMesh, placed: PlacedJoints, frames: Floats | None = None) -> RestPose:
    """Turn all bones of the target as they are turned in the source.

    The target stays where it is, and stands as high above its root as it was delivered.  Bones that move no vertex
    follow those that carry them.

    Parameters
    ----------
    rig : FittedRig
        The rig.
    source : TriangleMesh
        The body that it moves.
    placed : PlacedJoints
        Its bones in the target, from `place_joints`.
    frames : (k, 3, 3) array of float, optional
        Rotations that the whole body may be turned by: see `standing`.

    Returns
    -------
    RestPose
        In the space of the target.
    """
    carriers, upright = carriers_of(rig, source), standing(rig, source, frames)
    turns = upright @ placed.rotations.transpose(0, 2, 1)
    heads = placed.heads.copy()
    leaders = _leaders(rig, carriers.above, moved_areas(rig, source))
    after_leaders = sorted(range(len(leaders)), key=lambda bone: len(way_to_root(leaders, bone)))
    for bone in after_leaders:
        above = leaders[bone]
        if carriers.moving[bone] and above >= 0:
            heads[bone] = heads[above] + turns[above] @ (placed.heads[bone] - placed.heads[above])
    rooted = carriers.anchors >= 0
    for bone in np.flatnonzero(~carriers.moving & ~rooted):
        parts = carriers.of_places[carriers.places[bone]]
        heads[bone] = parts @ (heads + np.einsum("cij,cj->ci", turns, placed.heads[bone] - placed.heads))
    if rooted.any():
        down = upright @ root_direction(rig, source, int(np.flatnonzero(rooted)[0]))
        lying = unposed(rig.registered, rig.weights, RestPose(placed.heads, heads, turns))
        heads[~rooted] += ((rig.registered @ down).max() - (lying @ down).max()) * down
    return RestPose(placed.heads, heads, turns)


def _leaders(rig: FittedRig, above: Ints, masses: Floats) -> Ints:
    """Find for each bone the one that it goes with, (b,): the moving one above it, -1 for none.

    A foot that hangs on nothing, because inverse kinematics move it, goes with the bone of the body that moves most of
    the same vertices: the shin.  Else they would be torn apart.
    """
    leaders = above.copy()
    tops = np.arange(len(above))
    for bone in rig.skeleton.order:
        if above[bone] >= 0:
            tops[bone] = tops[above[bone]]
    sums = np.bincount(tops, weights=masses, minlength=len(above))
    shared = (rig.weights.T @ rig.weights).toarray()
    joined = tops == sums.argmax()
    waiting = {int(top) for top in tops[masses > 0]} - {int(sums.argmax())}
    while waiting:
        common = {top: shared[np.ix_([top], joined)][0] for top in waiting}
        top = max(sorted(waiting), key=lambda one: common[one].max(initial=0.0))
        if not common[top].max(initial=0.0) > 0:
            break
        leaders[top] = np.flatnonzero(joined)[common[top].argmax()]
        joined |= tops == top
        waiting.remove(top)
    return leaders


def at_rest(placed: PlacedJoints, rest: RestPose) -> PlacedJoints:
    """Return the bones of the target as they lie in its rest pose: turned as in the source, with their own lengths."""
    tails = rest.heads + np.einsum("bij,bj->bi", rest.turns, placed.tails - placed.heads)
    normals = np.einsum("bij,bj->bi", rest.turns, placed.normals)
    return PlacedJoints(rest.heads, tails, normals, rest.turns @ placed.rotations)


def length_ratio(rig: FittedRig, source: TriangleMesh, rest: RestPose) -> float:
    """Find how many times longer the large bones of the target are than those of the source, all together.

    Parameters
    ----------
    rig : FittedRig
        The rig.
    source : TriangleMesh
        The body that it moves.
    rest : RestPose
        The target at rest.

    Returns
    -------
    float
        By what movements of the whole body grow, such as steps; the mean scale of the bones if none hangs on another.
    """
    judged, above = _large_bones(rig, source)
    before, after = (
        float(np.linalg.norm(heads[judged] - heads[above], axis=1).sum()) for heads in (rig.skeleton.heads, rest.heads)
    )
    if not (before > 0 and after > 0):
        return float(np.average(rig.scales, weights=moved_areas(rig, source)))
    return after / before


def unposed(vertices: Floats, weights: csr_array, rest: RestPose) -> Floats:
    """Bring vertices of the target to rest: the inverse of linear blend skinning, which posed them.

    Parameters
    ----------
    vertices : (n, 3) array of float
        The target as delivered.
    weights : (n, b) csr_array of float
        How much each bone moves each vertex; rows sum to one, or are empty: such vertices stay.
    rest : RestPose
        The pose.

    Returns
    -------
    (n, 3) array of float
        Positions at rest.

    Raises
    ------
    RigError
        If the weights are not of these vertices and bones.
    """
    if weights.shape != (len(vertices), len(rest.heads)):
        raise RigError(
            f"Weights of {len(vertices)} vertices and {len(rest.heads)} bones are needed, but got {weights.shape}."
        )
    back = rest.turns.transpose(0, 2, 1)
    shifts = rest.posed_heads - np.einsum("bij,bj->bi", back, rest.heads)
    blended = (weights @ back.reshape(-1, 9)).reshape(-1, 3, 3)
    # Where bones turn nearly opposite ways the blend collapses; forward blending is the better guess there.
    sound = np.linalg.det(blended) > _LEAST_DETERMINANT
    blended[~sound] = np.eye(3)
    inverse = np.linalg.solve(blended, (vertices - weights @ shifts)[:, :, None])[:, :, 0]
    way = rest.heads - np.einsum("bij,bj->bi", rest.turns, rest.posed_heads)
    forward = skinned(vertices, weights, rest.turns, way)
    weighted = row_sums(weights) > 0
    return np.where(weighted[:, None], np.where(sound[:, None], inverse, forward), vertices)
