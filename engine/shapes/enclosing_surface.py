# SPDX-License-Identifier: GPL-3.0-or-later
"""One surface around all the pieces of a body that was put together from several."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from itertools import compress

import numpy as np
from scipy.spatial import cKDTree

from ..mesh.area_samples import even_samples
from ..mesh.closest_points import ClosestPoints, facing
from ..mesh.connectivity.mesh_orientation import enclosed_volumes
from ..mesh.surface_map import SurfaceMap
from ..mesh.triangle_mesh import TriangleMesh
from ..repair.body_pieces import BESIDE, LEAST_MORE, SAMPLES
from ..repair.clean_surface import CleanSurface, StandIn, SurfacePart
from ..repair.cleaning import clean
from ..repair.cleaning_notes import cleaning_notes
from ..repair.gap_bridges import bridged
from ..repair.solid_indicator import SolidIndicator, solid_indicator
from ..repair.surface_nets import surface_net
from ..runtime.arrays import Bools, Floats, Ints
from ..runtime.errors import MeshError
from ..runtime.parallel_map import MOST_SENT, here_steps, shared_steps
from ..runtime.progress import Progress, Steps, within
from .openwork import FLAT, filled_openwork, is_openwork
from .proxy import Proxy, coarse_mesh_steps
from .shape import Shape

_LYING, _ITS_OWN = 0.04, 0.25
"""How far, in sqrt(area), most of a piece may be from a surface around it; and in the square root of its own area, if
that is less.  Of seven characters, pieces with a surface around them are at 0.22 at most, and parts of fingers that
none is around at 0.31 and more."""

_FINER = 4
"""How many times the vertices of a small body its surface has at most: about as many as `Proxy.finer` makes of them."""

_SPACING, _PER_VERTEX = 0.005, 0.35
"""Distance of the places of the grid, in sqrt(area): a third of a finger of a person, which loses 2 cm of its length on
a body that loses 4 cm with .007 and one with .0035, in twice the time.  And if that is more, as for a small body, in
the root of the area of a vertex of the surface: eight places for each, as many as the former gives 5,000 vertices."""

_LEVEL = 0.4
"""How far inside counts as inside: less than half, so that open ends that stop short of each other meet."""

_WIDEST = 0.06
"""Widest gap that is bridged, in sqrt(area)."""

_LABEL = "Joining pieces"


def with_limbs_steps(shape: Shape, name: str, vertices: Ints) -> Steps[Shape]:
    """Join the pieces of one body, see `all_with_limbs_steps`."""
    (whole,) = yield from all_with_limbs_steps([(shape, name, vertices)])
    return whole


def all_with_limbs_steps(bodies: Sequence[tuple[Shape, str, Ints]]) -> Steps[list[Shape]]:
    """Join the pieces of each body some vertices of which are on limbs beside the main piece.

    Parameters
    ----------
    bodies : sequence of (Shape, str, (k,) array of int)
        A body, what notes call it, and vertices of the original mesh; those that do not exist are passed over.

    Returns
    -------
    list of Shape
        Each body as one surface, or what was given.
    """
    wanted = [_touches_limbs(shape.surface.cleaned, vertices) for shape, _, vertices in bodies]
    # Keyed by itself: a shape may be matched with itself.
    new = {
        id(shape): (shape, name)
        for (shape, name, _), wants in zip(bodies, wanted, strict=True)
        if wants and shape.joined is None
    }
    items = [(shape.surface.cleaned, name, shape.surface.wanted) for shape, name in new.values()]
    found = yield from all_joined_steps(items)
    for (shape, _), cleaned in zip(new.values(), found, strict=True):
        whole, surface = shape, shape.surface
        if cleaned is not surface.cleaned:
            # It has as many vertices as it should, also that of a small body.
            count = min(surface.wanted, cleaned.mesh.vertex_count)
            whole = Shape.of(replace(surface, cleaned=cleaned, proxy=Proxy.identity(cleaned.mesh), wanted=count))
        shape.keep_joined(whole)
    return [
        shape.joined if wants and shape.joined is not None else shape
        for (shape, _, _), wants in zip(bodies, wanted, strict=True)
    ]


def both_joined_steps(x: Shape, y: Shape) -> Steps[list[Shape]]:
    """Join the main piece and all limbs of the source, and those of the target; see `all_with_limbs_steps`."""
    bodies = ((x, "source"), (y, "target"))
    return (yield from all_with_limbs_steps([(s, name, np.flatnonzero(s.surface.cleaned.limbs)) for s, name in bodies]))


def joined_shapes_steps(x: Shape, y: Shape, found: SurfaceMap, ends: tuple[Ints, Ints]) -> Steps[tuple[Shape, Shape]]:
    """Join the pieces of two bodies if a map takes the main piece of one to other pieces of the other.

    Parameters
    ----------
    x, y : Shape
        The source and the target.
    found : SurfaceMap
        A map from the source.
    ends : pair of (k,) array of int
        Vertices of the source and of the target that have to be on what is matched.

    Returns
    -------
    x, y : Shape
        The bodies as one surface each, or what was given.
    """
    limbs = x.surface.cleaned.limbs, y.surface.cleaned.limbs
    main, on_main = (shape.surface.cleaned.vertex_parts == 0 for shape in (x, y))
    images, areas = found.nearest_vertices, x.original.vertex_areas
    across = (main & limbs[1][images]) | (limbs[0] & on_main[images])
    if areas @ across > LEAST_MORE * areas[main | limbs[0]].sum():
        ends = np.flatnonzero(limbs[0]), np.flatnonzero(limbs[1])
    x, y = yield from all_with_limbs_steps([(x, "source", ends[0]), (y, "target", ends[1])])
    return x, y


def _touches_limbs(cleaned: CleanSurface, vertices: Ints) -> bool:
    """Say whether any of some vertices is on a limb."""
    limbs = cleaned.limbs
    return bool(limbs[vertices[(vertices >= 0) & (vertices < len(limbs))]].any())


def all_joined_steps(bodies: Sequence[tuple[CleanSurface, str, int]]) -> Steps[list[CleanSurface]]:
    """Put one surface around the body of each of several meshes.

    Parameters
    ----------
    bodies : sequence of (CleanSurface, str, int)
        A mesh, and its pieces; what notes call it; and about how many vertices the surface has at most.

    Returns
    -------
    list of CleanSurface
        Those surfaces; what was given of meshes without limbs, of those joined before, and where pieces have no inside
        together.
    """
    number = [i for i, (cleaned, _, _) in enumerate(bodies) if cleaned.stand_in is None and cleaned.limbs.any()]
    items = [bodies[i] for i in number]
    share = shared_steps if all(item[0].original.vertex_count <= MOST_SENT for item in items) else here_steps
    joined = [cleaned for cleaned, _, _ in bodies]
    for i, found in zip(number, (yield from share(_joined_steps, None, items)), strict=True):
        if found is not None:
            joined[i] = replace(found, original=joined[i].original)  # not the copy of another process
    return joined


def _joined_steps(_: None, body: tuple[CleanSurface, str, int]) -> Steps[CleanSurface | None]:
    """Put one surface around the main part of a mesh and the pieces that go on beyond it.

    Parameters
    ----------
    body : (CleanSurface, str, int)
        The mesh, and its pieces; what notes call it; and about how many vertices the surface has: a small body's has
        fewer.

    Returns
    -------
    CleanSurface or None
        That surface in the place of the main part; None if the pieces have no inside together.

    Notes
    -----
    What is inside of the pieces is found on a grid, however they lie in each other and where they are open, and gaps
    between them are bridged.  Wire frames stand for what they enclose.  The surface is where that begins.  What is
    finer than the grid, such as fingers that touch, is one there.
    """
    cleaned, name, most = body
    taking_part = cleaned.of_body.copy()
    pieces = [piece.mesh for piece in cleaned.pieces]
    most = min(most, _FINER * sum(piece.vertex_count for piece in compress(pieces, taking_part)))
    apart = max(_SPACING, _PER_VERTEX / np.sqrt(most))
    unit = float(np.sqrt(sum(piece.area for piece in compress(pieces, taking_part))))
    pieces = [filled_openwork(each, apart * unit, _WIDEST * unit) if is_openwork(each) else each for each in pieces]
    yield Progress(0.0, _LABEL)
    solid = solid_indicator(_solids(compress(pieces, taking_part)), apart * unit)
    skin = yield from within(_skin_steps(solid, unit), 0.2, 0.4, _LABEL)
    lying = _lying_on(skin, pieces, apart) if skin is not None else taking_part
    if (taking_part & ~lying).any():
        more = _between(pieces, taking_part & lying, taking_part & ~lying) & ~taking_part
        taking_part |= more
        if more.any():
            solid = solid.with_surfaces(_solids(compress(pieces, more)))
        for thin in compress(pieces, taking_part & ~lying):
            _fill(solid, _midst(thin, solid.spacing))
        skin = yield from within(_skin_steps(solid, unit), 0.4, 0.6, _LABEL)
        lying = _lying_on(skin, pieces, apart) if skin is not None else taking_part
    if skin is None:
        return None
    coarse = yield from within(coarse_mesh_steps(skin, most), 0.6, 0.9, _LABEL)
    # What is too far away from all else was not reached.
    taking_part &= lying
    if not taking_part[0] or taking_part.sum() == 1:
        return None
    pieced = _Body.of(list(compress(cleaned.pieces, taking_part)))
    number = np.cumsum(~taking_part)
    number[taking_part] = 0
    parts = np.append(number, -1)[cleaned.vertex_parts]
    main = pieced.stand_in(coarse, cleaned)
    yield Progress(1.0, _LABEL)
    nearest = main.mesh.triangles[main.place_triangles, main.place_barycentric.argmax(axis=1)]
    others = tuple(compress(cleaned.pieces, ~taking_part))
    united = int(taking_part.sum())
    counts = replace(cleaned.counts, united=united, parts=cleaned.counts.parts + 1 - united, left_open=0)
    return replace(
        cleaned,
        pieces=(main, *others),
        vertex_parts=parts,
        vertex_images=np.where(parts == 0, nearest, cleaned.vertex_images),
        notes=cleaning_notes(name, counts),
        counts=counts,
    )


def _solids(pieces: Iterable[TriangleMesh]) -> TriangleMesh:
    """Take of pieces, turned outward, the triangles that are around an inside."""
    mesh, _, solids = _outward(pieces)
    return TriangleMesh(mesh.vertices, mesh.triangles[solids])


def _fill(solid: SolidIndicator, points: Floats) -> None:
    """Make the places of a grid that points (k, 3) are nearest to a part of the inside."""
    places = tuple(np.rint((points - solid.origin) / solid.spacing).astype(np.int64).T)
    solid.values[places] = np.maximum(solid.values[places], (1 + _LEVEL) / 2)


def _skin_steps(solid: SolidIndicator, unit: float) -> Steps[TriangleMesh | None]:
    """Find the surface around an inside, bridging gaps in a body of that sqrt(area); None if there is no inside."""
    values = bridged(solid.values, _LEVEL, _WIDEST * unit / solid.spacing)
    yield Progress(0.5, _LABEL)
    places, triangles = surface_net(values, _LEVEL)
    if not len(triangles):
        return None
    try:
        return clean(TriangleMesh(places * solid.spacing + solid.origin, triangles)).mesh
    except MeshError:
        return None


def _outward(pieces: Iterable[TriangleMesh]) -> tuple[TriangleMesh, Bools, Bools]:
    """Turn pieces outward: all as one mesh, which of its triangles (m,) are turned, and which are around an inside."""
    together = TriangleMesh.concatenated(list(pieces))
    components, volumes = enclosed_volumes(together)
    inward = (volumes < 0)[components]
    areas = np.bincount(components, together.triangle_areas)
    has_inside = (np.abs(volumes) >= FLAT * areas**1.5) | (areas == areas.max())
    triangles = np.where(inward[:, None], together.triangles[:, [0, 2, 1]], together.triangles)
    return TriangleMesh(together.vertices, triangles), inward, has_inside[components]


def _midst(piece: TriangleMesh, spacing: float) -> Floats:
    """Spread points (k, 3) within a piece, below its surface by its volume over its area; none in a sheet."""
    mesh, _, _ = _outward([piece])
    volume = enclosed_volumes(mesh)[1].sum()
    if volume < FLAT * mesh.area**1.5:
        return np.zeros((0, 3))
    samples = even_samples(mesh, spacing**2 / 4)
    return samples.positions - volume / mesh.area * mesh.triangle_normals[samples.triangles]


def _between(pieces: Sequence[TriangleMesh], reached: Bools, lost: Bools) -> Bools:
    """Tell which pieces (p,) touch two of the body, one of them not reached, or if no larger than those, any two."""
    areas = np.array([piece.area for piece in pieces])
    samples = [even_samples(piece, areas.sum() / SAMPLES).positions for piece in pieces]
    owners = np.repeat(np.arange(len(pieces)), [len(own) for own in samples])
    near = cKDTree(np.concatenate(samples)).query_pairs(BESIDE * np.sqrt(areas.sum()), output_type="ndarray")
    touch = np.eye(len(pieces), dtype=bool)
    touch[tuple(owners[near].T)] = True
    touch |= touch.T
    touching = np.stack([touch[:, side].sum(axis=1) for side in (reached, lost)])
    return ((touching[1] > 0) | (areas <= areas[lost].max())) & (touching.sum(axis=0) > 1)


def _lying_on(mesh: TriangleMesh, pieces: Sequence[TriangleMesh], apart: float) -> Bools:
    """Tell which pieces (p,) lie on a surface made on such a grid, or near beneath it, for the most part."""
    tree, lying = cKDTree(mesh.vertices), np.zeros(len(pieces), bool)
    for number, piece in enumerate(pieces):
        # A piece may be far larger than what was found to be inside of all.
        spread = max(mesh.area, piece.area) / SAMPLES
        distances = tree.query(even_samples(piece, spread).positions)[0]
        unit, own = np.sqrt(mesh.area), np.sqrt(piece.area)
        lying[number] = np.median(distances) < min(_LYING * unit, max(apart * unit, _ITS_OWN * own))
    return lying


@dataclass(frozen=True, eq=False)
class _Body:
    """The pieces of a body, turned to look outward.

    Attributes
    ----------
    mesh : TriangleMesh
        All of them, with filled holes.
    vertices, triangles : (n,) and (m,) array of int
        The original vertex and triangle of each, -1 in filled holes.
    turned : (m,) array of bool
        Which have their last two corners exchanged against the original.
    """

    mesh: TriangleMesh
    vertices: Ints
    triangles: Ints
    turned: Bools

    @classmethod
    def of(cls, pieces: list[SurfacePart]) -> _Body:
        """Turn pieces outward."""
        mesh, inward, _ = _outward(piece.mesh for piece in pieces)
        return cls(
            mesh,
            np.concatenate([piece.original_vertices for piece in pieces]),
            np.concatenate([piece.original_triangles for piece in pieces]),
            np.concatenate([piece.turned for piece in pieces]) ^ inward,
        )

    def stand_in(self, mesh: TriangleMesh, cleaned: CleanSurface) -> StandIn:
        """Let a surface around the body stand for it."""
        kept = self.triangles >= 0
        shown = TriangleMesh(self.mesh.vertices, self.mesh.triangles[kept])
        size = float(np.sqrt(mesh.area))
        here = facing(ClosestPoints(shown), mesh.vertices, mesh.vertex_normals, size)
        own = self.vertices[here.nearest_vertices(shown.triangles)]
        # Every original vertex, also one that was welded to another, is where its surface is nearest.
        its = np.flatnonzero(self.vertices >= 0)
        normals = np.zeros((cleaned.original.vertex_count, 3))
        normals[self.vertices[its]] = self.mesh.vertex_normals[its]
        places = facing(ClosestPoints(mesh), cleaned.original.vertices, normals, size)
        return StandIn(
            mesh,
            own,
            self.triangles[kept][here.triangles][mesh.triangles[:, 0]],
            np.zeros(mesh.triangle_count, bool),
            place_triangles=places.triangles,
            place_barycentric=places.barycentric,
            shown=shown,
            shown_triangles=self.triangles[kept],
            shown_turned=self.turned[kept],
        )
