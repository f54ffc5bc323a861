# SPDX-License-Identifier: GPL-3.0-or-later
"""Clothes that are pushed out of what is below them, smoothly, until nothing pokes through."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.sparse import csr_array, diags_array, vstack
from scipy.spatial import cKDTree

from ...geometry.laplacian import LaplaceBeltrami
from ...geometry.symmetric_factor import symmetric_factor
from ...mesh.connectivity.components import joined_components, triangle_neighbours
from ...mesh.connectivity.halfedges import twins_of
from ...mesh.surface_points import interpolation_matrix
from ...mesh.triangle_mesh import TriangleMesh
from ...runtime.arrays import Bools, Floats, Ints, marked, unit_vectors
from .buried_places import Buried
from .contact import Surface

_ROUNDS = 8
"""How often is looked anew where something pokes through."""

_SMOOTHLY = 6
"""In how many of them items are pushed smoothly, and for places of theirs that are below as well; the last are for the
places of what is below that can be seen.  Chosen by ``python -m tests.benchmarks.outfits``: with 4 smooth rounds and 2
that move places of the item one by one, twice as many of O1's edges are folded over."""

SPREAD = 0.03
"""How far a push spreads over the cloth, in sqrt(area of the body), if `FREE` is one; farther the less that is.  Both
were chosen by ``python -m tests.benchmarks.outfits``: with 0.018 and 0.05 most of a shirt and of trousers is pushed."""

FIRM = 30.0
"""How much a place that has to move counts against the smoothness of the push."""

FREE = 0.5
"""How much a place that need not move counts."""

_LARGEST_STEP = 0.02
"""How far, in the same unit, anything is pushed at once."""

_NEAR = 0.03
"""Distance on the first body, in the same unit, within which a layer below is looked at."""

_POKING = 0.022
"""How far through the cloth, in the same unit, a place of the skin is looked for."""

_STRAIGHT = 0.5
"""Least cosine between the way from such a place to the cloth and its normal."""

_ALIKE, _HOME = 0.3, 0.06
"""Least cosine between the normals there and where the item lay before, and the largest distance between the two, in
the same unit: else it is another limb."""

_MARGIN = 0.001
"""How far over such a place, in the same unit, the item is moved: with half of that, and no middles of edges among the
places, three times as much skin shows in specks on the Witch of ``python -m tests.benchmarks.worn_makers``."""

_MOSTLY = 0.3
"""Part of a place of the item by its corners that has to have lain outside, for the skin not to show above it."""

_ALONG = 0.3
"""Least cosine between the normals of two layers of cloth, of either sign, for the one to lie on the other: what comes
out of a hem or ends at it, as trousers at a jacket that is closed below, crosses it."""

_CROSSING = np.sqrt(1 / 2)
"""Cosine between the normals of cloth and skin up to which cloth that ends within the body crosses the skin: what
closes a jacket below does, a trouser leg that goes on within a boot does not.  With 0.3 what closes hems still pushes
them away (``python -m tests.benchmarks.worn_makers``)."""

_ONE = 1e-6
"""Distance, in the same unit, up to which two layers of cloth are one, as where two parts of a body were cut apart:
neither is the upper one."""

_INSIDE = -0.001
"""Distance from the surface below, in the same unit, down to which a place counts as lying on it: what is further
inside, as the inner side of a sole, was meant to."""


@dataclass(frozen=True, eq=False)
class Layer:
    """What an item lies on: the skin, or an item below.

    Attributes
    ----------
    surface : Surface
        As it is now, on the second body.
    wanted : (s,) array of float
        For each sample of the item the least distance from it; minus infinity where it does not lie on it.
    starts : (s,) array of int
        The vertex of the surface from which to search, near where it lay on it before.
    outside : (n,) array of bool
        Which vertices of the item lay outside.
    closing : (t,) array of bool
        Which of its triangles close it within the body: nothing is moved for their sake.
    """

    surface: Surface
    wanted: Floats
    starts: Ints
    outside: Bools
    closing: Bools


def layer_of(
    surface_before: Surface,
    surface: Surface,
    *,
    samples: tuple[csr_array, Ints],
    items: tuple[TriangleMesh, TriangleMesh],
    scales: Floats,
    unit: float,
    least: float,
    places: Ints | None = None,
    buried: Buried | None = None,
    margin: float = 0.0,
) -> Layer:
    """Find how an item lay on a surface, and so how it has to lie on it now.

    Parameters
    ----------
    surface_before, surface : Surface
        The skin, or an item below, on the first body and as it is now.
    samples : (s, n) csr_array of float and (s - n,) array of int
        Samples of the item, see `surface_samples`.
    items : pair of TriangleMesh
        The item on the first body and as it is now, n vertices.
    scales : (n,) array of float
        How many times as large it becomes.
    unit : float
        Root of the area of the first body.
    least : float
        Distance that is enough, now: where the item was further away, nothing is asked beyond it.
    places : (m,) array of int, optional
        For each vertex of the skin before, the vertex of the other that it came to be; none for an item below.
    buried : Buried, optional
        What of the skin before lies deep within the body, as where parts of a character are closed: nothing has to lie
        outside of it.
    margin : float
        Least distance, now, of all that lay outside.
    """
    (shares, owners), (before, now), n = samples, items, items[0].vertex_count
    points = shares @ before.vertices
    # Away from the surface only vertices are asked on which side they are.
    low, high = surface_before.mesh.vertices.min(axis=0), surface_before.mesh.vertices.max(axis=0)
    asked = ((points > low - _NEAR * unit) & (points < high + _NEAR * unit)).all(axis=1)
    asked[:n] = True
    asked_shares = shares[asked]
    found = surface_before.clearance(points[asked])
    outside = (found.distances > _INSIDE * unit) | ~found.known
    near = found.known & (found.distances < _NEAR * unit)
    if places is None:
        along = np.einsum("si,si->s", unit_vectors(asked_shares @ before.vertex_normals), found.normals)
        outside &= ~near | (np.abs(along) > _ALONG) & (np.abs(found.distances) > _ONE * unit)
    closing = np.zeros(before.triangle_count, bool)
    if buried is not None:
        outside &= ~buried.vertices[found.vertices]
        inner = buried.vertices[found.vertices[:n]][before.triangles].any(axis=1)
        closing = _crossing(surface, now, inner | _lids(buried.middles, before, unit))
        outside[n:] &= ~closing[owners[asked[n:]]]
    wanted = np.minimum((asked_shares @ scales) * found.distances.clip(min=0), least)
    all_wanted, starts = np.full(len(points), -np.inf), np.zeros(len(points), np.int64)
    all_wanted[asked] = np.where(near & outside, np.maximum(wanted, margin), -np.inf)
    starts[asked] = found.vertices if places is None else places[found.vertices]
    return Layer(surface, all_wanted, starts, outside[:n], closing)


def _lids(middles: Floats, item: TriangleMesh, unit: float) -> Bools:
    """Tell which triangles of an item, (t,), have their middles at some of the body, (k, 3), or are flat with those."""
    if not len(middles):
        return np.zeros(item.triangle_count, bool)
    own = item.vertices[item.triangles].mean(axis=1)
    there = np.isfinite(cKDTree(middles).query(own, distance_upper_bound=_ONE * unit)[0])
    other, normals = triangle_neighbours(twins_of(item.vertices, item.triangles)).ravel(), item.triangle_normals
    one = np.arange(item.triangle_count).repeat(3)
    flat = np.einsum("li,li->l", normals[one], normals[other]) > _CROSSING
    labels = joined_components(item.triangle_count, one[flat], other[flat])
    return np.isin(labels, labels[there])


def _crossing(surface: Surface, item: TriangleMesh, within: Bools) -> Bools:
    """Find which triangles of some within the body, (t,), cross its surface instead of lying along it, (t,)."""
    near = np.flatnonzero(within)
    normals = surface.clearance(item.vertices[item.triangles[near]].mean(axis=1)).normals
    along = np.abs(np.einsum("ti,ti->t", item.triangle_normals[near], normals))
    return marked(near[along < _CROSSING], item.triangle_count)


def pushed_out(
    mesh: TriangleMesh,
    positions: Floats,
    laplace: LaplaceBeltrami,
    samples: csr_array,
    *,
    layers: Sequence[Layer],
    fixed: Bools,
    unit: float,
    drawn: Floats | None = None,
) -> Floats:
    """Push an item out of what is below it: where its vertices are then, (n, 3).

    Where samples of it are below, or vertices of what is below are above it, the cloth is moved along the normals
    there; the move is as smooth as that allows, so that folds and seams keep their shape.

    Parameters
    ----------
    mesh : TriangleMesh
        The item, on the first body.
    positions : (n, 3) array of float
        Where it is.
    laplace : LaplaceBeltrami
        Operator of the item where it is.
    samples : (s, n) csr_array of float
        Samples of it, its vertices first.
    layers : sequence of Layer
        What it lies on.
    fixed : (n,) array of bool
        Vertices that stay: rigid pieces, and what is to be left alone.
    unit : float
        Root of the area of the second body.
    drawn : (n, 3) array of float, optional
        How far such vertices are moved first, and the cloth around them with them; zero for those that stay.
    """
    free = ~fixed
    mass = np.where(laplace.mass > 0, laplace.mass, laplace.mass.mean())
    smooth = (SPREAD * unit) ** 2 * laplace.stiffness + diags_array(FREE * mass + 1e6 * mass * fixed)
    if drawn is not None and drawn.any():
        positions = positions + symmetric_factor(csr_array(smooth)).solve(1e6 * (mass * fixed)[:, None] * drawn)
    shares = np.asarray((samples != 0).sum(axis=0)).ravel()
    sample_mass = samples @ (mass / np.maximum(shares, 1))
    tolerance = 1e-4 * unit
    surface = Surface(mesh)
    sides = [(_Above(layer, samples.shape[0]), _Under(layer, len(positions), unit)) for layer in layers]
    for number in range(_ROUNDS):
        item, all_places = surface.moved(positions), number < _SMOOTHLY
        rows, moves, counts = _needed(item, samples, sample_mass, sides, free=free, all_places=all_places)
        needed = np.linalg.norm(moves, axis=1)
        if rows is None or needed.max() < tolerance:
            break
        moves *= np.minimum(1, _LARGEST_STEP * unit / np.maximum(needed, tolerance))[:, None]
        if all_places:
            weighted = csr_array(diags_array(FIRM * counts) @ rows)
            factor = symmetric_factor(csr_array(smooth + rows.T @ weighted))
            positions = positions + factor.solve(weighted.T @ moves) * free[:, None]
        else:
            positions = positions + _directly(rows, moves) * free[:, None]
    return positions


def _needed(
    item: Surface,
    samples: csr_array,
    sample_mass: Floats,
    sides: Sequence[tuple[_Above, _Under]],
    *,
    free: Bools,
    all_places: bool,
) -> tuple[csr_array | None, Floats, Floats]:
    """Places of the item that have to move: shares of the vertices (k, n), the moves (k, 3), and weights (k,)."""
    points = samples @ item.mesh.vertices
    rows: list[csr_array] = []
    moves: list[Floats] = []
    weights: list[Floats] = []
    movable = np.asarray(samples @ free.astype(float)).ravel() > 0.5
    for above, under in sides:
        lying = np.flatnonzero(np.isfinite(above.layer.wanted) & movable)
        if all_places:
            needed = above.lacking(points[lying], lying)
            chosen = np.flatnonzero(needed.any(axis=1))
            at = lying[chosen]
            rows.append(csr_array(samples[at]))
            moves.append(needed[chosen])
            weights.append(sample_mass[at])
        poked = under.poking(item, free, every=not all_places)
        if poked is not None:
            rows.append(poked[0])
            moves.append(poked[1])
            weights.append(np.full(len(poked[1]), sample_mass.mean()))
    if not sum(len(move) for move in moves):
        return None, np.empty((0, 3)), np.empty(0)
    return csr_array(vstack(rows)), np.concatenate(moves), np.concatenate(weights)


class _Above:
    """Samples of an item above a layer, of which only those are looked at that may have come too near to it.

    A distance changes by no more than the sample moves, so that what had more room than this still has some.  Twice
    as much is asked for, because a search along the surface may come to another fold.
    """

    def __init__(self, layer: Layer, count: int) -> None:
        self.layer = layer
        self._seen, self._room = np.zeros((count, 3)), np.full(count, -np.inf)

    def lacking(self, points: Floats, numbers: Ints) -> Floats:
        """Find how far points (k, 3), samples of such numbers (k,), have to move out of the layer, (k, 3).

        First counts the limb that each lay on, then any other, if between the two there is room.
        """
        moves = np.zeros((len(points), 3))
        moved = np.linalg.norm(points - self._seen[numbers], axis=1)
        near = np.flatnonzero(2 * moved >= self._room[numbers])
        if not len(near):
            return moves
        points, numbers = points[near], numbers[near]
        surface, wanted = self.layer.surface, self.layer.wanted[numbers]
        own, every = surface.clearance(points, self.layer.starts[numbers]), surface.clearance(points)
        rooms = [np.where(found.known, found.distances - wanted, 0.0) for found in (own, every)]
        self._seen[numbers], self._room[numbers] = points, np.minimum(*rooms)
        lacks = [(-room).clip(min=0) for room in rooms]
        left = own.distances + lacks[1] * np.einsum("ki,ki->k", own.normals, every.normals)
        other = (lacks[1] > lacks[0]) & (left > 0)
        moves[near] = np.where(other[:, None], lacks[1][:, None] * every.normals, lacks[0][:, None] * own.normals)
        return moves


class _Under:
    """Places of a layer that may come through an item: its vertices, and the middles of its edges and triangles.

    Only those are looked at near which the item lay, as the skin of another limb is none of its business; and of these
    only those that it may have come to since, as in `_Above`: what is under it, it has to come as near to as it is.
    The last rounds, which move places one by one, look at all near which it lay.
    """

    def __init__(self, layer: Layer, item_count: int, unit: float) -> None:
        mesh = layer.surface.mesh
        self._layer, self._unit = layer, unit
        ends = layer.surface.normals[mesh.edges]
        self._points = np.concatenate(
            [mesh.vertices, mesh.vertices[mesh.triangles].mean(axis=1), mesh.vertices[mesh.edges].mean(axis=1)]
        )
        self._normals = np.concatenate([layer.surface.normals, mesh.triangle_normals, unit_vectors(ends.sum(axis=1))])
        homes = mesh.vertices[np.unique(layer.starts[:item_count])]
        self._near_home = _near_cells(self._points, homes, _HOME * unit)
        self._room = np.zeros(len(self._points))
        self._corners = np.zeros((len(self._points), 3), np.int64)
        self._seen = np.zeros((len(self._points), 3, 3))

    def poking(self, item: Surface, free: Bools, *, every: bool) -> tuple[csr_array, Floats] | None:
        """Find places of the layer that are above the item, of every one or of those it may have come to.

        Returns shares of the item's vertices (k, n) where they are, and its moves over them (k, 3); none if none is.
        """
        layer, unit, reach = self._layer, self._unit, _POKING * self._unit
        mesh, positions = item.mesh, item.mesh.vertices
        loose = positions[mesh.triangles[free[mesh.triangles].any(axis=1)]].reshape(-1, 3)  # what is fixed stays
        if not len(loose):
            return None
        low, high = loose.min(axis=0) - reach, loose.max(axis=0) + reach
        near = np.flatnonzero(self._near_home & ((self._points > low) & (self._points < high)).all(axis=1))
        moved = np.linalg.norm(positions[self._corners[near]] - self._seen[near], axis=2).max(axis=1)
        near = near[every | (2 * moved >= self._room[near])]
        if not len(near):
            return None
        points, normals = self._points[near], self._normals[near]
        found = item.search.nearest(points)
        corners = mesh.triangles[found.triangles]
        height = np.einsum("ki,ki->k", found.interpolate(mesh.triangles, positions) - points, normals)
        distance = np.sqrt(found.squared_distances)
        self._corners[near], self._seen[near] = corners, positions[corners]
        self._room[near] = np.where(height < 0, (distance - reach).clip(min=0), distance)
        under = (height < 0) & (distance < reach) & (-height > _STRAIGHT * distance)
        under &= np.einsum("kc,kc->k", found.barycentric, layer.outside[corners]) > _MOSTLY
        under &= free[corners].any(axis=1) & ~layer.closing[found.triangles]
        at = found.barycentric.argmax(axis=1)
        home = layer.starts[np.take_along_axis(corners, at[:, None], axis=1)[:, 0]]
        under &= np.einsum("ki,ki->k", self._normals[home], normals) > _ALIKE
        under &= np.linalg.norm(self._points[home] - points, axis=1) < _HOME * unit
        # What is at the rim of the item is beside it, not above it.
        under &= ~((found.barycentric > 1e-3) <= item.rim[corners]).all(axis=1)
        if not under.any():
            return None
        rows = interpolation_matrix(found.barycentric[under], corners[under], len(positions))
        return rows, (_MARGIN * unit - height[under])[:, None] * normals[under]


def _near_cells(points: Floats, places: Floats, size: float) -> Bools:
    """Tell which points (k, 3) are in the cell of a place (p, 3) or in one beside it, (k,)."""
    low = np.minimum(points.min(axis=0), places.min(axis=0)) - size
    counts = np.floor((np.maximum(points.max(axis=0), places.max(axis=0)) - low) / size).astype(np.int64) + 2
    cells = [np.floor((each - low) / size).astype(np.int64) for each in (points, places)]
    numbers = [(each[:, 0] * counts[1] + each[:, 1]) * counts[2] + each[:, 2] for each in cells]
    x, y, z = (step.ravel() - 1 for step in np.indices((3, 3, 3)))
    steps = (x * counts[1] + y) * counts[2] + z
    return np.isin(numbers[0], (np.unique(numbers[1])[:, None] + steps).ravel())


def _directly(rows: csr_array, moves: Floats) -> Floats:
    """Move every vertex as far as any place near it has to: the mean of the moves, as long as the longest."""
    shares = csr_array(rows.T)
    total = np.asarray(shares.sum(axis=1)).ravel()
    mean = (shares @ moves) / np.where(total > 0, total, 1)[:, None]
    length = np.linalg.norm(moves, axis=1)
    longest = np.asarray(csr_array((rows != 0).T.astype(float)).multiply(length[None]).max(axis=1).todense()).ravel()
    return mean * (longest / np.maximum(np.linalg.norm(mean, axis=1), 1e-300))[:, None]
