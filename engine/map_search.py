# SPDX-License-Identifier: GPL-3.0-or-later
"""Rough maps between two surfaces: many matchings of extremities, carried over the surface and refined a little."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from .extremities import spread_extremities
from .extremity_search import beam_matchings
from .functional_maps import PointMaps, fit_functional_maps, refine_bijective_steps, spectral_sizes
from .lifted_matchings import LiftedMatchings
from .map_scores import curvature_terms, map_orientation, rigidity_term, score_of, spectral_terms
from .progress import Progress, Steps, within

if TYPE_CHECKING:
    from collections.abc import Mapping

    from numpy.typing import NDArray

    from .map_domain import MapDomain

__all__ = ["MapLead", "distinct_leads", "rough_maps_steps"]

# How many farthest points of X and of Y are matched, and how many matchings are followed up that keep the orientation
# (1) and that mirror it (-1).
_FARTHEST = ((5, 9, {1: 10, -1: 8}), (6, 10, {1: 12, -1: 8}))
# The same for tips of limbs: which points are the farthest depends on proportions, which limbs there are does not.
_TIPS = (6, 9, {1: 10, -1: 8})
_TIPS_APART = (0.4, 0.25)  # least distance of those of X, each of another limb, and of those offered of Y
_EXCHANGES = 6  # other ways to match the tips to what the best map takes there, of limbs that are alike
_OFFERED = 400  # matchings that are carried over the surfaces to choose those that are followed up
_SIZES = spectral_sizes(15, 30, 5)  # not from fewer: those would turn even true matchings front to back
_VARIANTS = {1: (3, 2, 1, 1, 1, 1), -1: (2, 1)}  # how many of each group of like maps are followed up, by orientation
_HOPELESS = 2.5  # excess of the score over the best of the same orientation
_CLUSTER = 0.15  # mean distance between the images of maps of different groups, in sqrt(area)
_VARIANT = 0.04  # the same for those of one group: a limb may be crossed in the best of them


@dataclass(frozen=True, eq=False)
class MapLead:
    """A map between samples on its way to a hypothesis.

    Attributes
    ----------
    points : PointMaps
        The map and its inverse.
    score : float
        Smaller is more credible; comparable between leads of one stage.
    orientation : float
        From -1 (mirrored everywhere) to 1 (kept everywhere).
    terms : mapping of str to float
        The parts of the score.
    origin : str
        Where it started.
    """

    points: PointMaps
    score: float
    orientation: float
    terms: Mapping[str, float]
    origin: str


class _Search(NamedTuple):
    """Samples of X by number, (m,), samples of Y to match them to, (n,), and how many matchings are followed up."""

    of_x: NDArray[np.int64]
    of_y: NDArray[np.int64]
    kept: Mapping[int, int]

    def possible(self, count_x: int, count_y: int) -> _Search:
        """Leave out samples beyond those that there are, and points of X that are too many for those of Y."""
        of_y = self.of_y[self.of_y < count_y]
        return self._replace(of_x=self.of_x[self.of_x < count_x][: len(of_y)], of_y=of_y)


def rough_maps_steps(x: MapDomain, y: MapDomain, signs: tuple[int, ...] = (1, -1)) -> Steps[list[MapLead]]:
    """Propose maps between the coarse samples of two surfaces.

    Parameters
    ----------
    x, y : MapDomain
        The surfaces.
    signs : tuple of int
        Whether matchings are carried over with the orientation kept (1), with it mirrored (-1), or each both ways.

    Yields
    ------
    Progress
        After each matching of extremities that was followed up.

    Returns
    -------
    list of MapLead
        A few of each of the most credible groups of like maps, of either orientation.
    """
    leads: list[MapLead] = []
    searches = _searches(x, y)
    parts = len(searches) + 1
    for number, search in enumerate(searches):
        steps = _followed_steps(x, y, search, signs)
        leads += yield from within(steps, number / parts, (number + 1) / parts)
    for number, sign in enumerate(signs):
        begin, end = (1 - (1 - (number + i) / len(signs)) / parts for i in (0, 1))
        for lead in _of_orientation(leads, sign)[:1]:
            leads += yield from within(_exchanged_steps(x, y, lead, sign), begin, end)
    return _candidates(y, leads)


def _followed_steps(x: MapDomain, y: MapDomain, search: _Search, signs: tuple[int, ...]) -> Steps[list[MapLead]]:
    """Follow up the matchings of one kind that fit the whole surfaces best."""
    leads: list[MapLead] = []
    matchings = _matchings(x, y, search.of_x, search.of_y)
    lifted = LiftedMatchings(x, y, search.of_x, search.of_y)
    total = sum(search.kept[sign] for sign in signs)
    for sign in signs:
        for images in lifted.best(matchings, sign, search.kept[sign]):
            steps = _refined_steps(x, y, lifted.maps(images, sign))
            leads.append((yield from within(steps, len(leads) / total, (len(leads) + 1) / total)))
    return leads


def _exchanged_steps(x: MapDomain, y: MapDomain, lead: MapLead, sign: int) -> Steps[list[MapLead]]:
    """Follow up other ways to match what a map takes to the tips of limbs of Y."""
    tips = spread_extremities(y.shape, _TIPS[1], _TIPS_APART[1])
    of_x, first = np.unique(lead.points.on_x[tips], return_index=True)
    of_y = tips[first]
    lifted = LiftedMatchings(x, y, of_x, of_y)
    starts = lifted.best(_matchings(x, y, of_x, of_y), sign, _EXCHANGES)
    better = []
    for images in starts:
        better.append(lifted.exchanged(images, sign))
        yield Progress(0.5 * len(better) / len(starts), "Comparing maps")
    leads: list[MapLead] = []
    for images in lifted.best(np.array(better), sign, _EXCHANGES):
        begin, end = (0.5 + 0.5 * (len(leads) + i) / len(starts) for i in (0, 1))
        leads.append((yield from within(_refined_steps(x, y, lifted.maps(images, sign)), begin, end)))
    return leads


def _matchings(x: MapDomain, y: MapDomain, of_x: NDArray[np.int64], of_y: NDArray[np.int64]) -> NDArray[np.int64]:
    """Match coarse samples (m,) to coarse samples (n,) in many ways: positions of images (r, m)."""
    distances_x, distances_y = (d.shape.sample_distances[np.ix_(n, n)] for d, n in ((x, of_x), (y, of_y)))
    unlike = _dissimilarity(x, y, of_x, of_y)
    return beam_matchings(distances_x, distances_y, unlike, kept=_OFFERED, width=_OFFERED).images


def _searches(x: MapDomain, y: MapDomain) -> list[_Search]:
    """Choose what is matched to what."""
    few, offered, kept = _TIPS
    apart_x, apart_y = _TIPS_APART
    tips = spread_extremities(x.shape, few, apart_x), spread_extremities(y.shape, offered, apart_y)
    searches = [_Search(np.arange(m), np.arange(n), counts) for m, n, counts in _FARTHEST]
    return [search.possible(x.coarse_count, y.coarse_count) for search in (*searches, _Search(*tips, kept))]


def distinct_leads(
    y: MapDomain, leads: list[MapLead], apart: float, worse: float, most: Mapping[int, int]
) -> list[MapLead]:
    """Keep the best few of either orientation, leaving out those that are nearly the same as a better one.

    Parameters
    ----------
    y : MapDomain
        The surface that is mapped to.
    leads : list of MapLead
        All between the same samples.
    apart : float
        Least mean distance between the images, in sqrt(area).
    worse : float
        By how much the score may be larger than the best one of the same orientation.
    most : mapping of int to int
        How many to keep that keep the orientation (1) and that mirror it (-1).

    Returns
    -------
    list of MapLead
        By growing score.
    """
    kept: list[MapLead] = []
    for sign, count in most.items():
        group: list[MapLead] = []
        for lead in _of_orientation(leads, sign):
            hopeless = len(group) == count or (group and lead.score > group[0].score + worse)
            if not hopeless and all(_move(y, lead, other) > apart for other in group):
                group.append(lead)
        kept += group
    return sorted(kept, key=lambda lead: lead.score)


def _candidates(y: MapDomain, leads: list[MapLead]) -> list[MapLead]:
    """Choose the most credible groups of like maps, and of each the best few that differ a little."""
    chosen: list[MapLead] = []
    for sign, variants in _VARIANTS.items():
        groups: list[list[MapLead]] = []
        for lead in _of_orientation(leads, sign):
            if groups and lead.score > groups[0][0].score + _HOPELESS:
                break
            place = next((i for i, group in enumerate(groups) if _move(y, lead, group[0]) <= _CLUSTER), None)
            if place is None:
                if len(groups) < len(variants):
                    groups.append([lead])
            elif len(groups[place]) < variants[place] and all(_move(y, lead, o) > _VARIANT for o in groups[place]):
                groups[place].append(lead)
        chosen += [lead for group in groups for lead in group]
    return chosen


def _of_orientation(leads: list[MapLead], sign: int) -> list[MapLead]:
    """Sort those of one orientation by their score."""
    return sorted((lead for lead in leads if (lead.orientation > 0) == (sign > 0)), key=lambda lead: lead.score)


def _move(y: MapDomain, first: MapLead, second: MapLead) -> float:
    """Mean distance in space between the images under two maps, in sqrt(area)."""
    return float(np.linalg.norm(y.places[first.points.on_y] - y.places[second.points.on_y], axis=1).mean())


def _refined_steps(x: MapDomain, y: MapDomain, points: PointMaps) -> Steps[MapLead]:
    """Refine a map between the coarse samples, and score it."""
    points = yield from refine_bijective_steps(x.coarse_basis, y.coarse_basis, points, _SIZES)
    maps = fit_functional_maps(
        x.coarse_basis, y.coarse_basis, points, min(_SIZES[-1], x.coarse_basis.size, y.coarse_basis.size)
    )
    terms = spectral_terms(x, y, maps) | curvature_terms(x, y, points)
    terms["rigidity"] = rigidity_term(x, y, points, len(maps.onto_x))
    yield Progress(1.0, "Comparing maps")
    return MapLead(points, score_of(terms), map_orientation(x, y, points, maps)[0], terms, "extremities")


def _dissimilarity(x: MapDomain, y: MapDomain, of_x: NDArray[np.int64], of_y: NDArray[np.int64]) -> NDArray[np.float64]:
    """Compare the descriptors of samples given by number, (m,) and (n,): (m, n), in units of the median."""
    difference = x.extremity_descriptors(of_x)[:, None] - y.extremity_descriptors(of_y)
    root = np.sqrt(np.square(difference).mean(axis=2))
    return root / max(float(np.median(root)), np.finfo(float).tiny)
