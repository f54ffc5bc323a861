# SPDX-License-Identifier: GPL-3.0-or-later
"""Landmarks of one side carried to the other, by the symmetry of each of the two meshes."""

from __future__ import annotations

from typing import TYPE_CHECKING

import bpy
import numpy as np

from ..engine import symmetry_map_steps
from ..engine.progress import within
from .access import mesh_of, view_layer_of
from .errors import ObjectError
from .landmarks import add_landmarks, find_landmarks, landmark_array
from .mesh_io import position_digest, read_mesh, topology
from .pair import check_pair
from .stepped_job import SteppedJob

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from ..engine import TriangleMesh
    from ..engine.progress import Steps
    from .landmarks import Landmark

__all__ = ["MirrorJob"]

_MIDDLE = 0.02
"""A place that is not farther from its mirror image, in sqrt(area), is called the middle."""


class MirrorJob(SteppedJob):
    """Finds the mirror images of the landmarks of two meshes.

    Between two calls of `advance` Blender may do anything, so the job holds no references to its objects but looks
    them up again.  Nothing is written before `finish`.

    Parameters
    ----------
    context : bpy.types.Context
        Where the objects are.
    source, target : bpy.types.Object
        The objects, in Object Mode.

    Attributes
    ----------
    progress : Progress
        How far the work is.

    Raises
    ------
    ObjectError
        If the objects cannot be read or written, or have no landmarks in common.
    """

    def __init__(self, context: bpy.types.Context, source: bpy.types.Object, target: bpy.types.Object) -> None:
        depsgraph = context.evaluated_depsgraph_get()
        check_pair(view_layer_of(context), source, target)
        found = landmark_array(find_landmarks(source, target))
        if found is None:
            raise ObjectError(
                f'"{source.name}" and "{target.name}" have no landmarks in common that are on. Add some first.'
            )
        self._landmarks = found
        self._objects = tuple((obj.session_uid, obj.name, _state(obj)) for obj in (source, target))
        self._meshes = tuple(read_mesh(obj, depsgraph, use_modifiers=False) for obj in (source, target))
        self._images: list[NDArray[np.int64]] = []
        super().__init__()

    def finish(self, view_layer: bpy.types.ViewLayer) -> list[Landmark]:
        """Add the mirror images as landmarks, except for those of landmarks in the middle or that are there already.

        Raises
        ------
        ObjectError
            If the objects have changed.
        """
        objects = []
        for uid, name, state in self._objects:
            obj = next((obj for obj in bpy.data.objects if obj.session_uid == uid), None)
            if obj is None or _state(obj) != state:
                raise ObjectError(f'"{name}" was deleted or edited meanwhile. No landmark was added.')
            objects.append(obj)
        source, target = objects
        check_pair(view_layer, source, target)
        taken = {vertex for landmark in find_landmarks(source, target) for vertex in [("s", landmark.source)]}
        taken |= {("t", landmark.target) for landmark in find_landmarks(source, target)}
        pairs: list[tuple[int, int]] = []
        for (x, y), image_x, image_y in zip(self._landmarks.tolist(), *self._images, strict=True):
            if _in_middle(self._meshes[0], x, image_x) or _in_middle(self._meshes[1], y, image_y):
                continue
            new = {("s", int(image_x)), ("t", int(image_y))}
            if not new & taken:
                taken |= new
                pairs.append((int(image_x), int(image_y)))
        return add_landmarks(source, target, pairs)

    def _all_steps(self) -> Steps[None]:
        """Find the symmetry of one mesh after the other."""
        for number, mesh in enumerate(self._meshes):
            dense = yield from within(symmetry_map_steps(mesh), number / 2, (number + 1) / 2)
            self._images.append(dense.source_to_target.nearest_vertices[self._landmarks[:, number]])


def _state(obj: bpy.types.Object) -> tuple[str, str]:
    return topology(mesh_of(obj)), position_digest(mesh_of(obj))


def _in_middle(mesh: TriangleMesh, vertex: int, image: int) -> bool:
    apart = float(np.linalg.norm(mesh.vertices[vertex] - mesh.vertices[image]))
    return apart <= _MIDDLE * float(np.sqrt(mesh.vertex_areas.sum()))
