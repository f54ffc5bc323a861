# SPDX-License-Identifier: GPL-3.0-or-later
"""Joints of a rig that stands in a body without moving it, carried into another body by the map between the two."""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from ...geometry.procrustes import across_axes, nearest_frame, nearest_orthogonal
from ...mesh.closest_points import ClosestPoints
from ...mesh.surface_map import SurfaceMap
from ...mesh.triangle_mesh import TriangleMesh
from ...runtime.arrays import TINY, Bools, Floats, Ints, evenly, group_means, marked, slices
from ...runtime.background import can_go_beside
from ...runtime.errors import RigError
from ...runtime.progress import Progress, Steps, at_once
from .bend_directions import kept_bends
from .joint_carriers import joint_places
from .joint_placement import NEAR_FRAME, PlacedJoints, swung, with_lengths
from .joint_symmetry import mirrored_joints
from .skeleton import Skeleton

_POWER = 3
"""With what power of its distance from a joint a place of the surface counts less."""

_AGAINST = 5.0
"""How many times as far a place counts that faces the joint from outside, such as the trunk beside an arm."""

_NEAREST = 8
"""How many places around a joint count alike at least: else one vertex under the skin decides."""

_FORWARD = 0.2
"""How much the map from the source counts against that to it, as in `rig_fit`."""

_LEAST_TRUST = 1e-3
"""With what confidence a place counts whose own is lower, so that there is always some."""

_MOST = 12_000
"""Places of each map that are looked at: of denser meshes that many, evenly among their vertices."""

_AT_ONCE = 64
"""Joints computed at once."""

_ROUNDS = 40
"""Rounds of moving a rig into a body."""

_MOST_SCALED = 1.2
"""Factor by which such a rig may become larger or smaller than the body is high: a tiny one would fit into any."""

_STEPS = np.linspace(0.1, 0.9, 5)
"""Where on a bone it is asked whether it is in the body."""


@can_go_beside
def carry_standing_rig_steps(
    source: TriangleMesh,
    target: TriangleMesh,
    source_to_target: SurfaceMap,
    target_to_source: SurfaceMap,
    *,
    skeleton: Skeleton,
    normals: Floats,
    frames: Floats | None = None,
    space: Floats | None = None,
) -> Steps[PlacedJoints]:
    r"""Carry a rig that stands in a body, and moves nothing of it, into another body.

    Each joint moves with the surface around it, by the similarity that is nearest to where the map takes it: moving
    least squares [1]_ with the weights :math:`a_i / |p_i - x|^3` for places with areas :math:`a_i`, of which those
    count less that face the joint from outside.  Joints at one place stay at one place.  Elbows and knees stay bent the
    way they are, and what is symmetric in a symmetric body stays symmetric.

    Parameters
    ----------
    source, target : TriangleMesh
        The bodies.
    source_to_target, target_to_source : SurfaceMap
        Maps between all their vertices.
    skeleton : Skeleton
        The bones, b, as they stand in the source.
    normals : (b, 3) array of float
        For each bone a direction across it, such as its local z axis.
    frames : (k, 3, 3) array of float, optional
        Rotations that the whole body may well be turned by exactly; roots outside of the body are turned so.
    space : (4, 4) array of float, optional
        The space in which the target was made, whose planes are preferred for its symmetry: see `mirrored_joints`.

    Returns
    -------
    PlacedJoints
        The bones in the target.

    Raises
    ------
    RigError
        If there is no bone, or not one normal for each.
    MatchError
        If the maps are not those of the surfaces.

    References
    ----------
    .. [1] S. Schaefer, T. McPhail, J. Warren, "Image deformation using moving least squares", SIGGRAPH 2006.
    """
    if not len(skeleton) or normals.shape != (len(skeleton), 3):
        raise RigError(
            f"{len(skeleton)} bones need one normal each, at least one, but got an array of the shape {normals.shape}."
        )
    source_to_target.check(source, target)
    target_to_source.check(target, source)
    yield Progress(0.0, "Carrying joints")
    field = _Field.of(source, target, source_to_target, target_to_source)
    places = joint_places(skeleton)
    counts = np.bincount(places)
    points = group_means(places, skeleton.joints, len(counts))
    wanted = np.concatenate([points, (skeleton.heads + skeleton.tails) / 2])
    found = []
    for part in slices(len(wanted), _AT_ONCE):
        yield Progress(0.9 * part.start / len(wanted), "Carrying joints")
        found.append(field.at(wanted[part]))
    moved, turns, scales = (np.concatenate([getattr(each, name) for each in found]) for name in _Moved.__annotations__)
    heads, tails = np.split(moved[: len(points)][places], 2)
    turns, scales = turns[len(points) :], scales[len(points) :]
    yield Progress(0.9, "Carrying joints")
    outside = _roots_outside(skeleton, source)
    turns[outside] = field.upright(frames)
    axes = skeleton.axes
    rigid = np.einsum("bij,bj->bi", turns, axes) * scales[:, None]
    alone = marked(outside, len(axes)) & (counts[np.split(places, 2)[1]] == 1)
    tails = np.where(alone[:, None], heads + rigid, tails)
    heads, tails = kept_bends(skeleton, heads, tails, turns, places)
    heads, tails = with_lengths(skeleton, heads, tails, rigid, places)
    rotations = swung(turns, axes, tails - heads)
    across = np.einsum("bij,bj->bi", rotations, across_axes(normals, axes))
    heads, tails, across = mirrored_joints(skeleton, target, (heads, tails, across), space)
    yield Progress(1.0, "Carrying joints")
    return PlacedJoints(heads, tails, across, swung(turns, axes, tails - heads))


carry_standing_rig = at_once(carry_standing_rig_steps)


def standing_share(skeleton: Skeleton, mesh: TriangleMesh, deforming: Bools) -> float:
    """Tell what part of deforming bones (b,) lies inside of a body: near one if they stand in it, else near zero."""
    lengths = np.repeat(np.linalg.norm(skeleton.axes, axis=1)[deforming], len(_STEPS))
    inside = ~_outside(skeleton.points_along(_STEPS)[deforming].reshape(-1, 3), mesh)
    return float(lengths @ inside / max(lengths.sum(), TINY))


def moved_into(skeleton: Skeleton, mesh: TriangleMesh, deforming: Bools, up: Floats) -> Skeleton:
    """Move and scale a rig that stands elsewhere so that it lies in a body as well as it can without being posed.

    Parameters
    ----------
    skeleton : Skeleton
        The bones, upright as the body is.
    mesh : TriangleMesh
        The body.
    deforming : (b,) array of bool
        Which bones belong into it.
    up : (3,) array of float
        Direction away from the ground, of length one.

    Returns
    -------
    Skeleton
        The bones: first as high as the body and in its middle, then moved and scaled until as little as may be lies
        outside.
    """
    points = skeleton.points_along(_STEPS)[deforming].reshape(-1, 3)
    heights = [np.array([(each @ up).min(), (each @ up).max()]) for each in (points, mesh.vertices)]
    whole = scale = float(np.diff(heights[1])[0] / max(np.diff(heights[0])[0], TINY))
    middles = [(each.min(axis=0) + each.max(axis=0)) / 2 for each in (points, mesh.vertices)]
    way = middles[1] - scale * middles[0]
    search = ClosestPoints(mesh)
    for _ in range(_ROUNDS):
        now = scale * points + way
        nearest, facing = _surface_beside(now, mesh, search)
        # What is inside may stay, and what is outside is to come in as far as it is out.
        goals = np.where((facing > 0)[:, None], 2 * nearest - now, now)
        here, there = points - points.mean(axis=0), goals - goals.mean(axis=0)
        best = float((here * there).sum() / max(np.square(here).sum(), TINY))
        scale = float(np.clip(best, whole / _MOST_SCALED, whole * _MOST_SCALED))
        way = goals.mean(axis=0) - scale * points.mean(axis=0)
    return Skeleton(skeleton.parents, *(scale * ends + way for ends in (skeleton.heads, skeleton.tails)))


def _outside(points: Floats, mesh: TriangleMesh) -> Bools:
    """Tell which points (k, 3) the surface nearest to them faces."""
    return _surface_beside(points, mesh, ClosestPoints(mesh))[1] > 0


def _surface_beside(points: Floats, mesh: TriangleMesh, search: ClosestPoints) -> tuple[Floats, Floats]:
    """Find the nearest points (k, 3) of the surface, and how far it faces the points, (k,): negative inside."""
    found = search.nearest(points)
    nearest, normals = (found.interpolate(mesh.triangles, each) for each in (mesh.vertices, mesh.vertex_normals))
    return nearest, ((points - nearest) * normals).sum(axis=1)


def _roots_outside(skeleton: Skeleton, source: TriangleMesh) -> Ints:
    """Find the bones without a parent that begin outside of the body, such as a root on the ground."""
    roots = np.flatnonzero(skeleton.parents < 0)
    return roots[_outside(skeleton.heads[roots], source)]


class _Moved(NamedTuple):
    """Where points went (k, 3), how what is around them is turned (k, 3, 3), and how it is scaled (k,)."""

    points: Floats
    turns: Floats
    scales: Floats


@dataclass(frozen=True, eq=False)
class _Field:
    """Places of the source's surface (n, 3), its normals there, their images, and how much each counts.

    The handedness is -1 if the images are those of a mirror, else 1.
    """

    places: Floats
    normals: Floats
    images: Floats
    areas: Floats
    handedness: float

    @classmethod
    def of(cls, source: TriangleMesh, target: TriangleMesh, there: SurfaceMap, back: SurfaceMap) -> _Field:
        """Take the vertices of both bodies with their images."""
        forward = evenly(source.vertex_count, _MOST)
        backward = evenly(target.vertex_count, _MOST)
        trust = [np.maximum(each.confidence, _LEAST_TRUST) * each.has_partner for each in (there, back)]
        shares = [
            part * mesh.vertex_areas[rows] * sure[rows] / mesh.area / max(len(rows), 1) * mesh.vertex_count
            for part, mesh, sure, rows in ((_FORWARD, source, trust[0], forward), (1.0, target, trust[1], backward))
        ]
        areas = np.concatenate(shares)
        if not areas.any():
            raise RigError("The two bodies have nothing in common, so the rig cannot be carried over.")
        kept = areas > 0
        normals = np.concatenate([source.vertex_normals[forward], back.transfer(source.vertex_normals)[backward]])
        places = np.concatenate([source.vertices[forward], back.positions[backward]])
        images = np.concatenate([there.positions[forward], target.vertices[backward]])
        handedness = -1.0 if there.mirrors(source, target) else 1.0
        return cls(places[kept], normals[kept], images[kept], areas[kept], handedness)

    def at(self, points: Floats) -> _Moved:
        """Move points (k, 3) with what is around them."""
        away = self.places - points[:, None]  # (k, n, 3)
        distances = np.linalg.norm(away, axis=2)
        facing = np.einsum("knd,nd->kn", away, self.normals) / np.maximum(distances, TINY)
        distances = distances * (1 + (_AGAINST - 1) * np.clip(-facing, 0, 1))
        count = min(_NEAREST, distances.shape[1]) - 1
        near = np.partition(distances, count, axis=1)[:, count]
        weights = self.areas / np.maximum(distances, np.maximum(near, TINY)[:, None]) ** _POWER
        return self._similar(points, weights / weights.sum(axis=1, keepdims=True))

    def upright(self, frames: Floats | None) -> Floats:
        """Find how the whole body is turned: as one of the frames if that is near."""
        turn = self._similar(self.places[:1], (self.areas / self.areas.sum())[None]).turns[0]
        return nearest_frame(turn, frames, NEAR_FRAME)

    def _similar(self, points: Floats, weights: Floats) -> _Moved:
        """Move points (k, 3) by the similarities that weights (k, n), which sum to one, make best."""
        here, there = weights @ self.places, weights @ self.images
        products = np.einsum("nd,ne->nde", self.images, self.places).reshape(-1, 9)
        covariances = (weights @ products).reshape(-1, 3, 3) - there[:, :, None] * here[:, None]
        spreads = weights @ np.square(self.places).sum(axis=1) - np.square(here).sum(axis=1)
        turns = nearest_orthogonal(covariances, self.handedness)
        scales = np.einsum("kij,kij->k", turns, covariances) / np.maximum(spreads, TINY)
        return _Moved(there + scales[:, None] * np.einsum("kij,kj->ki", turns, points - here), turns, scales)
