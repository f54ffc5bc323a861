# SPDX-License-Identifier: GPL-3.0-or-later
"""A match made better around landmarks: from what the two meshes keep to what is written on them anew."""

from __future__ import annotations

import time
from typing import TYPE_CHECKING

import numpy as np

from ...engine import Progress, refine_map_steps, within
from ..common.access import view_layer_of
from ..common.errors import ObjectError
from ..scene.character import read_surface
from ..scene.pair import check_pair
from ..storage.answer_writing import following_steps, mapped_contents_steps
from ..storage.excluded_regions import excluded_vertices
from ..storage.halves import check_fresh
from ..storage.landmarks import find_landmarks, landmark_array
from ..storage.stored_match import StoredMatch
from ..storage.vertex_maps import StoredMaps, map_name, read_all_maps
from .rewriting_job import RewritingJob

if TYPE_CHECKING:
    import bpy
    from numpy.typing import NDArray

    from ...engine import Steps
    from ..storage.halves import Half


class RefineJob(RewritingJob):
    """Refines the match that two meshes carry around their landmarks.

    Parameters
    ----------
    context : bpy.types.Context
        Where the objects are.
    halves : tuple of Half
        The two sides of the match, as the panel calls them source and target.
    exclude : tuple of str
        Names of the regions to leave out on each, in the same order.

    Attributes
    ----------
    moved : float
        Once computed, how far the map took the landmarks from where they belong before: the largest distance, in units
        of the square root of the target's area.

    Raises
    ------
    HierMatchError
        If the match cannot be refined.
    """

    def __init__(self, context: bpy.types.Context, halves: tuple[Half, Half], exclude: tuple[str, str]) -> None:
        started = time.perf_counter()
        depsgraph = context.evaluated_depsgraph_get()
        check_pair(view_layer_of(context), halves[0].obj, halves[1].obj)
        check_fresh(halves)
        if halves[0].role != "source":
            halves, exclude = (halves[1], halves[0]), (exclude[1], exclude[0])
        first, second = halves
        stored, prefix = StoredMatch.from_plain(first.kept, second.kept), first.prefix
        pair = f'"{first.obj.name}" and "{second.obj.name}"'
        marks = landmark_array(find_landmarks(first.obj, second.obj))
        if marks is None:
            raise ObjectError(
                f"{pair} have no landmarks that are on. Add some where the match is wrong, and lock points where it is "
                "right."
            )
        self._landmarks: NDArray[np.int64] = marks
        maps = StoredMaps.read(first.obj, second.obj, map_name(prefix))
        if maps is None:
            raise ObjectError(f"The match of {pair} has no dense map to refine. Match them again with Dense Map on.")
        use_modifiers = stored.written.use_modifiers
        self._meshes = (
            read_surface(first.obj, depsgraph, use_modifiers=use_modifiers),
            read_surface(second.obj, depsgraph, use_modifiers=use_modifiers),
        )
        between = maps.between(*self._meshes)
        self._map, self._map_back = between.source_to_target, between.target_to_source
        self._excluded = (excluded_vertices(first.obj, exclude[0]), excluded_vertices(second.obj, exclude[1]))
        at, to = self._landmarks.T
        apart = np.linalg.norm(self._meshes[1].vertices[to] - self._map.positions[at], axis=1)
        self.moved = float(apart.max() / np.sqrt(self._meshes[1].area))
        _, *self._other_maps = read_all_maps(first.obj, second.obj, prefix, len(stored.answers))
        super().__init__((first, second), stored, started)

    def _check_half(self, half: Half) -> None:
        if half.staleness():
            raise ObjectError(f'"{half.obj.name}" was edited meanwhile. Nothing was written.')

    def _all_steps(self) -> Steps[None]:
        """Refine the map, and let the matched points follow it."""
        source, target = self._meshes
        steps = refine_map_steps(
            source, target, self._map, self._landmarks, self._excluded, target_to_source=self._map_back
        )
        dense = yield from within(steps, 0.0, 0.9)
        yield Progress(0.9, "Measuring the matched points")
        self._stored = yield from following_steps(self._stored, self._meshes, dense, proven=False)
        shown = StoredMaps.of(dense.source_to_target, dense.target_to_source)
        writing = mapped_contents_steps(self._stored, self._meshes, self.prefix, shown, self._other_maps)
        self._prepared = yield from within(writing, 0.92, 1.0)
