# SPDX-License-Identifier: GPL-3.0-or-later
"""The few most credible dense maps between two surfaces, the mirrored and turned ones told apart."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import chain
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..runtime.parallel_map import shared_steps
from ..runtime.progress import Progress, Steps, in_turn, run, within
from ..shapes.shape import Shape
from .credibility import map_score
from .functional_maps import (
    FunctionalMaps,
    PointMaps,
    fit_functional_maps,
    nearest_both_ways,
    points_from_functions,
    points_from_functions_steps,
    refine_bijective_steps,
    spectral_sizes,
)
from .map_energies import curvature_terms, distance_term, map_orientation, rigidity_term, spectral_terms
from .rough_maps.extremity_maps import MapLead, RoughSearch, distinct_leads, fitting_maps_steps, rough_maps_steps
from .rough_maps.rigid_maps import rigid_maps
from .spectral_domain import MapDomain

_FINE_SIZES = spectral_sizes(15, 80, 9)
_SMOOTH = 25  # eigenfunctions that maps between coarse samples are carried over with
_SMOOTHED = 110  # eigenfunctions that patches are smoothed by before they are compared as rigid bodies
_ISOMETRIC = 0.05  # isometric defect up to which functional maps agree with the truth
_ROUGH = "matching"  # origin of what functional maps have not refined
_ORIENTED = 0.7  # orientation from which on hardly anything is turned over but what is too thin to tell
_DISTINCT = 0.07  # mean distance, in sqrt(area), between the images of distinct maps
_HOPELESS = 3.0  # excess of the score over the best of the same orientation from which on a map is left out
_MOST = {1: 4, -1: 2}  # how many maps are returned that keep the orientation, and that mirror it, at most


@dataclass(frozen=True, eq=False)
class SparseStart:
    """A few corresponding places that a map starts from, each by the distances to it.

    Attributes
    ----------
    source_distances : (k, n) array of float
        Distance from each place to every vertex of X, in units of the square root of its area.
    target_distances : (k, n') array of float
        Distance from the corresponding place to every vertex of Y, in units of the square root of its area.
    origin : str
        Where they are from.
    """

    source_distances: NDArray[np.floating[Any]]
    target_distances: NDArray[np.floating[Any]]
    origin: str = "landmarks"


class Extension:
    """The map of a hypothesis between all vertices: made when it is asked for, as many hypotheses never are.

    Parameters
    ----------
    known : PointMaps, optional
        The map, if it is known already.
    """

    def __init__(self, known: PointMaps | None = None) -> None:
        self.known = known

    def steps(self, domains: tuple[MapDomain, MapDomain], points: PointMaps) -> Steps[PointMaps]:
        """Make the map of that between the fine samples, unless it is known."""
        if self.known is None:
            self.known = yield from _between_all_vertices_steps(*domains, points)
        return self.known


@dataclass(frozen=True, eq=False)
class MapHypothesis(MapLead):
    """A dense map that may be the true one: a lead between the fine samples, of a pair of surfaces.

    Attributes
    ----------
    domains : pair of MapDomain
        The surfaces.
    extension : Extension
        The map between all vertices.
    """

    domains: tuple[MapDomain, MapDomain]
    extension: Extension

    @property
    def images(self) -> PointMaps:
        """The map between all vertices."""
        return run(self.images_steps())

    def images_steps(self) -> Steps[PointMaps]:
        """Extend the map to all vertices in short steps; the result is kept."""
        return self.extension.steps(self.domains, self.points)

    @property
    def isometric_defect(self) -> float:
        """How far the map is from keeping all distances; below 0.1 where it is nearly an isometry."""
        return self.terms["commutator"]

    @property
    def is_rough(self) -> bool:
        """Whether it is a matching of extremities as it is, see `unrefined_hypotheses_steps`."""
        return self.origin == _ROUGH

    @property
    def is_doubtful(self) -> bool:
        """Whether functional maps may have led astray: the map is no isometry, or turns parts of the surface over."""
        return self.isometric_defect > _ISOMETRIC or self.orientation < _ORIENTED


def map_hypotheses_steps(
    x: Shape,
    y: Shape,
    starts: Sequence[SparseStart] = (),
    *,
    search: bool = True,
    mirrored: bool = True,
    domains: tuple[MapDomain, MapDomain] | None = None,
    searched: RoughSearch | None = None,
) -> Steps[list[MapHypothesis]]:
    """Propose dense maps between two surfaces, most credible first.

    Nearly symmetric shapes have several maps that nearly keep all distances: the true one, its reflection, and for
    people also the half turn, which swaps left with right and front with back, and keeps the orientation.  So a few
    extremities are matched in many ways, each way is carried over the whole surface and refined by bijective ZoomOut,
    and the best distinct maps are compared by all that is known of both surfaces.  Where one can be laid onto the other
    as it is, such maps are compared as well.

    Parameters
    ----------
    x, y : Shape
        The surfaces, for which `Shape.sample_steps` and `Shape.spectrum_steps` were run; 512 samples and 120
        eigenpairs are used, or what there is.
    starts : sequence of SparseStart
        Correspondences from elsewhere that enter the comparison.
    search : bool
        Whether matchings of extremities and rigid motions are tried as well; without, there must be a start.
    mirrored : bool
        Whether matchings of extremities that mirror the surface are followed up even if there are others.
    domains : pair of MapDomain, optional
        Those of the surfaces, if earlier hypotheses have them.
    searched : RoughSearch, optional
        Matchings of extremities that keep the orientation, with its domains, if they have been looked for.

    Yields
    ------
    Progress
        About every tenth of a second for meshes of some thousand vertices.

    Returns
    -------
    list of MapHypothesis
        Those that keep the orientation and those that mirror it, by growing score; what is far less credible than the
        best of its orientation is left out.
    """
    a, b = domains = domains or (map_domains(x, y) if searched is None else searched.domains)
    yield Progress(0.05, "Comparing maps")
    leads: list[MapLead] = []
    if search:
        steps = rough_maps_steps(a, b) if mirrored else _keeping_leads_steps(a, b, searched)
        leads = yield from within(steps, 0.05, 0.4)
    candidates = [(_between_fine(a, b, _smooth_maps(a, b, lead.points)), lead.origin) for lead in leads]
    candidates += [(_from_start(a, b, start), start.origin) for start in starts]
    # What takes longest comes first.
    items = [*([None] if search else []), *candidates]
    refined = yield from within(shared_steps(_refined_leads_steps, domains, items), 0.4, 1.0)
    kept = distinct_leads(b, list(chain.from_iterable(refined)), _DISTINCT, _HOPELESS, _MOST)
    return [hypothesis_of(domains, lead) for lead in kept]


def map_domains(x: Shape, y: Shape) -> tuple[MapDomain, MapDomain]:
    """Prepare two shapes, with samples and spectra, for the search for maps."""
    size = min(len(x.spectrum), len(y.spectrum))
    return MapDomain(x, size), MapDomain(y, size)


def unrefined_hypotheses_steps(domains: tuple[MapDomain, MapDomain]) -> Steps[list[MapHypothesis]]:
    """Propose maps that keep the orientation, of matchings of extremities as they are.

    From either side: which points of a surface are its farthest, and what they may be matched to, differs.

    Parameters
    ----------
    domains : pair of MapDomain
        The surfaces.

    Yields
    ------
    Progress
        After each search for matchings, and each map that is scored.

    Returns
    -------
    list of MapHypothesis
        The most credible matching of X to Y, and of Y to X.  Their scores are comparable among each other.
    """
    found = yield from shared_steps(_best_unrefined_steps, domains, (0, 1))
    return [hypothesis_of(domains, *best) for best in found if best is not None]


def _best_unrefined_steps(domains: tuple[MapDomain, MapDomain], way: int) -> Steps[tuple[MapLead, PointMaps] | None]:
    """Choose the most credible matching of X to Y (way 0), or of Y to X (1), if any keeps the orientation."""
    (x, y), turned = domains, way == 1
    proposed = yield from within(fitting_maps_steps(*(domains[::-1] if turned else domains)), 0.0, 0.5)
    if turned:
        proposed = [PointMaps(points.on_x, points.on_y) for points in proposed]
    best: tuple[MapLead, FunctionalMaps] | None = None
    for number, points in enumerate(proposed):
        maps = _smooth_maps(x, y, points)
        lead = _assessed(x, y, _between_fine(x, y, maps), _ROUGH)
        if lead.orientation > 0 and (best is None or lead.score < best[0].score):
            best = lead, maps
        yield Progress(0.5 + 0.5 * (number + 1) / len(proposed), "Comparing maps")
    if best is None:
        return None
    images = yield from within(points_from_functions_steps(best[1], x.functions, y.functions), 1.0, 1.0)
    return best[0], images


def unrefined_hypothesis(domains: tuple[MapDomain, MapDomain], start: SparseStart) -> MapHypothesis:
    """Take a start as it is: every vertex goes to the one at the most similar distances from the known places.

    Functional maps join what looks alike, such as the one horn of two that is whole with itself in a map that mirrors.
    """
    x, y = domains
    lead = _assessed(x, y, _from_start(x, y, start), start.origin)
    rows = (np.asarray(distances, np.float64).T for distances in (start.source_distances, start.target_distances))
    return hypothesis_of(domains, lead, nearest_both_ways(*rows))


def assessed_everywhere(domains: tuple[MapDomain, MapDomain], images: PointMaps) -> MapLead:
    """Score maps between all vertices like a hypothesis: smaller is more credible."""
    return _assessed(*domains, _at_fine_samples(*domains, images), "")


def refined_hypothesis_steps(
    domains: tuple[MapDomain, MapDomain], images: PointMaps, origin: str
) -> Steps[MapHypothesis]:
    """Refine maps between all vertices by functional maps, as rough maps are, so that their scores compare.

    Parameters
    ----------
    domains : pair of MapDomain
        The surfaces.
    images : PointMaps
        Between all their vertices.
    origin : str
        Where they are from.

    Yields
    ------
    Progress
        After each number of eigenfunctions.

    Returns
    -------
    MapHypothesis
        What has become of them.
    """
    x, y = domains
    rough = _at_fine_samples(x, y, images)
    points = yield from refine_bijective_steps(x.fine_basis, y.fine_basis, rough, _FINE_SIZES)
    return hypothesis_of(domains, _assessed(x, y, points, origin))


def _at_fine_samples(x: MapDomain, y: MapDomain, images: PointMaps) -> PointMaps:
    """Take maps between all vertices to the fine samples."""
    return PointMaps(y.nearest_samples(images.on_y[x.vertices]), x.nearest_samples(images.on_x[y.vertices]))


def _refined_leads_steps(
    domains: tuple[MapDomain, MapDomain], start: tuple[PointMaps, str] | None
) -> Steps[list[MapLead]]:
    """Refine a map between the fine samples, from somewhere, and score it; or look for rigid ones first (None)."""
    starts = [(points, "rigid") for points in rigid_maps(*domains)] if start is None else [start]
    return (yield from in_turn(_refined_lead_steps(*domains, *each) for each in starts))


def _refined_lead_steps(x: MapDomain, y: MapDomain, points: PointMaps, origin: str) -> Steps[MapLead]:
    """Refine a map between the fine samples, and score it."""
    refined = yield from refine_bijective_steps(x.fine_basis, y.fine_basis, points, _FINE_SIZES)
    return _assessed(x, y, refined, origin)


def hypothesis_of(
    domains: tuple[MapDomain, MapDomain], lead: MapLead, images: PointMaps | None = None
) -> MapHypothesis:
    """Make a hypothesis of a lead, with its map between all vertices if that is known already."""
    return MapHypothesis(lead.points, lead.score, lead.orientation, lead.terms, lead.origin, domains, Extension(images))


def _keeping_leads_steps(x: MapDomain, y: MapDomain, searched: RoughSearch | None) -> Steps[list[MapLead]]:
    """Propose maps between the coarse samples that keep the orientation, or any if there are none."""
    leads = yield from within(rough_maps_steps(x, y, (1,), searched), 0.0, 0.9)
    keeping = [lead for lead in leads if lead.orientation > 0]
    return keeping or (yield from within(rough_maps_steps(x, y), 0.9, 1.0))


def _smooth_maps(x: MapDomain, y: MapDomain, points: PointMaps) -> FunctionalMaps:
    """Take maps between the coarse samples without their noise."""
    return fit_functional_maps(x.coarse_basis, y.coarse_basis, points, _SMOOTH)


def _between_fine(x: MapDomain, y: MapDomain, maps: FunctionalMaps) -> PointMaps:
    """Carry functional maps to the fine samples."""
    return points_from_functions(maps, x.fine_basis.functions, y.fine_basis.functions)


def _from_start(x: MapDomain, y: MapDomain, start: SparseStart) -> PointMaps:
    """Map fine samples to those at the most similar distances from the landmarks."""
    return nearest_both_ways(
        np.asarray(start.source_distances, np.float64)[:, x.vertices].T,
        np.asarray(start.target_distances, np.float64)[:, y.vertices].T,
    )


def _assessed(x: MapDomain, y: MapDomain, points: PointMaps, origin: str) -> MapLead:
    """Score maps between the fine samples by all that is known."""
    maps = fit_functional_maps(x.fine_basis, y.fine_basis, points, _FINE_SIZES[-1])
    terms = spectral_terms(x, y, maps) | curvature_terms(x, y, points)
    terms["distances"] = distance_term(x, y, points)
    terms["rigidity"] = rigidity_term(x, y, points, _SMOOTHED)
    return MapLead(points, map_score(terms), map_orientation(x, y, points, maps), terms, origin)


def _between_all_vertices_steps(x: MapDomain, y: MapDomain, points: PointMaps) -> Steps[PointMaps]:
    """Extend maps between the fine samples to all vertices."""
    maps = fit_functional_maps(x.fine_basis, y.fine_basis, points, _FINE_SIZES[-1])
    return (yield from points_from_functions_steps(maps, x.functions, y.functions))
