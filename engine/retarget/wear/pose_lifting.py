# SPDX-License-Identifier: GPL-3.0-or-later
"""Clothes that are lifted where the skin would come through them in a bent joint."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from scipy.sparse import block_diag, csr_array, diags_array, vstack
from scipy.spatial import cKDTree

from ...geometry.laplacian import laplace_beltrami
from ...geometry.symmetric_factor import symmetric_factor
from ...mesh.closest_points import ClosestPoints, FoundPoints
from ...mesh.connectivity.welded_parts import WeldedParts
from ...mesh.surface_points import interpolation_matrix
from ...mesh.triangle_mesh import TriangleMesh
from ...runtime.arrays import Bools, Floats, Ints, marked, unit_vectors
from ...runtime.background import can_go_beside
from ...runtime.progress import Progress, Steps
from ..rig.skeleton import Skeleton
from ..weights.skin_weights import row_sums
from .contact import Surface, surface_samples
from .joint_bends import JointBend, Pose, joint_bends, poses_of, strides, turned
from .pose_mending import WeightedItem
from .pushing import FIRM, FREE, SPREAD
from .rigid_pieces import moved_along

_ROUNDS = 4
"""How often is looked anew what comes through."""

_NEAR = 0.012
"""Distance from the skin, in sqrt(area) of the body, up to which cloth lies on it: 16 mm on a human.  What hangs
further away moves along the skin in a pose, and is not judged by the place below it at rest."""

_ABOVE = 5e-4
"""Least distance from the skin in a pose, in the same unit, if it is more at rest."""

_SHALLOW = 0.015
"""How deep in the skin, in the same unit, cloth is in a pose that lifting it may help; what is deeper is in a fold."""

_MOST = 0.004
"""How far, in the same unit, cloth of small triangles is lifted at most: 5 mm on a human.  With twice as much the
outfits of ``python -m tests.benchmarks.outfits`` are further from where they should be (0.717 instead of 0.710)."""

_COARSE = 0.15
"""The same for cloth of large triangles, further through which skin comes: a part of the root of a vertex's area, up to
`_NEAR`.  With 0.1 and 0.008 twice as much skin shows at the raised thigh of Formal in ``python -m
tests.benchmarks.worn_makers``."""

_REACH = 0.022
"""How deep places of the skin are looked for, in the same unit, that come through cloth of large triangles.  Cloth
may be lifted for them by `_LOOSE` times as much as it hangs off the skin, up to this: else most of what shows in a
stride through the skirt of Formal on a woman in trousers still does (tried once)."""

_LOOSE = 2.0
"""Chosen by hand: with 1 a third more shows there, in wide strides (tried once)."""

_COVERED, _APART = 0.06, 0.014
"""How far below cloth, in the same unit, a place of the skin is covered by it, and so how far it may slide along it in
a pose; and how far apart such places are: a part of the size of large triangles."""

_STRAIGHT = 0.5
"""Least cosine between the way from such a place to the cloth and its normal."""

_LOWER = 0.5
"""Part of its height over such a place, below which what covers it comes in a pose, for the place to be looked at."""

_RIM = 1e-3
"""Barycentric coordinate up to which a place is at a side of its triangle."""

_FAR = float(np.radians(80.0))
"""How far joints are bent, as hips are in a squat, in poses that are tried for large triangles alone: without, four
times as much skin shows through Formal there.  Small ones would take outfits further away in them (0.713)."""

_STRIDE = float(np.radians(45.0))
"""How far two limbs are bent against each other, as in a long stride."""

_ROOM = 0.8
"""Part of the distance that a vertex would have from the skin, lifted twice as far as any is, from which on it has
room: with less, other skin is above it, as between thighs that touch, and it stays.  Without that, tried once, O1 of
``python -m tests.benchmarks.outfits`` shows 0.29 % of the skin instead of 0.03."""

_TRIFLE = 1e-4
"""What is less than this, in the same unit, is nothing."""

_TURNED = 0.5
"""Least cosine between the normal of the skin in a pose and as it would be turned with the cloth: else it is folded."""

_PARTLY = 0.005
"""Part of a place that a joint moves from which on, and that it does not move, for the place to be looked at."""

_LAYERS, _NEIGHBOURS, _OPPOSITE, _ALIKE = 0.012, 12, -0.3, 0.3
"""How far apart layers of cloth are at most, in the same unit, that are lifted together; how many vertices are looked
at; the largest cosine between the normals of both sides of one item; and the least between those of the skin below."""

_TOGETHER = 10.0
"""How much layers that move apart count, beside `FREE`: chosen by hand, so that they keep their order; what shows of
the skin hardly depends on it."""

_STILL = 1e6
"""How much what stays counts."""


@can_go_beside
def lift_for_poses_steps(
    items: Sequence[WeightedItem], *, body: TriangleMesh, skin_weights: csr_array, skeleton: Skeleton
) -> Steps[list[Floats]]:
    """Lift clothes off the skin where it comes through them when a joint is bent.

    The weights of the skin are not linear over it, those of a triangle of cloth are: in a bent joint, the larger the
    triangle, the further the skin below its middle comes through.  So places of the cloth that lie on the skin at
    rest are looked at in poses, and lifted, smoothly, as far as they are short of it.  Where the triangles are large,
    places of the skin are looked at as well, also where the cloth hangs off it, and it is lifted over those that come
    through.  Layers that lie on each other are lifted together, rigid pieces with what is around them.

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
        After each round.

    Returns
    -------
    list of (n, 3) array of float
        How far the vertices of each item are moved.
    """
    bends = list(joint_bends(body, skin_weights, skeleton, range(len(skeleton))))
    if not items or not bends:
        return [np.zeros(item.positions.shape) for item in items]
    unit = float(np.sqrt(body.area))
    skin = Surface(body)
    cloth = _Cloth(items, skin, unit)
    lying = _Lying.of(cloth, skin, unit)
    looked = [(bend, lying.partly(cloth, bend)) for bend in bends]
    for bend in joint_bends(body, skin_weights, skeleton, range(len(skeleton)), angle=_FAR):
        rows = lying.partly(cloth, bend)
        looked.append((bend, rows[lying.coarse[rows]]))
    covered = _Covered(cloth, skin, unit)
    near = joint_bends(body, skin_weights, skeleton, range(len(skeleton)), angle=_STRIDE)
    covered.try_in([*poses_of(bends), *strides(list(near), skeleton)])
    for number in range(_ROUNDS):
        yield Progress(number / _ROUNDS, "Trying poses")
        lacking, (shares, pokes) = lying.lacking(cloth, looked, unit), covered.poking()
        if not lacking.any() and not len(pokes):
            break
        cloth.lift(csr_array(vstack([lying.shares, shares])), np.concatenate([lacking, pokes]))
    yield Progress(1.0, "Trying poses")
    return cloth.lifts()


class _Cloth:
    """All items as one surface whose seams are closed, w vertices, and how far it is lifted by now."""

    def __init__(self, items: Sequence[WeightedItem], skin: Surface, unit: float) -> None:
        self.items, self._unit = items, unit
        self.parts = [WeldedParts.of(item.mesh) for item in items]
        meshes = [part.closed for part in self.parts]
        self.surface = TriangleMesh.concatenated(meshes)
        self.positions = self.surface.vertices
        self.weights = csr_array(
            vstack([part.means @ item.weights for part, item in zip(self.parts, items, strict=True)])
        )
        still = [item.still[part.first] for part, item in zip(self.parts, items, strict=True)]
        _, self._outward, heights = _below(self.positions, skin)
        self.is_still = np.concatenate(still) | (row_sums(self.weights) <= 0)
        operators = [laplace_beltrami(mesh) for mesh in meshes]
        self.mass = np.concatenate([np.where(each.mass > 0, each.mass, each.mass.mean()) for each in operators])
        size = np.sqrt(self.mass)
        self.most_lying = (_COARSE * size).clip(_MOST * unit, _NEAR * unit)
        self.is_coarse = self.most_lying > _MOST * unit
        hangs = (_LOOSE * heights).clip(max=_REACH * unit)
        self.most = np.where(self.is_coarse, np.maximum(hangs, self.most_lying), self.most_lying)
        self.is_still |= _is_squeezed(self.positions, heights, self._outward, skin, 2 * self.most_lying)
        stiffness = block_diag([each.stiffness for each in operators], format="csr")
        self._smooth = csr_array((SPREAD * unit) ** 2 * stiffness + self._ties(meshes))
        self.moves = np.zeros_like(self.positions)

    def _ties(self, meshes: Sequence[TriangleMesh]) -> csr_array:
        """Return what holds layers above the same skin together, be they of different items or of one, (w, w)."""
        owners = np.repeat(np.arange(len(meshes)), [mesh.vertex_count for mesh in meshes])
        normals = np.concatenate([mesh.vertex_normals for mesh in meshes])
        count = min(_NEIGHBOURS, len(owners))
        distances, near = cKDTree(self.positions).query(self.positions, [*range(1, count + 1)])
        one, column = np.nonzero(distances < _LAYERS * self._unit)
        other = near[one, column]
        apart = (owners[one] != owners[other]) | (np.einsum("ki,ki->k", normals[one], normals[other]) < _OPPOSITE)
        apart &= np.einsum("ki,ki->k", self._outward[one], self._outward[other]) > _ALIKE
        one, column, other = one[apart], column[apart], other[apart]
        partners = np.bincount(one, minlength=len(owners))[one]
        # Where two parts were one they stay so.
        sewn = distances[one, column] < _TRIFLE * self._unit
        np.minimum.at(self.most, one[sewn], self.most[other[sewn]])
        np.logical_or.at(self.is_still, one[sewn], self.is_still[other[sewn]])
        strength = np.where(sewn, _STILL, _TOGETHER) * np.minimum(self.mass[one], self.mass[other]) / partners
        rows = np.arange(len(one))
        shape = (len(one), len(owners))
        between = csr_array((np.ones(len(one)), (rows, one)), shape=shape)
        between = csr_array(between - csr_array((np.ones(len(one)), (rows, other)), shape=shape))
        return csr_array(between.T @ diags_array(strength) @ between)

    def samples(self, spacing: float) -> csr_array:
        """Shares of the vertices in places that are spread over all items, (s, w)."""
        every = [surface_samples(part.closed, spacing)[0] for part in self.parts]
        return csr_array(block_diag(every, format="csr"))

    def lift(self, shares: csr_array, lacking: Floats) -> None:
        """Move places (k, w) as far as is lacking (k, 3), as smoothly as that allows."""
        spread = (shares != 0).sum(axis=0)
        masses = shares @ (self.mass / np.maximum(spread, 1))
        chosen = np.flatnonzero(lacking.any(axis=1))
        rows = csr_array(shares[chosen])
        weighted = csr_array(diags_array(FIRM * masses[chosen]) @ rows)
        hold = diags_array(self.mass * (FREE + _STILL * self.is_still))
        factor = symmetric_factor(csr_array(self._smooth + hold + rows.T @ weighted))
        moves = self.moves + factor.solve(weighted.T @ lacking[chosen])
        # Beside what is lifted a smooth move overshoots, but nothing is to come nearer to the skin.
        moves -= np.einsum("ki,ki->k", moves, self._outward).clip(max=0)[:, None] * self._outward
        lengths = np.linalg.norm(moves, axis=1)
        moves *= np.minimum(1, self.most / np.maximum(lengths, _TRIFLE * self._unit))[:, None]
        moves[self.is_still] = 0.0
        self.moves = moves

    def lifts(self) -> list[Floats]:
        """How far the vertices of each item are moved, rigid pieces as those of its cloth that are nearest to them."""
        ends = np.cumsum([part.welded_count for part in self.parts])
        found = []
        for item, part, own in zip(self.items, self.parts, np.split(self.moves, ends[:-1]), strict=True):
            moves, rigid = own[part.welded], item.pieces >= 0
            moves[rigid] = moved_along(item.positions, moves, item.pieces)[item.pieces[rigid]]
            moves[np.linalg.norm(moves, axis=1) < _TRIFLE * self._unit] = 0.0
            found.append(moves)
        return found


@dataclass(frozen=True, eq=False)
class _Lying:
    """Places of cloth (k) that lie on the skin at rest.

    Attributes
    ----------
    shares : (k, w) csr_array of float
        Their shares of the vertices of the cloth.
    corners : (k, 3, 3) array of float
        The triangle of the skin below each, and `barycentric` (k, 3) where in it; `numbers` (k, 3) are its vertices.
    normals : (k, 3) array of float
        The normal there.
    least : (k,) array of float
        Their least distance from it in a pose.
    coarse : (k,) array of bool
        Which are on large triangles.
    """

    shares: csr_array
    corners: Floats
    barycentric: Floats
    numbers: Ints
    normals: Floats
    least: Floats
    coarse: Bools

    @classmethod
    def of(cls, cloth: _Cloth, skin: Surface, unit: float) -> _Lying:
        """Find the places that lie on the skin."""
        body = skin.mesh
        shares = cloth.samples(0.75 * float(np.sqrt(2 * body.area / max(body.triangle_count, 1))))
        shares = csr_array(shares[np.flatnonzero(shares @ cloth.is_still < 1)])
        found, _, heights = _below(shares @ cloth.positions, skin)
        numbers, barycentric = body.triangles[found.triangles], found.barycentric
        beside = ((barycentric > 0) <= skin.rim[numbers]).all(axis=1)  # beyond the rim of a hole
        at = np.flatnonzero((heights > 0) & (heights < _NEAR * unit) & ~beside)
        return cls(
            csr_array(shares[at]),
            body.vertices[numbers[at]],
            barycentric[at],
            numbers[at],
            body.triangle_normals[found.triangles[at]],
            np.minimum(heights[at], _ABOVE * unit),
            (shares @ cloth.is_coarse)[at] > 1 / 2,
        )

    def partly(self, cloth: _Cloth, bend: JointBend) -> Ints:
        """Find the places that a joint neither moves wholly, with all of the skin below, nor leaves at rest."""
        shares = self.shares @ row_sums(cloth.weights[:, bend.hanging])
        parts = [shares, *bend.on_skin[self.numbers.T]]
        least, most = np.minimum.reduce(parts), np.maximum.reduce(parts)
        return np.flatnonzero((most > _PARTLY) & (least < 1 - _PARTLY))

    def lacking(self, cloth: _Cloth, looked: Sequence[tuple[JointBend, Ints]], unit: float) -> Floats:
        """Find how far each place has to be moved at rest so that in no pose it is below the skin, (k, 3)."""
        largest, moves = np.full(len(self.least), _TRIFLE * unit), np.zeros((len(self.least), 3))
        now = cloth.positions + cloth.moves
        for bend, rows in looked:
            if not len(rows):
                continue
            places, corners = csr_array(self.shares[rows]), self.corners[rows]
            on_cloth, on_skin = row_sums(cloth.weights[:, bend.hanging]), bend.on_skin[self.numbers[rows]]
            shares = places @ on_cloth
            at_rest, of_cloth = places @ now, places @ bend.levers(now, on_cloth)
            of_skin = bend.levers(corners, on_skin)
            for rotation in bend.rotations:
                skin, points = corners + turned(of_skin, rotation), at_rest + turned(of_cloth, rotation)
                normals = unit_vectors(np.cross(skin[:, 1] - skin[:, 0], skin[:, 2] - skin[:, 0]))
                feet = np.einsum("kc,kci->ki", self.barycentric[rows], skin)
                lack = self.least[rows] - np.einsum("ki,ki->k", points - feet, normals)
                worse = np.flatnonzero((lack > largest[rows]) & (lack < _SHALLOW * unit))
                at, share = rows[worse], shares[worse][:, None]
                back = (1 - share) * normals[worse] + share * (normals[worse] @ rotation)
                alike = np.einsum("ki,ki->k", unit_vectors(back), self.normals[at]) > _TURNED
                at, worse, back = at[alike], worse[alike], back[alike]
                largest[at], moves[at] = lack[worse], lack[worse][:, None] * back
        most = self.shares @ cloth.most_lying - np.linalg.norm(self.shares @ cloth.moves, axis=1)
        return moves * (most / largest).clip(0, 1)[:, None]


class _Covered:
    """Places of the skin (k) below cloth of large triangles, which may come through it in poses."""

    def __init__(self, cloth: _Cloth, skin: Surface, unit: float) -> None:
        body, mesh = skin.mesh, cloth.surface
        shares, owners = surface_samples(body, _APART * unit)
        places, normals = shares @ body.vertices, np.concatenate([skin.normals, body.triangle_normals[owners]])
        chosen = _spaced(places, mesh, (_COVERED * unit, _APART * unit))
        self._cloth, self._unit, self._search = cloth, unit, ClosestPoints(mesh)
        found = self._search.nearest(places[chosen])
        over, heights = self._heights_of(found, self._search, places[chosen], normals[chosen])
        covered = (heights > 0) & (heights < _COVERED * unit) & (cloth.is_coarse[over].sum(axis=1) > 1)
        self._rim = marked(mesh.boundary_edges, mesh.vertex_count)
        at = chosen[covered]
        self._places, self._normals, self._shares = places[at], normals[at], csr_array(shares[at])
        self._over, self._barycentric, self._heights = over[covered], found.barycentric[covered], heights[covered]
        self._starts = self._over[np.arange(len(at)), self._barycentric.argmax(axis=1)]
        self._tries: list[_Try] = []

    def _heights_of(
        self, found: FoundPoints, search: ClosestPoints, places: Floats, normals: Floats
    ) -> tuple[Ints, Floats]:
        """Return the corners of the cloth nearest to places of the skin, and its heights; no numbers if it is aside."""
        corners = self._cloth.surface.triangles[found.triangles]
        away = np.einsum("kc,kci->ki", found.barycentric, search.vertices[corners]) - places
        heights, distances = np.einsum("ki,ki->k", away, normals), np.sqrt(found.squared_distances)
        return corners, np.where(np.abs(heights) > _STRAIGHT * distances, heights, np.nan)

    def try_in(self, poses: Sequence[Pose]) -> None:
        """Look at the places in poses whose joints move them or the cloth over them, and not both wholly."""
        if not len(self._places):
            return
        parts = {}
        for bend in {id(bend): bend for pose in poses for bend in pose.bends}.values():
            on_cloth, on_skin = row_sums(self._cloth.weights[:, bend.hanging]), self._shares @ bend.on_skin
            both = [on_skin, *on_cloth[self._over.T]]
            parts[id(bend)] = on_cloth, on_skin, np.minimum.reduce(both), np.maximum.reduce(both)
        for pose in poses:
            moved = [parts[id(bend)] for bend in pose.bends]
            partly = np.all([(most > _PARTLY) & (least < 1 - _PARTLY) for _, _, least, most in moved], axis=0)
            rows = np.flatnonzero(partly)
            if len(rows):
                self._tries.append(_Try(pose, rows, [each[0] for each in moved], [each[1][rows] for each in moved]))

    def poking(self) -> tuple[csr_array, Floats]:
        """Find places that come through the cloth: shares of its vertices there (p, w), and the moves over them (p, 3).

        Of each place the pose counts in which it comes furthest.  Next time only those are looked at that were through.
        """
        now, largest = self._cloth.positions + self._cloth.moves, np.zeros(len(self._places))
        corners, barycentric = np.zeros((len(largest), 3), np.int64), np.zeros((len(largest), 3))
        moves, tries = np.zeros_like(barycentric), []
        for given in self._tries:
            one, through = self._through(given, now)
            if not len(one.rows):
                continue
            tries.append(one)
            worse = np.flatnonzero(through.lacks > largest[one.rows] + _TRIFLE * self._unit)  # not by rounding
            at, lacks = one.rows[worse], through.lacks[worse]
            over, where = through.corners[worse], through.barycentric[worse]
            shares = [np.einsum("kc,kc->k", where, each[over]) for each in one.on_cloth]
            largest[at], corners[at], barycentric[at] = lacks, over, where
            moves[at] = one.pose.brought_back(lacks[:, None] * through.normals[worse], shares)
        self._tries, at = tries, np.flatnonzero(largest)
        return interpolation_matrix(barycentric[at], corners[at], len(now)), moves[at]

    def _through(self, one: _Try, now: Floats) -> tuple[_Try, _Through]:
        """Find which places of a try come through the cloth in its pose, if it is at rest where it is now, (w, 3)."""
        posed = one.pose.bent(now, one.on_cloth)
        normals = one.pose.turned(self._normals[one.rows], one.on_skin)
        places = one.pose.bent(self._places[one.rows], one.on_skin)
        own = np.einsum("kc,kci->ki", self._barycentric[one.rows], posed[self._over[one.rows]]) - places
        lower = np.einsum("ki,ki->k", own, normals) < _LOWER * self._heights[one.rows]
        one, normals, places = one.only(lower), normals[lower], places[lower]
        search = self._search.moved(posed)
        found = search.walk(places, self._starts[one.rows])
        over, heights = self._heights_of(found, search, places, normals)
        within = (heights < 0) & (heights > -_REACH * self._unit)
        within &= ~((found.barycentric > _RIM) <= self._rim[over]).all(axis=1)
        home = np.einsum("kc,kci->ki", found.barycentric, self._cloth.positions[over])
        within &= np.linalg.norm(home - self._places[one.rows], axis=1) < _COVERED * self._unit
        looks = unit_vectors(np.cross(*(posed[over[:, side]] - posed[over[:, 0]] for side in (1, 2))))
        within &= np.abs(np.einsum("ki,ki->k", looks, normals)) > _ALIKE
        lacks = _ABOVE * self._unit - heights
        return one.only(within), _Through(lacks[within], normals[within], over[within], found.barycentric[within])


@dataclass(frozen=True, eq=False)
class _Try:
    """A pose, the places looked at in it (r,), and how much its joints move the cloth (w,) and each of them (r,)."""

    pose: Pose
    rows: Ints
    on_cloth: Sequence[Floats]
    on_skin: Sequence[Floats]

    def only(self, chosen: Bools) -> _Try:
        """Return the same of some of the places, (r,)."""
        return replace(self, rows=self.rows[chosen], on_skin=[each[chosen] for each in self.on_skin])


@dataclass(frozen=True, eq=False)
class _Through:
    """How far cloth lacks over places of the skin (p,), which way (p, 3), its corners there and where in it (p, 3)."""

    lacks: Floats
    normals: Floats
    corners: Ints
    barycentric: Floats


def _spaced(points: Floats, mesh: TriangleMesh, sizes: tuple[float, float]) -> Ints:
    """Choose points (k, 3) within a distance of a mesh's extent, one in each cell of another size."""
    reach, cell = sizes
    low, high = mesh.vertices.min(axis=0) - reach, mesh.vertices.max(axis=0) + reach
    near = np.flatnonzero(((points > low) & (points < high)).all(axis=1))
    cells = np.floor((points[near] - low) / cell).astype(np.int64)
    return near[np.sort(np.unique(cells, axis=0, return_index=True)[1])]


def _below(points: Floats, skin: Surface) -> tuple[FoundPoints, Floats, Floats]:
    """Find the skin nearest to points (k, 3), its normals there (k, 3), and their heights above it (k,)."""
    found, body = skin.search.nearest(points), skin.mesh
    outward = np.einsum("kc,kci->ki", found.barycentric, skin.normals[body.triangles[found.triangles]])
    away = points - found.interpolate(body.triangles, body.vertices)
    heights = np.linalg.norm(away, axis=1) * np.sign(np.einsum("ki,ki->k", away, outward))
    return found, unit_vectors(outward), heights


def _is_squeezed(points: Floats, heights: Floats, outward: Floats, skin: Surface, room: Floats) -> Bools:
    """Say which points (k, 3), at heights (k,) along normals of the skin (k, 3), have no room (k,) or are in it."""
    lifted = skin.clearance(points + room[:, None] * outward).distances
    return (heights <= 0) | (lifted < _ROOM * (heights + room))
