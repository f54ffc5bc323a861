# SPDX-License-Identifier: GPL-3.0-or-later
"""Proposers: other registered maps than the best so far, each kind for one way in which it may be wrong.

A proposer gets what is known of a pair of surfaces and the candidates so far, the best first, and returns them with
what it proposes beside them or instead of them, the best first again.  All are compared by one score.  Another kind of
repair is another one in `PROPOSERS`.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from itertools import chain
from operator import attrgetter, is_
from typing import NamedTuple

import numpy as np

from ..geometry.best_distinct import best_distinct
from ..runtime.arrays import Floats
from ..runtime.errors import MatchError
from ..runtime.progress import Steps, part_of, within
from ..shapes.landmarks import Landmarks
from .credibility import EVEN, LITTLE_RISE, MUCH_ALIKE, RISE, is_less_alike, is_placed, may_reach
from .dense_hypotheses import map_hypotheses_steps, unrefined_hypotheses_steps
from .landmark_selection import agrees
from .limb_sides import repaired_start_steps
from .lost_limbs import lost_limbs
from .registered_hypotheses import Candidate, Follower

MOST = 3
"""How many maps are registered, and how many closely, at most."""

_CONTESTED = 3.0
"""Difference of scores up to which a registered map is registered closely, too, before one is chosen."""

_DISTINCT = 0.07
"""Mean distance, in sqrt(area), from which on two registrations are different maps."""

_ELSEWHERE, _LIMB = 0.15, 0.02
"""Or they are different maps if they take so large a part of the source so far, in sqrt(area), from each other."""

_ROUGHLY = 0.3
"""The same distance for a rough map, which errs by half of that here and there.  Between bodies much alike, of the
bodies of `game_units` and the listed pairs of `dense_pairs`, all but one that were nearer to another map led to that,
and the one to a worse map (tried once)."""

_LIKE = 0.04
"""Mean distance, in sqrt(area), up to which a rough map between other bodies would lead to where another one has."""


@dataclass(frozen=True, eq=False)
class Contest:
    """What is compared.

    Attributes
    ----------
    follow : Follower
        Registers what is proposed.
    landmarks : Landmarks or None
        What the maps have to agree with.
    least : float
        Likeness below which no map is of use: all is given up as soon as it cannot be reached any more.
    """

    follow: Follower
    landmarks: Landmarks | None = None
    least: float = -np.inf

    def may_reach(self, least: float, candidates: list[Candidate], rise: float) -> bool:
        """Say whether any of the candidates may still lead to a map of so much likeness; with landmarks, all may.

        Of surfaces that end somewhere, parts are looked for from where the map leads, be it likely or not.
        """
        rise = rise if self.follow.are_closed else max(rise, RISE)
        return self.landmarks is not None or any(may_reach(least, c.likeness, c.in_place, rise) for c in candidates)

    def check(self, candidates: list[Candidate], rise: float) -> None:
        """Raise a `MatchError` if none of the candidates may be of use any more."""
        if not self.may_reach(self.least, candidates, rise):
            raise MatchError("The surfaces are not enough alike to be matched.")

    def check_last(self, candidates: list[Candidate]) -> None:
        """Do so where nothing more is proposed: then only the likeness of rough ones changes, once they are refined."""
        if not self.may_reach(self.least, candidates, 0.0):
            self.check([candidate for candidate in candidates if candidate.hypothesis.is_rough], LITTLE_RISE)

    def credited(self, candidates: list[Candidate]) -> tuple[Contest, list[Candidate]]:
        """Judge candidates anew, the best first, if one of them leaves more in place than any before."""
        standing = max(candidate.in_place for candidate in candidates)
        if standing <= self.follow.standing:
            return self, candidates
        follow = replace(self.follow, standing=standing)
        return replace(self, follow=follow), sorted(map(follow.credited, candidates), key=attrgetter("score"))


class Proposer(NamedTuple):
    """What proposes other registered maps.

    Attributes
    ----------
    steps : callable
        Proposes them.
    rise : float
        By how much the likeness may rise by that.
    """

    steps: Callable[[Contest, list[Candidate]], Steps[list[Candidate]]]
    rise: float


def are_distinct(first: Floats, second: Floats, areas: Floats, elsewhere: float = _ELSEWHERE) -> bool:
    """Say whether two registrations are different maps, as a whole or in where they take a limb.

    Parameters
    ----------
    first, second : (n, 3) array of float
        Where they take the vertices of the source, in units of the square root of the target's area.
    areas : (n,) array of float
        Areas of these vertices, in any unit; zero where it says nothing that they are taken elsewhere.
    elsewhere : float
        From which distance on, in the same units, a limb is taken elsewhere.
    """
    if not areas.any():
        return False
    apart = np.linalg.norm(first - second, axis=1)
    mean, share = np.average(np.stack([apart, apart > elsewhere]), axis=1, weights=areas)
    return bool(mean > _DISTINCT or share > _LIMB)


def contenders(contest: Contest, candidates: list[Candidate]) -> list[Candidate]:
    """Take the best candidate, and other maps that are nearly as credible."""
    areas = contest.follow.source.mass
    close = [candidate for candidate in candidates if candidate.score <= candidates[0].score + _CONTESTED]

    def differ(candidate: Candidate, other: Candidate) -> bool:
        """Say whether the registrations of two candidates are different maps."""
        return are_distinct(candidate.registration.positions, other.registration.positions, areas)

    return best_distinct(close, differ, MOST)


def _matchings_steps(contest: Contest, candidates: list[Candidate]) -> Steps[list[Candidate]]:
    """Propose matchings of extremities as they are, where the best candidate may be led astray by functional maps.

    Those are followed that would not lead to where a candidate is.
    """
    best, follow, landmarks = candidates[0].hypothesis, contest.follow, contest.landmarks
    if not best.is_doubtful:
        return candidates
    rough = yield from within(unrefined_hypotheses_steps(best.domains), 0.0, 0.25)
    taken = [candidate.registration.positions for candidate in candidates]
    are_unlike = is_less_alike(candidates[0].likeness, MUCH_ALIKE)

    def leads_elsewhere(start: Floats, other: Floats) -> bool:
        """Say whether a rough map may lead to another map than one that is known, or of unlike bodies a better one."""
        is_better = are_unlike and follow.apart(start, other) > _LIKE
        return is_better or are_distinct(start, other, follow.source.mass, _ROUGHLY)

    new = []
    for hypothesis in rough:
        start = follow.start(hypothesis.images)
        is_new = all(leads_elsewhere(start, other) for other in taken)
        if is_new and (landmarks is None or agrees(follow.x, follow.y, landmarks, hypothesis)):
            new.append(hypothesis)
            taken.append(start)
    followed = yield from within(follow.all_steps(new), 0.25, 1.0)
    return sorted([*candidates, *followed], key=lambda candidate: candidate.score)


def _limbs_steps(contest: Contest, candidates: list[Candidate]) -> Steps[list[Candidate]]:
    """Propose the best candidate anew if it seems to exchange limbs, with these put right."""
    follow, best = contest.follow, candidates[0]
    shapes, domains = (follow.x, follow.y), best.hypothesis.domains
    start = yield from within(repaired_start_steps(*shapes, follow.vertex_maps(best.registration)), 0.0, 0.0)
    if start is None:
        return candidates
    hypotheses = yield from within(map_hypotheses_steps(*shapes, (start,), search=False, domains=domains), 0.0, 0.3)
    repaired = yield from within(follow.steps(hypotheses[0]), 0.3, 1.0)
    return sorted([repaired, *candidates], key=lambda candidate: candidate.score)


def _lost_limbs_steps(contest: Contest, candidates: list[Candidate]) -> Steps[list[Candidate]]:
    """Propose the best candidate anew if both surfaces have ends of limbs that it loses, with these held together."""
    follow, best = contest.follow, candidates[0]
    if follow.ties is not None:
        return candidates
    pairs = lost_limbs(follow.x, follow.y, follow.vertex_maps(best.registration))
    if not len(pairs):
        return candidates
    held = yield from follow.held_steps(best.hypothesis, pairs)
    return sorted([*candidates, held], key=attrgetter("score"))


def _turned_steps(contest: Contest, candidates: list[Candidate]) -> Steps[list[Candidate]]:
    """Propose a body that looks the other way: turned half around from where most of it is left in place.

    Most bodies look the same way, so that what is in place is believed more; but a half turn is compared fairly only if
    it is registered as well.  Bodies that are much alike tell front from back themselves.
    """
    contested = candidates[0].score + _CONTESTED
    placed = [c for c in candidates if c.score <= contested and is_placed(c.in_place)]
    if contest.landmarks is not None or not placed or not is_less_alike(placed[0].likeness, MUCH_ALIKE):
        return candidates
    turned = yield from contest.follow.half_turned_steps(placed[0])
    return sorted([*candidates, turned], key=attrgetter("score"))


def _rolls_steps(contest: Contest, candidates: list[Candidate]) -> Steps[list[Candidate]]:
    """Propose long bodies turned back about their axes, and how else they might lie, for all that may be chosen."""
    chosen = contenders(contest, candidates)
    ways = list(chain.from_iterable((yield from contest.follow.rolled_back_steps(chosen))))
    if len(ways) == len(chosen) and all(map(is_, ways, chosen)):
        return candidates
    others = [candidate for candidate in candidates if not any(candidate is c for c in chosen)]
    return sorted([*ways, *others], key=lambda candidate: candidate.score)


PROPOSERS = (
    Proposer(_matchings_steps, LITTLE_RISE),
    Proposer(_limbs_steps, LITTLE_RISE),
    Proposer(_lost_limbs_steps, LITTLE_RISE),
    Proposer(_turned_steps, LITTLE_RISE),
    Proposer(_rolls_steps, RISE),
)
"""In the order in which they are asked: each may mend what those before it have proposed."""


def proposed_steps(contest: Contest, candidates: list[Candidate]) -> Steps[tuple[Contest, list[Candidate]]]:
    """Ask in turn all proposers by which the map may become right rather than not, and of use.

    Those by which it may not are put off: it may once others have been asked.

    Parameters
    ----------
    contest : Contest
        What is compared.
    candidates : list of Candidate
        What has been registered softly, the best first.

    Returns
    -------
    contest : Contest
        What is compared, now that more is known of what the maps leave in place.
    candidates : list of Candidate
        All of them, the best first.

    Raises
    ------
    MatchError
        If the surfaces are less alike than is asked for, whatever may be proposed.
    """
    wanted = max(EVEN, contest.least)
    pending = list(PROPOSERS)
    while True:
        contest.check(candidates, max((proposer.rise for proposer in pending), default=LITTLE_RISE))
        helpful = [proposer for proposer in pending if contest.may_reach(wanted, candidates, proposer.rise)]
        if not helpful:
            return contest, candidates
        done = part_of(len(PROPOSERS) - len(pending), len(PROPOSERS))
        candidates = yield from within(helpful[0].steps(contest, candidates), *done)
        contest, candidates = contest.credited(candidates)
        pending.remove(helpful[0])
