# SPDX-License-Identifier: GPL-3.0-or-later
"""Matching of bodies that consist of pieces: piece by piece, or all pieces of a body as one surface."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from ..dense.credibility import EVEN, MUCH_ALIKE, is_likely
from ..runtime.arrays import Bools
from ..runtime.errors import MatchError
from ..runtime.progress import Steps, within
from ..shapes.borders import has_border
from ..shapes.enclosing_surface import both_joined_steps
from ..shapes.landmarks import landmark_pairs
from ..shapes.shape import Shape
from .pieced_body import PiecedBody, common_cut, resized_share, torn_share, without_partner
from .result import MatchResult
from .shape_matching import MatchTask, matched_steps

_ALIKE = 0.95
"""Part of bodies that is common to their largest pieces, and so on, from which on they are cut alike: each piece may go
with one of the other.  Of nine characters no two have more than 0.93, and one in two poses has 1; `modular --both`
gives the same with it as if pieces were tried first."""

_ALL_BUT_HANDS = 0.9
"""Part of a body that its main part has if that may be all of it, and what the other has beside its own is no body."""

_TOGETHER, _MORE = 0.955, 0.02
"""Part of the bodies from which on pieces go with one another, and how much more has to if bodies are joined."""

_TORN = 0.2
"""Part of a body in pieces that are torn off from which on pieces were taken for others."""

_ALL = 0.99
"""Part of the main parts with a partner from which on these are whole bodies, if they are `MUCH_ALIKE`."""

_FIRST, _JOINED = 0.4, 0.1
"""Parts of the work that are done when pieces are matched one by one, and that joining those of both bodies takes."""


def has_limbs(x: Shape, y: Shape) -> bool:
    """Say whether either of two bodies has limbs that are pieces of their own."""
    return any(bool(shape.surface.cleaned.limbs.any()) for shape in (x, y))


def matched_with_pieces_steps(x: Shape, y: Shape, task: MatchTask) -> Steps[tuple[MatchResult, Shape, Shape]]:
    """Match two bodies piece by piece, or where the pieces do not go with one another, all of a body as one surface.

    A head, hands or a forearm may be pieces of their own.  If both bodies are cut alike, each piece goes with one.
    Else one may be cut elsewhere, or not at all: then one surface around all its pieces is matched.

    Parameters
    ----------
    x, y : Shape
        The source and the target.
    task : MatchTask
        What is wanted.

    Returns
    -------
    result : MatchResult
        The more credible one.
    x, y : Shape
        What was matched.

    Raises
    ------
    MatchError
        If landmarks are at fault, or neither the main parts nor the joined bodies can be matched.
    """
    landmark_pairs(x, y, task.landmarks, task.settings.points)  # what is wrong with them is wrong for every part
    limbs = x.surface.cleaned.limbs, y.surface.cleaned.limbs
    if not (limbs[0].any() or limbs[1].any()):
        return (yield from matched_steps(x, y, task)), x, y
    bodies = _body(x, limbs[0]), _body(y, limbs[1])
    first, together = None, 0.0
    alike = common_cut(*bodies) >= _ALIKE
    main = [float(body.shares[0]) for body in bodies]
    # Without its limbs, a trunk is open; what is closed may be all of a body, and the rest what it stands on.
    if alike or (max(main) >= _ALL_BUT_HANDS and not has_border(y if main[0] > main[1] else x)):
        # What is not right rather than not by its main parts is better joined first.
        first = yield from within(_tried_steps(x, y, replace(task, least_softly=EVEN)), 0.0, _FIRST)
        together = 0.0 if first is None else _together_but_for_extras(first, bodies)
        if first is not None and together >= _TOGETHER and (alike or _is_clear(first)):
            return first, x, y
    begin = _FIRST + _JOINED
    joined = yield from within(both_joined_steps(x, y), _FIRST, begin)
    task.clock.lap("joining pieces")
    end = 1.0 if first is not None else (1 + begin) / 2
    second = None
    if joined[0] is not x or joined[1] is not y:
        least = -np.inf if first is None else min(_likeness(first), EVEN)
        second = yield from within(
            _tried_steps(joined[0], joined[1], replace(task, least=max(task.least, least))), begin, end
        )
    if second is None:
        # If bodies as a whole cannot be matched either, their main parts say why; but landmarks may be on any part.
        if first is None and task.landmarks is not None:
            x, y = joined
        return first or (yield from within(matched_steps(x, y, task), end, 1.0)), x, y
    if first is None and not (_is_plausible(second) and _covered(second) >= _TOGETHER):
        # What hangs on one body alone is better left alone, as clothes are here.
        task = replace(task, least_softly=min(_likeness(second), EVEN))
        first = yield from within(_tried_steps(x, y, task), end, 1.0)
    if first is not None and not alike and (together < _TOGETHER or _likeness(first) < _likeness(second)):
        together = min(_together(first, bodies), _partnered(first))
    if first is None or _is_better(second, first, together):
        return second, joined[0], joined[1]
    return first, x, y


def _tried_steps(x: Shape, y: Shape, task: MatchTask) -> Steps[MatchResult | None]:
    """Match two surfaces; None if they cannot be."""
    try:
        return (yield from matched_steps(x, y, task))
    except MatchError:
        return None


def _together_but_for_extras(result: MatchResult, bodies: tuple[PiecedBody, PiecedBody]) -> float:
    """Tell what part of two bodies goes together, without what only one of them has, such as a bag.

    If both have pieces without a partner, they are cut elsewhere.
    """
    dense = result.dense
    lonely = without_partner(*bodies, dense.source_to_target), without_partner(*bodies[::-1], dense.target_to_source)
    alone = min(float(body.shares[pieces].sum()) for body, pieces in zip(bodies, lonely, strict=True))
    return (1 - alone) * _together(result, (bodies[0].without(lonely[0]), bodies[1].without(lonely[1])))


def _together(result: MatchResult, bodies: tuple[PiecedBody, PiecedBody]) -> float:
    """Tell what part of two bodies has a partner that fits to the partners of what is around it."""
    there, back = result.dense.source_to_target, result.dense.target_to_source
    torn = max(torn_share(*bodies, there), torn_share(*bodies[::-1], back))
    resized = max(resized_share(*bodies, there), resized_share(*bodies[::-1], back))
    return min(_covered(result), 1 - resized) * (1 - torn if torn > _TORN else 1.0)


def _partnered(result: MatchResult) -> float:
    """Tell what part of two bodies has a partner."""
    return _covered(result) * (1 - result.dense.quality.pieces_alone)


def _covered(result: MatchResult) -> float:
    """Tell what part of the surfaces that were matched has a partner."""
    quality = result.dense.quality
    return min(quality.coverage, quality.source_coverage)


def _body(shape: Shape, limbs: Bools) -> PiecedBody:
    """Take what of a mesh is of the main part, or of limbs (n,)."""
    parts = shape.surface.cleaned.vertex_parts
    return PiecedBody(shape.original, np.where(limbs | (parts == 0), parts, -1))


def _likeness(result: MatchResult) -> float:
    """How credible a match is; with landmarks, it is said to be."""
    known = result.dense.quality.likeness
    return np.inf if known is None else known


def _is_plausible(result: MatchResult) -> bool:
    """Say whether bodies seem to be matched rightly."""
    quality = result.dense.quality
    return is_likely(quality.likeness, quality.in_place)


def _is_clear(result: MatchResult) -> bool:
    """Say whether all of the main parts is alike: nothing is missing on them."""
    return _covered(result) >= _ALL and _likeness(result) >= MUCH_ALIKE


def _is_better(joined: MatchResult, pieces: MatchResult, together: float) -> bool:
    """Say whether a match of joined bodies is more credible than one by pieces, so much of which goes together."""
    if _is_plausible(joined) and not _is_plausible(pieces):
        return True
    if _partnered(joined) <= together + _MORE:
        return False
    return _is_plausible(joined) or _likeness(pieces) < _likeness(joined)
