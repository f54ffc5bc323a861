# SPDX-License-Identifier: GPL-3.0-or-later
"""The map between all points of two surfaces: the most credible start, laid onto the target by registration."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from operator import attrgetter

import numpy as np

from ..geometry.procrustes import mirrored_across
from ..mesh.closest_points import FoundPoints
from ..registration.deformable import DeformableSurface
from ..registration.positional_constraints import Ties
from ..registration.registration import Registration
from ..runtime.arrays import Floats
from ..runtime.errors import MatchError
from ..runtime.progress import Preview, Progress, Steps, within
from ..shapes.landmarks import Landmarks
from ..shapes.shape import Shape
from .credibility import EVEN, LITTLE_RISE, RISE, is_clear_choice
from .dense_hypotheses import MapHypothesis, SparseStart, map_hypotheses_steps, unrefined_hypothesis
from .landmark_selection import steered_hypotheses_steps
from .proposers import MOST, Contest, are_distinct, contenders, proposed_steps
from .registered_hypotheses import Candidate, CloseFit, Follower, at_vertices
from .rough_maps.extremity_maps import RoughSearch

EIGENPAIRS = 120
"""Laplace-Beltrami eigenpairs that the dense map is made with."""

_AMBIGUOUS = 2.0
"""Difference of scores up to which a map is registered before it is given up."""

_LAID = 0.5
"""What counts of the probability that a map is right because it leaves all in place, if it was made so; by hand."""


@dataclass(frozen=True, eq=False)
class RegisteredPair:
    """Two surfaces, one laid onto the other.

    Attributes
    ----------
    x, y : Shape
        The shapes.
    source, target : DeformableSurface
        Their surfaces.
    registration : Registration
        The source on the target.
    reverse : Registration
        The target on the source.
    candidates : tuple of Candidate
        What was compared: the chosen one, then the others by growing score.
    margin : float or None
        By how much the best candidate that is another map is less credible; None if there was none.
    landmarks : Landmarks or None
        What the registration was held at.
    mirrored : bool
        Whether `x` is the reflection of the shape that was given, because that is what the landmarks ask for.
    trips : pair of (n_x,) and (n_y,) arrays of float, optional
        How far, in sqrt(area), vertices were from where both registrations brought them, there and back, before the
        target followed the source at last: where that is much they may err.
    alternatives : tuple of FoundPoints
        Where other maps that are as credible take the vertices of the source, the most credible first: of a body that
        is the same from several sides.  They are known about as well as they had to be to be compared.
    in_place : float
        How probably the map is right because it leaves everything where it stands, see `Follower.in_place`.
    """

    x: Shape
    y: Shape
    source: DeformableSurface
    target: DeformableSurface
    registration: Registration
    reverse: Registration
    candidates: tuple[Candidate, ...]
    margin: float | None
    landmarks: Landmarks | None = None
    mirrored: bool = False
    trips: tuple[Floats, Floats] | None = None
    alternatives: tuple[FoundPoints, ...] = ()
    in_place: float = 0.0

    @property
    def likeness(self) -> float | None:
        """How credible the best candidate was, whatever the others; None with landmarks or without candidates."""
        return self.candidates[0].likeness if self.landmarks is None and self.candidates else None


@dataclass(frozen=True, eq=False)
class Rival:
    """Another map than the one that is chosen.

    Attributes
    ----------
    map : Registration or MapHypothesis
        Where it was registered, or the map that was not.
    behind : float
        By how much it is less credible.
    behind_elsewhere : float
        The same if nothing is made of what either leaves in place.
    """

    map: Registration | MapHypothesis
    behind: float
    behind_elsewhere: float

    @classmethod
    def of(cls, other: Candidate, best: Candidate) -> Rival:
        """Compare two that were registered."""
        behind = other.score - best.score
        return cls(other.registration, behind, behind + other.credit - best.credit)

    @property
    def least(self) -> float:
        """The smaller of both, 0 at least: the limbs of what is chosen may have been put right."""
        return max(min(self.behind, self.behind_elsewhere), 0.0)


def registered_pair_steps(
    x: Shape,
    y: Shape,
    starts: Sequence[SparseStart] = (),
    *,
    search: bool = True,
    as_they_are: bool = False,
    landmarks: Landmarks | None = None,
    searched: RoughSearch | None = None,
    least: float = -np.inf,
    least_softly: float = -np.inf,
) -> Steps[RegisteredPair]:
    """Find the map between two surfaces that keeps left on the left, and refine it.

    Parameters
    ----------
    x, y : Shape
        The surfaces X and Y; their samples have been taken.
    starts : sequence of SparseStart
        Sparse correspondences that the map may start from.
    search : bool
        Whether other starts are looked for as well.
    as_they_are : bool
        Whether the starts are followed up without being refined by functional maps, too.
    landmarks : Landmarks, optional
        What is known to correspond, and is held together; the samples of the shapes begin with them.
    searched : RoughSearch, optional
        Matchings of extremities that keep the orientation, if they have been looked for; without landmarks only.
    least : float
        Likeness below which no map is of use: all is given up as soon as it cannot be reached any more.
    least_softly : float
        Likeness of the best that has been registered softly below which no other is looked for.

    Returns
    -------
    RegisteredPair
        The surfaces, laid onto one another.

    Raises
    ------
    MatchError
        If they are less alike than is asked for.
    """
    yield from within(x.spectrum_steps(EIGENPAIRS), 0.0, 0.05)
    yield from within(y.spectrum_steps(EIGENPAIRS), 0.05, 0.1)
    mirrored = False
    if landmarks is None:
        # Mirrored maps serve only landmarks that ask for one.
        proposals = map_hypotheses_steps(x, y, starts, search=search, mirrored=False, searched=searched)
        hypotheses = yield from within(proposals, 0.1, 0.4)
        yield Progress(0.4, "Comparing maps", _preview(hypotheses[0]))
    else:
        steered = yield from within(steered_hypotheses_steps(x, y, starts, landmarks, search=search), 0.1, 0.4)
        x, hypotheses, mirrored = steered.x, steered.hypotheses, steered.mirrored
    source, target = (DeformableSurface(each.mesh, each.laplace, each.surface.cut_border(each.mesh)) for each in (x, y))
    yield from within(source.prepare_steps(), 0.4, 0.41)
    yield from within(target.prepare_steps(), 0.41, 0.42)
    ties = ties_back = None
    if landmarks is not None:
        here, there, proxies = landmarks.source, landmarks.target, (x.surface.proxy, y.surface.proxy)
        ties = Ties.of_landmarks(*proxies, target, here, there)
        ties_back = Ties.of_landmarks(*proxies[::-1], source, there, here)
    # Both surfaces are seen from outside, so the true map keeps the orientation.
    keeping = [h for h in hypotheses if h.orientation > 0] or hypotheses
    plausible = [h for h in keeping if h.score < keeping[0].score + _AMBIGUOUS][:MOST]
    if as_they_are:
        plausible += [unrefined_hypothesis(hypotheses[0].domains, start) for start in starts]
    untried = [h for h in hypotheses if h.orientation > 0 and not any(h is p for p in plausible)]
    upright = yield from within(_upright_steps(x, target, plausible[-1 if as_they_are else 0]), 0.42, 0.42)
    follow = Follower(x, y, source, target, ties, ties_back, upright=upright)
    candidates = yield from within(follow.all_steps(plausible), 0.42, 0.6)
    candidates.sort(key=lambda candidate: candidate.score)
    contest, candidates = Contest(follow, landmarks, least).credited(candidates)
    yield Progress(0.6, "Fitting the surfaces", _preview(candidates[0].hypothesis, candidates[0].registration))
    if landmarks is None and max(candidate.likeness for candidate in candidates) < least_softly:
        raise MatchError("The surfaces are not enough alike to be matched.")
    if search:
        contest, candidates = yield from within(proposed_steps(contest, candidates), 0.6, 0.7)
    # What cannot be right is followed as it is.
    hopeful = contest.may_reach(EVEN, candidates, LITTLE_RISE if search else RISE)
    contest.check_last(candidates)
    fit, others = yield from within(_contest_steps(contest, candidates, closely=hopeful), 0.7, 0.9)
    best = fit.candidate
    contest.check_last([best])
    follow = contest.follow if hopeful else replace(contest.follow, disagree=())
    fit, trips = yield from within(follow.settled_steps(fit), 0.9, 1.0)
    if best.hypothesis.is_rough:
        # Others are compared with what functional maps make of it, not with the rough map.
        best = yield from within(follow.refined_steps(best), 1.0, 1.0)
    rivals = _rivals(best, others, () if as_they_are else untried, source.mass)
    margin, alternatives = yield from alternatives_steps(follow, rivals, fit)
    registered = fit.registration, fit.reverse, (best, *others)
    in_place = follow.in_place(fit.registration.positions)
    if landmarks is not None and landmarks.assumed:
        landmarks, in_place = None, _LAID * in_place
    return RegisteredPair(x, y, source, target, *registered, margin, landmarks, mirrored, trips, alternatives, in_place)


def _upright_steps(x: Shape, target: DeformableSurface, hypothesis: MapHypothesis) -> Steps[Floats]:
    """Turn the reflection of a source, (3, 3), to be one in the plane in which a map mirrors it, however it stands."""
    if not x.surface.is_reflected:
        return np.eye(3)
    images = (yield from hypothesis.images_steps()).on_y
    axis = mirrored_across(x.surface.as_given(x.mesh.vertices), target.vertices[images], x.mesh.vertex_areas)
    return x.surface.as_given(np.eye(3) - 2 * np.outer(axis, axis))


def _preview(hypothesis: MapHypothesis, registration: Registration | None = None) -> Preview:
    """Show where samples correspond by a hypothesis, or by the registration that it led to."""
    x, y = hypothesis.domains
    there = y.shape.mesh
    if registration is None:
        images = there.vertices[y.vertices[hypothesis.points.on_y]]
    else:
        images = registration.on_target.interpolate(there.triangles, there.vertices)[x.vertices]
    return Preview(x.shape.surface.as_given(x.shape.mesh.vertices[x.vertices]), images)


def _contest_steps(
    contest: Contest, candidates: list[Candidate], *, closely: bool
) -> Steps[tuple[CloseFit, list[Candidate]]]:
    """Register closely what may be chosen, and choose; returned are the most credible map and the other candidates."""
    chosen = contenders(contest, candidates) if closely else candidates[:1]
    fits = yield from contest.follow.all_close_steps(chosen)
    others = [candidate for candidate in candidates if not any(candidate is each for each in chosen)]
    if len(fits) > 1:
        fits = sorted(map(contest.follow.judged_closely, fits), key=lambda fit: fit.candidate.score)
    return fits[0], [*(fit.candidate for fit in fits[1:]), *others]


def _rivals(
    best: Candidate, others: Sequence[Candidate], untried: Sequence[MapHypothesis], areas: Floats
) -> list[Rival]:
    """List other maps, and how each compares, by its own score if it was not registered."""
    taken = best.registration.positions
    registered = [Rival.of(each, best) for each in others if are_distinct(taken, each.registration.positions, areas)]
    behind = [each.score - best.hypothesis.score for each in untried]
    return [*registered, *map(Rival, untried, behind, behind)]


def alternatives_steps(
    follow: Follower, rivals: list[Rival], chosen: CloseFit
) -> Steps[tuple[float | None, tuple[FoundPoints, ...]]]:
    """Choose the maps that are about as credible as the one that is taken, and differ from it and each other.

    Where neither of two maps finds a partner, as for a hat if the other body has none, it says nothing that they lead
    elsewhere.  What is left in place makes the choice clear, but what would be as credible without that is offered all
    the same: a table may be meant to be turned.

    Returns
    -------
    margin : float or None
        By how much the best map that differs is less credible; None if there is none.
    alternatives : tuple of FoundPoints
        Those about as credible.
    """
    partnered = follow.partnered(chosen.registration.on_target, chosen.reverse.on_target)
    taken = [chosen.registration.positions]
    found: list[FoundPoints] = []
    margin = None
    ranked = sorted(rivals, key=attrgetter("least"))
    for number, each in enumerate(ranked):
        if is_clear_choice(each.least):
            nearest = min(other.behind for other in ranked[number:])
            return nearest if margin is None else margin, tuple(found)
        rival, behind = each.map, each.behind
        if isinstance(rival, MapHypothesis):
            images = yield from within(rival.images_steps(), 1.0, 1.0)
            positions, points = follow.start(images), at_vertices(follow.target, images.on_y)
            back = at_vertices(follow.source, images.on_x)
            behind += max(chosen.candidate.credit - follow.credit(positions), 0.0)
        else:
            positions, points, back = rival.positions, rival.on_target, rival.on_source
        areas = follow.source.mass * (partnered | follow.partnered(points, back))
        distinct = [are_distinct(positions, other, areas) for other in taken]
        if distinct[0]:
            margin = max(behind, 0.0) if margin is None else min(margin, max(behind, 0.0))
        if all(distinct):
            taken.append(positions)
            found.append(points)
    return margin, tuple(found)
