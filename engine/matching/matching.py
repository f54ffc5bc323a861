# SPDX-License-Identifier: GPL-3.0-or-later
"""The engine's front door: matching of two surfaces."""

from __future__ import annotations

from dataclasses import replace

from numpy.typing import ArrayLike

from ..dense.credibility import ALL_ALIKE, CREDIBLE, least_likeness
from ..hierarchical.settings import MatchSettings
from ..mesh.triangle_mesh import TriangleMesh
from ..runtime.arrays import Bools, Floats, Ints
from ..runtime.background import can_go_beside
from ..runtime.errors import MatchError
from ..runtime.parallel_map import shared_steps
from ..runtime.progress import Progress, Steps, at_once, in_turn, within
from ..runtime.worker import call_helpers
from ..shapes.borders import has_border, longest_border
from ..shapes.known_shapes import KnownShapes
from ..shapes.landmarks import vertex_pairs
from ..shapes.prepared_surface import PreparedSurface, prepared_steps
from ..shapes.shape import Shape, check_surface, left_out_of
from .alike_match import alike_match_steps
from .joined_match import has_limbs, matched_with_pieces_steps
from .overlap.overlap_match import OverlapMatch, overlap_match_steps
from .partial_match import (
    PartialPair,
    agreed_part_steps,
    is_as_alike,
    known_piece_matched_steps,
    part_matched_steps,
    piece_matched_steps,
)
from .result import MatchResult
from .shape_matching import MatchTask, fitting_settings, matched_steps
from .standing_match import standing_match_steps

_Unprepared = tuple[TriangleMesh, str, Bools | None]

_FIRST, _FIRST_OF_CLOSED = 0.45, 0.95
"""Part of the work after which surfaces have been matched as they are: if one of them is open, and may be a part of the
other, and if both are closed."""

_CUT = 0.4
"""Length of a border, in sqrt(area), from which on much may have been cut off a surface: around a thigh."""

_SHARED = 0.8
"""Part of both surfaces that is shared from which on all of them is matched as well: their sizes hardly differ."""

_SMALL_PART = 0.6
"""Part of a surface that is shared up to which more is missing on the other than faces here and there."""

_OVERLAP, _FIRST_AFTER = 0.35, 0.6
"""Parts of the work after which it is known what surfaces share, and how they match as they are."""

_BEGUN, _AGREED, _CLOSER = 0.2, 0.6, 0.8
"""Parts of the work in `_part_steps` after which the piece of the overlap has been matched from there, another search
has looked for the piece, and that of the overlap has been matched anew."""

_SURE = 0.9
"""Credibility of what surfaces share from which on no other map is looked for: of the 36 pairs of ``python -m
tests.benchmarks.partial_pairs --pairs 12 --kept 0.75,0.6,0.45`` 14 have as much, all right but for a leg of a cat, and
one person that was turned back to front 0.65."""

_HOPELESS = 0.1
"""Confidence that a match of all of two surfaces needs at least to be preferred to one of what they share."""

_SMALL = 8000
"""Vertices up to which a mesh is prepared sooner than it is sent.  Larger ones are prepared in two processes whatever
their size: what that needs is free again before the most is needed."""


@can_go_beside
def match_steps(
    source: TriangleMesh | Shape,
    target: TriangleMesh | Shape,
    settings: MatchSettings | None = None,
    *,
    landmarks: ArrayLike | None = None,
    assumed: bool = False,
    excluded: tuple[ArrayLike | None, ArrayLike | None] = (None, None),
    known: KnownShapes | None = None,
) -> Steps[MatchResult]:
    """Find corresponding points on two surfaces that differ by a non-rigid deformation.

    The first points are matched exactly by branch and bound; then points are added level by level, and all points are
    matched again at each level in a relaxed problem over their neighbourhoods [1]_.  With a dense map, which is the
    default, that is only one of the starts of the map, and the points lie at last where the map takes them.

    Parameters
    ----------
    source, target : TriangleMesh or Shape
        The surfaces X and Y.  Position, orientation, size, units, triangulation and vertex order do not matter.
        Pass a `Shape` to keep what is computed for it from one match to the next.
    settings : MatchSettings, optional
        How many points, and how hard to search.  Of surfaces with fewer vertices, no more points are matched.
    landmarks : (k, 2) array_like of int, optional
        Pairs of a vertex of the source and one of the target that are known to correspond: at most as many as there are
        points, all different, on the main parts of the meshes.  They are the first points of the result, and exact
        in all of it.  One may be enough to choose between left and right; where the landmarks call for a map that
        mirrors the surface, the orientation in the result's `quality` is that of the mirrored source.
    assumed : bool
        Whether it is only tried that the landmarks correspond: then they lead the match, but it is judged without them.
    excluded : pair of (n,) array_like of bool, optional
        Vertices of the source and of the target to leave out.  In dense maps they follow what is around them.
    known : KnownShapes, optional
        What meshes of matches before were prepared to: taken from there, and kept there.

    Returns
    -------
    MatchResult
        Corresponding points, their distortion, and the mirrored answer if the shapes are nearly symmetric.

    Raises
    ------
    MatchError
        If a surface has fewer vertices than coarse points, or without a dense map than points, landmarks cannot be
        used, or vertices are excluded from a `Shape`, which was made with or without them.
    MeshError, SettingsError
        If a surface is none, as its arrays, or the settings are others, as a dictionary.

    References
    ----------
    .. [1] D. Raviv, A. Dubrovina, R. Kimmel, "Hierarchical Matching of Non-rigid Shapes", SSVM 2011.
    """
    for surface, name in ((source, "source"), (target, "target")):
        check_surface(surface, name)
    settings, pairs = MatchSettings.checked(settings), vertex_pairs(landmarks)
    task = MatchTask(settings, pairs if len(pairs) else None, assumed=assumed and len(pairs) > 0)
    masks = left_out_of((source, target), excluded)
    call_helpers()
    try:
        x, y = yield from within(_shapes_steps((source, target), masks, known), 0.0, 0.06)
        if not has_limbs(x, y):  # which are more when they are joined
            fitting_settings(x, y, settings)
        result = yield from within(_chosen_steps(x, y, task), 0.06, 1.0)
    finally:
        if known is not None:
            known.trim()
    yield Progress(1.0, "Done")
    return task.clock.noted(result)


match = at_once(match_steps)


def _chosen_steps(x: Shape, y: Shape, task: MatchTask) -> Steps[MatchResult]:
    """Match in the way that two shapes and the settings ask for."""
    if not task.settings.dense:
        return (yield from matched_steps(x, y, task))
    if task.landmarks is None and (longest_border(x) > _CUT or longest_border(y) > _CUT) and not has_limbs(x, y):
        return (yield from _overlapping_steps(x, y, task))
    end = _FIRST if has_border(x) or has_border(y) else _FIRST_OF_CLOSED
    return (yield from _whole_steps(x, y, task, end))


def _whole_steps(x: Shape, y: Shape, task: MatchTask, end: float, *, is_sure: bool = False) -> Steps[MatchResult]:
    """Match surfaces as they are, which takes that part of the work, and again if that leads nowhere.

    `is_sure` says that what the task begins with is as good as certain.
    """
    result, first, second = yield from within(matched_with_pieces_steps(x, y, task), 0.0, end)
    standing = yield from within(standing_match_steps(result, x, y, task), end, end)
    if standing is not None:
        return standing
    return (yield from within(part_matched_steps(result, first, second, task, is_sure=is_sure), end, 1.0))


def _overlapping_steps(x: Shape, y: Shape, task: MatchTask) -> Steps[MatchResult]:
    """Match surfaces of which much may have been cut off: what they share first, and all of them if that is unclear."""
    alike = yield from within(alike_match_steps(x, y, task), 0.0, 0.1)
    if alike is not None:
        return alike
    overlap = yield from within(overlap_match_steps(x, y, task), 0.1, _OVERLAP)
    cut = longest_border(x) > _CUT, longest_border(y) > _CUT
    if overlap is not None and overlap.is_likely and min(overlap.shares) < _SHARED:
        if all(cut):
            return overlap.result
        return (yield from within(_part_steps(overlap, PartialPair(x, y, of_source=cut[1]), task), _OVERLAP, 1.0))
    is_sure = overlap is not None and overlap.credibility >= _SURE
    if overlap is not None and is_sure:
        task = replace(task, begun=overlap.result.source_to_target)
    try:
        if all(cut):
            # Neither shows all of the other: no piece of one is to be looked for.
            task = task if overlap is None else replace(task, least=least_likeness(_worth(overlap)))
            result, _, _ = yield from within(matched_with_pieces_steps(x, y, task), _OVERLAP, 1.0)
        else:
            result = yield from within(_whole_steps(x, y, task, _FIRST_AFTER, is_sure=is_sure), _OVERLAP, 1.0)
    except MatchError:
        if overlap is None:
            raise
        return overlap.result
    # Of surfaces as they are and what they share, the more credible counts, or what claims least.
    if overlap is not None and result.dense.quality.confidence <= _worth(overlap):
        return overlap.result
    return overlap.doubted(result, x, y) if overlap is not None and all(cut) else result


def _part_steps(overlap: OverlapMatch, pair: PartialPair, task: MatchTask) -> Steps[MatchResult]:
    """Match a part with the piece of a whole surface that it shares, as closely as whole surfaces are matched.

    That begins with the map of the overlap.  Where that leads is trusted if it is nearly certain, or as much alike as
    one body is in two poses.  Else another search looks for the piece; it is certain where both lead to the same, and
    where they do not, the piece of the overlap is matched anew as well.  If some of the part has no partner then, or
    the two are not even like two whole bodies, all of the whole surface is tried as well.  So it is if most of that is
    shared: a body whose faces are missing here and there is no part.
    """
    known, is_sure = overlap.result, overlap.credibility >= _SURE
    closer = yield from within(known_piece_matched_steps(known, pair, task), 0.0, _BEGUN)
    result = closer if is_sure or is_as_alike(closer, ALL_ALIKE) else known

    def clear() -> bool:
        """Say whether no other piece is worth trying."""
        return pair.is_clear(result, known, is_sure=is_sure)

    if not clear():
        agreed = agreed_part_steps(result, closer, pair, task)
        result, agrees = yield from within(agreed, _BEGUN, _AGREED)
        is_sure = is_sure or agrees
    if not clear():
        steps = piece_matched_steps(result, pair, task, pair.with_partner(known))
        result = yield from within(steps, _AGREED, _CLOSER)
    if clear() and min(result.dense.quality.coverage, result.dense.quality.source_coverage) < _SMALL_PART:
        return result
    # All of both wins if that is more credible, so it is given up as soon as it cannot be.
    found = result.source_to_target if clear() else None
    task = replace(task, begun=found, least=pair.credibility(result))
    try:
        other, _, _ = yield from within(matched_with_pieces_steps(pair.x, pair.y, task), _CLOSER, 1.0)
    except MatchError:
        return result
    return other if pair.is_better(other, result, CREDIBLE) else result


def _worth(overlap: OverlapMatch) -> float:
    """Confidence that a match of all of two surfaces needs to be taken instead of one of what they share."""
    return max(overlap.result.dense.quality.confidence, _HOPELESS)


def _shapes_steps(
    surfaces: tuple[TriangleMesh | Shape, TriangleMesh | Shape],
    masks: list[Bools | None],
    known: KnownShapes | None,
) -> Steps[list[Shape]]:
    """Prepare meshes that are not known; shapes stay as they are."""
    shapes: list[Shape | None] = []
    items: list[_Unprepared] = []
    for surface, name, mask in zip(surfaces, ("source", "target"), masks, strict=True):
        if isinstance(surface, Shape):
            shapes.append(surface)
            continue
        item = surface, name, mask
        found = None if known is None else known.find(*item)
        items += [item] if found is None else []
        shapes.append(found)
    prepared = iter(zip(items, (yield from _prepared_meshes_steps(items)), strict=True))
    return [_new_shape(*next(prepared), known) if shape is None else shape for shape in shapes]


def _prepared_meshes_steps(items: list[_Unprepared]) -> Steps[list[PreparedSurface]]:
    """Prepare meshes, large ones in several processes."""
    if any(mesh.vertex_count <= _SMALL for mesh, *_ in items):
        return (yield from in_turn(prepared_steps(mesh, name, excluded=excluded) for mesh, name, excluded in items))
    # A mesh would be kept where it is sent to, with all that was computed of it.
    arrays = [((mesh.vertices, mesh.triangles), name, excluded) for mesh, name, excluded in items]
    found = yield from shared_steps(_prepared_arrays_steps, None, arrays)
    return [prepared.of_same(item[0]) for item, prepared in zip(items, found, strict=True)]


def _new_shape(item: _Unprepared, prepared: PreparedSurface, known: KnownShapes | None) -> Shape:
    """Make the shape of a mesh that was prepared."""
    shape = Shape.of(prepared)
    if known is not None:
        known.keep(*item, shape)
    return shape


def _prepared_arrays_steps(_: None, given: tuple[tuple[Floats, Ints], str, Bools | None]) -> Steps[PreparedSurface]:
    """Prepare a mesh, given by its arrays."""
    arrays, name, excluded = given
    return (yield from prepared_steps(TriangleMesh(*arrays), name, excluded=excluded))
