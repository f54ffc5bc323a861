# SPDX-License-Identifier: GPL-3.0-or-later
"""Candidates for the map between two surfaces: hypotheses that are followed up by registrations, soft and close."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, fields, replace
from functools import cached_property, partial
from typing import Any, ClassVar

import numpy as np

from ..geometry.procrustes import agreement_in_place
from ..mesh.closest_points import FoundPoints
from ..mesh.surface_points import SurfacePoints
from ..registration.axial_twists import rolled_back, untwisted
from ..registration.axial_windings import wound_steps
from ..registration.deformable import DeformableSurface
from ..registration.half_turns import half_turned
from ..registration.positional_constraints import Ties
from ..registration.registration import (
    AGAIN,
    CLOSE,
    FINE,
    GUIDED,
    LAST,
    SOFT,
    Registration,
    Stage,
    register_steps,
    restarted_steps,
    smooth_start,
)
from ..runtime.arrays import Bools, Floats, Ints
from ..runtime.parallel_map import shared_steps
from ..runtime.progress import Steps, part_of, within
from ..shapes.borders import has_border
from ..shapes.shape import Shape
from .credibility import (
    is_placed,
    likeness,
    place_credit,
    probability_in_place,
    probability_turned,
    registered_score,
)
from .dense_hypotheses import MapHypothesis, assessed_everywhere, refined_hypothesis_steps
from .functional_maps import PointMaps
from .missing_parts import with_partner

Trips = tuple[Floats, Floats]

_SMOOTH = 40
"""Eigenfunctions that the source is placed by before it is registered."""

_GUIDES = 10
"""Eigenfunctions of the target that guide the soft registration."""

_DETAILED = 100
"""Eigenfunctions that either surface is placed by before it is registered again."""

_ROLLS = 3
"""How often a long body is turned back at most: the better it lies, the better is seen how it is turned."""

_TRIFLE = 0.006
"""Mean distance, in sqrt(area), up to which a body lies as before: but a tip is turned, or it is wound about itself."""

_MOST_LYING = 3
"""In how many other ways all of a body is laid down at most: as many as are registered of anything."""

_WORTHWHILE = 3.0
"""Difference of scores up to which a body that was laid down otherwise is turned back as well."""

_POSED, _BUILT = 0.38, 0.48
"""Mean difference of wave kernel signatures up to which only poses differ, and from which on bodies are unlike."""

_STAGES = AGAIN, CLOSE, LAST
"""How a surface is registered from where the other lies: each corrects what the other strains."""

_NEARER = 0.95
"""Part of its length before from which on the way there and back has not become shorter."""


@dataclass(frozen=True, eq=False)
class Candidate:
    """A hypothesis, softly registered.

    Attributes
    ----------
    hypothesis : MapHypothesis
        The map it started from; of the best, if that was rough, what functional maps make of where it led.
    registration : Registration
        The source on the target.
    score : float
        Smaller is more credible: the score of the registered map and the logarithms of the gaps that are left.
    likeness : float
        How much alike the surfaces are, if this is the map, larger for more: by the score of the hypothesis and the
        logarithm of what the deformation costs.
    isometry : float
        From 0, bodies of unlike build, to 1, one body in two poses, by wave kernel signatures where it was registered.
    in_place : float
        How probably the map is right because it leaves everything where it stands, see `Follower.in_place`.
    credit : float
        By how much its score is smaller because of what it leaves in place, see `Follower.credit`.
    """

    hypothesis: MapHypothesis
    registration: Registration
    score: float
    likeness: float
    isometry: float
    in_place: float = 0.0
    credit: float = 0.0


_Judged = tuple[Registration, float, float, float, float, float]
"""All of a candidate but its hypothesis."""


@dataclass(frozen=True, eq=False)
class CloseFit:
    """A candidate, registered closely from either side.

    Attributes
    ----------
    candidate : Candidate
        What was followed.
    registration : Registration
        The source on the target.
    reverse : Registration
        The target on the source.
    """

    candidate: Candidate
    registration: Registration
    reverse: Registration


@dataclass(frozen=True, eq=False)
class Follower:
    """Follows hypotheses up by registrations.

    Attributes
    ----------
    x, y : Shape
        The shapes.
    source, target : DeformableSurface
        Their surfaces.
    ties, ties_back : Ties or None
        Where the source is held on the target, and the target on the source.
    disagree : tuple of float
        Mean length of the way there and back, in sqrt(area), from which on both are registered in turn once more,
        twice, and so on.
    standing : float
        How probably, at most, a map of these surfaces that is known already is right by what it leaves in place.
    upright : (3, 3) array of float
        How the source is turned before it is seen whether it is left in place: as it is, if it is not a reflection.
    """

    x: Shape
    y: Shape
    source: DeformableSurface
    target: DeformableSurface
    ties: Ties | None = None
    ties_back: Ties | None = None
    disagree: tuple[float, ...] = (0.0055, 0.008, 0.012)
    standing: float = 0.0
    upright: Floats = field(default_factory=lambda: np.eye(3))
    is_sent_once: ClassVar[bool] = True

    @cached_property
    def _smooth(self) -> Floats:
        """Functions that the source is placed by before it is registered, (n_x, k)."""
        return self._functions[:, :_SMOOTH]

    @cached_property
    def _functions(self) -> Floats:
        """All functions of the source, (n_x, k)."""
        return self.x.unit_functions()

    @cached_property
    def are_closed(self) -> bool:
        """Whether nothing can have been cut off."""
        return not (has_border(self.x) or has_border(self.y))

    def __getstate__(self) -> dict[str, Any]:
        """Leave out what the surfaces stand for, and what is made in no time."""
        state = {field.name: getattr(self, field.name) for field in fields(self)}
        return state | {"x": self.x.lean(), "y": self.y.lean()}

    def all_steps(self, hypotheses: Sequence[MapHypothesis]) -> Steps[list[Candidate]]:
        """Follow up several hypotheses; see `steps`."""
        found = yield from shared_steps(_followed_steps, self, hypotheses)
        return [Candidate(hypothesis, *rest) for hypothesis, rest in zip(hypotheses, found, strict=True)]

    def steps(self, hypothesis: MapHypothesis) -> Steps[Candidate]:
        """Register the source from where a hypothesis takes it, and judge what comes of it."""
        source, target = self.source, self.target
        images = yield from within(hypothesis.images_steps(), 0.0, 0.2)
        start = self.start(images)
        posed = (start + smooth_start(source, target, images.on_y, self._functions)) / 2
        first = at_vertices(target, images.on_y), at_vertices(source, images.on_x)
        guides = self._guides(hypothesis, images)
        stages = GUIDED, SOFT
        steps = register_steps(source, target, start, stages, first, posed=posed, ties=self.ties, guides=guides)
        registration = yield from within(steps, 0.2, 1.0)
        return self._judged(hypothesis, registration)

    def held_steps(self, hypothesis: MapHypothesis, pairs: Ints) -> Steps[Candidate]:
        """Do so with vertices of source and target (k, 2) held together, which is forgotten afterwards."""
        points = SurfacePoints.at_vertices(self.source.mesh, pairs[:, 0])
        ties = Ties.at(self.source.mesh, points, self.target.vertices[pairs[:, 1]])
        return (yield from replace(self, ties=ties).steps(hypothesis))

    def rolled_back_steps(self, candidates: Sequence[Candidate]) -> Steps[list[list[Candidate]]]:
        """Turn a long body back where it is turned about its axis, and try how else it might lie as a whole.

        Returned are for each candidate all ways to lie, the most credible first, or the candidate alone.  What
        landmarks hold stays the way round it is, and no other way is tried if the first one leaves all in place.  Of
        all other ways those of the most credible candidates are tried, a few at most.
        """
        if self.ties is not None:
            return [[candidate] for candidate in candidates]
        turned = yield from within(shared_steps(_turned_back_steps, self, candidates), 0.0, 0.4)
        if is_placed(candidates[0].in_place):
            turned = [(judged, []) for judged, _ in turned]
        found = []
        others: list[tuple[int, Floats]] = []
        for number, (candidate, (judged, ways)) in enumerate(zip(candidates, turned, strict=True)):
            found.append([candidate if judged is None else Candidate(candidate.hypothesis, *judged)])
            others += [(number, way) for way in ways]
        others = sorted(others, key=lambda other: found[other[0]][0].score)[:_MOST_LYING]
        items = [(found[number][0], way) for number, way in others]
        lying = yield from within(shared_steps(_lying_steps, self, items), 0.4, 1.0)
        for (number, _), judged in zip(others, lying, strict=True):
            found[number].append(Candidate(found[number][0].hypothesis, *judged))
        return [sorted(ways, key=lambda candidate: candidate.score) for ways in found]

    def lying_steps(self, best: Candidate, way: Floats) -> Steps[Candidate]:
        """Register a long body as it might lie otherwise, and turn it back if that may be the better way."""
        lying = yield from within(self._registered_again_steps(best, way), 0.0, 0.5)
        if lying.score < best.score + _WORTHWHILE:
            lying, _ = yield from within(self.turned_back_steps(lying), 0.5, 1.0)
        return lying

    def turned_back_steps(self, candidate: Candidate) -> Steps[tuple[Candidate, list[Floats]]]:
        """Turn parts of a long body back while that is more credible; and say how else all of it might be placed."""
        ways: list[Floats] = []
        for number in range(_ROLLS):
            positions = candidate.registration.positions
            turned, otherwise = rolled_back(self.x, self.source, self.target, positions)
            ways = [way for winding in otherwise for way in winding.positions if self.apart(way, positions) > _TRIFLE]
            if turned is positions:
                break
            again = self._registered_again_steps(candidate, turned)
            rolled = yield from within(again, *part_of(number, _ROLLS))
            if rolled.score >= candidate.score:
                break
            candidate = rolled
        return candidate, ways

    def half_turned_steps(self, candidate: Candidate) -> Steps[Candidate]:
        """Register the source turned half around from where a candidate leaves it."""
        turned = half_turned(self.source, self.target, candidate.registration.positions, self._smooth)
        hypothesis = replace(candidate.hypothesis, origin="half turn")  # which is not refined: it leads elsewhere
        return (yield from self._registered_again_steps(replace(candidate, hypothesis=hypothesis), turned))

    def _registered_again_steps(self, candidate: Candidate, positions: Floats) -> Steps[Candidate]:
        """Follow a candidate's hypothesis from other positions."""
        registration = yield from register_steps(self.source, self.target, positions, (GUIDED, SOFT))
        return self._judged(candidate.hypothesis, registration)

    def _judged(self, hypothesis: MapHypothesis, registration: Registration) -> Candidate:
        """Say how credible a hypothesis is by the soft registration that it led to."""
        lead = assessed_everywhere(hypothesis.domains, self.vertex_maps(registration))
        credit = self.credit(registration.positions)
        score = registered_score(lead.score, registration.gaps, credit)
        # The rough map that it began with may be no isometry though the bodies are alike.
        isometry = float(np.clip((_BUILT - lead.terms["waves"]) / (_BUILT - _POSED), 0, 1))
        alike = likeness(hypothesis.score, registration.cost)
        return Candidate(
            hypothesis, registration, score, alike, isometry, self.in_place(registration.positions), credit
        )

    def judged_closely(self, fit: CloseFit) -> CloseFit:
        """Judge a candidate by the mean of how credible its soft registration is, and its close one.

        A rough start may lead the soft one of the true map to where the surfaces meet badly, and a close one fits wrong
        maps as well.
        """
        before, now = fit.candidate, self._judged(fit.candidate.hypothesis, fit.registration)
        score, credit = (before.score + now.score) / 2, (before.credit + now.credit) / 2
        return replace(fit, candidate=replace(before, score=score, credit=credit))

    def credited(self, candidate: Candidate) -> Candidate:
        """Judge a candidate anew by what is known to be left in place by now."""
        credit = self.credit(candidate.registration.positions)
        return replace(candidate, score=candidate.score + candidate.credit - credit, credit=credit)

    def all_close_steps(self, candidates: Sequence[Candidate]) -> Steps[list[CloseFit]]:
        """Register several candidates closely; see `close_steps`."""
        found = yield from shared_steps(_closely_followed_steps, self, candidates)
        return [CloseFit(candidate, *rest) for candidate, rest in zip(candidates, found, strict=True)]

    def close_steps(self, candidate: Candidate) -> Steps[CloseFit]:
        """Register closely: the source, then the target from where it lies, then the source again."""
        source, target = self.source, self.target
        positions, isometry = candidate.registration.positions, candidate.isometry

        def register_all_steps(starts: list[Floats], stage: Stage) -> Steps[list[Registration]]:
            """Register from several positions."""
            items = [(start, stage, isometry) for start in starts]
            return (yield from shared_steps(_registered_steps, self, items))

        if self.ties is None:
            way = untwisted(self.x, source, target, positions, isometry)
            first = yield from within(wound_steps(register_all_steps, source, target, way), 0.0, 0.2)
        else:  # what landmarks hold stays the way round it is
            (first,) = yield from within(register_all_steps([positions], FINE), 0.0, 0.2)
        reverse, final = yield from within(self.again_steps(candidate, first), 0.2, 1.0)
        return CloseFit(candidate, final, reverse)

    def settled_steps(self, fit: CloseFit) -> Steps[tuple[CloseFit, Trips]]:
        """Go on from either side in turn, while the two disagree and come nearer to each other by that.

        At last the target follows where the source has come to lie since.  How far they were apart before that tells
        where they may err, see `trips`.
        """
        trips, disagree = self.trips(fit), self.disagree
        for number, agreed in enumerate(disagree):
            length = self._length(trips)
            if length <= agreed:
                break
            again = self.again_steps(fit.candidate, fit.registration)
            reverse, registration = yield from within(again, *part_of(number, len(disagree) + 1))
            other = replace(fit, registration=registration, reverse=reverse)
            apart = self.trips(other)
            if self._length(apart) >= length:
                break
            fit, trips = other, apart
            if self._length(apart) > _NEARER * length:
                break
        matches = fit.registration.on_source, fit.registration.on_target
        start, isometry = fit.reverse.positions, fit.candidate.isometry
        following = register_steps(
            self.target, self.source, start, (LAST,), matches, isometry=isometry, ties=self.ties_back
        )
        follower = yield from within(following, len(disagree) / (len(disagree) + 1), 1.0)
        return replace(fit, reverse=follower), trips

    def trips(self, fit: CloseFit) -> Trips:
        """Distances, in sqrt(area), between vertices and where the two maps bring them, there and back."""
        ways = (self.source, self.target, fit.registration), (self.target, self.source, fit.reverse)
        trips = []
        for (start, end, there), (_, _, back) in zip(ways, ways[::-1], strict=True):
            images = back.on_target.interpolate(start.triangles, start.vertices)
            returned = there.on_target.interpolate(end.triangles, images)
            trips.append(np.linalg.norm(returned - start.vertices, axis=1))
        return trips[0], trips[1]

    def partnered(self, there: FoundPoints, back: FoundPoints) -> Bools:
        """Tell which vertices of the source have a partner by a pair of maps, (n_x,), see `with_partner`."""
        source, target = self.source.mesh, self.target.mesh
        return with_partner(source, target, there.on(target), back.on(source))

    def _length(self, trips: Trips) -> float:
        """Mean length from where it is shorter: what only one of the surfaces has leads elsewhere anyhow."""
        masses = self.source.mass, self.target.mass
        return min(float(np.average(trip, weights=mass)) for trip, mass in zip(trips, masses, strict=True))

    def again_steps(self, candidate: Candidate, found: Registration) -> Steps[tuple[Registration, Registration]]:
        """Register the target from where the source lies on it, then the source from where the target does."""
        source, target = self.source, self.target
        here, there = self._guides(candidate.hypothesis, self.vertex_maps(found))
        restart = partial(restarted_steps, stages=_STAGES, isometry=candidate.isometry)
        matches, guides = (found.on_source, found.on_target), (there, here)
        steps = restart(target, source, self.y.unit_functions(_DETAILED), matches, ties=self.ties_back, guides=guides)
        reverse = yield from within(steps, 0.0, 0.5)
        matches, guides = (reverse.on_source, reverse.on_target), (here, there)
        steps = restart(source, target, self.x.unit_functions(_DETAILED), matches, ties=self.ties, guides=guides)
        return reverse, (yield from within(steps, 0.5, 1.0))

    def in_place(self, positions: Floats) -> float:
        """Estimate how probably it is right where the source lies because it is left as it stands, 0 to 1.

        It is 0 where something may have been cut off: of a part, another map may leave more in place than the true one.
        """
        if not self.are_closed:
            return 0.0
        return probability_in_place(self._agreement(positions))

    def credit(self, positions: Floats) -> float:
        """By how much a score is smaller because of what is in place, be it after a half turn, see `place_credit`."""
        if not self.are_closed:
            return 0.0
        turned = probability_turned(self._agreement(positions, half_turn=True), self.standing)
        return place_credit(max(self.in_place(positions), turned))

    def _agreement(self, positions: Floats, *, half_turn: bool = False) -> float:
        """Say how well the source is left in place, see `agreement_in_place`."""
        standing = self.source.mesh.vertices @ self.upright.T
        return agreement_in_place(standing, positions, self.source.mass, half_turn=half_turn)

    def start(self, images: PointMaps) -> Floats:
        """Place the source where a map between all vertices puts it, smoothly."""
        return smooth_start(self.source, self.target, images.on_y, self._smooth)

    def apart(self, first: Floats, second: Floats) -> float:
        """Mean distance, in sqrt(area), between two ways to place the source."""
        areas = self.source.mass
        return float(areas @ np.linalg.norm(first - second, axis=1) / areas.sum())

    def refined_steps(self, candidate: Candidate) -> Steps[Candidate]:
        """Let functional maps refine a registered map, and take that for the hypothesis that led to it."""
        was = candidate.hypothesis
        maps = self.vertex_maps(candidate.registration)
        hypothesis = yield from refined_hypothesis_steps(was.domains, maps, was.origin)
        likeness = candidate.likeness + was.score - hypothesis.score
        return replace(candidate, hypothesis=hypothesis, likeness=likeness)

    def _guides(self, hypothesis: MapHypothesis, images: PointMaps) -> tuple[Floats, Floats]:
        """Take the lowest eigenfunctions of the target to both surfaces: a tail is far from a leg in them, in any pose.

        The higher ones count less, by the root of their eigenvalues: they err more, and say less about limbs.
        """
        domain, lowest = hypothesis.domains[1], slice(1, 1 + _GUIDES)
        values = domain.values[lowest]
        there = domain.functions[:, lowest] * np.sqrt(values[:1] / values)
        return self.source.smoothed(there[images.on_y], self._smooth), there

    def vertex_maps(self, registration: Registration) -> PointMaps:
        """Take the maps of a registration between all vertices."""
        there = registration.on_target.nearest_vertices(self.target.triangles)
        return PointMaps(there, registration.on_source.nearest_vertices(self.source.triangles))


def _followed_steps(follow: Follower, hypothesis: MapHypothesis) -> Steps[_Judged]:
    """Find what `Follower.steps` does, beside the hypothesis."""
    return _judged((yield from follow.steps(hypothesis)))


def _turned_back_steps(follow: Follower, candidate: Candidate) -> Steps[tuple[_Judged | None, list[Floats]]]:
    """Find what `Follower.turned_back_steps` does, beside the hypothesis; None if nothing is turned."""
    best, ways = yield from follow.turned_back_steps(candidate)
    return None if best is candidate else _judged(best), ways


def _lying_steps(follow: Follower, item: tuple[Candidate, Floats]) -> Steps[_Judged]:
    """Find what `Follower.lying_steps` does, beside the hypothesis."""
    return _judged((yield from follow.lying_steps(*item)))


def _judged(found: Candidate) -> _Judged:
    """Take what is sent of a candidate, the hypothesis of which is known."""
    return found.registration, found.score, found.likeness, found.isometry, found.in_place, found.credit


def _closely_followed_steps(follow: Follower, candidate: Candidate) -> Steps[tuple[Registration, Registration]]:
    """Find what `Follower.close_steps` does, beside the candidate."""
    found = yield from follow.close_steps(candidate)
    return found.registration, found.reverse


def _registered_steps(follow: Follower, item: tuple[Floats, Stage, float]) -> Steps[Registration]:
    """Register the source from some positions."""
    start, stage, isometry = item
    return register_steps(follow.source, follow.target, start, (stage,), isometry=isometry, ties=follow.ties)


def at_vertices(surface: DeformableSurface, vertices: Ints) -> FoundPoints:
    """Name vertices of a surface as points on it."""
    return surface.search.at_vertices(surface.mesh.vertices[vertices], vertices)
