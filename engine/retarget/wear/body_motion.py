# SPDX-License-Identifier: GPL-3.0-or-later
"""Motion of the space around a body that becomes another one, which takes along what the body wears."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.sparse import csr_array, vstack
from scipy.spatial import cKDTree
from scipy.spatial.distance import pdist

from ...geometry.procrustes import nearest_rotations
from ...mesh.closest_points import ClosestPoints
from ...mesh.surface_points import interpolation_matrix
from ...mesh.triangle_mesh import TriangleMesh
from ...runtime.arrays import TINY, Floats, Ints, slices, unit_vectors, weighted_quantile
from ..values.deformation_gradients import surface_frames

_TURN_RADIUS = 0.02
"""Over what distance rotations of the skin are averaged, in sqrt(area): about the breadth of a finger."""

_SCALE_RADIUS = 0.08
"""The same for scales: cloth is as large as what is around it on the whole, not as the skin under it."""

_PIECE_RADIUS = 0.08
"""Over what distance from a rigid piece, in sqrt(area), its size is that of the skin around it: some 11 cm on a human.
With 0.04 to 0.16 ``python -m tests.benchmarks.outfits`` has nearly the same error of sizes, .03."""

_MOST_PLACES = 400
"""Places between which distances are measured for that, all with all."""

_NEIGHBOURS = 48
"""Places on the skin that carry a point."""

_POOL = 192
"""How many are looked at to find them: those of other limbs may be nearer."""

_WIDTH = 0.6
"""How wide the surroundings are that carry a point, as a part of its distance from the skin."""

_LEAST_WIDTH = 0.006
"""Least width, in sqrt(area): skin is moved to a map that is not exact to less."""

_OTHER_LIMB = 3.0
"""How many times further away skin counts as that is moved by wholly other bones than the point."""

_BEHIND = 1.0
"""How much further, as a part of the distance, skin counts as that looks away from the point."""

_TOUCHING = 0.003
"""Distance from the skin, in sqrt(area), below which it says nothing which way the skin looks."""

_FEWEST = 4 * _NEIGHBOURS
"""No coarser set of places is made of fewer than these."""

_CHUNK = 2048
"""Points treated at once, which bounds the memory."""


@dataclass(frozen=True, eq=False)
class Motion:
    """How points move with a body.

    Attributes
    ----------
    positions : (k, 3) array of float
        Where they come to be.
    rotations : (k, 3, 3) array of float
        How the space around each turns.
    scales : (k,) array of float
        How many times as large it becomes.
    places : csr_array of float
        For each point (k) what part of it each vertex of the body carries; rows sum to one.
    """

    positions: Floats
    rotations: Floats
    scales: Floats
    places: csr_array


@dataclass(frozen=True, eq=False)
class Carriers:
    """What carries points: at each of some levels of places, which points (k',), and the shares of places (k', p).

    Attributes
    ----------
    levels : tuple of (int, (k',) array of int, (k', p) csr_array of float)
        The number of the level, the points, and the shares, whose rows sum to one.
    away : (k, 3) array of float
        From the mean of its places to each point.
    places : (k, n) csr_array of float
        The shares of the vertices of the body.
    """

    levels: tuple[tuple[int, Ints, csr_array], ...]
    away: Floats
    places: csr_array


@dataclass(frozen=True, eq=False)
class _Places:
    """Places on the skin (p, ...), so far apart; which vertices each stands for is a matrix (p, n) of shares."""

    spacing: float
    positions: Floats
    normals: Floats
    areas: Floats
    bones: Floats
    shares: csr_array

    def averaged(self, number: Ints) -> _Places:
        """Put places together that have the same number (p,)."""
        count = int(number.max()) + 1
        # A least area, so that places of needles only have a mean as well.
        areas = np.maximum(self.areas, 1e-9 * self.areas.mean())
        totals = np.bincount(number, areas, count).astype(np.float64)
        mean = csr_array((areas / totals[number], (number, np.arange(len(number)))), shape=(count, len(number)))
        return _Places(
            2 * self.spacing,
            mean @ self.positions,
            unit_vectors(mean @ self.normals),
            totals,
            mean @ self.bones,
            csr_array(mean @ self.shares),
        )


class BodySkin:
    """The skin of a body as what is around it sees it: places on it, ever fewer.

    Parameters
    ----------
    body : TriangleMesh
        The body.
    bones : (n, b) csr_array of float, optional
        How much each of some bones moves each vertex.
    """

    def __init__(self, body: TriangleMesh, bones: csr_array | None = None) -> None:
        self.body = body
        self.search = ClosestPoints(body)
        self.size = float(np.sqrt(body.area))
        self._has_bones = bones is not None
        used = np.flatnonzero(body.vertex_areas > 0)
        n = body.vertex_count
        known = np.zeros((n, 1)) if bones is None else bones.toarray()
        first = _Places(
            float(np.sqrt(body.area / max(len(used), 1))),
            body.vertices[used],
            body.vertex_normals[used],
            body.vertex_areas[used],
            known[used],
            csr_array((np.ones(len(used)), (np.arange(len(used)), used)), shape=(len(used), n)),
        )
        self.levels = [first]
        while (coarser := _coarser(self.levels[-1])) is not None:
            self.levels.append(coarser)
        self._trees = [cKDTree(level.positions, balanced_tree=False, compact_nodes=False) for level in self.levels]

    def carriers(self, points: Floats, distances: Floats, bones: csr_array | None) -> Carriers:
        """Find what carries points.

        Parameters
        ----------
        points : (k, 3) array of float
            Points around the body.
        distances : (k,) array of float
            How wide each looks around: its distance from the skin, or more.
        bones : (k, b) csr_array of float, optional
            How much the same bones move each point.
        """
        width = np.maximum(_WIDTH * distances, _LEAST_WIDTH * self.size)
        spacings = np.array([level.spacing for level in self.levels])
        numbers = (np.searchsorted(spacings, width / 2, side="right") - 1).clip(min=0)
        away, levels, places = np.zeros((len(points), 3)), [], [csr_array((0, self.body.vertex_count))]
        for number in np.unique(numbers):
            chosen = np.flatnonzero(numbers == number)
            shares = []
            for chunk in slices(len(chosen), _CHUNK):
                part = chosen[chunk]
                known = bones[part].toarray() if bones is not None and self._has_bones else None
                shares.append(self._shares(points[part], width[part], bones=known, number=int(number)))
            joined = csr_array(vstack(shares))
            level = self.levels[number]
            away[chosen] = points[chosen] - joined @ level.positions
            levels.append((int(number), chosen, joined))
            places.append(csr_array(joined @ level.shares))
        order = np.argsort(np.concatenate([np.empty(0, np.int64), *(rows for _, rows, _ in levels)]), kind="stable")
        return Carriers(tuple(levels), away, csr_array(csr_array(vstack(places))[order]))

    def _shares(self, points: Floats, width: Floats, *, bones: Floats | None, number: int) -> csr_array:
        """Find the places of a level that carry some points, and their shares."""
        level, tree = self.levels[number], self._trees[number]
        pool = min(_POOL, len(level.positions))
        count = min(_NEIGHBOURS, pool)
        distances, near = (found.reshape(-1, pool) for found in tree.query(points, pool))
        away = points[:, None] - level.positions[near]
        cost = np.ones_like(distances)
        if bones is not None:
            total = np.minimum(bones.sum(axis=1), level.bones.sum(axis=1)[near].max(axis=1))
            same = np.zeros_like(distances)
            for bone, column in enumerate(bones.T):  # few of which move any one point
                moved = np.flatnonzero(column)
                same[moved] += np.minimum(column[moved, None], level.bones[near[moved], bone])
            cost += _OTHER_LIMB * (total[:, None] - same).clip(0, 1)
        front = np.einsum("kpi,kpi->kp", away, level.normals[near]) / np.maximum(distances, TINY)
        cost += _BEHIND * (1 - front.clip(0, 1)) * (distances > _TOUCHING * self.size)
        cost *= distances
        best = np.argsort(cost, axis=1, kind="stable")[:, :count]
        near, cost = np.take_along_axis(near, best, 1), np.take_along_axis(cost, best, 1)
        weights = level.areas[near] * np.exp(-(cost**2 - cost[:, :1] ** 2) / (2 * width[:, None] ** 2))
        weights = np.where(weights.sum(axis=1, keepdims=True) > 0, weights, 1.0)
        weights /= weights.sum(axis=1, keepdims=True)
        return interpolation_matrix(weights, near, len(level.positions))


class BodyMotion:
    r"""The motion of space around a body.

    A point x moves as skin near it would take it along: vertex i of the skin, which goes from :math:`a_i` to
    :math:`b_i` and turns and scales what is around it by :math:`R_i` and :math:`s_i`, takes x to
    :math:`b_i + s_i R_i (x - a_i)`, and x goes to the mean of these.  The further away from the skin it is, the wider
    the skin that carries it: a shirt follows the chest, a coat the body.  Skin moved by other bones than x, or
    looking away from it, counts as further away.

    Parameters
    ----------
    skin : BodySkin
        The body, before.
    images : (n, 3) array of float
        Where its vertices come to be.
    """

    def __init__(self, skin: BodySkin, images: Floats) -> None:
        body = skin.body
        turning = surface_frames(body, images, radius=_TURN_RADIUS)
        growing = surface_frames(body, images, radius=_SCALE_RADIUS)
        self._skin = skin
        # Of each level: where its places come to be, how they turn and grow, and both in one, (p, 3), (p, 3, 3), (p,).
        self._images = [level.shares @ images for level in skin.levels]
        self._scales = [level.shares @ growing.scales for level in skin.levels]
        grown = (turning.rotations * growing.scales[:, None, None]).reshape(-1, 9)
        self._turned = [level.shares @ grown for level in skin.levels]

    @property
    def overall(self) -> float:
        """How many times as long lengths become on the whole."""
        return float(np.average(self._scales[0], weights=self._skin.levels[0].areas))

    def growth_around(self, points: Floats) -> float:
        """Find how many times as far apart the skin around some points comes to be.

        The median over pairs of places counts: unlike areas and edges it knows nothing of folds that the skin has on
        one body alone, such as eye sockets, the mouth and ears, and little of a joint that is bent.

        Parameters
        ----------
        points : (k, 3) array of float
            Points around the body before, of one rigid piece.
        """
        radius, levels = _PIECE_RADIUS * self._skin.size, self._skin.levels
        number = max(int(np.searchsorted([level.spacing for level in levels], radius / 2, side="right")) - 1, 0)
        level = levels[number]
        away = cKDTree(points).query(level.positions)[0]
        near = np.argsort(away, kind="stable")[:_MOST_PLACES]
        closeness = level.areas[near] * np.exp(-(away[near] ** 2 - away[near[0]] ** 2) / (2 * radius**2))
        before, after = pdist(level.positions[near]), pdist(self._images[number][near])
        one, other = np.triu_indices(len(near), 1)
        weights = closeness[one] * closeness[other] * (before > 0)
        if not weights.sum() > 0:
            return self.overall
        return weighted_quantile(after / np.where(before > 0, before, 1.0), weights)

    def move(self, carriers: Carriers) -> Motion:
        """Move points along with what carries them."""
        k = len(carriers.away)
        positions, turned, scales = np.empty((k, 3)), np.empty((k, 9)), np.empty(k)
        for number, rows, shares in carriers.levels:
            positions[rows] = shares @ self._images[number]
            turned[rows], scales[rows] = shares @ self._turned[number], shares @ self._scales[number]
        rotations = nearest_rotations(turned.reshape(-1, 3, 3))
        positions += scales[:, None] * np.einsum("kij,kj->ki", rotations, carriers.away)
        return Motion(positions, rotations, scales, carriers.places)


def _coarser(places: _Places) -> _Places | None:
    """Average places in the cells of a grid, twice as far apart; none if too few would be left.

    Places that look to opposite sides stay apart, such as both sides of a hand.
    """
    cells = np.floor((places.positions - places.positions.min(axis=0)) / (2 * places.spacing)).astype(np.int64)
    octants = (places.normals > 0) @ np.array([1, 2, 4])
    _, number = np.unique(np.column_stack([cells, octants]), axis=0, return_inverse=True)
    number = number.ravel()
    if int(number.max()) + 1 < _FEWEST or int(number.max()) + 1 > 0.7 * len(number):
        return None
    return places.averaged(number)
