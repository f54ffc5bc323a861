# SPDX-License-Identifier: GPL-3.0-or-later
"""The other answer of a match that two meshes keep: from what they keep to what is written on them anew."""

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
from ..storage.halves import find_keyed
from ..storage.stored_match import StoredMatch
from ..storage.vertex_maps import StoredMaps, map_name
from .rewriting_job import RewritingJob

if TYPE_CHECKING:
    import bpy

    from ...engine import Steps
    from ..storage.contents import Content
    from ..storage.halves import Half

__all__ = ["FlipJob"]

_MAPPED = 0.95
"""Where on the bar of progress the making of dense maps ends."""


class FlipJob(RewritingJob):
    """Writes the other answer of a match in place of the one that is written.

    The dense maps of the answer that was written stay on the meshes, so that the way back takes no time.

    Parameters
    ----------
    context : bpy.types.Context
        Where the objects are.
    half : Half
        One side of the match.

    Raises
    ------
    HierMatchError
        If there is no other answer, or the meshes are not what they were.
    """

    def __init__(self, context: bpy.types.Context, half: Half) -> None:
        started = time.perf_counter()
        depsgraph = context.evaluated_depsgraph_get()  # brings world matrices up to date, too
        view_layer = view_layer_of(context)
        partner = find_keyed(view_layer, half.key, half.prefix, half.partner_role, half.partner_name)
        source, target = (half, partner) if half.role == "source" else (partner, half)
        check_pair(view_layer, source.obj, target.obj)
        for side in (source, target):
            _check_topology(side)
        stored = StoredMatch.from_plain(source.kept, target.kept)
        if len(stored.answers) < 2:
            raise ObjectError(
                f'The match of "{source.obj.name}" and "{target.obj.name}" has no mirrored answer: '
                "the meshes are not symmetric enough for one."
            )
        use_modifiers = stored.written.use_modifiers
        self._meshes = (
            read_surface(source.obj, depsgraph, use_modifiers=use_modifiers),
            read_surface(target.obj, depsgraph, use_modifiers=use_modifiers),
        )
        self._maps, self._other_maps = (
            StoredMaps.read(source.obj, target.obj, map_name(half.prefix, other=other)) for other in (False, True)
        )
        super().__init__((source, target), replace(stored, mirrored=not stored.mirrored), started)

    def _check_half(self, half: Half) -> None:
        _check_topology(half)

    def _all_steps(self) -> Steps[None]:
        """Find what the other answer says of every vertex, and prepare what is written."""
        steps = self._mapped_steps() if self._stored.written.dense else self._measured_steps()
        self._prepared = yield from steps

    def _mapped_steps(self) -> Steps[tuple[Content, Content]]:
        """Prepare the answer from its dense maps, which are made if the meshes do not keep them."""
        stored, meshes, maps, start = self._stored, self._meshes, self._other_maps, 0.0
        if maps is None:
            points = restored(stored, meshes)
            shown = None if self._maps is None else self._maps.between(*meshes)
            known = (None, None) if shown is None else (shown.source_to_target, shown.target_to_source)
            steps = densify_steps(*meshes, points.source_points, points.target_points, maps=known)
            dense = yield from within(steps, 0.0, _MAPPED)
            maps, start = StoredMaps.of(dense.source_to_target, dense.target_to_source), _MAPPED
            self._stored = yield from following_steps(stored, meshes, dense, proven=stored.answer.proven)
        writing = mapped_contents_steps(self._stored, meshes, self.prefix, maps, self._maps)
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
