# SPDX-License-Identifier: GPL-3.0-or-later
"""Proposers: other registered maps than the best so far, each of what may be wrong with it.

A proposer gets what is known of a pair of surfaces and the candidates so far, the best first, and returns them with
what it proposes beside them or instead of them, the best first again.  All are compared by one score.  Another kind of
repair is another function in `PROPOSERS`.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from itertools import chain, compress
from operator import is_

import numpy as np

from ..geometry.best_distinct import best_distinct
from ..runtime.arrays import Floats
from ..runtime.progress import Steps, within
from ..shapes.landmarks import Landmarks
from .dense_hypotheses import USUAL, Selection, map_hypotheses_steps, unrefined_hypotheses_steps
from .landmark_selection import agrees
from .limb_sides import exchanged_limbs, repaired_start_steps
from .registered_hypotheses import Candidate, Follower

_CONTRADICTED = 4.0
"""Difference of scores up to which a map whose limbs are where they belong is preferred to one that exchanges them as
seen from both surfaces."""

_DISTINCT = 0.07
"""Mean distance, in sqrt(area), from which on two registrations are different maps."""

_ELSEWHERE, _LIMB = 0.15, 0.02
"""Or they are different maps if they take so large a part of the source so far, in sqrt(area), from each other."""

_LIKE = 0.04
"""Mean distance, in sqrt(area), up to which a rough map would lead to where another one already has."""


@dataclass(frozen=True, eq=False)
class Contest:
    """What is compared.

    Attributes
    ----------
    follow : Follower
        Registers what is proposed.
    landmarks : Landmarks or None
        What the maps have to agree with.
    selection : Selection
        Which maps are compared.
    """

    follow: Follower
    landmarks: Landmarks | None = None
    selection: Selection = USUAL


Proposer = Callable[[Contest, list[Candidate]], Steps[list[Candidate]]]


def are_distinct(first: Floats, second: Floats, areas: Floats) -> bool:
    """Say whether two registrations are different maps, as a whole or in where they take a limb.

    Parameters
    ----------
    first, second : (n, 3) array of float
        Where they take the vertices of the source, in units of the square root of the target's area.
    areas : (n,) array of float
        Areas of these vertices, in any unit.
    """
    apart = np.linalg.norm(first - second, axis=1)
    mean, elsewhere = np.average(np.stack([apart, apart > _ELSEWHERE]), axis=1, weights=areas)
    return bool(mean > _DISTINCT or elsewhere > _LIMB)


def contenders(contest: Contest, candidates: list[Candidate]) -> list[Candidate]:
    """Take the best candidate, and other maps that are nearly as credible."""
    selection, areas = contest.selection, contest.follow.source.mass
    close = [candidate for candidate in candidates if candidate.score <= candidates[0].score + selection.contested]

    def differ(candidate: Candidate, other: Candidate) -> bool:
        """Say whether the registrations of two candidates are different maps."""
        return are_distinct(candidate.registration.positions, other.registration.positions, areas)

    return best_distinct(close, differ, selection.most)


def _matchings_steps(contest: Contest, candidates: list[Candidate]) -> Steps[list[Candidate]]:
    """Propose matchings of extremities as they are, where the best candidate may be led astray by functional maps.

    Those are followed that would not lead to where a candidate is.
    """
    best, follow, landmarks = candidates[0].hypothesis, contest.follow, contest.landmarks
    if not best.is_doubtful:
        return candidates
    rough = yield from within(unrefined_hypotheses_steps(best.domains), 0.0, 0.25)
    hypotheses = [h for h in rough if landmarks is None or agrees(follow.x, follow.y, landmarks, h)]
    taken = [candidate.registration.positions for candidate in candidates]
    starts = [follow.start(hypothesis.images) for hypothesis in hypotheses]
    new = [all(follow.apart(start, positions) > _LIKE for positions in taken) for start in starts]
    followed = yield from within(follow.all_steps(list(compress(hypotheses, new))), 0.25, 1.0)
    for start, candidate in zip(compress(starts, new), followed, strict=True):
        if all(follow.apart(start, positions) > _LIKE for positions in taken):
            candidates = [*candidates, candidate]
            taken += [start, candidate.registration.positions]
    return sorted(candidates, key=lambda candidate: candidate.score)


def _limbs_steps(contest: Contest, candidates: list[Candidate]) -> Steps[list[Candidate]]:
    """Propose the best candidate anew if it exchanges limbs, with these put right, in its place if that is better."""
    follow, (best, *others) = contest.follow, candidates
    shapes, domains = (follow.x, follow.y), best.hypothesis.domains
    wrong = follow.vertex_maps(best.registration)
    start = yield from within(repaired_start_steps(*shapes, wrong), 0.0, 0.0)
    if start is None:
        return candidates
    hypotheses = yield from within(map_hypotheses_steps(*shapes, (start,), search=False, domains=domains), 0.0, 0.3)
    repaired = yield from within(follow.steps(hypotheses[0]), 0.3, 1.0)
    right = follow.vertex_maps(repaired.registration)
    # What exchanges the ends of limbs may fit a little better by all other measures.
    clear = all(exchanged_limbs(*shapes, wrong)) and not any(exchanged_limbs(*shapes, right))
    better = repaired.score < best.score + (_CONTRADICTED if clear else 0.0)
    return [repaired, *others] if better else candidates


def _rolls_steps(contest: Contest, candidates: list[Candidate]) -> Steps[list[Candidate]]:
    """Propose long bodies turned back about their axes, and how else they might lie, for all that may be chosen."""
    chosen = contenders(contest, candidates)
    ways = list(chain.from_iterable((yield from contest.follow.rolled_back_steps(chosen))))
    if len(ways) == len(chosen) and all(map(is_, ways, chosen)):
        return candidates
    others = [candidate for candidate in candidates if not any(candidate is c for c in chosen)]
    return sorted([*ways, *others], key=lambda candidate: candidate.score)


PROPOSERS: tuple[Proposer, ...] = (_matchings_steps, _limbs_steps, _rolls_steps)
"""In the order in which they are asked: each may mend what those before it have proposed."""
