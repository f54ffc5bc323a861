# SPDX-License-Identifier: GPL-3.0-or-later
"""Covered parts: what of a whole surface is covered by a surface that shows only a part of it."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import chain
from typing import NamedTuple

import numpy as np
from scipy.sparse.csgraph import dijkstra
from scipy.spatial import cKDTree

from ..dense.credibility import may_reach
from ..dense.dense_hypotheses import (
    MapHypothesis,
    SparseStart,
    map_domains,
    map_hypotheses_steps,
    unrefined_hypothesis,
)
from ..dense.dense_registration import EIGENPAIRS
from ..dense.missing_parts import with_partner
from ..dense.proposers import are_distinct
from ..dense.registered_hypotheses import Follower
from ..geometry.best_distinct import best_distinct
from ..mesh.surface_map import SurfaceMap
from ..mesh.triangle_mesh import TriangleMesh
from ..registration.deformable import DeformableSurface
from ..runtime.arrays import TINY, Bools, Floats, Ints, group_largest
from ..runtime.parallel_map import shared_steps
from ..runtime.progress import Steps, part_of, within
from ..shapes.shape import Shape
from .partial_placement import part_placements_steps

_VERTICES = 1300
"""Vertices of the coarse surfaces on which parts are looked for: with 2000 the errors of ``partial_pairs --pairs 12
--kept 0.75`` were no smaller, in a fifth more time."""

_SAMPLES, _MEASURED = 256, 64
"""Samples of either, and of how many the distances are measured, not estimated."""

_PLACEMENTS, _REGISTERED = 12, 6
"""Ways to lay the part onto the whole that are compared, and how many of them are registered, without rivals."""

_REFINED, _ROUNDS = 3, 2
"""How many of these are followed up with what they cover by the registration, without rivals, and how often: the nearer
the piece that is cut out is to the true one, the better fits the size that it is compared in."""

_RIVALS = 2
"""Other ways than these that are registered, or followed up, as well, if their scores are not much worse than the best:
turned by a half, a body is nearly the same, and may take all places before the true one."""

_OTHER = 0.12
"""Mean distance, in sqrt(area) of the whole, between where two ways take the part, from which on they are different."""

_HOPEFUL = 2.5, 5.0
"""Difference of scores to the best way up to which another one is a rival: before they are registered, and after."""

_ROUGHLY = 0.06
"""Distance, in sqrt(area) of the whole, from samples that something goes to in which a rough placement covers it."""

_SPACINGS = 1.25
"""The same of a registration: in spacings of the vertices of the whole."""

_STARTS = 64
"""Samples of the part whose images a registration starts from."""

_LEAST = 200
"""Vertices of the coarse surface that must be covered for it to be more than a guess."""

_SAME = 0.7
"""What two pieces of the whole have in common, as a part of both together, from which on they are one."""

_OVERHANGING = 20.0
"""How much the part of the part that overhangs counts against a piece: nothing of it should."""

_CONTESTED = 3.0
"""Difference of scores up to which another piece may be the true one."""

_BETTER = 0.7
"""By how much the score of a piece must be better than that of all of the whole: of true parts it is by more than one,
where nothing is missing by nothing."""


@dataclass(frozen=True, eq=False)
class CoveredPart:
    """What of one surface may correspond to all of the other.

    Attributes
    ----------
    covered : (n,) array of bool
        Which vertices of the whole's mesh do.
    score : float
        Smaller is more credible; comparable between pieces, and between the two ways round.
    is_new : bool
        Whether this takes the part elsewhere than the map that was known.
    """

    covered: Bools
    score: float
    is_new: bool


class _Proposal(NamedTuple):
    """A piece of the whole, how it may lie on the part, and where some samples of the part would be on it, (s, 3)."""

    piece: Shape
    hypothesis: MapHypothesis
    places: Floats


class _Fit(NamedTuple):
    """What a registration says.

    Attributes
    ----------
    score, likeness : float
        How credible it is, smaller is more, and how much alike the piece and the part are.
    places : (m, 3) array of float
        Where the vertices of the part lie on the whole.
    overhanging : (m,) array of bool
        Which of them have no partner on the piece of the whole, see `with_partner`.
    unit : float
        Length on the whole of a unit of length on the part.
    """

    score: float
    likeness: float
    places: Floats
    overhanging: Bools
    unit: float


def covered_parts_steps(
    whole: Shape, part: Shape, first: tuple[SurfaceMap, SurfaceMap], least: float = -np.inf
) -> Steps[list[CoveredPart]]:
    """Find what of a surface another one shows.

    Surfaces are compared in units of their area, so a part is seen too large beside the whole, and what it lacks has to
    go somewhere: the larger the missing part, the less is right.  With the whole cut down to what the part shows, both
    are like any two surfaces.  So some ways to lay the part onto the whole are found by distances; of each what it
    covers is cut out, and compared with the part; the most credible are registered to it; and the best are cut out
    again, by what the registration covers.

    Parameters
    ----------
    whole, part : Shape
        The surfaces.
    first : pair of SurfaceMap
        What is known, of them as they are or of a piece: a map of the whole to the part, and the other way round.
    least : float
        Likeness of the part and a piece below which that is of no use.

    Returns
    -------
    list of CoveredPart
        The most credible piece, and others that are nearly as credible; empty if there is none that fits better than
        all of the whole, or that may be of use.
    """
    coarse = yield from within(Shape.steps(whole.mesh, proxy_vertices=_VERTICES), 0.0, 0.05)
    other = yield from within(Shape.steps(part.mesh, proxy_vertices=_VERTICES), 0.05, 0.1)
    yield from within(coarse.sample_steps(_SAMPLES, _MEASURED), 0.1, 0.13)
    yield from within(other.sample_steps(_SAMPLES, _MEASURED), 0.13, 0.16)
    yield from within(other.spectrum_steps(EIGENPAIRS), 0.16, 0.2)
    there, back = first
    places = back.positions[part.vertices[other.vertices[other.samples.vertices]]]
    fitter = _Fitter(coarse.limited(_SAMPLES, _MEASURED), other.limited(_SAMPLES, _MEASURED))
    first_images = fitter.nearest_samples(places)
    kept = there.confidence[whole.vertices[coarse.vertices]] > 0
    starts = [(kept, first_images)]
    placements = yield from within(part_placements_steps(fitter.whole, fitter.part, _PLACEMENTS), 0.2, 0.25)
    starts += [(fitter.roughly_covered(images), images) for images in placements]
    fits = yield from within(_registered_steps(fitter, starts), 0.25, 0.75)
    if not any(may_reach(least, fit.likeness, 0.0) for fit in fits):
        return []
    scores, taken = np.array([fit.score for fit in fits]), np.array([fit.places for fit in fits]) / whole.scale
    best = best_and_rivals(scores, taken, _REFINED, _HOPEFUL[1])
    starting = [(*fitter.start(fits[way]), _ROUNDS) for way in best]
    everything = np.ones(coarse.mesh.vertex_count, bool), first_images, 1
    followed = shared_steps(_refined_steps, fitter, [*starting, everything])
    *refined, unchanged = yield from within(followed, 0.75, 1.0)
    bound = min((fit.score for fit in unchanged), default=np.inf) - _BETTER
    ranked = sorted([*fits, *chain.from_iterable(refined)], key=lambda fit: fit.score)
    credible = [fit for fit in ranked if fit.score <= bound and fit.score < ranked[0].score + _CONTESTED]
    pieces = [(fitter.covered(fit), fit) for fit in credible]
    found = best_distinct(pieces, lambda piece, other: fitter.common_part(piece[0], other[0]) < _SAME)
    return [
        CoveredPart(
            coarse.surface.spread(covered.astype(np.float64), 0.0) > 1 / 2, fit.score, fitter.is_new(fit, places)
        )
        for covered, fit in found
    ]


def best_and_rivals(scores: Floats, places: Floats, count: int, worse: float) -> list[int]:
    """Choose the best ways to lay a part onto a whole, and some more that differ from all of these.

    Parameters
    ----------
    scores : (n,) array of float
        Of the ways; smaller is better.
    places : (n, s, 3) array of float
        Where they take s places of the part, in sqrt(area) of the whole.
    count : int
        How many are chosen by score alone.
    worse : float
        Difference of scores to the best up to which a way that differs from all chosen ones is chosen, too.

    Returns
    -------
    list of int
        Indices into the ways, first the best, by growing score, then up to `_RIVALS` others.
    """
    order = np.argsort(scores, kind="stable").tolist()
    chosen: list[int] = order[:count]
    hopeful = [way for way in order[count:] if scores[way] < scores[order[0]] + worse]
    return chosen + best_distinct(
        hopeful,
        lambda way, other: bool(np.linalg.norm(places[way] - places[other], axis=1).mean() > _OTHER),
        _RIVALS,
        beside=chosen,
    )


def continued(whole: Shape, part: Shape, places: Floats, overhanging: Bools, unit: float) -> Bools:
    """Tell where the whole goes on beyond a piece of it that was cut out too small, without a leg of the part.

    Parameters
    ----------
    whole, part : Shape
        The surfaces, n and m vertices.
    places : (m, 3) array of float
        Where the vertices of the part lie on the piece.
    overhanging : (m,) array of bool
        Which of them belong to nothing of it.
    unit : float
        Length on the whole of a unit of length on the part.

    Returns
    -------
    (n,) array of bool
        The vertices of the whole that are as near to where something hangs on what lies well as it reaches from there.
    """
    if not overhanging.any() or overhanging.all():
        return np.zeros(whole.mesh.vertex_count, bool)
    # Where the patches hang on what lies well: what belongs to nothing of the piece lies anywhere on it.
    lying = np.flatnonzero(~overhanging)
    lengths, _, roots = dijkstra(
        part.solver.graph, directed=False, indices=lying, min_only=True, return_predecessors=True
    )
    hanging = np.flatnonzero(overhanging & (roots >= 0))
    lengths, roots = lengths[hanging], roots[hanging]
    ends, numbers = np.unique(cKDTree(whole.mesh.vertices).query(places[roots])[1], return_inverse=True)
    longest = group_largest(numbers, unit * lengths, len(ends))
    distances = dijkstra(whole.solver.graph, directed=False, indices=ends, limit=float(longest.max()))
    return (distances <= longest[:, None]).any(axis=0)


def _registered_steps(fitter: _Fitter, starts: list[tuple[Bools, Ints]]) -> Steps[list[_Fit]]:
    """Compare pieces with the part, and register the most credible ones and their rivals."""
    proposed = yield from within(shared_steps(_Fitter.proposal_steps, fitter, starts), 0.0, 0.6)
    proposals = [proposal for proposal in proposed if proposal is not None]
    scores = np.array([proposal.hypothesis.score for proposal in proposals])
    places = np.array([proposal.places for proposal in proposals]) / fitter.whole.scale
    best = best_and_rivals(scores, places, _REGISTERED, _HOPEFUL[0])
    steps = shared_steps(_Fitter.fit_steps, fitter, [proposals[way] for way in best])
    return (yield from within(steps, 0.6, 1.0))


def _refined_steps(fitter: _Fitter, start: tuple[Bools, Ints, int]) -> Steps[list[_Fit]]:
    """Register a piece where it is known to lie, then again, so many times, what that covers."""
    refined: list[_Fit] = []
    covered, images, rounds = start
    for again in range(rounds):
        begin, end = part_of(again, rounds)
        proposal = yield from within(fitter.proposal_steps((covered, images), known=True), begin, (begin + end) / 2)
        if proposal is None:
            break
        refined.append((yield from within(fitter.fit_steps(proposal), (begin + end) / 2, end)))
        covered, images = fitter.start(refined[-1])
    return refined


class _Fitter:
    """Registers pieces of the whole to the part."""

    is_sent_once = True
    """See `parallel_map.shared_steps`."""

    def __init__(self, whole: Shape, part: Shape) -> None:
        self.whole, self.part = whole, part
        self._surface = DeformableSurface(part.mesh, part.laplace)

    def roughly_covered(self, images: Ints) -> Bools:
        """Tell which vertices of the whole (n,) are near to samples that something goes to."""
        return self.whole.samples.rows[np.unique(images)].min(axis=0) < _ROUGHLY

    def covered(self, fit: _Fit) -> Bools:
        """Tell which vertices of the whole (n,) are near to the part's vertices or the middles of its triangles.

        And where the whole goes on beyond a piece that was cut out too small, see `continued`.
        """
        mesh = self.whole.mesh
        places = np.concatenate([fit.places, fit.places[self.part.mesh.triangles].mean(axis=1)])
        near = cKDTree(places).query(mesh.vertices)[0] < _SPACINGS * np.sqrt(mesh.area / mesh.vertex_count)
        return near | continued(self.whole, self.part, fit.places, fit.overhanging, fit.unit)

    def start(self, fit: _Fit) -> tuple[Bools, Ints]:
        """Tell what of the whole a registration covers, (n,), and its samples that those of the part go to."""
        return self.covered(fit), self.nearest_samples(fit.places[self.part.samples.vertices])

    def nearest_samples(self, places: Floats) -> Ints:
        """Find the samples of the whole that are nearest to places (k, 3)."""
        return cKDTree(self.whole.mesh.vertices[self.whole.samples.vertices]).query(places)[1]

    def is_new(self, fit: _Fit, places: Floats) -> bool:
        """Say whether a registration takes the part's first samples (s,) elsewhere than to these places (s, 3)."""
        samples, scale = self.part.samples.vertices[: len(places)], self.whole.scale
        return are_distinct(fit.places[samples] / scale, places / scale, self.part.mesh.vertex_areas[samples])

    def common_part(self, first: Bools, second: Bools) -> float:
        """Area that two pieces of the whole, (n,) each, have in common, as a part of that of both together."""
        areas = self.whole.mesh.vertex_areas
        return float(areas @ (first & second)) / max(float(areas @ (first | second)), TINY)

    def proposal_steps(self, start: tuple[Bools, Ints], *, known: bool = False) -> Steps[_Proposal | None]:
        """Cut a piece out of the whole and compare it with the part; None if it is too small for that.

        A start is which vertices of the whole, (n,), are the piece, and the images of the part's samples on the whole.
        If these are known well, functional maps would only make them worse.
        """
        covered, images = start
        whole = self.whole.mesh
        kept = whole.triangles[covered[whole.triangles].all(axis=1)]
        vertices, triangles = np.unique(kept, return_inverse=True)
        if len(vertices) < _LEAST:
            return None
        piece = Shape(TriangleMesh(whole.vertices[vertices], triangles.reshape(-1, 3)))
        vertices = vertices[piece.vertices]
        yield from within(piece.sample_steps(_SAMPLES, _MEASURED), 0.0, 0.2)
        yield from within(piece.spectrum_steps(EIGENPAIRS), 0.2, 0.5)
        piece = piece.limited(_SAMPLES, _MEASURED)
        places = whole.vertices[self.whole.samples.vertices[images[:_STARTS]]]
        rows = self.whole.samples.rows[images[:_STARTS]][:, vertices] * (self.whole.scale / piece.scale)
        begin = SparseStart(rows, self.part.samples.rows[:_STARTS], "placement")
        if known:
            return _Proposal(piece, unrefined_hypothesis(map_domains(piece, self.part), begin), places)
        hypotheses = yield from within(map_hypotheses_steps(piece, self.part, [begin], search=False), 0.5, 1.0)
        return _Proposal(piece, hypotheses[0], places)

    def fit_steps(self, proposal: _Proposal) -> Steps[_Fit]:
        """Register a piece of the whole to the part."""
        piece = proposal.piece
        source = DeformableSurface(piece.mesh, piece.laplace)
        candidate = yield from Follower(piece, self.part, source, self._surface).steps(proposal.hypothesis)
        there = candidate.registration.on_source.on(piece.mesh)
        back = candidate.registration.on_target.on(self.part.mesh)
        overhanging = ~with_partner(self.part.mesh, piece.mesh, there, back)
        score = candidate.score + _OVERHANGING * float(self._surface.mass @ overhanging)
        return _Fit(score, candidate.likeness, there.positions, overhanging, piece.scale / self.part.scale)
