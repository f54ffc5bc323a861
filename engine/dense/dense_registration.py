# SPDX-License-Identifier: GPL-3.0-or-later
"""The map between all points of two surfaces: the most credible start, laid onto the target by registration."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import compress
from operator import is_
from typing import TYPE_CHECKING

import numpy as np

from ..geometry.best_distinct import best_distinct
from ..registration.deformable import DeformableSurface
from ..registration.positional_constraints import Ties
from ..runtime.progress import Steps, within
from .dense_hypotheses import MapHypothesis, map_hypotheses_steps, unrefined_hypotheses_steps, unrefined_hypothesis
from .landmark_selection import agrees, steered_hypotheses_steps
from .limb_sides import exchanged_limbs, repaired_start_steps
from .registered_hypotheses import Candidate, CloseFit, Follower

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

    from ..registration.registration import Registration
    from ..shapes.landmarks import Landmarks
    from ..shapes.shape import Shape
    from .dense_hypotheses import LandmarkStart
    from .initial_maps import RoughSearch

__all__ = ["EIGENPAIRS", "RegisteredPair", "are_distinct", "registered_pair_steps"]

EIGENPAIRS = 120
"""Laplace-Beltrami eigenpairs that the dense map is made with."""

_AMBIGUOUS = 2.0
"""Difference of scores up to which a hypothesis is registered before it is given up."""

_CONTRADICTED = 4.0
"""The same for a map whose limbs are where they belong, against one that exchanges them as seen from both surfaces."""

_DISTINCT = 0.07
"""Mean distance, in sqrt(area), from which on two registrations are different maps."""

_ELSEWHERE, _LIMB = 0.15, 0.02
"""Or they are different maps if they take so large a part of the source so far, in sqrt(area), from each other."""

_MOST_CANDIDATES = 3

_LIKE = 0.04
"""Mean distance, in sqrt(area), up to which a rough map would lead to where another one already has."""

_CONTESTED = 3.0
"""Difference of scores up to which other maps are registered closely, too, before one is chosen."""


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
    trips: tuple[NDArray[np.float64], NDArray[np.float64]] | None = None

    @property
    def likeness(self) -> float | None:
        """How credible the best candidate was, whatever the others; None with landmarks or without candidates."""
        return self.candidates[0].likeness if self.landmarks is None and self.candidates else None


def registered_pair_steps(
    x: Shape,
    y: Shape,
    starts: Sequence[LandmarkStart] = (),
    *,
    search: bool = True,
    as_they_are: bool = False,
    landmarks: Landmarks | None = None,
    searched: RoughSearch | None = None,
) -> Steps[RegisteredPair]:
    """Find the map between two surfaces that keeps left on the left, and refine it.

    Parameters
    ----------
    x, y : Shape
        The surfaces X and Y; their samples have been taken.
    starts : sequence of LandmarkStart
        Sparse correspondences that the map may start from.
    search : bool
        Whether other starts are looked for as well.
    as_they_are : bool
        Whether the starts are followed up without being refined by functional maps, too.
    landmarks : Landmarks, optional
        What is known to correspond, and is held together; the samples of the shapes begin with them.
    searched : RoughSearch, optional
        Matchings of extremities that keep the orientation, if they have been looked for; without landmarks only.

    Returns
    -------
    RegisteredPair
        The surfaces, laid onto one another.
    """
    yield from within(x.spectrum_steps(EIGENPAIRS), 0.0, 0.05)
    yield from within(y.spectrum_steps(EIGENPAIRS), 0.05, 0.1)
    mirrored = False
    if landmarks is None:
        # Mirrored maps serve only landmarks that ask for one.
        proposals = map_hypotheses_steps(x, y, starts, search=search, mirrored=False, searched=searched)
        hypotheses = yield from within(proposals, 0.1, 0.4)
    else:
        steered = yield from within(steered_hypotheses_steps(x, y, starts, landmarks, search=search), 0.1, 0.4)
        x, hypotheses, mirrored = steered.x, steered.hypotheses, steered.mirrored
    source, target = DeformableSurface(x.mesh, x.laplace), DeformableSurface(y.mesh, y.laplace)
    yield from within(source.prepare_steps(), 0.4, 0.41)
    yield from within(target.prepare_steps(), 0.41, 0.42)
    ties = ties_back = None
    if landmarks is not None:
        here, there, proxies = landmarks.source, landmarks.target, (x.surface.proxy, y.surface.proxy)
        ties = Ties.of_landmarks(*proxies, target, here, there)
        ties_back = Ties.of_landmarks(*proxies[::-1], source, there, here)
    # Both surfaces are seen from outside, so the true map keeps the orientation.
    keeping = [h for h in hypotheses if h.orientation > 0] or hypotheses
    plausible = [h for h in keeping if h.score < keeping[0].score + _AMBIGUOUS][:_MOST_CANDIDATES]
    if as_they_are:
        plausible += [unrefined_hypothesis(hypotheses[0].domains, start) for start in starts]
    follow = Follower(x, y, source, target, ties, ties_back)
    candidates = yield from within(follow.all_steps(plausible), 0.42, 0.6)
    candidates.sort(key=lambda candidate: candidate.score)
    rough: list[MapHypothesis] = []
    if search and candidates[0].hypothesis.is_doubtful:
        proposals = unrefined_hypotheses_steps(candidates[0].hypothesis.domains)
        unrefined = yield from within(proposals, 0.6, 0.62)
        rough = [h for h in unrefined if landmarks is None or agrees(x, y, landmarks, h)]
        candidates = yield from within(_unrefined_steps(follow, candidates, rough), 0.62, 0.68)
    if search:
        # Where no map is looked for, the one that is given is followed as it is.
        repaired = yield from within(_limbs_repaired_steps(follow, candidates[0]), 0.68, 0.69)
        if repaired is not None:
            hypotheses = [h for h in hypotheses if h is not candidates[0].hypothesis]
            candidates[0] = repaired
        candidates = yield from within(_rolled_back_steps(follow, candidates), 0.69, 0.7)
    fits = yield from within(_contest_steps(follow, candidates), 0.7, 0.9)
    closest, trips = yield from within(follow.settled_steps(fits[0]), 0.9, 1.0)
    best = closest.candidate
    others = [candidate for candidate in candidates if candidate is not best]
    if any(best.hypothesis is h for h in rough):
        # Others are compared with what functional maps make of it, not with the rough map.
        best = yield from within(follow.refined_steps(best), 1.0, 1.0)
    margin = _margin(best, others, fits, () if as_they_are else hypotheses, source.mass)
    registered = closest.registration, closest.reverse, (best, *others)
    return RegisteredPair(x, y, source, target, *registered, margin, landmarks, mirrored, trips)


def _unrefined_steps(
    follow: Follower, candidates: list[Candidate], hypotheses: list[MapHypothesis]
) -> Steps[list[Candidate]]:
    """Follow up rough maps, too, that would not lead to where a candidate is; the most credible candidate first."""
    taken = [candidate.registration.positions for candidate in candidates]
    starts = [follow.start(hypothesis.images) for hypothesis in hypotheses]
    new = [all(follow.apart(start, positions) > _LIKE for positions in taken) for start in starts]
    followed = yield from follow.all_steps(list(compress(hypotheses, new)))
    for start, candidate in zip(compress(starts, new), followed, strict=True):
        if all(follow.apart(start, positions) > _LIKE for positions in taken):
            candidates = [*candidates, candidate]
            taken += [start, candidate.registration.positions]
    return sorted(candidates, key=lambda candidate: candidate.score)


def _rolled_back_steps(follow: Follower, candidates: list[Candidate]) -> Steps[list[Candidate]]:
    """Turn a long body back where those that may be chosen turn it about its axis; then the most credible is first.

    How else it might lie is compared as well.
    """
    contenders = _contenders(follow, candidates)
    ways = []
    for number, candidate in enumerate(contenders):
        begin, end = ((number + i) / len(contenders) for i in (0, 1))
        ways += yield from within(follow.rolled_back_steps(candidate), begin, end)
    if len(ways) == len(contenders) and all(map(is_, ways, contenders)):
        return candidates
    others = [candidate for candidate in candidates if not any(candidate is c for c in contenders)]
    return sorted([*ways, *others], key=lambda candidate: candidate.score)


def _contenders(follow: Follower, candidates: list[Candidate]) -> list[Candidate]:
    """Take the best candidate, and other maps that are nearly as credible."""
    close = [candidate for candidate in candidates if candidate.score <= candidates[0].score + _CONTESTED]
    return best_distinct(close, lambda candidate, other: _distinct(follow, candidate, other), _MOST_CANDIDATES)


def _contest_steps(follow: Follower, candidates: list[Candidate]) -> Steps[list[CloseFit]]:
    """Register the candidates that may be chosen closely; the most credible first."""
    fits = yield from follow.all_close_steps(_contenders(follow, candidates))
    return sorted(fits, key=lambda fit: fit.score)


def _distinct(follow: Follower, first: Candidate, second: Candidate) -> bool:
    """Say whether two candidates are different maps."""
    return are_distinct(first.registration.positions, second.registration.positions, follow.source.mass)


def _limbs_repaired_steps(follow: Follower, best: Candidate) -> Steps[Candidate | None]:
    """Follow the best candidate up anew if it exchanges limbs; None if it does not, or if that is no better."""
    shapes = follow.x, follow.y
    wrong = follow.vertex_maps(best.registration)
    start = yield from within(repaired_start_steps(*shapes, wrong), 0.0, 0.0)
    if start is None:
        return None
    domains = best.hypothesis.domains
    hypotheses = yield from within(map_hypotheses_steps(*shapes, (start,), search=False, domains=domains), 0.0, 0.3)
    repaired = yield from within(follow.steps(hypotheses[0]), 0.3, 1.0)
    right = follow.vertex_maps(repaired.registration)
    # What exchanges the ends of limbs may fit a little better by all other measures.
    clear = all(exchanged_limbs(*shapes, wrong)) and not any(exchanged_limbs(*shapes, right))
    return repaired if repaired.score < best.score + (_CONTRADICTED if clear else 0.0) else None


def _margin(
    best: Candidate,
    others: list[Candidate],
    fits: list[CloseFit],
    hypotheses: Sequence[MapHypothesis],
    areas: NDArray[np.float64],
) -> float | None:
    """By how much the second choice is less credible; hypotheses that were not registered count by their own score."""
    # Starts that differ in a limb may lead to the same place at last.
    last = fits[0].registration.positions
    rivals = [fit for fit in fits[1:] if are_distinct(last, fit.registration.positions, areas)]
    gaps = [fit.score - fits[0].score for fit in rivals]
    closely = {id(fit.candidate) for fit in fits}
    for other in others:
        taken = other.registration.positions
        if id(other) not in closely and are_distinct(best.registration.positions, taken, areas):
            gaps.append(other.score - best.score)
    tried = {id(candidate.hypothesis) for candidate in (fits[0].candidate, *others)}
    gaps += [h.score - best.hypothesis.score for h in hypotheses if id(h) not in tried and h.orientation > 0]
    # With limbs put right, the hypothesis is another one than those that were sorted out by their scores.
    return max(float(min(gaps)), 0.0) if gaps else None


def are_distinct(first: NDArray[np.float64], second: NDArray[np.float64], areas: NDArray[np.float64]) -> bool:
    """Say whether two registrations are different maps, as a whole or in where they take a limb.

    Parameters
    ----------
    first, second : (n, 3) array of float
        Where they take the vertices of the source, in units of the square root of the target's area.
    areas : (n,) array of float
        Areas of these vertices, in any unit.
    """
    apart = np.linalg.norm(first - second, axis=1)
    elsewhere = areas[apart > _ELSEWHERE].sum() / areas.sum()
    return bool(apart.mean() > _DISTINCT or elsewhere > _LIMB)
