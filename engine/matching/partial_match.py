# SPDX-License-Identifier: GPL-3.0-or-later
"""Matching of two surfaces one of which shows only a part of the other."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import ArrayLike

from ..dense.components.masked_maps import share_of, with_pieces_only
from ..dense.credibility import ALL_ALIKE, CREDIBLE, EVEN, MUCH_ALIKE, has_failed, is_less_alike
from ..runtime.arrays import Bools, marked
from ..runtime.errors import MatchError
from ..runtime.progress import Steps, part_of, within
from ..shapes.borders import has_border
from ..shapes.enclosing_surface import with_limbs_steps
from ..shapes.shape import Shape
from .covered_parts import CoveredPart, continued, covered_parts_steps
from .result import MatchResult
from .shape_matching import MatchTask, matched_steps

_MISSING = 0.95
"""Part of either surface with a partner from which on what is missing does not matter: the size hardly differs."""

_COVERED = 0.98
"""Part of the part with a partner from which on a piece is large enough."""

_WHOLE = 0.985
"""Part of a surface from which on what is covered of it is all."""

_MISSED = 15.0
"""How much likeness all of a part without a partner would outweigh."""

_LACKING = 0.04
"""Part of a piece that was found otherwise that a known match may leave without a partner, and still be taken for as
good: what a piece lacks makes a match worse, and what it has more does not.  Chosen by `partial_pairs`."""

_MOST = 2
"""Pieces of the surfaces that the match is done with at most, to choose between them."""

_ROUNDS = 2
"""How often: a piece that turns out too small grows, and one that turns out too large shrinks."""

_TOO_LARGE = 0.1
"""Part of a piece without a partner from which on it is too large: it is seen too small beside the part, and too little
like it.  Chosen by `partial_pairs`."""

_BEGUN, _FOUND = 0.15, 0.45
"""Parts of the work after which the piece is matched that is known already, and other pieces are known."""


def part_matched_steps(
    result: MatchResult, x: Shape, y: Shape, task: MatchTask, *, is_sure: bool = False
) -> Steps[MatchResult]:
    """Match anew with only that of one surface which the other shows, if something seems to be missing.

    If all of the part has a partner by what is known, what that covers is tried first.  That is enough if it is clear,
    or if a search that does not need what is known leads to the same.

    Parameters
    ----------
    result : MatchResult
        What comes of the surfaces as they are.
    x, y : Shape
        The source and the target.
    task : MatchTask
        What is wanted.
    is_sure : bool
        Whether it is known otherwise that this is the right map, so that less likeness is enough.

    Returns
    -------
    MatchResult
        The more credible one.  If that is the new one, what was left out follows what is around it, without any
        confidence, and counts as not covered in `quality`.
    """
    quality, maps = result.dense.quality, (result.dense.source_to_target, result.dense.target_to_source)
    parts = has_border(x), has_border(y)
    if not any(parts) and not has_failed(quality.likeness, quality.confidence):
        return result
    if not is_less_alike(quality.likeness, CREDIBLE) and min(quality.coverage, quality.source_coverage) >= _MISSING:
        return result
    # What was cut off may have been closed; then nothing says which of them is the part.
    ways = [(x, y, maps)] if parts[1] or not any(parts) else []
    ways += [(y, x, maps[::-1])] if parts[0] or not any(parts) else []
    closer: dict[bool, MatchResult] = {}
    for of_source in [whole is x for whole, *_ in ways]:
        # With landmarks nothing says how much alike a piece is.
        if task.landmarks is None and shows_all_of_part(result, of_source=of_source):
            steps = known_piece_matched_steps(result, x, y, task, of_source=of_source)
            closer[of_source] = yield from within(steps, 0.0, _BEGUN)
            if is_clear(closer[of_source], result, of_source=of_source, is_sure=is_sure):
                return closer[of_source]
    # Of a closed body, some piece is always more like a ball than all of it.
    least = CREDIBLE if any(parts) else MUCH_ALIKE
    found = []
    for number, (whole, part, known) in enumerate(ways):
        needed = _needed(result, least, of_source=whole is x)
        searching = covered_parts_steps(whole, part, known, needed)
        pieces = yield from within(searching, *part_of(number, len(ways), _BEGUN, _FOUND), "Looking for missing parts")
        found += [(piece, whole is x) for piece in pieces]
    found.sort(key=lambda pair: pair[0].score)
    task.clock.lap("missing parts")
    if found:
        piece, of_source = found[0]
        if of_source in closer and _is_shown(piece, closer[of_source], result, (x, y), of_source=of_source):
            return closer[of_source]
    return (yield from within(_best_piece_steps(result, x, y, task, found[:_MOST], least=least), _FOUND, 1.0))


def agreed_part_steps(
    known: MatchResult, closer: MatchResult, x: Shape, y: Shape, task: MatchTask, *, of_source: bool
) -> Steps[tuple[MatchResult, bool]]:
    """Match with what of one surface the other shows, by a search that does not need what is known of that already.

    Parameters
    ----------
    known, closer : MatchResult
        A match with a piece of one surface, and what came of that as a start, see `known_piece_matched_steps`.
    x, y : Shape
        The source and the target.
    task : MatchTask
        What is wanted.
    of_source : bool
        Which surface the other one shows a part of: `x`, or else `y`.

    Returns
    -------
    result : MatchResult
        The most credible match, the known one among them.
    agrees : bool
        Whether the search leads to where that does: then it was followed, and nothing else.
    """
    dense = known.dense
    maps = dense.source_to_target, dense.target_to_source
    ends = (x, y, maps) if of_source else (y, x, maps[::-1])
    searching = covered_parts_steps(*ends, _needed(known, CREDIBLE, of_source=of_source))
    pieces = yield from within(searching, 0.0, _FOUND, "Looking for missing parts")
    task.clock.lap("missing parts")
    agrees = bool(pieces) and not pieces[0].is_new
    if agrees and _is_shown(pieces[0], closer, known, (x, y), of_source=of_source):
        return closer, True
    task = replace(task, begun=known.source_to_target) if agrees else task
    found = [(piece, of_source) for piece in pieces[: 1 if agrees else _MOST]]
    return (yield from within(_best_piece_steps(known, x, y, task, found, least=CREDIBLE), _FOUND, 1.0)), agrees


def _is_shown(
    piece: CoveredPart, closer: MatchResult, known: MatchResult, shapes: tuple[Shape, Shape], *, of_source: bool
) -> bool:
    """Say whether what was made of a known match is clear, as a search leads there as well, and shows all it found."""
    if piece.is_new or not is_clear(closer, known, of_source=of_source, is_sure=True):
        return False
    areas = (shapes[0] if of_source else shapes[1]).mesh.vertex_areas * piece.covered
    return float(areas @ ~piece_with_partner(closer, *shapes, of_source=of_source)) <= _LACKING * float(areas.sum())


def _best_piece_steps(
    result: MatchResult, x: Shape, y: Shape, task: MatchTask, pieces: list[tuple[CoveredPart, bool]], *, least: float
) -> Steps[MatchResult]:
    """Match with pieces, each of the source or else of the target, until one fits like one body in two poses."""
    for number, (piece, of_source) in enumerate(pieces):
        matching = piece_matched_steps(result, x, y, task, piece.covered, of_source=of_source, least=least)
        result = yield from within(matching, *part_of(number, len(pieces)))
        if is_as_alike(result, ALL_ALIKE):
            break
    return result


def known_piece_matched_steps(
    known: MatchResult, x: Shape, y: Shape, task: MatchTask, *, of_source: bool
) -> Steps[MatchResult]:
    """Match with only that of one surface which has a partner by a known match, beginning with that match.

    See `piece_matched_steps`.
    """
    piece, begun = piece_with_partner(known, x, y, of_source=of_source), replace(task, begun=known.source_to_target)
    return (yield from piece_matched_steps(known, x, y, begun, piece, of_source=of_source))


def piece_with_partner(known: MatchResult, x: Shape, y: Shape, *, of_source: bool) -> Bools:
    """Tell which vertices (n,) of the source, or else of the target, have a partner by a match."""
    whole, shown = (x, known.dense.source_to_target) if of_source else (y, known.dense.target_to_source)
    return shown.has_partner[whole.vertices]


def piece_matched_steps(
    result: MatchResult, x: Shape, y: Shape, task: MatchTask, piece: Bools, *, of_source: bool, least: float = CREDIBLE
) -> Steps[MatchResult]:
    """Match with only a piece of one surface, and with more of it where the other goes on beyond.

    Parameters
    ----------
    result : MatchResult
        What is known so far.
    x, y : Shape
        The source and the target.
    task : MatchTask
        What is wanted.
    piece : (n,) array of bool
        Vertices of the surface that is to be cut down: of `x` if `of_source`, else of `y`.
    of_source : bool
        Which surface that is.
    least : float
        Likeness that a match with a piece needs to be taken.

    Returns
    -------
    MatchResult
        The most credible match, the given one among them.
    """
    for again in range(_ROUNDS):
        way = _Way(x, y, of_source, replace(task, least=_needed(result, least, of_source=of_source)))
        other = yield from within(way.matched_steps(piece), *part_of(again, _ROUNDS))
        if other is None or is_less_alike(other.dense.quality.likeness, EVEN):
            break
        if is_better_part(other, result, least, of_source=of_source):
            # Its notes would speak of openings where a piece was cut out.
            result = replace(other, notes=result.notes)
        better = way.better_piece(other, piece)
        if better is None:
            break
        piece = better
    return result


@dataclass(frozen=True, eq=False)
class _Way:
    """Matches only a piece of the source with the target, or the source with only a piece of the target."""

    x: Shape
    y: Shape
    of_source: bool
    task: MatchTask

    def matched_steps(self, piece: Bools) -> Steps[MatchResult | None]:
        """Match with some vertices (n,) of a surface only; None if these are all of it, or cannot be matched."""
        whole = self.x if self.of_source else self.y
        covered = whole.surface.spread(piece.astype(np.float64), 1.0) > 1 / 2
        if share_of(whole.original, covered) > _WHOLE or _misses(
            covered, self.task.landmarks, 0 if self.of_source else 1
        ):
            return None
        try:
            cut = yield from within(_cut_steps(whole, covered, "source" if self.of_source else "target"), 0.0, 0.1)
            shapes = (cut, self.y) if self.of_source else (self.x, cut)
            result = yield from within(matched_steps(*shapes, self.task), 0.1, 1.0)
        except MatchError:  # what is left is too small for so many points
            return None
        pieces = (covered, None) if self.of_source else (None, covered)
        return result.with_dense(with_pieces_only(result.dense, (self.x.original, self.y.original), pieces))

    def better_piece(self, result: MatchResult, piece: Bools) -> Bools | None:
        """Tell what of a surface would be a better piece than one (n,), by what has no partner; None if that is right.

        It is without that if that is much, and goes on where the part hangs over.
        """
        whole, part = (self.x, self.y) if self.of_source else (self.y, self.x)
        shown = piece_with_partner(result, self.x, self.y, of_source=self.of_source)
        areas = whole.mesh.vertex_areas
        is_too_large = float(areas @ (piece & ~shown)) > _TOO_LARGE * float(areas @ piece)
        kept = shown if is_too_large else piece
        if shows_all_of_part(result, of_source=self.of_source):
            return kept if is_too_large else None
        back = result.dense.target_to_source if self.of_source else result.dense.source_to_target
        alone = back.confidence[part.vertices] == 0
        unit = np.sqrt(float(areas @ piece) / part.mesh.area)
        return kept | continued(whole, part, back.positions[part.vertices], alone, unit)


def _misses(covered: Bools, landmarks: ArrayLike | None, column: int) -> bool:
    """Say whether a landmark lies outside of what is covered, (n,)."""
    return landmarks is not None and not covered[np.reshape(landmarks, (-1, 2))[:, column]].all()


def _cut_steps(shape: Shape, covered: Bools, name: str) -> Steps[Shape]:
    """Make the shape of what is covered of a mesh, (n,), without what was left out before."""
    mesh, kept = shape.original, shape.surface.kept_triangles
    excluded = ~covered
    if len(kept) < mesh.triangle_count:
        excluded |= ~marked(mesh.triangles[kept], mesh.vertex_count)
    cut = yield from within(Shape.steps(mesh, name, excluded=excluded), 0.0, 0.7)
    if shape.surface.cleaned.stand_in is None:
        return cut
    return (yield from within(with_limbs_steps(cut, name, np.arange(mesh.vertex_count)), 0.7, 1.0))


def _needed(result: MatchResult, least: float, *, of_source: bool) -> float:
    """Tell the likeness below which no match with a piece is better than a result, see `is_better_part`."""
    if result.dense.quality.likeness is None:
        return least
    return max(least, part_credibility(result, of_source=of_source))


def is_better_part(other: MatchResult, result: MatchResult, least: float, *, of_source: bool) -> bool:
    """Say whether a match with less of a surface is more credible than that with more of it, and credible enough."""
    if is_less_alike(other.dense.quality.likeness, least):
        return False
    return part_credibility(other, of_source=of_source) > part_credibility(result, of_source=of_source)


def shows_all_of_part(result: MatchResult, *, of_source: bool) -> bool:
    """Say whether all of the part has a partner: all of the target, if the source is cut down, and the other way."""
    quality = result.dense.quality
    return (quality.coverage if of_source else quality.source_coverage) >= _COVERED


def is_clear(result: MatchResult, known: MatchResult, *, of_source: bool, is_sure: bool) -> bool:
    """Say whether a match is new, and all of the part so much like the piece that nothing else is worth trying.

    Less likeness is enough if something else says as well that the piece is the right one.
    """
    enough = MUCH_ALIKE if is_sure else ALL_ALIKE
    return result is not known and shows_all_of_part(result, of_source=of_source) and is_as_alike(result, enough)


def is_as_alike(result: MatchResult, enough: float) -> bool:
    """Say whether what is matched is so much alike that nothing else is worth trying."""
    return not is_less_alike(result.dense.quality.likeness, enough)


def part_credibility(result: MatchResult, *, of_source: bool) -> float:
    """Compare matches with a part: larger is more credible; all of it should have a partner."""
    quality = result.dense.quality
    missed = 1 - (quality.coverage if of_source else quality.source_coverage)
    if quality.likeness is None:  # landmarks say which map it is
        return quality.confidence - missed
    return quality.likeness - _MISSED * missed
