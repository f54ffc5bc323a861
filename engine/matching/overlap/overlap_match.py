# SPDX-License-Identifier: GPL-3.0-or-later
"""Matching of two surfaces that may share only a part of what they show."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np
from scipy.special import expit

from ...dense.components.component_maps import follow_steps
from ...dense.missing_parts import round_trips
from ...dense.quality import DenseMatch, MatchQuality, overlap_sentence, trip_confidence
from ...geometry.geodesics import GeodesicSolver
from ...geometry.sampling import FarthestPointSampler
from ...hierarchical.sparse_result import CoarseMatch, Level
from ...mesh.connectivity.adjacency import neighbour_means
from ...mesh.surface_map import SurfaceMap
from ...mesh.surface_points import SurfacePoints
from ...mesh.triangle_mesh import TriangleMesh
from ...registration.prolongation import lift_steps
from ...runtime.arrays import TINY, Bools, Floats, Ints, marked
from ...runtime.parallel_map import MOST_SENT, here_steps, shared_steps
from ...runtime.progress import Progress, Steps, part_of, within
from ...shapes.prepared_surface import PreparedSurface
from ...shapes.shape import Shape
from ..result import MatchResult
from ..shape_matching import MatchTask
from .overlap_maps import Overlap, OverlapSearch, overlap_steps

CLEAR = 0.5
"""Credibility from which on an overlap is more likely right than not."""


_SCORE, _MARGIN, _AGREEMENT, _AREA = (1.4, 0.6), (2.2, 0.35), (0.5, 0.06), (0.15, 0.04)
"""Of what an overlap is judged by, the value at which it is believed as often as not if all else is clear, and by how
much more or less that changes: see the attributes of `Overlap`.  Chosen so that few that are wrong are believed: of the
parts of `docs/results.md`, 2 of 21, and 35 of the 57 that are right."""

_SIZES = 2.5
"""Ratio of the sizes of two surfaces, in the units they are given in, from which on these are not the same unit."""

_SCALES = 1.0, 1 / 1.3, 1.3
"""What is tried then: ratios of sizes, as many as make both surfaces as large as each other."""

_LEAST_POINTS = 4
"""Points at least that are shown of an overlap."""

_LABEL = "Mapping every vertex"


@dataclass(frozen=True, eq=False)
class OverlapMatch:
    """A match of what two surfaces share.

    Attributes
    ----------
    result : MatchResult
        The match.
    is_likely : bool
        Whether it is more likely right than not, by its score alone.
    credibility : float
        How far it can be trusted as a whole, 0 to 1.
    shares : pair of float
        Part of the area of the main part of the source, and of the target, that is shared.
    search : OverlapSearch
        What it was found on.
    """

    result: MatchResult
    is_likely: bool
    credibility: float
    shares: tuple[float, float]
    search: OverlapSearch

    def doubted(self, other: MatchResult, x: Shape, y: Shape) -> MatchResult:
        """Trust a match of all of the surfaces less, the less it would be worth as an overlap.

        All of two surfaces that were cut off somewhere seldom corresponds.  A wrong map that says so leads across where
        one of them was cut, and strains them.
        """
        dense = other.dense
        there, back, quality = dense.source_to_target, dense.target_to_source, dense.quality
        trust = float(expit(self.search.score((there.positions[x.vertices], back.positions[y.vertices]))))
        sentence = quality.sentence if trust >= CLEAR else overlap_sentence(self.shares, credible=False)
        there, back = (replace(each, confidence=trust * each.confidence) for each in (there, back))
        quality = replace(quality, confidence=trust * quality.confidence, sentence=sentence)
        return other.with_dense(DenseMatch(there, back, quality))


def credibility(overlap: Overlap) -> float:
    """Say how far an overlap can be trusted as a whole, 0 to 1: not if there is any reason to doubt it."""
    known = overlap.score, overlap.margin, overlap.agreement, overlap.area
    limits = _SCORE, _MARGIN, _AGREEMENT, _AREA
    return float(np.prod([expit((value - half) / spread) for value, (half, spread) in zip(known, limits, strict=True)]))


def overlap_match_steps(x: Shape, y: Shape, task: MatchTask) -> Steps[OverlapMatch | None]:
    """Match what two surfaces share.

    Parameters
    ----------
    x, y : Shape
        The source and the target.
    task : MatchTask
        What is wanted; landmarks do not count.

    Returns
    -------
    OverlapMatch or None
        The match: vertices outside of the overlap have no partner, and no confidence.  None if no overlap was found.
    """
    overlap = yield from within(_found_steps(x, y), 0.0, 0.8)
    task.clock.lap("overlap")
    if overlap is None:
        return None
    likely = credibility(overlap)
    main = x.surface.cleaned.mesh, y.surface.cleaned.mesh
    known = _on_main(x, overlap.members[0]), _on_main(y, overlap.members[1])
    lift = _Lift((x.surface, y.surface), overlap.positions, overlap.images, known)
    share = shared_steps if max(mesh.vertex_count for mesh in main) <= MOST_SENT else here_steps
    there, back = yield from within(share(_lifted_steps, lift, (0, 1)), 0.8, 0.92)
    shared = _Shared(main, (there, back), known, likely)
    forward = yield from within(_whole_map_steps((x, y), shared, 0), 0.92, 0.95)
    backward = yield from within(_whole_map_steps((y, x), shared, 1), 0.95, 0.98)
    quality = _quality(shared, overlap)
    task.clock.lap("lift")
    showing = _result_steps((x, y), overlap, task, (forward, backward), quality)
    result = yield from within(showing, 0.98, 1.0)
    return OverlapMatch(result, overlap.score > 0, likely, shared.shares, overlap.search)


def _found_steps(x: Shape, y: Shape) -> Steps[Overlap | None]:
    """Find what two surfaces share: in the units they are given in, if that can be, or in the first credible ones."""
    ratio = x.scale / y.scale
    scales = [1.0] if 1 / _SIZES < ratio < _SIZES else [ratio * scale for scale in _SCALES]
    best = None
    for number, scale in enumerate(scales):
        overlap = yield from within(overlap_steps(x.mesh, y.mesh, scale), *part_of(number, len(scales)))
        if overlap is not None and (best is None or credibility(overlap) > credibility(best)):
            best = overlap
        if best is not None and credibility(best) >= CLEAR:
            break
    return best


@dataclass(frozen=True, eq=False)
class _Shared:
    """What two surfaces share, in full resolution.

    Attributes
    ----------
    meshes : pair of TriangleMesh
        The main parts, n and n' vertices.
    maps : pair of SurfacePoints
        For each vertex of either its point on the other.
    known : pair of arrays of bool, (n,) and (n',)
        Which have a partner.
    likely : float
        How likely all of it is right.
    """

    meshes: tuple[TriangleMesh, TriangleMesh]
    maps: tuple[SurfacePoints, SurfacePoints]
    known: tuple[Bools, Bools]
    likely: float

    @property
    def shares(self) -> tuple[float, float]:
        """Part of the area of either that is shared."""
        source, target = (
            float(mesh.vertex_areas @ known) / mesh.area for mesh, known in zip(self.meshes, self.known, strict=True)
        )
        return source, target

    def trips(self, here: int) -> Floats:
        """Distance between each vertex of one surface and where both maps bring it, in sqrt(area)."""
        mesh = self.meshes[here]
        return round_trips(mesh, self.maps[here], self.maps[1 - here]) / np.sqrt(mesh.area)

    def trust(self, here: int) -> Floats:
        """How far the image of each vertex of one surface can be trusted: no more than all of it."""
        confidence = neighbour_means(self.meshes[here], trip_confidence(self.trips(here)))
        return self.likely * self.known[here] * np.clip(confidence, 0, 1)


class _Lift(NamedTuple):
    """Two surfaces, where what stands for either lies on the other, its matches there, and which vertices have one."""

    surfaces: tuple[PreparedSurface, PreparedSurface]
    positions: tuple[Floats, Floats]
    images: tuple[Ints, Ints]
    known: tuple[Bools, Bools]


def _lifted_steps(lift: _Lift, here: int) -> Steps[SurfacePoints]:
    """Map every vertex of the main part of one surface to that of the other."""
    surface, image = lift.surfaces[here], lift.surfaces[1 - here]
    ends = surface.cleaned.mesh, surface.proxy, lift.positions[here], image.cleaned.mesh
    images, search, shown = lift.images[here], image.dense_search, lift.known[here]
    return lift_steps(*ends, target_proxy=image.proxy, proxy_map=images, search=search, shown=shown)


def _on_main(shape: Shape, members: Bools) -> Bools:
    """Carry truth values (k,) of what is matched to the vertices of the main part."""
    return shape.surface.proxy.points.interpolate(members.astype(np.float64)) > 1 / 2


def _whole_map_steps(pair: tuple[Shape, Shape], shared: _Shared, here: int) -> Steps[SurfaceMap]:
    """Extend the map of one main part, with its confidence and which vertices have a partner, to all of its mesh."""
    x, y = pair
    followed = yield from follow_steps(x.surface.cleaned, y.surface.cleaned, shared.maps[here])
    confidence = followed.confidence * shared.trust(here)[followed.surroundings]
    triangles = y.surface.kept_triangles[followed.points.triangles]
    partners = shared.known[here][followed.surroundings]
    return SurfaceMap.from_barycentric(y.original, triangles, followed.points.barycentric, confidence, partners)


def _quality(shared: _Shared, overlap: Overlap) -> MatchQuality:
    """Measure what is shared."""
    (source, target), known, lengths = shared.meshes, shared.known[0], overlap.search.lengths
    areas = source.vertex_areas * known
    total = max(float(areas.sum()), TINY)
    found = SurfaceMap.from_points(target, shared.maps[0])
    shown = source.triangle_areas * known[source.triangles].all(axis=1)
    orientation = float(shown @ found.face_orientations(source, target)) / max(float(shown.sum()), TINY)
    # In one unit of length: parts have no sizes of their own.
    stretch = found.edge_stretch(source, target) * np.sqrt(target.area / source.area) * lengths[0] / lengths[1]
    usable = known[source.edges].all(axis=1) & np.isfinite(stretch) & (stretch > 0)
    weights = np.square(source.edge_lengths[usable])
    distortion = float(weights @ np.abs(np.log(stretch[usable]))) / max(float(weights.sum()), TINY)
    confidence = float(areas @ shared.trust(0)) / total * max(orientation, 0.0)
    disagreement = float(areas @ shared.trips(0)) / total
    credible = shared.likely >= CLEAR
    sentence = overlap_sentence(shared.shares, credible=credible)
    # What is not likely right has no partner as likely as not.
    shares = [share * (1.0 if credible else shared.likely) for share in shared.shares]
    numbers = orientation, distortion, shares[1], disagreement, overlap.margin, confidence
    return MatchQuality(*numbers, sentence, source_coverage=shares[0])


def _result_steps(
    pair: tuple[Shape, Shape],
    overlap: Overlap,
    task: MatchTask,
    maps: tuple[SurfaceMap, SurfaceMap],
    quality: MatchQuality,
) -> Steps[MatchResult]:
    """Show the map by points that are spread over what is shared."""
    (x, y), (forward, backward) = pair, maps
    settings = task.settings
    vertices = _spread(x, np.flatnonzero(overlap.members[0]), settings.points)
    own = x.vertices[vertices]
    images = SurfacePoints.from_barycentric(y.original, forward.triangles[own], forward.barycentric[own])
    on_main = (y.surface.cleaned.vertex_parts[images.nearest_vertices] == 0).all()
    ends = y.surface.mesh_vertices(images.nearest_vertices) if on_main else overlap.images[0][vertices]
    distances = yield from shared_steps(_distances_steps, None, ((x.solver, vertices), (y.solver, ends)))
    here, there = (rows / unit for rows, unit in zip(distances, overlap.search.lengths, strict=True))
    differences = here - there
    squares = np.where(np.isfinite(differences), np.square(differences), 0.0)
    distortion = settings.quadratic_weight * float(squares.sum())
    first = min(settings.coarse_points, len(vertices))
    coarse = settings.quadratic_weight * float(squares[:first, :first].sum())
    return MatchResult(
        source_points=SurfacePoints.at_vertices(x.original, own),
        target_points=images,
        distortion=distortion,
        linear=0.0,
        quadratic=float(squares.sum()),
        point_distortion=np.sqrt(squares.sum(axis=1) / max(len(vertices) - 1, 1)),
        orientation=quality.orientation,
        levels=(Level(len(vertices), 0, distortion, images),),
        coarse=CoarseMatch(own[:first], images.nearest_vertices[:first], first, coarse, 0.0, proven=False, nodes=0),
        source_distances=None,
        target_distances=None,
        notes=tuple(note for shape in (x, y) for note in shape.surface.cleaned.notes),
        seconds=dict(task.clock.laps),
        source_to_target=forward,
        target_to_source=backward,
        quality=quality,
    )


def _distances_steps(_: None, ends: tuple[GeodesicSolver, Ints]) -> Steps[Floats]:
    """Measure the distances between some vertices (k,), (k, k)."""
    solver, vertices = ends
    yield Progress(0.0, _LABEL)
    return solver.distances(vertices)[:, vertices]


def _spread(shape: Shape, members: Ints, count: int) -> Ints:
    """Take some of the vertices (k,) of a surface, far from each other; they may be in several pieces."""
    graph = shape.solver.graph
    centre = shape.mesh.vertices[members].mean(axis=0)
    first = members[int(np.square(shape.mesh.vertices[members] - centre).sum(axis=1).argmax())]
    sampler = FarthestPointSampler(graph, int(first))
    sampler.distances[~marked(members, shape.mesh.vertex_count)] = -1.0
    sampler.extend(max(min(count, len(members)), min(_LEAST_POINTS, len(members))))
    return np.array(sampler.samples)
