# SPDX-License-Identifier: GPL-3.0-or-later
r"""Credibility of maps: the score that they are compared by, and the probabilities that every decision is made by.

The score of a map between samples is a weighted sum of the logarithms of its terms :math:`t_k`, see `map_energies`,

.. math:: s = \sum_k w_k \log t_k,

and that of a registered map adds :math:`4 \sum \log g` for the gaps g that are left between the surfaces, from either
side.  Smaller is more credible.  These scores compare maps of one pair of surfaces.  How much alike the surfaces are,
whatever the other maps, says the *likeness* of the best one: by its score before it was registered, and by what the
deformation costs that lays one surface onto the other, E, see `Registration.cost`,

.. math:: \ell = -s - 4 \log E.

From the likeness follows how probable it is that the map as a whole is right, by a logistic function; and so from what
it leaves in place, see `probability_in_place`, which also makes its score smaller.  The constants of the first
were chosen by hand; ``python -m tests.benchmarks.calibration`` compares them with a fit [1]_ on pairs whose truth is
known, which so far says less than they do.

References
----------
.. [1] J. Platt, "Probabilistic outputs for support vector machines and comparisons to regularized likelihood methods",
   Advances in Large Margin Classifiers, 1999.
"""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from scipy.special import expit, logit

from ..runtime.arrays import TINY

_WEIGHTS = {"bijectivity": 0.25, "curvature": 1.0, "distances": 0.25, "rigidity": 3.0, "waves": 0.5}
"""Of the logarithms of the terms of a map.  Rigidity is the strongest cue against half turns; in distances and spectra
these are hardly worse than the truth."""

_LEAST_TERM = 1e-6
"""Terms that are smaller are all the same."""

_GAP_WEIGHT, _LEAST_GAP = 4.0, 1e-4
"""Weight of the logarithm of a gap between registered surfaces, and the gap, in sqrt(area), below which all are the
same."""

_ELASTIC_WEIGHT = 4.0
"""Weight of the logarithm of what a deformation costs."""

_RIGHT, _RIGHT_SPREAD = 13.5, 0.6
"""Likeness of surfaces that are matched wrongly as often as not, and by how much more or less it decides: cats, people
and octopuses are matched to one another at 9 to 13, gorillas to men at 14 to 17, two persons at 20 to 30."""

_CLOSE, _CLOSE_SPREAD, _LEAST_CLOSENESS = 15.0, 1.4, 0.3
"""Likeness of surfaces of which half of what the maps agree on is as close to the truth as it seems, by how much more
or less it changes, and what is left for surfaces that are not alike at all.  Both maps may slide the same way."""

_EITHER, _CLEARER = 0.5, 1.0
"""Probability that the better of two maps with the same score is right, and the difference of scores by which the rest
falls to 1/e."""

_IN_PLACE, _IN_PLACE_SPREAD = 0.75, 0.05
"""Agreement in place, see `agreement_in_place`, of a map of closed surfaces that is right as often as not because of
that alone, and by how much more or less it decides: chosen by hand well above what wrong maps have; of eight pairs,
wrong ones have -0.18 to 0.09 and right ones, poses and turns included, 0.09 to 0.95, see
``python -m tests.benchmarks.standing --pairs 8``."""

_OTHERWISE = 0.9
"""Probability up to which a map counts as one that leaves all in place if it does so after a half turn: chosen by hand,
as if one character in ten looked the other way, such as those made for VRM 0."""

_CLEAR = 0.816
"""Probability that the better of two maps is right from which on the choice was clear: scores that differ by one."""

DOUBTFUL = 0.3
"""Confidence of a whole map below which it is not trusted unless the user wants it: chosen by hand, as more of such
maps is wrong than right."""

_UNCERTAIN = 0.35
"""The same below which one of two whole bodies may be a part that was closed: a half that is laid onto all of one has
0.32 on one processor, where a test of ``partial_match`` failed with `DOUBTFUL` that passes on others."""

_LEAST_CREDIBILITY = 0.1
"""What vertices of a map that is surely wrong are still trusted: none at all are those without a partner."""


def least_likeness(probability: float) -> float:
    """Likeness at which maps are right with a probability: below, none has more confidence than that."""
    return float(_RIGHT + _RIGHT_SPREAD * logit(probability))


def _alike_closely(part: float) -> float:
    """Likeness at which a part of what maps agree on is as near to the truth as it seems."""
    return float(_CLOSE + _CLOSE_SPREAD * logit((part - _LEAST_CLOSENESS) / (1 - _LEAST_CLOSENESS)))


EVEN = least_likeness(0.5)
"""Likeness from which on a map is right rather than not."""

CREDIBLE = least_likeness(0.965)
"""Likeness below which a map is doubtful: from here on, one in thirty is wrong."""

MUCH_ALIKE = _alike_closely(0.981)
"""Likeness of surfaces that are whole bodies, whatever else there is: two in a hundred places are not where they seem
to be."""

ALL_ALIKE = _alike_closely(0.99945)
"""Likeness of surfaces that are one body in two poses, by which nothing can be missing."""


RISE, LITTLE_RISE = 4.0, 1.0
"""By how much the likeness of surfaces that have been registered softly may rise where long bodies are turned back, and
by all else that is done: of eight pairs of characters it rose by 0.9 at most, of fuzzed shapes by 3.7; of the pairs of
``ablation`` and ``small_shapes``, tried once, by 2.8 where bodies were turned back, and by 0.7 else."""


PLACED_ROUGHLY = float(expit(-0.1 / _IN_PLACE_SPREAD))
"""Probability from which on what is in place may decide once other matchings have been followed: an agreement that is
0.1 below what is right as often as not.  Lower, more is tried in vain for surfaces with nothing in common."""


def map_score(terms: Mapping[str, float]) -> float:
    """Score a map between samples by its terms: smaller is more credible."""
    return float(sum(weight * np.log(max(terms[name], _LEAST_TERM)) for name, weight in _WEIGHTS.items()))


def probability_in_place(agreement: float) -> float:
    """Estimate how probably a map of closed surfaces is right because it leaves everything where it stands, 0 to 1.

    Characters mostly stand upright and look the same way; that a wrong map keeps above what is above, and left, and in
    front, is rare.
    """
    return float(expit((agreement - _IN_PLACE) / _IN_PLACE_SPREAD))


def place_credit(in_place: float) -> float:
    """By how much a score is smaller because of what is in place, so probably: one divides the chances by e."""
    return -_CLEARER * float(np.log1p(-in_place))


def probability_turned(agreement: float, standing: float) -> float:
    """Estimate how probably a map is right because it leaves everything in place after a half turn, 0 to 1.

    Most wrong maps are half turns.  So this counts no more than the probability that any map has by what it leaves
    `standing`: it takes away from what that says, but says nothing by itself.
    """
    return min(_OTHERWISE * probability_in_place(agreement), standing)


def registered_score(score: float, gaps: tuple[float, float], credit: float = 0.0) -> float:
    """Score a registered map by the `map_score` of where it leads, and the two gaps, in sqrt(area), that are left.

    What the map leaves in place counts as well, see `place_credit`.

    A rough map errs here and there, be it right or wrong as a whole; registered, it shows what it leads to.  The true
    one may take more deforming than a wrong one where proportions differ, but the surfaces meet closer.
    """
    return score + _GAP_WEIGHT * float(np.log(np.maximum(gaps, _LEAST_GAP)).sum()) - credit


def likeness(score: float, energy: float) -> float:
    """How much alike surfaces are if a map is right, by its `map_score` and what the deformation costs."""
    return -(score + _ELASTIC_WEIGHT * float(np.log(max(energy, TINY))))


def is_less_alike(known: float | None, least: float) -> bool:
    """Say whether surfaces are less alike than that; where landmarks are known, their likeness is not (None)."""
    return known is not None and known < least


def probability_right(known: float | None, in_place: float = 0.0) -> float:
    """Estimate how many maps of surfaces so much alike are right as a whole, 0 to 1, be it that or what is in place."""
    if known is None:
        return 1.0
    return 1 - (1 - in_place) * (1 - float(expit((known - _RIGHT) / _RIGHT_SPREAD)))


def is_likely(known: float | None, in_place: float = 0.0) -> bool:
    """Say whether a map is right rather than not, see `probability_right`."""
    return probability_right(known, in_place) >= 0.5


def is_placed(in_place: float) -> bool:
    """Say whether a map is right rather than not by what it leaves in place alone."""
    return is_likely(-np.inf, in_place)


def has_failed(known: float | None, confidence: float) -> bool:
    """Say whether a map of whole bodies is hardly trusted, so that one of them may be a part that was closed.

    However much alike they seem: half a body may be laid onto all of it, and stand where it does.
    """
    return known is not None and confidence < _UNCERTAIN


def may_reach(least: float, known: float, in_place: float, rise: float = RISE) -> bool:
    """Say whether a map that has been registered may still lead to one of so much likeness, if that rises so far.

    What is in place may be right rather than not whatever the likeness, but says nothing of more.  What may not reach
    what it has to is followed no further: this decides about every attempt that costs as much as a registration.
    """
    return known + rise >= least or (least <= EVEN and in_place >= PLACED_ROUGHLY)


def closeness(known: float | None) -> float:
    """Estimate the part of what both maps agree on that is as near to the truth as it seems, 0 to 1."""
    if known is None:
        return 1.0
    return _LEAST_CLOSENESS + (1 - _LEAST_CLOSENESS) * float(expit((known - _CLOSE) / _CLOSE_SPREAD))


def probability_chosen(margin: float | None) -> float:
    """Estimate how often the best of several maps is the right one, 0 to 1.

    Parameters
    ----------
    margin : float or None
        By how much the score of the second is larger; None if there was no other.
    """
    return 1.0 if margin is None else 1 - (1 - _EITHER) * float(np.exp(-margin / _CLEARER))


def is_clear_choice(margin: float | None) -> bool:
    """Say whether the choice of the best of several maps was clear, see `probability_chosen`."""
    return probability_chosen(margin) >= _CLEAR


def vertex_credibility(orientation: float, margin: float | None, known: float | None, in_place: float = 0.0) -> float:
    """Estimate the part of vertices, of those whose two images agree, that are where they seem to be, 0.1 to 1.

    Parameters
    ----------
    orientation : float
        Part of the area on which the map keeps left on the left, minus the part on which it mirrors.
    margin : float or None
        By how much the score of the second best map is larger.
    known : float or None
        The likeness.
    in_place : float
        How probably the map is right because it leaves everything where it stands.
    """
    whole = max(orientation, 0.0) * probability_chosen(margin) * probability_right(known, in_place)
    # Closeness was measured on wrong maps, too: the product would count these twice.
    return max(min(closeness(known), whole), _LEAST_CREDIBILITY)
