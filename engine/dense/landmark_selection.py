# SPDX-License-Identifier: GPL-3.0-or-later
"""The choice between dense maps where landmarks are known: also a mirrored one, if they ask for it."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from functools import partial
from itertools import chain

import numpy as np

from ..runtime.progress import Steps, in_turn, within
from ..shapes.landmarks import Landmarks
from ..shapes.shape import Shape
from .dense_hypotheses import MapHypothesis, SparseStart, map_hypotheses_steps
from .laid_start import laid_start

_PENALTY = 20.0
"""What a map's score rises by for each sqrt(area) that the images of landmarks are from their partners."""

_AGREEING = 0.1
"""Mean distance up to which a map that was found without them agrees with landmarks: functional maps are that rough."""

_START_LANDMARKS = 3
"""So many landmarks and more are worth a start of their own."""

_MIRROR = 1.0
"""By how much a mirrored map has to be more credible: seen from outside, surfaces correspond without mirroring."""

_NEARER = 0.5
"""And how near it has to take landmarks to their partners, in units of how near others do.  Between bodies of other
proportions all rough maps are far off: without it, two of five matches of a knight with a large head, its hands and
feet given, were mirrored, see ``python -m tests.benchmarks.maker_rigs --guided``."""


@dataclass(frozen=True, eq=False)
class Steered:
    """Hypotheses that have been judged by landmarks.

    Attributes
    ----------
    x : Shape
        The source, or its reflection.
    mirrored : bool
        Whether it is the reflection.
    hypotheses : list of MapHypothesis
        Maps from x, the most credible first.
    """

    x: Shape
    mirrored: bool
    hypotheses: list[MapHypothesis]


def landmark_distance(x: Shape, y: Shape, landmarks: Landmarks, hypothesis: MapHypothesis) -> float:
    """Mean distance, in sqrt(area), between the images of landmarks and their partners, in both directions.

    The samples of the shapes begin with the landmarks.
    """
    numbers = np.arange(len(landmarks))
    there = y.samples.rows[numbers, hypothesis.images.on_y[landmarks.source.matched]]
    back = x.samples.rows[numbers, hypothesis.images.on_x[landmarks.target.matched]]
    return float((there + back).mean() / 2)


def agrees(x: Shape, y: Shape, landmarks: Landmarks, hypothesis: MapHypothesis) -> bool:
    """Say whether a map takes landmarks to their partners, as nearly as rough maps do.

    Parameters
    ----------
    x, y : Shape
        The surfaces; their samples begin with the landmarks.
    landmarks : Landmarks
        What is known.
    hypothesis : MapHypothesis
        The map.

    Returns
    -------
    bool
        Whether `landmark_distance` is small.
    """
    return landmark_distance(x, y, landmarks, hypothesis) <= _AGREEING


def steered_hypotheses_steps(
    x: Shape, y: Shape, starts: Sequence[SparseStart], landmarks: Landmarks, *, search: bool = True
) -> Steps[Steered]:
    """Propose dense maps between two surfaces that agree with landmarks, most credible first.

    If the map that is most credible without the landmarks agrees with them, they only correct the ranking.  Otherwise
    maps of the source's reflection are compared as well, each orientation by what is known of the surfaces and how
    well it agrees; so on a symmetric body a single landmark on the wrong side makes the map a mirrored one.

    Parameters
    ----------
    x, y : Shape
        The surfaces, as for `map_hypotheses_steps`; their samples begin with the landmarks.
    starts : sequence of SparseStart
        Correspondences from elsewhere that enter the comparison.
    landmarks : Landmarks
        What is known.
    search : bool
        Whether matchings of extremities are tried as well.

    Returns
    -------
    Steered
        Hypotheses with the source or its reflection, their scores raised by what contradicts the landmarks.
    """
    own = _starts(x, y, len(landmarks))
    hypotheses = yield from within(map_hypotheses_steps(x, y, [*starts, *own], search=search), 0.0, 0.4)
    natural = _natural(hypotheses) or hypotheses[0]
    direct = _judged(x, y, landmarks, hypotheses)
    if agrees(x, y, landmarks, natural):
        return Steered(x, mirrored=False, hypotheses=direct)
    direct = yield from within(_completed_steps(x, y, [*starts, *own], landmarks, direct), 0.4, 0.5)
    if landmarks.assumed:  # what is not known asks for no mirroring
        return Steered(x, mirrored=False, hypotheses=direct)
    reflection = x.reflected()
    starts = [*starts, *_starts(reflection, y, len(landmarks))]
    found = yield from within(map_hypotheses_steps(reflection, y, starts, search=search), 0.5, 0.9)
    mirrored = _judged(reflection, y, landmarks, found)
    mirrored = yield from within(_completed_steps(reflection, y, starts, landmarks, mirrored), 0.9, 1.0)
    best, other = _natural(direct), _natural(mirrored)
    if other is not None and (best is None or _ask_for_mirrored((x, best), (reflection, other), y, landmarks)):
        return Steered(reflection, mirrored=True, hypotheses=mirrored)
    return Steered(x, mirrored=False, hypotheses=direct)


def _starts(x: Shape, y: Shape, count: int) -> list[SparseStart]:
    """Start from landmarks, if there are enough: as they are, and with what lies on each other where they coincide."""
    if count < _START_LANDMARKS:
        return []
    return [SparseStart(x.samples.rows[:count], y.samples.rows[:count], "landmarks"), laid_start(x, y, count)]


def _completed_steps(
    x: Shape, y: Shape, starts: Sequence[SparseStart], landmarks: Landmarks, judged: list[MapHypothesis]
) -> Steps[list[MapHypothesis]]:
    """Add what comes of the starts alone, unless there is a map that keeps the orientation and agrees.

    Without the landmarks it may have been too poor to be kept beside the others.
    """
    if any(h.orientation > 0 and agrees(x, y, landmarks, h) for h in judged):
        return judged
    propose = partial(map_hypotheses_steps, x, y, search=False, domains=judged[0].domains)
    more = chain.from_iterable((yield from in_turn(propose([start]) for start in starts)))
    return sorted(judged + _judged(x, y, landmarks, more), key=lambda h: h.score)


def _judged(x: Shape, y: Shape, landmarks: Landmarks, hypotheses: Iterable[MapHypothesis]) -> list[MapHypothesis]:
    judged = [replace(h, score=h.score + _PENALTY * landmark_distance(x, y, landmarks, h)) for h in hypotheses]
    return sorted(judged, key=lambda h: h.score)


def _natural(hypotheses: list[MapHypothesis]) -> MapHypothesis | None:
    """Return the most credible map that keeps the orientation, if there is one; they are sorted."""
    return next((h for h in hypotheses if h.orientation > 0), None)


def _ask_for_mirrored(
    direct: tuple[Shape, MapHypothesis], mirrored: tuple[Shape, MapHypothesis], y: Shape, landmarks: Landmarks
) -> bool:
    """Say whether landmarks ask for a mirrored map: it is more credible, and they speak clearly for it."""
    near, far = (landmark_distance(x, y, landmarks, hypothesis) for x, hypothesis in (mirrored, direct))
    return mirrored[1].score + _MIRROR < direct[1].score and near <= _NEARER * far
