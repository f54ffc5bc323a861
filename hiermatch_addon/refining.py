# SPDX-License-Identifier: GPL-3.0-or-later
"""A match made better around landmarks: from what the two meshes keep to what is written on them anew."""

from __future__ import annotations

import time
from dataclasses import replace
from typing import TYPE_CHECKING

import bpy
import numpy as np

from ..engine import Progress, SurfacePoints
from ..engine.progress import within
from ..engine.refinement import point_distortions, refine_map_steps
from .access import mesh_of, view_layer_of
from .answer_writing import contents_with_maps, restored, write_answer
from .errors import ObjectError
from .excluded_regions import excluded_vertices
from .halves import Half
from .landmarks import find_landmarks, landmark_array
from .mesh_io import read_mesh
from .pair import check_pair
from .stepped_job import SteppedJob
from .stored_match import CornerPoints, Quality, StoredMatch
from .vertex_maps import StoredMaps, map_name
from .writing import kept

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from ..engine import DenseMatch
    from ..engine.progress import Steps

__all__ = ["RefineJob"]


class RefineJob(SteppedJob):
    """Refines the match that two meshes carry around their landmarks.

    Between two calls of `advance` Blender may do anything, so the job holds no references to its objects but looks
    them up again, and ends with an error if they are not what they were.  Nothing is written before `finish`.

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
    progress : Progress
        How far the work is.
    names : tuple of str
        What source and target of the match are called now.
    prefix : str
        What all names written start with.
    moved : float
        Once computed, how far the map took the landmarks from where they belong before: the largest distance, in units
        of the square root of the target's area.
    seconds : float
        Once finished, how long it took.

    Raises
    ------
    HierMatchError
        If the match cannot be refined.
    """

    def __init__(self, context: bpy.types.Context, halves: tuple[Half, Half], exclude: tuple[str, str]) -> None:
        self._start = time.perf_counter()
        depsgraph = context.evaluated_depsgraph_get()
        check_pair(view_layer_of(context), halves[0].obj, halves[1].obj)
        for half in halves:
            if stale := half.staleness():
                raise ObjectError(stale)
        if halves[0].role != "source":
            halves, exclude = (halves[1], halves[0]), (exclude[1], exclude[0])
        first, second = halves
        self.names, self.prefix, self._key = (first.obj.name, second.obj.name), first.prefix, first.key
        self._uids = (first.obj.session_uid, second.obj.session_uid)
        self._stored = StoredMatch.from_plain(first.kept, second.kept)
        pair = f'"{first.obj.name}" and "{second.obj.name}"'
        marks = landmark_array(find_landmarks(first.obj, second.obj))
        if marks is None:
            raise ObjectError(
                f"{pair} have no landmarks that are on. Add some where the match is wrong, and lock points where it is "
                "right."
            )
        self._landmarks: NDArray[np.int64] = marks
        maps = StoredMaps.read(mesh_of(first.obj), mesh_of(second.obj), map_name(self.prefix))
        if maps is None:
            raise ObjectError(f"The match of {pair} has no dense map to refine. Match them again with Dense Map on.")
        use_modifiers = self._stored.written.use_modifiers
        self._meshes = (
            read_mesh(first.obj, depsgraph, use_modifiers=use_modifiers),
            read_mesh(second.obj, depsgraph, use_modifiers=use_modifiers),
        )
        self._map = maps.between(*self._meshes).source_to_target
        self._excluded = (excluded_vertices(first.obj, exclude[0]), excluded_vertices(second.obj, exclude[1]))
        at, to = self._landmarks.T
        apart = np.linalg.norm(self._meshes[1].vertices[to] - self._map.positions[at], axis=1)
        self.moved = float(apart.max() / np.sqrt(self._meshes[1].area))
        self._dense: DenseMatch | None = None
        self.seconds = 0.0
        super().__init__()

    def finish(self, context: bpy.types.Context) -> StoredMatch:
        """Write the better match on both objects in place of the one before, and return what is kept of it.

        Raises
        ------
        HierMatchError
            If the objects have changed, or the user's own vertex groups or attributes are in the way.
        """
        if self._dense is None:
            raise RuntimeError("The work has not come to its end yet.")
        objects = self._objects(view_layer_of(context))
        prefix, shown = self.prefix, StoredMaps.of(self._dense.source_to_target, self._dense.target_to_source)
        other = StoredMaps.read(mesh_of(objects[0]), mesh_of(objects[1]), map_name(prefix, other=True))
        prepared = contents_with_maps(self._stored, self._meshes, prefix, shown, other)
        write_answer(objects, self._stored, prepared, prefix)
        self.seconds = time.perf_counter() - self._start
        return self._stored

    def _all_steps(self) -> Steps[None]:
        """Refine the map, and let the matched points follow it."""
        source, target = self._meshes
        steps = refine_map_steps(source, target, self._map, self._landmarks, self._excluded)
        self._dense = yield from within(steps, 0.0, 0.9)
        yield Progress(0.9, "Measuring the matched points")
        places = restored(self._stored, self._meshes).source_points
        vertices = places.nearest_vertices  # the points of a source are at vertices
        found = self._dense.source_to_target
        images = SurfacePoints.from_barycentric(target, found.triangles[vertices], found.barycentric[vertices])
        distortion = point_distortions(source, target, vertices, images.nearest_vertices)
        answer = self._stored.answer
        before = float(np.square(answer.point_distortion).sum())
        ratio = float(np.square(distortion).sum()) / before if before > 0 else 1.0
        answers = list(self._stored.answers)
        answers[self._stored.mirrored] = replace(
            answer,
            target_points=CornerPoints.of(images),
            point_distortion=distortion,
            distortion=answer.distortion * ratio,  # it is made of the same squares
            proven=False,
            quality=Quality.of(self._dense.quality),
            refined=False,
        )
        self._stored = replace(self._stored, answers=tuple(answers))

    def _objects(self, view_layer: bpy.types.ViewLayer) -> tuple[bpy.types.Object, bpy.types.Object]:
        """Look the objects up again and make sure that they still carry the match, and are what was read."""
        objects = []
        for uid, name in zip(self._uids, self.names, strict=True):
            obj = next((obj for obj in bpy.data.objects if obj.session_uid == uid), None)
            half = None if obj is None else Half(obj, self.prefix, kept(obj, self.prefix))
            if obj is None or half is None or not half.kept or half.key != self._key or half.staleness():
                raise ObjectError(f'"{name}" was deleted, edited or matched anew meanwhile. Nothing was written.')
            objects.append(obj)
        check_pair(view_layer, objects[0], objects[1])
        return objects[0], objects[1]
