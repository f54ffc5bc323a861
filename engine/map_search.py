# SPDX-License-Identifier: GPL-3.0-or-later
"""Rough maps between two surfaces: many matchings of extremities, carried over the surface and refined a little."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from .extremity_search import beam_matchings
from .functional_maps import PointMaps, fit_functional_maps, nearest_both_ways, refine_bijective_steps, spectral_sizes
from .map_scores import map_orientation, spectral_terms
from .orientation import signed_areas
from .progress import Progress, Steps, within

if TYPE_CHECKING:
    from collections.abc import Mapping

    from numpy.typing import NDArray

    from .map_domain import MapDomain

__all__ = ["MapLead", "distinct_leads", "rough_maps_steps"]

# Extremities of X and of Y that are matched, and how many matchings are carried over with the orientation kept, and
# how many with it mirrored: the best ones only, as mirror images are matched as well as what they mirror.
_SEARCHES = ((5, 9, 20, 8), (6, 10, 40, 12))
_SIGNED_WEIGHT = 1.0  # of signed areas beside distances, when matchings of extremities are carried over the surface
_SIZES = spectral_sizes(15, 30, 5)  # not from fewer: those would turn even true matchings front to back
_ORIENTED = 0.3  # how much more credible a map of one orientation throughout is
_VARIANTS = {1: (3, 2, 1, 1), -1: (2, 1)}  # how many of each group of like maps are followed up, by orientation
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
    counts = {1: sum(keeping for *_, keeping, _ in _SEARCHES), -1: sum(mirroring for *_, mirroring in _SEARCHES)}
    most = max(max(search[:2]) for search in _SEARCHES)
    directions_x, directions_y = x.directions(min(most, x.coarse_count)), y.directions(min(most, y.coarse_count))
    total, done = sum(counts[sign] for sign in signs), 0
    for few, offered, keeping, mirroring in _SEARCHES:
        n = min(offered, y.coarse_count)
        m = min(few, x.coarse_count, n)
        matchings = beam_matchings(
            x.shape.sample_distances[:m, :m], y.shape.sample_distances[:n, :n], _dissimilarity(x, y, m, n), kept=keeping
        )
        rows_x = _lifting_rows(x, np.arange(m), directions_x, 1)
        for sign in signs:
            for images in matchings.images[: keeping if sign > 0 else mirroring]:
                points = nearest_both_ways(rows_x, _lifting_rows(y, images, directions_y, sign))
                leads.append((yield from within(_refined_steps(x, y, points), done / total, (done + 1) / total)))
                done += 1
    return _candidates(y, leads)


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
    terms = spectral_terms(x, y, maps)
    orientation = map_orientation(x, y, points, maps)[0]
    score = terms["bijectivity"] - _ORIENTED * abs(orientation)
    yield Progress(1.0, "Comparing maps")
    return MapLead(points, score, orientation, terms, "extremities")


def _dissimilarity(x: MapDomain, y: MapDomain, m: int, n: int) -> NDArray[np.float64]:
    """Compare the descriptors of the first m and n samples, (m, n), in units of the median."""
    difference = x.extremity_descriptors(m)[:, None] - y.extremity_descriptors(n)
    root = np.sqrt(np.square(difference).mean(axis=2))
    return root / max(float(np.median(root)), np.finfo(float).tiny)


def _lifting_rows(
    domain: MapDomain, extremities: NDArray[np.int64], directions: NDArray[np.float64], sign: int
) -> NDArray[np.float64]:
    """Describe the coarse samples by their distances to some extremities, and on which side of each pair they are."""
    distances = domain.shape.sample_distances[:, extremities]
    sides = signed_areas(directions[:, extremities])
    columns = [distances / np.sqrt(distances.shape[1])]
    if sides.shape[1]:
        columns.append(sign * _SIGNED_WEIGHT * sides / np.sqrt(sides.shape[1]))
    return np.column_stack(columns)
