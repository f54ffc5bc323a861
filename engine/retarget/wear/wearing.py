# SPDX-License-Identifier: GPL-3.0-or-later
"""Items that one body wears, fitted to another body."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from functools import partial
from itertools import combinations

import numpy as np
from scipy.sparse import block_diag, csr_array, diags_array
from scipy.spatial import cKDTree

from ...geometry.laplacian import LaplaceBeltrami, laplace_beltrami
from ...geometry.symmetric_factor import symmetric_factor
from ...mesh.mirror_planes import MirrorPlane, mirror_planes
from ...mesh.surface_map import SurfaceMap
from ...mesh.triangle_mesh import TriangleMesh
from ...registration.elastic import ElasticSurface
from ...runtime.arrays import TINY, Bools, Floats, Ints
from ...runtime.background import can_go_beside
from ...runtime.errors import MatchError, MeshError
from ...runtime.parallel_map import MOST_SENT, here_steps, shared_steps
from ...runtime.progress import Progress, Steps, within
from ...runtime.worker import call_helpers
from .body_motion import BodyMotion, BodySkin, Carriers, Motion
from .buried_places import Buried, BuriedPlaces
from .contact import Clearance, Surface, surface_samples
from .pushing import Layer, layer_of, pushed_out
from .rigid_pieces import moved_along, placed_rigidly, rigid_pieces
from .sewn_items import cut_open, sewn
from .worn_item import FittedItem, WornItem

_HOLD = 0.010
"""Over what length, in sqrt(area) of the body, an item at the skin smooths out how the skin under it moves."""

_HOLD_AWAY = 0.6
"""The same far from the skin, as a part of the distance."""

_UNSEEN = 0.05
"""How far below an item that stands for skin, in the same unit, the skin may be: 7 cm on a human.  With 0 the waist of
Formal, whose skirt lacks hips below it, dips by 7 instead of 5 cm in ``python -m tests.benchmarks.worn_makers``; with
0.08 clothes stand off by a quarter more there."""

_SEWN, _SEAM = 1e-6, 100.0
"""How near, in the same unit, vertices of two items are that move as one, and how much more that counts than cloth."""

_ROUNDS = 4
"""How often positions and rotations are found in turn."""

_TURN_RADIUS = 0.5
"""Over what part of the length above rotations are averaged."""

_ENOUGH = 0.0012
"""Distance from the skin, in the same unit, that is enough for cloth: about 1.5 mm on a human."""

_LAYERS = 0.0008
"""The same between layers of cloth."""

_NOTHING = 5e-4
"""A push over less than this, in the same unit, is none."""

_CLEARLY = 0.2
"""How much of one of two items must lie over the other, less what of that lies over it, that it does so.  For clothes
of one layer that is 0.3 to 2, for those that have an inner side, each of which seems to lie over the other, about 0."""

_SUNK = 0.002
"""How far within what it lay on a place of an item may be, in the same unit, to show: 3 mm on a human."""

_FASTENED = 0.02
"""How far from a rigid piece, in the same unit, cloth is that it is fastened to."""

_AT_SKIN = 0.03
"""Up to this distance from the skin, in the same unit, an item has skin below it, and so far beyond what it had it
has none: about 4 cm on a human.  A boot reaches further below an ankle, no shirt stands off a thinner body as far."""

_SAME = 1e-3
"""How far the vertices of items may be from mirror images of others, in units of the extent of all."""

_MIRRORED = 4e-3
"""How far the target's skin may be from its mirror image below items, in units of its extent."""

_WHOLLY = 0.9
"""Part of an item's vertices that are mirror images, on such skin, from which on it is symmetric."""

_TIGHT, _LOOSE = 0.4, 2.5
"""What tight and loose items multiply the length by over which they smooth."""


@dataclass(frozen=True, eq=False)
class DressedItem:
    """How a body wears an item: seams closed, and which vertex each was; what is below, and what carries it."""

    item: WornItem
    welded: Ints | None
    below: Clearance
    carriers: Carriers
    pieces: Ints
    laplace: LaplaceBeltrami


@dataclass(frozen=True, eq=False)
class DressedBody:
    """A body with what it wears, which can be fitted to any number of others."""

    skin: BodySkin
    surface: Surface
    buried: BuriedPlaces
    items: tuple[DressedItem, ...]


@dataclass
class _Work:
    """An item while it is fitted."""

    item: WornItem
    motion: Motion
    below: Clearance
    pieces: Ints
    positions: Floats = field(default_factory=lambda: np.empty((0, 3)))
    pushed: Floats = field(default_factory=lambda: np.empty(0))
    through: float = 0.0


@can_go_beside
def wear_steps(
    source: TriangleMesh,
    target: TriangleMesh,
    source_to_target: SurfaceMap,
    images: Floats,
    items: Sequence[WornItem],
    *,
    bones: csr_array | None = None,
    whole: TriangleMesh | None = None,
) -> Steps[list[FittedItem]]:
    """Fit what one body wears to another body.

    Each item moves with the skin near it, see `BodyMotion`, as an elastic surface that smooths this out: close to the
    skin hardly, far from it widely.  Rigid pieces are moved as they are and scaled.  Then items are pushed out of the
    skin and of the items below them, from the innermost to the outermost, where they lay outside before.  Seams at
    which an item was cut open, as for UVs or sharp edges, stay closed.

    Parameters
    ----------
    source, target : TriangleMesh
        The bodies.
    source_to_target : SurfaceMap
        The map from the one to the other.
    images : (n_x, 3) array of float
        Where the vertices of the source come to be, as one surface without folds: see `wrap_steps`.
    items : sequence of WornItem
        What the source wears.
    bones : (n_x, b) csr_array of float, optional
        How much each bone moves each vertex of the source.
    whole : TriangleMesh, optional
        The source with triangles that hang over it, see `hanging_triangles`, if it is without them.

    Yields
    ------
    Progress
        After each item's steps.

    Returns
    -------
    list of FittedItem
        The items on the target, in the same order.

    Raises
    ------
    MeshError
        If the map or positions are those of other meshes.
    MatchError
        If the map leads to the mirror image.
    """
    if images.shape != source.vertices.shape or len(source_to_target) != source.vertex_count:
        raise MeshError("The map belongs to other meshes than the bodies. Match them again.")
    if source_to_target.mirrors(source, target):
        raise MatchError(
            "The match exchanges left and right, and would turn clothes inside out. Use another answer of the match, "
            "or match the bodies again."
        )
    call_helpers()
    dressed = yield from within(dressed_steps(source, items, bones=bones, whole=whole), 0.0, 0.3)
    return (yield from within(fitted_steps(dressed, target, source_to_target, images, even=True), 0.3, 1.0))


def dressed_steps(
    source: TriangleMesh,
    items: Sequence[WornItem],
    *,
    bones: csr_array | None = None,
    whole: TriangleMesh | None = None,
) -> Steps[DressedBody]:
    """Find how a body wears items, see `wear_steps`: all that does not depend on what it becomes."""
    skin = BodySkin(source, bones)
    surface = Surface(source, skin.search)
    few = sum(mesh.vertex_count for mesh in (source, *(item.mesh for item in items))) <= MOST_SENT
    share = shared_steps if few else here_steps
    found = yield from share(_dressed_item_steps, (skin, surface), items)
    return DressedBody(skin, surface, BuriedPlaces.of(whole or source), tuple(found))


def _dressed_item_steps(body: tuple[BodySkin, Surface], given: WornItem) -> Steps[DressedItem]:
    """Find how a body wears an item."""
    yield Progress(0.0, "Moving items along")
    (skin, surface), unit = body, body[0].size
    item, welded = sewn(given)
    below = surface.clearance(item.mesh.vertices)
    reach = np.abs(below.distances) + 0.05 * unit * (item.fit == "LOOSE")
    pieces = item.pieces
    if pieces is None:
        named = np.ones(item.mesh.vertex_count, bool) if item.fit == "RIGID" else item.rigid
        pieces = rigid_pieces(item.mesh, unit, named, search=item.find_rigid)
    carriers = skin.carriers(item.mesh.vertices, reach, item.bones)
    return DressedItem(item, welded, below, carriers, pieces, laplace_beltrami(item.mesh))


def fitted_steps(
    dressed: DressedBody, target: TriangleMesh, source_to_target: SurfaceMap, images: Floats, *, even: bool = False
) -> Steps[list[FittedItem]]:
    """Fit what a body wears to another one, see `wear_steps`.

    What is symmetric stays so if it is to be `even`: not where the same body is compared with itself in another form.
    """
    if not dressed.items:
        return []
    yield Progress(0.0, "Moving the skin")
    motion, unit = BodyMotion(dressed.skin, images), dressed.skin.size
    new_unit = motion.overall * unit
    units, places = (unit, new_unit), source_to_target.nearest_vertices
    skin_before, skin = dressed.surface, Surface(target)
    buried = dressed.buried.on(skin, images)
    works: list[_Work] = []
    count = len(dressed.items)
    for number, one in enumerate(dressed.items):
        yield Progress(0.05 + 0.45 * number / count, "Moving items along")
        moved = motion.move(one.carriers)
        works.append(_Work(one.item, moved, one.below, one.pieces, moved.positions))
    _elastic(works, [one.laplace for one in dressed.items], unit)
    for work in works:
        _place_pieces(work, works, motion, unit)
    if even:
        planes = mirror_planes(target)
        for plane in mirror_planes(
            TriangleMesh.concatenated([skin_before.mesh, *(one.item.mesh for one in dressed.items)])
        ):
            _even_out(works, plane, skin, planes)
    order, seams = _inner_first(works, unit), _seams(works, unit)
    owners = np.repeat(np.arange(len(works)), [len(work.positions) for work in works])
    placed = np.full((len(owners), 3), np.nan)
    spacing = 0.75 * float(np.sqrt(target.area / max(target.triangle_count, 1) * 2))
    for done, number in enumerate(order):
        yield Progress(0.5 + 0.45 * done / count, "Pushing items out")
        below, goals = [works[other] for other in order[:done]], placed.copy()
        goals[seams[:, 0]] = placed[seams[:, 1]]
        work, own = works[number], owners == number
        _push(work, below, (skin_before, skin), places, buried, goals=goals[own], units=units, spacing=spacing)
        placed[own] = work.positions
    yield Progress(0.95, "Measuring")
    fitted = [_fitted(work, skin, source_to_target, units) for work in works]
    return [cut_open(one, worn.welded) for one, worn in zip(fitted, dressed.items, strict=True)]


def _elastic(works: Sequence[_Work], laplaces: Sequence[LaplaceBeltrami], unit: float) -> None:
    """Let items smooth out how the skin moved them; where they meet they stay together."""
    surfaces, drawn = [], []
    for work, laplace in zip(works, laplaces, strict=True):
        item, moved, depths = work.item, work.motion, np.abs(work.below.distances)
        depths = np.where(depths < _NOTHING * unit, _UNSEEN * unit, depths)
        length = _HOLD * unit + _HOLD_AWAY * depths
        length *= {"TIGHT": _TIGHT, "LOOSE": _LOOSE}.get(item.fit, 1.0)
        if item.tightness is not None:
            length *= np.where(
                item.tightness > 0, _TIGHT ** item.tightness.clip(0, 1), _LOOSE ** (-item.tightness).clip(0, 1)
            )
        mass = np.where(laplace.mass > 0, laplace.mass, laplace.mass.mean())
        # The item at rest in the size that it has on the other body, which differs from place to place.
        smooth = symmetric_factor(diags_array(mass) + (2 * _HOLD * unit) ** 2 * laplace.stiffness)
        scales = smooth.solve(mass * moved.scales)
        work.motion = replace(moved, scales=scales)
        surfaces.append(ElasticSurface(item.mesh.vertices, laplace).resized(scales))
        drawn.append(mass / length**2)
    ends = np.cumsum([len(work.positions) for work in works])[:-1]
    pull, goals = np.concatenate(drawn), np.concatenate([work.motion.positions for work in works])
    stiffness = block_diag([surface.stiffness for surface in surfaces])
    pairs = _seams(works, unit)
    rows, one, other = np.arange(len(pairs)), pairs[:, 0], pairs[:, 1]
    between = csr_array((np.ones(len(pairs)), (rows, one)), shape=(len(pairs), len(pull)))
    between = csr_array(between - csr_array((np.ones(len(pairs)), (rows, other)), shape=between.shape))
    seams = csr_array(between.T @ between) / 2
    factor = symmetric_factor(csr_array(stiffness + diags_array(pull) + _SEAM * seams))
    for _ in range(_ROUNDS):
        pulls = [surface.pull(work.motion.rotations) for work, surface in zip(works, surfaces, strict=True)]
        positions = np.split(factor.solve(np.concatenate(pulls) + pull[:, None] * goals), ends)
        for work, surface, places in zip(works, surfaces, positions, strict=True):
            work.positions = places
            work.motion = replace(work.motion, rotations=surface.rotations(places, _TURN_RADIUS * _HOLD * unit))


def _seams(works: Sequence[_Work], unit: float) -> Ints:
    """Find where parts meet that a body was cut into: pairs of vertices, numbered through all items, (s, 2)."""
    points = np.concatenate([work.item.mesh.vertices for work in works])
    owners = np.repeat(np.arange(len(works)), [len(work.positions) for work in works])
    stand_for_skin = np.concatenate([np.abs(work.below.distances) < _NOTHING * unit for work in works])
    pairs = cKDTree(points).query_pairs(_SEWN * unit, output_type="ndarray")
    pairs = pairs[(owners[pairs[:, 0]] != owners[pairs[:, 1]]) & stand_for_skin[pairs].all(axis=1)]
    return np.concatenate([pairs, pairs[:, ::-1]]).astype(np.int64)


def _place_pieces(work: _Work, works: Sequence[_Work], motion: BodyMotion, unit: float) -> None:
    """Put rigid pieces where the skin takes them, or what they are fastened to, in the size of the skin around."""
    if work.pieces.max(initial=-1) < 0:
        return
    before = work.item.mesh.vertices
    bending = [(other.item.mesh.vertices[other.pieces < 0], other) for other in works]
    points = np.concatenate([vertices for vertices, _ in bending])
    shifts = np.concatenate([(other.positions - other.motion.positions)[other.pieces < 0] for _, other in bending])
    tree = cKDTree(points) if len(points) else None
    positions = work.positions.copy()
    for piece in range(int(work.pieces.max()) + 1):
        inside = work.pieces == piece
        goal = work.motion.positions[inside]
        if tree is not None:
            distances, near = tree.query(before[inside])
            close = distances < _FASTENED * unit
            if close.any():
                goal = goal + shifts[near[close]].mean(axis=0)
        positions[inside] = placed_rigidly(before[inside], goal, motion.growth_around(before[inside]))
    work.positions = positions


def _even_out(works: Sequence[_Work], plane: MirrorPlane, skin: Surface, planes: Sequence[MirrorPlane]) -> None:
    """Let items that are symmetric in a plane, each or two of them, be so where the other body is in one of its."""
    target = skin.mesh
    before = np.concatenate([work.item.mesh.vertices for work in works])
    normals = np.concatenate([work.item.mesh.vertex_normals for work in works])
    owners = np.repeat(np.arange(len(works)), [len(work.positions) for work in works])
    extent = float(np.linalg.norm(np.ptp(before, axis=0)))
    # Both sides of cloth are told apart by where they look.
    looks = _SAME * extent * normals
    mirrored = np.concatenate([plane.reflected(before), plane.reflected_directions(looks)], axis=1)
    distances, partners = cKDTree(np.concatenate([before, looks], axis=1)).query(mirrored)
    asked = np.concatenate([_asked(work) for work in works])
    own = (distances <= _SAME * extent) & (asked == asked[partners]).all(axis=1)
    if not own.any():
        return
    positions = np.concatenate([work.positions for work in works])
    there = MirrorPlane.between(positions[own], positions[partners[own]], np.ones(np.count_nonzero(own)))
    image = next((each for each in planes if each.is_along(there)), None)
    if image is None:
        return
    below, number = np.unique(cKDTree(target.vertices).query(positions)[1], return_inverse=True)
    away = np.sqrt(skin.search.nearest(image.reflected(target.vertices[below])).squared_distances)
    own &= (away <= _MIRRORED * float(np.linalg.norm(np.ptp(target.vertices, axis=0))))[number]
    for _ in range(2):  # one of a pair that is not symmetric itself leaves the other without
        symmetric = _mostly(own, owners)
        own &= symmetric[owners] & symmetric[owners[partners]]
    if not own.any():
        return
    shifts = np.zeros_like(positions)
    shifts[own] = (image.reflected(positions[partners[own]]) - positions[own]) / 2
    # What has no mirror image, such as a pocket on one side, goes with what it is on.
    alone = symmetric[owners] & ~own
    shifts[alone] = shifts[own][cKDTree(before[own]).query(before[alone])[1]]
    positions += shifts
    for number, work in enumerate(works):
        work.positions = positions[owners == number]
        for piece in range(int(work.pieces.max(initial=-1)) + 1):
            inside = work.pieces == piece
            whole, goal = work.item.mesh.vertices[inside], work.positions[inside]
            sizes = [float(np.linalg.norm(points - points.mean(axis=0))) for points in (goal, whole)]
            work.positions[inside] = placed_rigidly(whole, goal, sizes[0] / max(sizes[1], TINY))


def _asked(work: _Work) -> Floats:
    """Tell what the owner wants of each vertex, (n, 5): what is asked for on one side alone is not symmetric."""
    item, count = work.item, len(work.positions)
    painted = [np.zeros(count) if values is None else values for values in (item.tightness, item.left)]
    fits = [np.full(count, item.fit == fit) for fit in ("TIGHT", "LOOSE")]
    return np.stack([work.pieces >= 0, *fits, *painted], axis=1).astype(np.float64)


def _mostly(held: Bools, owners: Ints) -> Bools:
    """Tell of which items, by the number of each vertex's, something holds at nearly all vertices."""
    return np.bincount(owners, held) >= _WHOLLY * np.bincount(owners)


def _inner_first(works: Sequence[_Work], unit: float) -> list[int]:
    """Put items in the order in which they lie on the body, (w,).

    Of two that meet, the one is inner that the other lies over.  Of those of which neither does so clearly, it is the
    one that is nearer to the skin where it lies on it.
    """
    heights = [np.quantile(work.below.distances, 0.25) for work in works]
    meshes = [work.item.mesh for work in works]
    surfaces, every = [Surface(mesh) for mesh in meshes], range(len(works))
    over = np.zeros((len(works), len(works)))
    for one, other in combinations(every, 2):
        if _near(meshes[one].vertices, meshes[other].vertices, unit):
            net = _lying_over(surfaces[one], meshes[other], unit) - _lying_over(surfaces[other], meshes[one], unit)
            if abs(net) > _CLEARLY:
                over[other, one], over[one, other] = max(net, 0.0), max(-net, 0.0)
    order: list[int] = []
    while len(order) < len(works):
        rest = [number for number in every if number not in order]
        order.append(min(rest, key=lambda number: (over[number, rest].sum(), heights[number])))
    return order


def _lying_over(surface: Surface, item: TriangleMesh, unit: float) -> float:
    """Tell what part of an item near a surface lies over it, less what lies under it, -1 to 1."""
    found = surface.clearance(item.vertices)
    areas = item.vertex_areas * (found.known & (np.abs(found.distances) < _AT_SKIN * unit))
    return float(areas @ np.sign(found.distances) / max(areas.sum(), TINY))


def _push(
    work: _Work,
    below: Sequence[_Work],
    skins: tuple[Surface, Surface],
    places: Ints,
    buried: Buried,
    *,
    goals: Floats,
    units: tuple[float, float],
    spacing: float,
) -> None:
    """Push an item out of the skin and of the items below it; some vertices have goals (n, 3), others no numbers."""
    item, (unit, new_unit) = work.item, units
    start = work.positions
    work.pushed = np.zeros(len(start))
    if item.fit == "LEAVE":
        return
    mesh = item.mesh
    now = TriangleMesh(start, mesh.triangles)
    samples = surface_samples(now, spacing)
    layer = partial(layer_of, samples=samples, items=(mesh, now), scales=work.motion.scales, unit=unit)
    layers = [layer(*skins, places=places, buried=buried, least=_ENOUGH * new_unit, margin=item.margin)]
    for other in below:
        beneath = other.item.mesh
        if not _near(mesh.vertices, beneath.vertices, unit):
            continue
        surfaces = Surface(beneath), Surface(TriangleMesh(other.positions, beneath.triangles))
        layers.append(layer(*surfaces, least=_LAYERS * new_unit))
    rigid = work.pieces >= 0
    fixed = rigid if item.left is None else rigid | item.left
    held = np.isfinite(goals).all(axis=1) & ~fixed
    drawn = np.where(held[:, None], goals - start, 0.0)
    positions = pushed_out(
        mesh, start, laplace_beltrami(now), samples[0], layers=layers, fixed=fixed | held, drawn=drawn, unit=new_unit
    )
    if rigid.any():
        positions = _with_pieces(work, positions, layers)
    work.positions, work.through = positions, _sunk(samples[0] @ positions, layers, new_unit)
    moved = np.linalg.norm(positions - start, axis=1)
    work.pushed = np.where(moved > _NOTHING * new_unit, moved, 0.0)


def _near(points: Floats, others: Floats, unit: float) -> bool:
    """Tell whether two items touch or nearly so."""
    reach = 0.03 * unit
    return bool(
        ((points.min(axis=0) - reach < others.max(axis=0)) & (others.min(axis=0) - reach < points.max(axis=0))).all()
    )


def _with_pieces(work: _Work, positions: Floats, layers: Sequence[Layer]) -> Floats:
    """Move rigid pieces with the cloth around them, and out of what is below."""
    moved = positions.copy()
    for piece, along in enumerate(moved_along(work.item.mesh.vertices, positions - work.positions, work.pieces)):
        inside, shift = np.flatnonzero(work.pieces == piece), along
        for _ in range(3):
            push = np.zeros(3)
            for layer in layers:
                found = layer.surface.clearance(moved[inside] + shift, layer.starts[inside])
                lack = np.where(found.known, layer.wanted[inside] - found.distances, -np.inf)
                worst = int(np.argmax(lack))
                if lack[worst] > 0:
                    push += lack[worst] * found.normals[worst]
            shift = shift + push
            if not push.any():
                break
        moved[inside] += shift
    return moved


def _sunk(points: Floats, layers: Sequence[Layer], unit: float) -> float:
    """Tell what part of an item's samples, (s, 3), lay outside and are clearly inside now, 0 to 1."""
    deep = np.zeros(len(points), bool)
    for layer in layers:
        lying = np.flatnonzero(np.isfinite(layer.wanted))
        found = layer.surface.clearance(points[lying], layer.starts[lying])
        deep[lying] |= found.known & (found.distances < -_SUNK * unit)
    return float(deep.mean())


def _fitted(work: _Work, skin: Surface, source_to_target: SurfaceMap, units: tuple[float, float]) -> FittedItem:
    """Put together what is known of an item."""
    moved, below, found = work.motion, work.below, skin.clearance(work.positions)
    apart = np.abs(below.distances)
    # Beyond the rim of a hole there is no inside.
    away = np.where(found.known, found.distances, np.abs(found.distances))
    wanted = np.maximum(moved.scales * apart, work.item.margin)
    return FittedItem(
        positions=work.positions,
        rotations=moved.rotations,
        scales=moved.scales,
        places=moved.places,
        pieces=work.pieces,
        clearance=found.distances,
        pushed=work.pushed,
        confidence=moved.places @ source_to_target.confidence,
        bare=below.known & (apart < _AT_SKIN * units[0]) & (away > wanted + _AT_SKIN * units[1]),
        through=work.through,
    )
