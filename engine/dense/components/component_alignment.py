# SPDX-License-Identifier: GPL-3.0-or-later
"""Alignment of a loose piece of one mesh with its partner on the other."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from scipy.spatial import cKDTree
from scipy.spatial.transform import Rotation

from ...geometry.laplacian import laplace_beltrami
from ...geometry.procrustes import nearest_orthogonal
from ...mesh.closest_points import ClosestPoints, FoundPoints
from ...mesh.triangle_mesh import TriangleMesh
from ...registration.deformable import DeformableSurface
from ...registration.registration import FINE, LAST, Stage, register_steps
from ...runtime.arrays import TINY, Floats, Ints, evenly
from ...runtime.progress import Steps, in_turn
from .component_pairs import PartPair
from .similarity_field import Surroundings

_NORMAL_LENGTH = 0.25
"""How many radii a unit of difference of the normals counts: it tells the two sides of a thin part from each other."""

_ROUNDS, _MOST_POINTS, _TRIED_POINTS = 12, 1500, 200
"""Rounds of rigid fitting at most; how many vertices of either part serve for it, and to try how it may be turned."""

_CONVERGED = 0.99
"""Mean squared distance, as part of that of the round before, from which on no further round is made."""

_CLEARLY = 0.5
"""Cost of another placement, as part of that of the usual one, from which on it is believed."""

_TURNS = 8
"""Angles about its direction that are tried where a part does not fit as it is expected."""

_RIGID = 0.02
"""Root mean square distance, in radii, up to which a part is rigid."""

_DEFORMED = 40, 10_000
"""Vertices that parts need, and may have, to be deformed."""

_BENDING = Stage((5, 10, 20, 40, 80, 160), 0.1, 0.05)
"""A tail or a sleeve may be bent otherwise as a whole."""

_CARRIED = Stage((80, 160, 320, 1280, 2560), 0.05, 0.0, matched="around")
"""What its surroundings carry there is nearly where it belongs, but bent as they are."""


class _Motion(NamedTuple):
    """A similarity x -> centre + ratio R (x - old centre).

    It leaves a mean squared distance, in radii; it costs more where what touches the surroundings does not stay there.
    """

    rotation: Floats
    centre: Floats
    distance: float
    cost: float


def laid_steps(around: Surroundings, item: tuple[TriangleMesh, TriangleMesh, PartPair, bool]) -> Steps[FoundPoints]:
    """Map the vertices of a part to points of its partner.

    It is moved as a rigid body, of the partner's size, to where the two are closest [1]_.  If it does not fit then, it
    is turned to other sides, and deformed, from there and as it may have swung about where it touches its surroundings;
    what costs less is taken, and what touches there.  If it fits much better as its surroundings take it along, like
    clothes on a body, it is deformed from that alone, which knows what lies where.

    Parameters
    ----------
    around : Surroundings
        How space moves around it.
    item : tuple
        The part, n vertices; its partner; how it may be turned; and whether it is turned to other sides, and deformed.

    Yields
    ------
    Progress
        While it is deformed.

    Returns
    -------
    FoundPoints
        The point of each vertex, n.

    References
    ----------
    .. [1] P. J. Besl, N. D. McKay, "A method for registration of 3-D shapes", IEEE PAMI 14(2), 1992.
    """
    part, partner, pair, thoroughly = item
    aim = _Aim(partner, pair, _MOST_POINTS)
    best = _rigidly(part, aim, pair, pair.rotations[0])
    if thoroughly and best.distance > _RIGID**2:
        roughly = _Aim(partner, pair, _TRIED_POINTS)
        others = [_rigidly(part, roughly, pair, rotation) for rotation in _turned(pair)]
        for tried in (others[0], min(others[1:], key=lambda motion: motion.cost)):
            other = _rigidly(part, aim, pair, tried.rotation)
            best = other if other.cost < _CLEARLY * best.cost else best
    placed, normals = _placed(part, pair, best.rotation, best.centre), part.vertex_normals @ best.rotation.T
    if best.distance < _RIGID**2:
        return _closest(partner, placed, normals, pair.radius)
    handed = np.sign(np.linalg.det(best.rotation))
    carried = around.similarities(part.vertices, around.nearest(part.vertices)[0])(part.vertices)
    worn = handed * TriangleMesh(carried, part.triangles).vertex_normals
    cost = _cost(aim.found(_points(part, carried, worn, _MOST_POINTS))[0], pair, carried)
    fewest, most = _DEFORMED
    sizes = part.vertex_count, partner.vertex_count
    if thoroughly and fewest <= min(sizes) and max(sizes) <= most and handed > 0:
        if cost < _CLEARLY * best.cost:
            return (yield from _deformed_steps(part, partner, pair, [carried], (_CARRIED, LAST)))
        starts = [placed, _placed(part, pair, pair.rotations[-1], pair.centres[1])]
        starts += [carried] if cost < best.cost else []
        return (yield from _deformed_steps(part, partner, pair, starts, (_BENDING, FINE, LAST)))
    if cost < best.cost:
        placed, normals = carried, worn
    return _closest(partner, placed, normals, pair.radius)


def _turned(pair: PartPair) -> list[Floats]:
    """Rotations of a part that has swung about where it touches its surroundings, by all angles about its direction."""
    swung, arm = pair.rotations[-1], pair.centres[1] - pair.joint
    axis = arm / np.maximum(np.linalg.norm(arm), TINY)
    angles = np.arange(_TURNS) * (2 * np.pi / _TURNS)
    return list(Rotation.from_rotvec(angles[:, None] * axis).as_matrix() @ swung)


def _placed(part: TriangleMesh, pair: PartPair, rotation: Floats, centre: Floats) -> Floats:
    """Vertices of the part where a motion takes them, (n, 3)."""
    return centre + pair.ratio * (part.vertices - pair.centres[0]) @ rotation.T


def _strayed(pair: PartPair, placed: Floats) -> float:
    """By what factor a placement (n, 3) is less credible for having moved what touches the surroundings away."""
    away = placed[pair.touching].mean(axis=0) - pair.joint
    return float(1 + (away @ away) / pair.radius**2)


def _cost(distance: float, pair: PartPair, placed: Floats) -> float:
    """Tell what a placement (n, 3) at this mean squared distance costs, in square radii."""
    return (distance + _RIGID**2) * _strayed(pair, placed)


def _deformed_steps(
    part: TriangleMesh, partner: TriangleMesh, pair: PartPair, starts: list[Floats], stages: tuple[Stage, ...]
) -> Steps[FoundPoints]:
    """Deform a part onto its partner from each of some positions (n, 3), and take the most credible result."""
    source, target = (DeformableSurface(mesh, laplace_beltrami(mesh)) for mesh in (part, partner))
    found = yield from in_turn(register_steps(source, target, target.in_unit_size(s), stages) for s in starts)
    best = min(found, key=lambda one: one.cost * _strayed(pair, target.in_its_units(one.positions)))
    return best.on_target


def _rigidly(part: TriangleMesh, aim: _Aim, pair: PartPair, rotation: Floats) -> _Motion:
    """Move a part to where it is closest to its partner, beginning with a rotation, centre on centre."""
    handed = float(np.sign(np.linalg.det(rotation)))
    here, centre = _points(part, part.vertices, part.vertex_normals, aim.most), pair.centres[1]
    arms = pair.ratio * (here.places - pair.centres[0])
    shift, before = np.zeros(3), np.inf
    for number in range(_ROUNDS + 1):
        moved = _Points(centre + arms @ rotation.T + shift, here.normals @ rotation.T, here.shares)
        distance, images, origins = aim.found(moved)
        if number == _ROUNDS or distance > _CONVERGED * before or not distance > 0:
            break
        before = distance
        wanted = aim.points.places - centre
        sources, targets = np.concatenate([arms, arms[origins]]), np.concatenate([wanted[images], wanted])
        shares = np.concatenate([here.shares, aim.points.shares]) / 2
        middle, goal = shares @ sources, shares @ targets
        product = np.einsum("k,ki,kj->ij", shares, targets - goal, sources - middle)
        rotation = nearest_orthogonal(product[None], handed)[0]
        shift = goal - rotation @ middle
    centre = centre + shift
    return _Motion(rotation, centre, distance, _cost(distance, pair, _placed(part, pair, rotation, centre)))


class _Points(NamedTuple):
    """Some vertices of a mesh, the normals there, and shares of the area."""

    places: Floats
    normals: Floats
    shares: Floats


def _points(mesh: TriangleMesh, places: Floats, normals: Floats, most: int) -> _Points:
    """Take evenly numbered vertices, so many at most, of a mesh that has been moved to places and normals (n, 3)."""
    chosen = evenly(mesh.vertex_count, most)
    areas = mesh.vertex_areas[chosen] + 1e-9 * mesh.area
    return _Points(places[chosen], normals[chosen], areas / areas.sum())


class _Aim:
    """The partner that parts are laid onto by so many points: finds what is closest and looks to the same side."""

    def __init__(self, partner: TriangleMesh, pair: PartPair, most: int) -> None:
        self.most = most
        self.points = _points(partner, partner.vertices, partner.vertex_normals, most)
        self._pair = pair
        self._features = self._located(self.points)
        self._tree = cKDTree(self._features)

    def found(self, points: _Points) -> tuple[float, Ints, Ints]:
        """Return the mean squared distance in radii, both ways, of points from here, and which ones are the closest.

        These are indices into `points` of the partner for each of the given ones, and the other way round.
        """
        own = self._located(points)
        images, origins = self._tree.query(own)[1], cKDTree(own).query(self._features)[1]
        ahead, back = own - self._features[images], own[origins] - self._features
        squares = points.shares @ np.square(ahead[:, :3]).sum(axis=1)
        squares += self.points.shares @ np.square(back[:, :3]).sum(axis=1)
        return float(squares) / 2, images, origins

    def _located(self, points: _Points) -> Floats:
        """Places in radii, and normals, (k, 6)."""
        places = (points.places - self._pair.centres[1]) / self._pair.radius
        return np.concatenate([places, _NORMAL_LENGTH * points.normals], axis=1)


def _closest(partner: TriangleMesh, points: Floats, normals: Floats, radius: float) -> FoundPoints:
    """Find the closest points of a part that look to the same side."""
    length = _NORMAL_LENGTH * radius
    return ClosestPoints(partner).nearest(points, normals, normal_length=length, normal_weight=4 * length**2)
