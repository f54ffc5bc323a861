# SPDX-License-Identifier: GPL-3.0-or-later
"""Maps between all vertices of two meshes, from the registered surfaces that stand for them."""

from __future__ import annotations

from dataclasses import replace
from typing import NamedTuple

from numpy.typing import ArrayLike

from ..mesh.reflection import reflected_mesh, reflected_points
from ..mesh.surface_map import SurfaceMap
from ..mesh.surface_points import SurfacePoints
from ..mesh.triangle_mesh import TriangleMesh
from ..registration.deformable import DeformableSurface
from ..registration.fine_registration import Polish, finer_surfaces_steps
from ..registration.landmark_snapping import pinned
from ..registration.prolongation import lift_steps
from ..registration.registration import POLISH, Registration, Stage
from ..runtime.arrays import Bools, Floats, Ints
from ..runtime.background import can_go_beside
from ..runtime.errors import MatchError
from ..runtime.parallel_map import MOST_SENT, here_steps, shared_steps
from ..runtime.progress import Progress, Steps, at_once, in_turn, within
from ..runtime.worker import call_helpers
from ..shapes.enclosing_surface import with_limbs_steps
from ..shapes.genus_reduction import evened_steps
from ..shapes.landmarks import placed_at_vertices
from ..shapes.prepared_surface import PreparedSurface
from ..shapes.shape import Shape, check_surface, left_out_of
from ..shapes.shape_preparation import Wanted, finer_shapes, prepared_shapes_steps
from .components.extended_maps import WholeMap, whole_maps_steps
from .components.masked_maps import left_out_beyond, piece_of, with_pieces_only
from .credibility import vertex_credibility
from .dense_hypotheses import SparseStart
from .dense_registration import EIGENPAIRS, RegisteredPair, registered_pair_steps
from .functional_maps import nearest_both_ways
from .quality import DenseMatch, assess_maps, judged_map, with_alternatives, with_pieces

_FEWEST = 3
"""Pairs of points that a correspondence to be extended has at least: fewer do not say how surfaces lie."""

_SAMPLES = 512
"""Samples of each surface that hypotheses are compared at."""

MEASURED = 64
"""Of how many of them, at least, the distances are measured, and not estimated."""

_POLISHED = 60_000
"""Vertices up to which meshes that have a proxy are registered once more, with more details.  Beyond, it would take
half as long again as all the rest."""


@can_go_beside
def densify_steps(
    source: TriangleMesh | Shape,
    target: TriangleMesh | Shape,
    source_points: SurfacePoints,
    target_points: SurfacePoints,
    *,
    excluded: tuple[ArrayLike | None, ArrayLike | None] = (None, None),
    maps: tuple[SurfaceMap | None, SurfaceMap | None] = (None, None),
    margin: float | None = None,
    alternatives: int = 0,
) -> Steps[DenseMatch]:
    """Extend a sparse correspondence to all vertices.

    If it mirrors one surface onto another, other maps that do are tried as well, and the most credible is taken; any
    other correspondence is extended as it is.

    Parameters
    ----------
    source, target : TriangleMesh or Shape
        The surfaces.  With one `Shape` as both, a correspondence that mirrors is taken for its own inverse: the map is
        found in one direction, which is the other one as well.
    source_points, target_points : SurfacePoints
        Corresponding points (k,) on them: some twenty, spread over the surface, are needed at least.
    excluded : pair of (n,) array_like of bool, optional
        Vertices of the source and of the target to leave out.
    maps : pair of SurfaceMap, optional
        Of two meshes, maps there and back by another correspondence: what has no partner by these has none by this
        one, if that is much.
    margin : float, optional
        By how much, at most, the correspondence is more credible than others that are known to keep the orientation,
        if it does so itself.
    alternatives : int
        How many of these are about as credible.

    Returns
    -------
    DenseMatch
        The maps.  Where the correspondence mirrors, the orientation in `quality` is that of the mirrored source.

    Raises
    ------
    MatchError
        If a point does not lie on the main part of its mesh, there are fewer than three pairs of them, or a map is of
        another mesh.
    MeshError
        If a surface is none.
    """
    if not len(source_points) == len(target_points) >= _FEWEST:
        raise MatchError(
            f"{len(source_points)} points of the source and {len(target_points)} of the target cannot be extended to a "
            f"map: give as many of one as of the other, {_FEWEST} at least."
        )
    masks = left_out_of((source, target), excluded)
    call_helpers()
    first = _piece_of(source, "source", maps[0], source_points)
    covered = first, _piece_of(target, "target", maps[1], target_points)
    ends = zip((source, target), ("source", "target"), masks, covered, (source_points, target_points), strict=True)
    x, y = yield from within(in_turn(_shape_steps(*end) for end in ends), 0.0, 0.2)
    x, y = yield from within(evened_steps(x, y), 0.2, 0.2)
    x, y = finer_shapes(x, y)
    start = SparseStart(_rows(x, source_points), _rows(y, target_points), "given")
    yield from within(prepared_shapes_steps(x, y, Wanted(_SAMPLES, MEASURED, EIGENPAIRS)), 0.2, 0.35)
    mirrored = _mirrors(x, y, start)
    # Seen in a mirror, the source is matched by a map that keeps the orientation.
    seen = x.reflected() if mirrored else x
    involution = mirrored and x is y
    shapes = seen.limited(_SAMPLES, MEASURED), y.limited(_SAMPLES, MEASURED)
    steps = registered_pair_steps(*shapes, (start,), search=mirrored, as_they_are=mirrored)
    pair = yield from within(steps, 0.35, 0.8)
    if margin is not None and not mirrored:
        pair = replace(pair, margin=margin if pair.margin is None else min(pair.margin, margin))
    dense = yield from within(dense_match_steps(pair, involution=involution), 0.8, 1.0)
    dense = replace(dense, quality=with_alternatives(dense.quality, 0 if mirrored else alternatives))
    if mirrored:
        dense = replace(dense, target_to_source=_seen_directly(dense.target_to_source, x.original))
    return with_pieces_only(dense, (x.original, y.original), covered)


densify = at_once(densify_steps)


def _piece_of(
    surface: TriangleMesh | Shape, name: str, found: SurfaceMap | None, points: SurfacePoints
) -> Bools | None:
    """Tell which vertices of a mesh that points lie on have a partner by an earlier map; a shape is taken as it is."""
    check_surface(surface, name)
    mesh = surface.original if isinstance(surface, Shape) else surface
    if points.triangles.max() >= mesh.triangle_count or (mesh.triangles[points.triangles] != points.corners).any():
        raise MatchError(f"The points of the {name} do not lie on it, but on another mesh.")
    return None if isinstance(surface, Shape) else piece_of(surface, found, points.nearest_vertices)


def _shape_steps(
    surface: TriangleMesh | Shape,
    name: str,
    left_out: Bools | None,
    covered: Bools | None,
    points: SurfacePoints,
) -> Steps[Shape]:
    """Prepare what is covered and not excluded of a mesh, so that points lie on it, or return a shape as it is."""
    if isinstance(surface, Shape):
        return surface
    excluded = left_out_beyond(covered, left_out)
    shape = yield from within(Shape.steps(surface, name, excluded=excluded), 0.0, 0.7)
    return (yield from within(with_limbs_steps(shape, name, points.nearest_vertices), 0.7, 1.0))


def _rows(shape: Shape, points: SurfacePoints) -> Floats:
    """Distances from the vertices nearest to points (k,) to all vertices, in sqrt(area), (k, n)."""
    return shape.solver.distances(shape.surface.on_mesh(points).nearest_vertices) / shape.scale


def _seen_directly(to_reflection: SurfaceMap, source: TriangleMesh) -> SurfaceMap:
    """Turn a map to the reflection of the source into one to the source."""
    return replace(to_reflection, points=reflected_points(source, to_reflection.points))


def _at_landmarks(found: SurfaceMap, image: TriangleMesh, vertices: Ints, partners: Ints) -> SurfaceMap:
    """Name the images of landmarks by the very vertices that were given, and trust them."""
    confidence, has_partner = found.confidence.copy(), found.has_partner.copy()
    confidence[vertices], has_partner[vertices] = 1, True
    points = placed_at_vertices(found.points, image, vertices, partners)
    return replace(found, points=points, confidence=confidence, has_partner=has_partner)


def _mirrors(x: Shape, y: Shape, start: SparseStart) -> bool:
    """Whether a correspondence turns most of the surface over."""
    images = nearest_both_ways(start.source_distances.T, start.target_distances.T).on_y
    return SurfaceMap.from_points(y.mesh, SurfacePoints.at_vertices(y.mesh, images)).orientation(x.mesh, y.mesh) < 0


def dense_match_steps(pair: RegisteredPair, polish: Stage = POLISH, *, involution: bool = False) -> Steps[DenseMatch]:
    """Carry a registration to every vertex of the meshes that the surfaces stand for.

    Parameters
    ----------
    pair : RegisteredPair
        The surfaces, one laid onto the other.
    polish : Stage
        How meshes that have a proxy are registered once more, with more details.
    involution : bool
        Whether `x` is the reflection of `y` and the map its own inverse: then it is carried one way only.

    Returns
    -------
    DenseMatch
        The maps between all vertices, parts beside the main ones included.
    """
    x, y = pair.x.surface, pair.y.surface
    main_x, main_y = x.cleaned.mesh, y.cleaned.mesh
    polished = None
    largest = max(main_x.vertex_count, main_y.vertex_count)
    if largest <= _POLISHED and (x.proxy.is_coarser or y.proxy.is_coarser):
        finer = yield from within(finer_surfaces_steps(x, y), 0.0, 0.2)
        polished = Polish(*finer, polish, pair.landmarks)
    lift = _Lift((x, y), (pair.source, pair.target), (pair.registration, pair.reverse), polished)
    if involution:
        there = yield from within(_main_map_steps(lift, 0), 0.2, 0.8)
        back = reflected_points(main_x, there)
    else:
        share = shared_steps if largest <= MOST_SENT else here_steps
        there, back = yield from within(share(_main_map_steps, lift, (0, 1)), 0.2, 0.8)
    if pair.landmarks is not None:
        here, partners = pair.landmarks.source.main, pair.landmarks.target.main
        there = pinned(main_x, main_y, there, here, partners, search=y.dense_search)
        back = pinned(main_y, main_x, back, partners, here, search=x.dense_search)
    yield Progress(0.8, "Judging the map")
    doubts, (alike, in_place) = _doubts(pair), (pair.likeness, pair.in_place)
    known = judged_map(main_x, main_y, there, back, doubts[0])
    yield Progress(0.82, "Judging the map")
    known_back = judged_map(main_y, main_x, back, there, doubts[1])
    yield Progress(0.84, "Judging the map")
    quality = assess_maps((main_x, main_y), there, (known, known_back), pair.margin, likeness=alike, in_place=in_place)
    credibility = vertex_credibility(quality.orientation, pair.margin, alike, in_place)
    confidences = known.confidence, known_back.confidence
    steps = whole_maps_steps(x.cleaned, y.cleaned, there, back, confidences=confidences, credibility=credibility)
    whole, whole_back = yield from within(steps, 0.85, 1.0)
    del there, back  # of a million vertices, what is not needed any more counts
    forward, backward = _on_original(whole, y), _on_original(whole_back, x)
    quality = with_pieces(quality, max(whole.alone, whole_back.alone), whole.share)
    if pair.landmarks is not None:
        given, partners = pair.landmarks.source.original, pair.landmarks.target.original
        forward = _at_landmarks(forward, y.original, given, partners)
        backward = _at_landmarks(backward, x.original, partners, given)
    if pair.mirrored:
        backward = _seen_directly(backward, reflected_mesh(x.original))
    return DenseMatch(forward, backward, quality)


def _doubts(pair: RegisteredPair) -> tuple[Floats | float, Floats | float]:
    """Say how far images of vertices of the main parts may err, (n,) and (n',), beside their ways there and back."""
    if pair.trips is None:
        return 0.0, 0.0
    places = pair.x.surface.proxy.points, pair.y.surface.proxy.points
    return places[0].interpolate(pair.trips[0]), places[1].interpolate(pair.trips[1])


class _Lift(NamedTuple):
    """Two surfaces, X and Y, what was registered in their place, each to the other, and how that is polished."""

    surfaces: tuple[PreparedSurface, PreparedSurface]
    deformable: tuple[DeformableSurface, DeformableSurface]
    registrations: tuple[Registration, Registration]
    polish: Polish | None


def _main_map_steps(lift: _Lift, here: int) -> Steps[SurfacePoints]:
    """Map every vertex of the main part of X to that of Y (`here` is 0), or of Y to that of X (1)."""
    x, y, registration = lift.surfaces[here], lift.surfaces[1 - here], lift.registrations[here]
    positions = lift.deformable[1 - here].in_its_units(registration.positions)
    proxy_map = registration.on_target.nearest_vertices(y.mesh.triangles)
    if lift.polish is not None:
        return (yield from lift.polish.steps(positions, proxy_map, here))
    ends = x.cleaned.mesh, x.proxy, positions, y.cleaned.mesh
    found = yield from lift_steps(*ends, target_proxy=y.proxy, proxy_map=proxy_map, search=y.dense_search)
    y.dense_search.forget()
    return found


def _on_original(found: WholeMap, y: PreparedSurface) -> SurfaceMap:
    """Name a map of all vertices by the triangles of the original mesh, excluded ones counted."""
    points = found.points
    if len(y.kept_triangles) < y.original.triangle_count:
        points = SurfacePoints.from_barycentric(y.original, y.kept_triangles[points.triangles], points.barycentric)
    # What has no partner is trusted nowhere, and all else at least a little.
    return SurfaceMap(points, found.confidence, y.original.vertex_count, found.confidence > 0)
