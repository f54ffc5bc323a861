# SPDX-License-Identifier: GPL-3.0-or-later
"""Another answer of a match that two meshes keep: from what they keep to what is written on them anew."""

from __future__ import annotations

import time
from dataclasses import replace
from typing import TYPE_CHECKING

from ...engine import densify_steps, distances_to_vertices_steps, within
from ..common.access import view_layer_of
from ..common.errors import ObjectError
from ..scene.character import read_surface
from ..scene.pair import check_pair
from ..storage.answer_writing import following_steps, mapped_contents_steps, restored
from ..storage.contents import contents_steps
from ..storage.excluded_regions import excluded_vertices, region_names
from ..storage.halves import find_keyed
from ..storage.stored_match import StoredMatch
from ..storage.vertex_maps import StoredMaps, read_all_maps
from .rewriting_job import RewritingJob

if TYPE_CHECKING:
    import bpy

    from ...engine import Steps
    from ..storage.contents import Content
    from ..storage.halves import Half

_MAPPED = 0.95
"""Where on the bar of progress the making of dense maps ends."""


class FlipJob(RewritingJob):
    """Writes another answer of a match in place of the one that is written.

    The dense maps of answers that were written once stay on the meshes, so that the way back takes no time.

    Parameters
    ----------
    context : bpy.types.Context
        Where the objects are.
    half : Half
        One side of the match.
    number : int
        Of the answer, from 0 for the direct one; or that of the next one, after the last the first, if it is negative.

    Raises
    ------
    HierMatchError
        If there is no such answer, or the meshes are not what they were.
    """

    def __init__(self, context: bpy.types.Context, half: Half, number: int = -1) -> None:
        started = time.perf_counter()
        depsgraph = context.evaluated_depsgraph_get()  # brings world matrices up to date, too
        view_layer = view_layer_of(context)
        partner = find_keyed(view_layer, half.key, half.prefix, half.partner_role, half.partner_name)
        source, target = (half, partner) if half.role == "source" else (partner, half)
        check_pair(view_layer, source.obj, target.obj)
        for side in (source, target):
            _check_topology(side)
        stored = StoredMatch.from_plain(source.kept, target.kept)
        count = len(stored.answers)
        if count < 2:
            raise ObjectError(
                f'The match of "{source.obj.name}" and "{target.obj.name}" has no mirrored answer and no other: '
                "the meshes are not symmetric enough for one."
            )
        if number >= count:
            raise ObjectError(
                f'The match of "{source.obj.name}" and "{target.obj.name}" has the alternatives 1 to {count - 1} only.'
            )
        use_modifiers = stored.written.use_modifiers
        self._meshes = (
            read_surface(source.obj, depsgraph, use_modifiers=use_modifiers),
            read_surface(target.obj, depsgraph, use_modifiers=use_modifiers),
        )
        left_out = [  # a region that is gone by now leaves nothing out
            excluded_vertices(side.obj, name if name in region_names(side.obj) else "")
            for side, name in zip((source, target), stored.written.excluded, strict=True)
        ]
        self._excluded = left_out[0], left_out[1]
        kept = read_all_maps(source.obj, target.obj, half.prefix, count)
        self._maps, self._shown = dict(zip(stored.order, kept, strict=True)), stored.chosen
        chosen = number if number >= 0 else (stored.chosen + 1) % count
        super().__init__((source, target), replace(stored, chosen=chosen), started)

    def _check_half(self, half: Half) -> None:
        _check_topology(half)

    def _all_steps(self) -> Steps[None]:
        """Find what the answer says of every vertex, and prepare what is written."""
        steps = self._mapped_steps() if self._stored.written.dense else self._measured_steps()
        self._prepared = yield from steps

    def _mapped_steps(self) -> Steps[tuple[Content, Content]]:
        """Prepare the answer from its dense maps, which are made if the meshes do not keep them."""
        stored, meshes, start = self._stored, self._meshes, 0.0
        maps, last = self._maps[stored.chosen], self._maps[self._shown]
        if maps is None:
            points = restored(stored, meshes)
            shown = None if last is None else last.between(*meshes)
            known = (None, None) if shown is None else (shown.source_to_target, shown.target_to_source)
            steps = densify_steps(
                *meshes,
                points.source_points,
                points.target_points,
                excluded=self._excluded,
                maps=known,
                margin=stored.margin,
                alternatives=stored.turned,
            )
            dense = yield from within(steps, 0.0, _MAPPED)
            maps, start = StoredMaps.of(dense.source_to_target, dense.target_to_source), _MAPPED
            self._stored = yield from following_steps(stored, meshes, dense, proven=stored.answer.proven)
        others = [self._maps[number] for number in stored.order[1:]]
        writing = mapped_contents_steps(self._stored, meshes, self.prefix, maps, others)
        return (yield from within(writing, start, 1.0))

    def _measured_steps(self) -> Steps[tuple[Content, Content]]:
        """Prepare the answer from the distances between its points and the vertices."""
        stored, (source, target) = self._stored, self._meshes
        answer = restored(stored, self._meshes)
        if stored.written.match_colors or stored.written.distortion:
            from_source = yield from within(distances_to_vertices_steps(source, answer.source_points), 0.0, 0.5)
            from_target = yield from within(distances_to_vertices_steps(target, answer.target_points), 0.5, 1.0)
            answer = replace(answer, source_distances=from_source, target_distances=from_target)
        return (yield from contents_steps(answer, self.prefix, stored.written, left_out=stored.left_out))


def _check_topology(half: Half) -> None:
    """Make sure that stored vertex numbers mean what they meant."""
    if not half.has_same_faces():
        raise ObjectError(
            f'"{half.obj.name}" has other vertices or faces than when it was matched, so the stored match does not '
            "fit it any more. Match again."
        )
