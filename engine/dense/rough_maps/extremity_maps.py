# SPDX-License-Identifier: GPL-3.0-or-later
"""Rough maps between two surfaces: many matchings of extremities, carried over the surface and refined a little."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from typing import NamedTuple, TypeVar

import numpy as np

from ...geometry.best_distinct import best_distinct
from ...runtime.arrays import TINY, Floats, Ints
from ...runtime.parallel_map import beside_steps, shared_steps
from ...runtime.progress import Progress, Steps, in_turn, within
from ...shapes.extremities import spread_extremities
from ..functional_maps import PointMaps, fit_functional_maps, refine_bijective_steps, spectral_sizes
from ..map_energies import map_orientation, spectral_terms
from ..spectral_domain import MapDomain
from .extremity_search import beam_matchings
from .lifted_matchings import LiftedMatchings

Own = TypeVar("Own")

# How many matchings are offered, by the distances between what is matched.
_OFFERED = 400
# How many farthest points of X and of Y are matched, and how many matchings are followed up with the orientation kept
# (1) and with it mirrored (-1): of these the best only, as mirror images are matched as well as what they mirror.
# The largest first: then what is shared with helpers ends at about the same time.
_FARTHEST = ((6, 10, {1: 40, -1: 12}), (5, 9, {1: 20, -1: 8}))
# The same for tips of limbs: which points are the farthest depends on proportions, which limbs there are does not.
_TIPS = (6, 9, {1: 20, -1: 8})
_TIPS_APART = (0.4, 0.25)  # least distance of those of X, each of another limb, and of those offered of Y
# How many of all that each of these searches offers are followed up besides, for carrying over to the whole surfaces
# best.
_FITTING = {1: 14, -1: 6}
# How many matchings of each search are proposed as they are, for carrying over best, and improved.
_UNREFINED = 3
# Of bodies with at least so many limbs all are matched: how many of the matchings that fit best are improved, and how
# many different ones are followed up at most.
_MANY_LIMBS, _STARTS, _ENDS = 8, 16, 8
_SIZES = spectral_sizes(15, 30, 5)  # not from fewer: those would turn even true matchings front to back
_ORIENTED = 0.3  # how much more credible a map of one orientation throughout is
_VARIANTS = {1: (3, 2, 1, 1), -1: (2, 1)}  # how many of each group of like maps are followed up, by orientation
_FITTING_VARIANTS = {1: (2, 1, 1), -1: (1,)}  # and of those that carry over best, where they are others
_CLUSTER = 0.15  # mean distance between the images of maps of different groups, in sqrt(area)
_VARIANT = 0.04  # the same for those of one group: a limb may be crossed in the best of them
_OTHER = 0.06  # the same from which on one that carries over best is followed up beside the others


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

    of_x: Ints
    of_y: Ints
    kept: Mapping[int, int]

    def possible(self, count_x: int, count_y: int) -> _Search:
        """Leave out samples beyond those that there are, and points of X that are too many for those of Y."""
        of_y = self.of_y[self.of_y < count_y]
        return self._replace(of_x=self.of_x[self.of_x < count_x][: len(of_y)], of_y=of_y)


@dataclass(frozen=True, eq=False)
class RoughSearch:
    """What `rough_maps_steps` begins with: several searches for matchings, which can be done earlier.

    Attributes
    ----------
    domains : pair of MapDomain
        The surfaces.
    signs : tuple of int
        Whether the orientation is kept (1), mirrored (-1), or each.
    found : list or None
        What the searches have found, once they are done.
    """

    domains: tuple[MapDomain, MapDomain]
    signs: tuple[int, ...]
    found: list[tuple[list[MapLead], list[MapLead]]] | None = None

    def steps(self) -> Steps[RoughSearch]:
        """Do the searches, unless they are done."""
        if self.found is not None:
            return self
        return replace(self, found=(yield from shared_steps(_searched_steps, self.domains, self._searches())))

    def beside_steps(self, own: Steps[Own]) -> Steps[tuple[Own, RoughSearch]]:
        """Do them after something else, or beside it."""
        result, found = yield from beside_steps(own, _searched_steps, self.domains, self._searches())
        return result, replace(self, found=found)

    def _searches(self) -> list[tuple[_Search, int]]:
        return [(search, sign) for search in _searches(*self.domains) for sign in self.signs]


def rough_maps_steps(
    x: MapDomain, y: MapDomain, signs: tuple[int, ...] = (1, -1), search: RoughSearch | None = None
) -> Steps[list[MapLead]]:
    """Propose maps between the coarse samples of two surfaces.

    Parameters
    ----------
    x, y : MapDomain
        The surfaces.
    signs : tuple of int
        Whether matchings are carried over with the orientation kept (1), with it mirrored (-1), or each both ways.
    search : RoughSearch, optional
        The searches for matchings of the same kind, if they have been done.

    Yields
    ------
    Progress
        After each matching of extremities that was followed up.

    Returns
    -------
    list of MapLead
        A few of each of the most credible groups of like maps, of either orientation.
    """
    done = yield from (search or RoughSearch((x, y), signs)).steps()
    usual = [lead for found in done.found or () for lead in found[0]]
    fitting = [lead for found in done.found or () for lead in found[1]]
    chosen = _candidates(y, usual, _VARIANTS)
    more = _candidates(y, fitting, _FITTING_VARIANTS)
    chosen += [lead for lead in more if all(y.apart(lead.points, other.points) > _OTHER for other in chosen)]
    for sign in signs:
        # Bodies with many limbs are rare: the bar has come to its end before.
        chosen += yield from within(_many_limbs_steps(x, y, sign), 1.0, 1.0)
    return chosen


def fitting_maps_steps(x: MapDomain, y: MapDomain) -> Steps[list[PointMaps]]:
    """Propose maps between the coarse samples that matchings of extremities of X give as they are.

    Between unlike bodies eigenfunctions differ, so that refined by them even the true map may be turned into a wrong
    one.  Matchings that carry over to the whole surfaces best need none.

    Parameters
    ----------
    x, y : MapDomain
        The surfaces.

    Yields
    ------
    Progress
        After each search for matchings.

    Returns
    -------
    list of PointMaps
        Of each search the best few, and what they become if one image after the other is changed for a better one.
    """
    found = []
    searches = _searches(x, y)
    for number, search in enumerate(searches):
        lifted = LiftedMatchings(x, y, search.of_x, search.of_y, relative=True)
        best = lifted.best(_matchings(x, y, search.of_x, search.of_y), 1, _UNREFINED)
        improved = [lifted.improved(images, 1) for images in best]
        found += [lifted.maps(images, 1) for images in np.unique([*best, *improved], axis=0)]
        yield Progress((number + 1) / len(searches), "Comparing maps")
    return found


def _searched_steps(
    surfaces: tuple[MapDomain, MapDomain], wanted: tuple[_Search, int]
) -> Steps[tuple[list[MapLead], list[MapLead]]]:
    """Match some samples, and follow up the best matchings, and others that carry over to the whole surfaces best.

    Between bodies of other proportions the distances between ends of limbs agree in many wrong matchings as well as in
    the true one, which may be the hundredth of them; that it fits everywhere else tells it from most.
    """
    (x, y), (search, sign) = surfaces, wanted
    relative, absolute = (LiftedMatchings(x, y, search.of_x, search.of_y, relative=r) for r in (True, False))
    offered = _matchings(x, y, search.of_x, search.of_y)
    yield Progress(0.0, "Comparing maps")
    best = offered[: search.kept[sign]]
    fitting = relative.best(offered[len(best) :], sign, _FITTING[sign])
    maps = [absolute.maps(images, sign) for images in best] + [relative.maps(images, sign) for images in fitting]
    leads = yield from in_turn(_refined_steps(x, y, points) for points in maps)
    return leads[: len(best)], leads[len(best) :]


def _many_limbs_steps(x: MapDomain, y: MapDomain, sign: int) -> Steps[list[MapLead]]:
    """Match all limbs of bodies that have many of them, such as the arms of an octopus or the legs of an ant.

    Distances between tips hardly tell which of eight arms is which, and a body that is turned by one arm is nearly the
    same.  So matchings are chosen by how well they carry over to the whole surfaces, and improved step by step.
    """
    apart = _TIPS_APART[0]
    of_x, of_y = (spread_extremities(d.shape, d.coarse_count, apart, filled=False) for d in (x, y))
    if min(len(of_x), len(of_y)) < _MANY_LIMBS:
        return []
    of_x = of_x[: len(of_y)]
    lifted = LiftedMatchings(x, y, of_x, of_y)
    starts = lifted.best(_matchings(x, y, of_x, of_y), sign, _STARTS)
    better, leads = [], []
    for images in starts:
        better.append(lifted.improved(images, sign))
        yield Progress(len(better) / len(starts), "Comparing maps")
    for images in lifted.best(np.array(better), sign, _ENDS):
        lead = yield from _refined_steps(x, y, lifted.maps(images, sign))
        leads.append(lead)
    return leads


def _matchings(x: MapDomain, y: MapDomain, of_x: Ints, of_y: Ints) -> Ints:
    """Match coarse samples (m,) to coarse samples (n,) in the best ways: positions of images (r, m)."""
    distances_x, distances_y = (d.shape.samples.distances[np.ix_(n, n)] for d, n in ((x, of_x), (y, of_y)))
    return beam_matchings(distances_x, distances_y, _dissimilarity(x, y, of_x, of_y), _OFFERED)


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
        ranked = _of_orientation(leads, sign)
        hopeful = [lead for lead in ranked if lead.score <= ranked[0].score + worse]
        kept += best_distinct(hopeful, _differing(y, apart), count)
    return sorted(kept, key=lambda lead: lead.score)


def _candidates(y: MapDomain, leads: list[MapLead], most: Mapping[int, tuple[int, ...]]) -> list[MapLead]:
    """Choose the most credible groups of like maps, and of each the best few that differ a little."""
    chosen: list[MapLead] = []
    for sign, variants in most.items():
        left = _of_orientation(leads, sign)
        unlike = _differing(y, _CLUSTER)
        for best, count in zip(best_distinct(left, unlike, len(variants)), variants, strict=False):
            group = [lead for lead in left if not unlike(lead, best)]
            left = [lead for lead in left if unlike(lead, best)]
            chosen += best_distinct(group, _differing(y, _VARIANT), count)
    return chosen


def _of_orientation(leads: list[MapLead], sign: int) -> list[MapLead]:
    """Sort those of one orientation by their score."""
    return sorted((lead for lead in leads if (lead.orientation > 0) == (sign > 0)), key=lambda lead: lead.score)


def _differing(y: MapDomain, apart: float) -> Callable[[MapLead, MapLead], bool]:
    """Make what tells maps apart that take places of X, in the mean, farther than that from each other."""
    return lambda lead, other: y.apart(lead.points, other.points) > apart


def _refined_steps(x: MapDomain, y: MapDomain, points: PointMaps) -> Steps[MapLead]:
    """Refine a map between the coarse samples, and score it."""
    points = yield from refine_bijective_steps(x.coarse_basis, y.coarse_basis, points, _SIZES)
    maps = fit_functional_maps(x.coarse_basis, y.coarse_basis, points, _SIZES[-1])
    terms = spectral_terms(x, y, maps)
    orientation = map_orientation(x, y, points, maps)
    score = terms["bijectivity"] - _ORIENTED * abs(orientation)
    yield Progress(1.0, "Comparing maps")
    return MapLead(points, score, orientation, terms, "extremities")


def _dissimilarity(x: MapDomain, y: MapDomain, of_x: Ints, of_y: Ints) -> Floats:
    """Compare the descriptors of samples given by number, (m,) and (n,): (m, n), in units of the median."""
    difference = x.extremity_descriptors(of_x)[:, None] - y.extremity_descriptors(of_y)
    root = np.sqrt(np.square(difference).mean(axis=2))
    return root / max(float(np.median(root)), TINY)
