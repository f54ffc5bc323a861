# SPDX-License-Identifier: GPL-3.0-or-later
"""Matching of two surfaces one of which shows only a part of the other."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import ArrayLike

from ..dense.components.masked_maps import share_of, with_pieces_only
from ..dense.credibility import ALL_ALIKE, CREDIBLE, EVEN, MUCH_ALIKE, has_failed, is_less_alike
from ..dense.proposers import are_distinct
from ..mesh.surface_map import SurfaceMap
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


@dataclass(frozen=True, eq=False)
class PartialPair:
    """Two surfaces, one of which shows only a part of the other.

    Attributes
    ----------
    x, y : Shape
        The source and the target.
    of_source : bool
        Whether the source is the whole surface, and the target the part; else it is the other way round.
    """

    x: Shape
    y: Shape
    of_source: bool

    @property
    def whole(self) -> Shape:
        """The surface of which only a piece may be matched."""
        return self.x if self.of_source else self.y

    @property
    def part(self) -> Shape:
        """The other surface."""
        return self.y if self.of_source else self.x

    def maps(self, result: MatchResult) -> tuple[SurfaceMap, SurfaceMap]:
        """Take the map of the whole surface to the part, and the one back."""
        there, back = result.dense.source_to_target, result.dense.target_to_source
        return (there, back) if self.of_source else (back, there)

    def with_partner(self, result: MatchResult) -> Bools:
        """Tell which vertices of the whole surface, (n,), have a partner by a match."""
        return self.maps(result)[0].has_partner[self.whole.vertices]

    def shown(self, result: MatchResult) -> float:
        """Tell how much of the part has a partner by a match, 0 to 1."""
        quality = result.dense.quality
        return quality.coverage if self.of_source else quality.source_coverage

    def shows_all(self, result: MatchResult) -> bool:
        """Say whether all of the part has a partner by a match."""
        return self.shown(result) >= _COVERED

    def credibility(self, result: MatchResult) -> float:
        """Compare matches: larger is more credible; all of the part should have a partner."""
        quality, missed = result.dense.quality, 1 - self.shown(result)
        if quality.likeness is None:  # landmarks say which map it is
            return quality.confidence - missed
        return quality.likeness - _MISSED * missed

    def needed(self, result: MatchResult, least: float) -> float:
        """Tell the likeness below which no match with a piece is better than a result, see `is_better`."""
        return least if result.dense.quality.likeness is None else max(least, self.credibility(result))

    def is_better(self, other: MatchResult, result: MatchResult, least: float) -> bool:
        """Say whether a match with less of the whole is credible enough, and more so than that with more of it."""
        enough = not is_less_alike(other.dense.quality.likeness, least)
        return enough and self.credibility(other) > self.credibility(result)

    def is_clear(self, result: MatchResult, known: MatchResult, *, is_sure: bool) -> bool:
        """Say whether a match is new, and all of the part so much like the piece that nothing else is worth trying.

        Less likeness is enough if something else says as well that the piece is the right one.
        """
        enough = MUCH_ALIKE if is_sure else ALL_ALIKE
        return result is not known and self.shows_all(result) and is_as_alike(result, enough)

    def lead_alike(self, first: MatchResult, second: MatchResult) -> bool:
        """Say whether two matches take what both show of the part to the same places."""
        (_, here), (_, there) = self.maps(first), self.maps(second)
        areas = self.part.original.vertex_areas * (here.has_partner & there.has_partner)
        unit = self.whole.scale
        return bool(areas.any()) and not are_distinct(here.positions / unit, there.positions / unit, areas)

    def piece_steps(self, piece: Bools, task: MatchTask) -> Steps[MatchResult | None]:
        """Match with some vertices (n,) of the whole only; None if these are all of it, or cannot be matched."""
        whole = self.whole
        covered = whole.surface.spread(piece.astype(np.float64), 1.0) > 1 / 2
        if share_of(whole.original, covered) > _WHOLE or self._misses(covered, task.landmarks):
            return None
        try:
            cut = yield from within(_cut_steps(whole, covered, "source" if self.of_source else "target"), 0.0, 0.1)
            shapes = (cut, self.y) if self.of_source else (self.x, cut)
            result = yield from within(matched_steps(*shapes, task), 0.1, 1.0)
        except MatchError:  # what is left is too small for so many points
            return None
        pieces = (covered, None) if self.of_source else (None, covered)
        return result.with_dense(with_pieces_only(result.dense, (self.x.original, self.y.original), pieces))

    def _misses(self, covered: Bools, landmarks: ArrayLike | None) -> bool:
        """Say whether a landmark lies outside of what is covered of the whole, (n,)."""
        return (
            landmarks is not None and not covered[np.reshape(landmarks, (-1, 2))[:, 0 if self.of_source else 1]].all()
        )

    def better_piece(self, result: MatchResult, piece: Bools) -> Bools | None:
        """Tell what of the whole would be a better piece than one (n,), by what has no partner; None if that is right.

        It is without that if that is much, and goes on where the part hangs over.
        """
        shown, areas = self.with_partner(result), self.whole.mesh.vertex_areas
        is_too_large = float(areas @ (piece & ~shown)) > _TOO_LARGE * float(areas @ piece)
        kept = shown if is_too_large else piece
        if self.shows_all(result):
            return kept if is_too_large else None
        part, (_, back) = self.part, self.maps(result)
        alone = back.confidence[part.vertices] == 0
        unit = np.sqrt(float(areas @ piece) / part.mesh.area)
        return kept | continued(self.whole, part, back.positions[part.vertices], alone, unit)


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
    quality, parts = result.dense.quality, (has_border(x), has_border(y))
    if not any(parts) and not has_failed(quality.likeness, quality.confidence):
        return result
    if not is_less_alike(quality.likeness, CREDIBLE) and min(quality.coverage, quality.source_coverage) >= _MISSING:
        return result
    # What was cut off may have been closed; then nothing says which of them is the part.
    pairs = [PartialPair(x, y, of_source=True)] if parts[1] or not any(parts) else []
    pairs += [PartialPair(x, y, of_source=False)] if parts[0] or not any(parts) else []
    closer: dict[PartialPair, MatchResult] = {}
    for number, pair in enumerate(pairs):
        # With landmarks nothing says how much alike a piece is.
        if task.landmarks is None and pair.shows_all(result):
            beginning = known_piece_matched_steps(result, pair, task)
            closer[pair] = yield from within(beginning, *part_of(number, len(pairs), 0.0, _BEGUN))
            if pair.is_clear(closer[pair], result, is_sure=is_sure):
                return closer[pair]
    # Of a closed body, some piece is always more like a ball than all of it.
    least = CREDIBLE if any(parts) else MUCH_ALIKE
    found = []
    for number, pair in enumerate(pairs):
        searching = _pieces_steps(result, pair, least)
        pieces = yield from within(searching, *part_of(number, len(pairs), _BEGUN, _FOUND))
        found += [(piece, pair) for piece in pieces]
    found.sort(key=lambda item: item[0].score)
    task.clock.lap("missing parts")
    if found:
        piece, pair = found[0]
        if pair in closer and _is_shown(piece, closer[pair], result, pair):
            return closer[pair]
    return (yield from within(_best_piece_steps(result, task, found[:_MOST], least=least), _FOUND, 1.0))


def agreed_part_steps(
    known: MatchResult, closer: MatchResult, pair: PartialPair, task: MatchTask
) -> Steps[tuple[MatchResult, bool]]:
    """Match with what of one surface the other shows, by a search that does not need what is known of that already.

    Parameters
    ----------
    known, closer : MatchResult
        A match with a piece of one surface, and what came of that as a start, see `known_piece_matched_steps`.
    pair : PartialPair
        The surfaces.
    task : MatchTask
        What is wanted.

    Returns
    -------
    result : MatchResult
        The most credible match, the known one among them.
    agrees : bool
        Whether the search leads to where that does, by the piece that it finds, or by a match with another one.
    """
    pieces = yield from within(_pieces_steps(known, pair, CREDIBLE), 0.0, _FOUND)
    task.clock.lap("missing parts")
    agrees = bool(pieces) and not pieces[0].is_new
    if agrees and _is_shown(pieces[0], closer, known, pair):
        return closer, True
    task = replace(task, begun=known.source_to_target) if agrees else task
    found = [(piece, pair) for piece in pieces[: 1 if agrees else _MOST]]
    result = yield from within(_best_piece_steps(known, task, found, least=CREDIBLE), _FOUND, 1.0)
    return result, agrees or (result is not known and pair.lead_alike(result, closer))


def _pieces_steps(known: MatchResult, pair: PartialPair, least: float) -> Steps[list[CoveredPart]]:
    """Look for pieces of the whole surface that are shown, and may be better than what is known."""
    steps = covered_parts_steps(pair.whole, pair.part, pair.maps(known), pair.needed(known, least))
    return within(steps, 0.0, 1.0, "Looking for missing parts")


def _is_shown(piece: CoveredPart, closer: MatchResult, known: MatchResult, pair: PartialPair) -> bool:
    """Say whether what was made of a known match is clear, as a search leads there as well, and shows all it found."""
    if piece.is_new or not pair.is_clear(closer, known, is_sure=True):
        return False
    areas = pair.whole.mesh.vertex_areas * piece.covered
    return float(areas @ ~pair.with_partner(closer)) <= _LACKING * float(areas.sum())


def _best_piece_steps(
    result: MatchResult, task: MatchTask, pieces: list[tuple[CoveredPart, PartialPair]], *, least: float
) -> Steps[MatchResult]:
    """Match with pieces, each of the source or else of the target, until one fits like one body in two poses."""
    for number, (piece, pair) in enumerate(pieces):
        matching = piece_matched_steps(result, pair, task, piece.covered, least)
        result = yield from within(matching, *part_of(number, len(pieces)))
        if is_as_alike(result, ALL_ALIKE):
            break
    return result


def known_piece_matched_steps(known: MatchResult, pair: PartialPair, task: MatchTask) -> Steps[MatchResult]:
    """Match with only that of one surface which has a partner by a known match, beginning with that match.

    See `piece_matched_steps`.
    """
    begun = replace(task, begun=known.source_to_target)
    return piece_matched_steps(known, pair, begun, pair.with_partner(known))


def piece_matched_steps(
    result: MatchResult, pair: PartialPair, task: MatchTask, piece: Bools, least: float = CREDIBLE
) -> Steps[MatchResult]:
    """Match with only a piece of one surface, and with more of it where the other goes on beyond.

    Parameters
    ----------
    result : MatchResult
        What is known so far.
    pair : PartialPair
        The surfaces.
    task : MatchTask
        What is wanted.
    piece : (n,) array of bool
        Vertices of the whole surface.
    least : float
        Likeness that a match with a piece needs to be taken.

    Returns
    -------
    MatchResult
        The most credible match, the given one among them.
    """
    for again in range(_ROUNDS):
        wanted = replace(task, least=pair.needed(result, least))
        other = yield from within(pair.piece_steps(piece, wanted), *part_of(again, _ROUNDS))
        if other is None or is_less_alike(other.dense.quality.likeness, EVEN):
            break
        if pair.is_better(other, result, least):
            # Its notes would speak of openings where a piece was cut out.
            result = replace(other, notes=result.notes)
        better = pair.better_piece(other, piece)
        if better is None:
            break
        piece = better
    return result


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


def is_as_alike(result: MatchResult, enough: float) -> bool:
    """Say whether what is matched is so much alike that nothing else is worth trying."""
    return not is_less_alike(result.dense.quality.likeness, enough)
