# SPDX-License-Identifier: GPL-3.0-or-later
"""The overlap of two surfaces and the maps between its two sides, in full resolution."""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from scipy.sparse import diags_array
from scipy.spatial import cKDTree

from ...geometry.best_distinct import best_distinct
from ...geometry.symmetric_factor import symmetric_factor
from ...mesh.triangle_mesh import TriangleMesh
from ...runtime.arrays import Bools, Floats, Ints
from ...runtime.parallel_map import shared_steps
from ...runtime.progress import Progress, Steps, within
from .oriented_patches import OrientedPatches, oriented_patches
from .overlap_score import shared_area
from .overlap_search import PATCHES, CoarsePair, ScoredFit, overlap_fits_steps, scored_fit
from .part_registration import FINE, REST, TURNED, Fit, Marks, placed, register_parts
from .part_surface import PartSurface

_COARSE = 800
"""Vertices of the coarse surfaces."""

_LEAST_MEMBERS = 8
"""Vertices of a coarse overlap at least."""

_TRIP = 0.1
"""Distance, in units of length, between a point with a partner and where both maps bring it, at most."""

_OUTLINE = 3e-4
"""How long what has a partner by both registrations spreads, in units of area, to have a smooth outline."""

_ROTATION_RADIUS, _TETHER = 0.06, 1e-9
"""Over what distance rotations of the coarse surface are averaged, in units of length; what keeps systems regular."""

_HOLD = 3.0
"""How much the coarse surface counts when the fine one is placed by it: for a surface of a thousand vertices."""

_COMMON, _OTHER = 0.3, 0.06
"""Part of the smaller of two overlaps that both must have, and median distance of the images, in units of length, up to
which they say the same."""

_NO_RIVAL = 20.0
"""Difference of scores that is said where no other way was found."""

_FOLLOWED = 6
"""How many different registrations, of either surface, are followed by one of the other."""

_LABEL = "Fitting what the surfaces share"


@dataclass(frozen=True, eq=False)
class Overlap:
    """What two surfaces share: n and n' vertices.

    Attributes
    ----------
    positions : pair of arrays of float, (n, 3) and (n', 3)
        Where the vertices of each lie on the other, in the coordinates of that one's mesh.
    images : pair of arrays of int, (n,) and (n',)
        The vertex of the other surface that is most like each.
    members : pair of arrays of bool, (n,) and (n',)
        Which vertices have a partner.
    score : float
        How credible the best way is, larger for more, see `overlap_score`.
    margin : float
        By how much the best other way is less credible.
    agreement : float
        Area of what has a partner by both registrations, as a part of that by either.
    area : float
        Area of what is shared, as a part of that of the larger surface.
    search : OverlapSearch
        What it was found on.
    """

    positions: tuple[Floats, Floats]
    images: tuple[Ints, Ints]
    members: tuple[Bools, Bools]
    score: float
    margin: float
    agreement: float
    area: float
    search: OverlapSearch


@dataclass(frozen=True, eq=False)
class OverlapSearch:
    """Two surfaces in one unit of length, around their middles.

    Attributes
    ----------
    pair : CoarsePair
        The surfaces.
    lengths : pair of float
        The unit, in that of either mesh.
    centres : pair of arrays of float, (3,)
        The middles, in the coordinates of either mesh.
    """

    pair: CoarsePair
    lengths: tuple[float, float]
    centres: tuple[Floats, Floats]

    def given(self, positions: Floats, there: int) -> Floats:
        """Return positions (n, 3) on one of the surfaces in the coordinates of its mesh."""
        return positions * self.lengths[there] + self.centres[there]

    def score(self, positions: tuple[Floats, Floats]) -> float:
        """Score maps as overlaps are scored, by registrations from where they lead; see `overlap_score`.

        Parameters
        ----------
        positions : pair of arrays of float, (n, 3) and (n', 3)
            Where the vertices of each surface lie on the other, in the coordinates of that one's mesh.
        """
        scores = []
        for here, pair in enumerate((self.pair, self.pair.turned())):
            coarse, other = pair.coarse
            places = (positions[here][coarse.ids] - self.centres[1 - here]) / self.lengths[1 - here]
            scores.append(scored_fit(coarse, other, register_parts(coarse, other, places, REST)).score)
        return sum(scores) / 2


def overlap_steps(source: TriangleMesh, target: TriangleMesh, scale: float = 1.0) -> Steps[Overlap | None]:
    """Find what two surfaces share, and how that corresponds.

    Parameters
    ----------
    source, target : TriangleMesh
        The surfaces: connected manifolds, of some thousand vertices, each of which may show only a part of a body.
    scale : float
        How many units of length of the source a unit of the target is.

    Returns
    -------
    Overlap or None
        The most credible way; None if nothing is shared by both registrations.

    Notes
    -----
    Surroundings of points are compared where both surfaces show them.  Alike ones that go together, by their distances
    and rotations, say how one surface may be laid onto the other; each such way is followed by a registration of coarse
    surfaces, in which what has no partner does not count; and the most credible is followed in full resolution, both
    ways.  What both registrations give a partner has one.
    """
    unit = float(np.sqrt(max(source.area, target.area * scale**2)))
    lengths = unit, unit / scale
    centres = source.vertices.mean(axis=0), target.vertices.mean(axis=0)
    surfaces = tuple(
        PartSurface(TriangleMesh((mesh.vertices - centre) / length, mesh.triangles))
        for mesh, centre, length in zip((source, target), centres, lengths, strict=True)
    )
    first, second = yield from within(shared_steps(_described_steps, None, surfaces), 0.0, 0.08)
    pair = CoarsePair((surfaces[0], surfaces[1]), (first[0], second[0]), (first[1], second[1]))
    ways = yield from within(shared_steps(_one_way_steps, pair, (False, True)), 0.08, 0.8)
    found = yield from within(_mutual_steps(pair, (ways[0], ways[1])), 0.8, 0.86)
    if not found:
        return None
    best = found[0]
    margin = best.score - found[1].score if len(found) > 1 else _NO_RIVAL
    starts = [(fit.positions, back) for back, fit in enumerate(best.fits)]
    fits = yield from within(shared_steps(_fine_fit_steps, pair, starts), 0.86, 1.0)
    members, agreement = _members_of_both(pair.surfaces, fits)
    if not (members[0].any() and members[1].any()):
        return None
    area = (shared_area(*pair.coarse, best.fits[0]) + shared_area(*pair.turned().coarse, best.fits[1])) / 2
    search = OverlapSearch(pair, lengths, centres)
    images = fits[0].there.images, fits[1].there.images
    return Overlap(
        (search.given(fits[0].positions, 1), search.given(fits[1].positions, 0)),
        images,
        members,
        best.score,
        float(margin),
        agreement,
        area,
        search,
    )


def _described_steps(_: None, surface: PartSurface) -> Steps[tuple[PartSurface, OrientedPatches]]:
    """Make a coarse surface, and describe the surroundings of points."""
    coarse = yield from within(surface.proxy_steps(_COARSE), 0.0, 0.3)
    patches = oriented_patches(surface, PATCHES)
    yield Progress(1.0, _LABEL)
    return coarse, patches


def _one_way_steps(pair: CoarsePair, back: bool) -> Steps[list[ScoredFit]]:  # noqa: FBT001 -- an item of `shared_steps`
    """Lay one surface onto the other, or the other way round."""
    return (yield from overlap_fits_steps(pair.turned() if back else pair))


class _MutualFit(NamedTuple):
    """Registrations of coarse surfaces onto each other that say the same.

    Attributes
    ----------
    fits : pair of Fit
        Of the first surface onto the second, and of the second onto the first.
    score : float
        The mean of their scores, larger for more credible.
    """

    fits: tuple[Fit, Fit]
    score: float


def _mutual_steps(pair: CoarsePair, ways: tuple[list[ScoredFit], list[ScoredFit]]) -> Steps[list[_MutualFit]]:
    """Follow the most credible registrations of either surface by one of the other: right ones look right from both.

    Returns
    -------
    list of _MutualFit
        The most credible first; no two of them say the same.
    """
    alone = sorted(((each, back) for back, way in enumerate(ways) for each in way), key=lambda either: -either[0].score)

    def differ(one: tuple[ScoredFit, int], other: tuple[ScoredFit, int]) -> bool:
        """Say whether two fits lead to different places."""
        return _differ(pair.coarse, _side(*one), _side(*other))

    taken = best_distinct(alone, differ, _FOLLOWED)
    turned = yield from shared_steps(_turned_fit_steps, pair, [(each.fit, back) for each, back in taken])
    found: list[_MutualFit] = []
    for (each, back), followed in zip(taken, turned, strict=True):
        others = [other for other in ways[1 - back] if not differ((each, back), (other, 1 - back))]
        others += [] if followed is None else [followed]
        if others:
            other = max(others, key=lambda scored: scored.score)
            fits = (other.fit, each.fit) if back else (each.fit, other.fit)
            found.append(_MutualFit(fits, (each.score + other.score) / 2))
    shared = [mutual for mutual in found if mutual.score > -np.inf]
    return sorted(shared, key=lambda mutual: -mutual.score)


_Side = tuple[Ints, Bools]


def _side(scored: ScoredFit, back: int) -> _Side:
    """Return what a fit says of the first surface: the image of each vertex, and which have one."""
    fit = scored.fit
    return (fit.back.images, fit.members_back) if back else (fit.there.images, fit.members)


def _differ(coarse: tuple[PartSurface, PartSurface], first: _Side, second: _Side) -> bool:
    """Say whether two maps of the first coarse surface lead to different places."""
    both = first[1] & second[1]
    if both.sum() < _COMMON * min(first[1].sum(), second[1].sum()):
        return True
    places = coarse[1].vertices
    apart = np.linalg.norm(places[first[0][both]] - places[second[0][both]], axis=1)
    return bool(len(apart) and np.median(apart) > _OTHER)


def _turned_fit_steps(pair: CoarsePair, registered: tuple[Fit, int]) -> Steps[ScoredFit | None]:
    """Register the second coarse surface onto the first, by a registration of the first onto the second.

    If the number with that is 1, it was the second that was registered.
    """
    yield Progress(0.0, _LABEL)
    fit, back = registered
    coarse, other = pair.coarse[::-1] if back else pair.coarse
    known = np.flatnonzero(fit.members_back)
    if len(known) < _LEAST_MEMBERS:
        return None
    images = fit.back.images[known]
    marks = Marks(known, coarse.vertices[images], other.mass[known])
    positions, marks = placed(other, marks, fit.rotations[images].transpose(0, 2, 1), other.paths(known))
    return scored_fit(other, coarse, register_parts(other, coarse, positions, TURNED, marks=marks))


def _fine_fit_steps(pair: CoarsePair, start: tuple[Floats, int]) -> Steps[Fit]:
    """Register the first surface (0) or the second (1) from where the coarse one that stands for it is."""
    yield Progress(0.0, _LABEL)
    positions, back = start
    source, target = pair.surfaces[::-1] if back else pair.surfaces
    coarse = pair.coarse[back]
    weights = np.zeros(source.count)
    weights[coarse.ids] = _HOLD * np.sqrt(1000 * source.area / source.count)
    right = np.zeros((source.count, 3))
    right[coarse.ids] = weights[coarse.ids, None] * positions
    elastic = source.elastic
    rotations = coarse.elastic.rotations(positions, _ROTATION_RADIUS)[
        cKDTree(coarse.vertices).query(source.vertices)[1]
    ]
    factor = symmetric_factor(elastic.stiffness + diags_array(weights + _TETHER))
    return register_parts(source, target, factor.solve(elastic.pull(rotations) + right), FINE)


def _members_of_both(surfaces: tuple[PartSurface, PartSurface], fits: list[Fit]) -> tuple[tuple[Bools, Bools], float]:
    """Say which vertices of either surface have a partner by both registrations, and how far these agree."""
    said = (fits[0].members, fits[1].members_back), (fits[1].members, fits[0].members_back)
    images = fits[0].there.images, fits[1].there.images
    members = []
    for number, (surface, (own, others)) in enumerate(zip(surfaces, said, strict=True)):
        there, back = images[number], images[1 - number]
        home = np.linalg.norm(surface.vertices[back[there]] - surface.vertices, axis=1) < _TRIP
        mean = (own.astype(np.float64) + others) / 2
        members.append(surface.smoothed(mean * home, _OUTLINE) > 1 / 2)
    own, others = said[0]
    either = float(surfaces[0].mass @ (own | others))
    agreement = float(surfaces[0].mass @ members[0]) / either if either else 0.0
    return (members[0], members[1]), agreement
