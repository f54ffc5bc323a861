# SPDX-License-Identifier: GPL-3.0-or-later
"""Landmarks of one side carried to the other, by the symmetry of each of the two meshes."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from ...engine import symmetry_map_steps, within
from ..common.access import view_layer_of
from ..common.errors import ObjectError
from ..scene.character import ReadSide, read_surface
from ..scene.pair import check_pair
from ..storage.halves import find_common, in_order
from ..storage.landmarks import add_landmarks, find_landmarks, landmark_array
from ..storage.vertex_maps import StoredMaps, map_name
from .stepped_job import SteppedJob
from .verdict import asymmetry_note

if TYPE_CHECKING:
    import bpy
    from numpy.typing import NDArray

    from ...engine import Steps, TriangleMesh
    from ..scene.character import Side
    from ..storage.landmarks import Landmark

_MIDDLE = 0.02
"""A place that is not farther from its mirror image, in sqrt(area), is called the middle."""

_ASTRAY = 0.1
"""So much farther, in sqrt(area), from where a match takes it a mirror image may be than its landmark is."""


class MirrorJob(SteppedJob):
    """Finds the mirror images of the landmarks of two meshes.

    Between two calls of `advance` Blender may do anything, so the job holds no references to its objects but looks
    them up again.  Nothing is written before `finish`.

    Parameters
    ----------
    context : bpy.types.Context
        Where the objects are.
    source, target : bpy.types.Object or Character
        The objects, in Object Mode.

    Attributes
    ----------
    progress : Progress
        How far the work is.
    left_out : int
        Once finished, how many mirror images were left out because they contradict the match of the two meshes.
    notes : list of str
        Once finished, what is said of meshes that are hardly symmetric.

    Raises
    ------
    ObjectError
        If the objects cannot be read or written, or have no landmarks in common.
    """

    def __init__(self, context: bpy.types.Context, source: Side, target: Side) -> None:
        depsgraph = context.evaluated_depsgraph_get()
        check_pair(view_layer_of(context), source, target)
        found = landmark_array(find_landmarks(source, target))
        if found is None:
            raise ObjectError(
                f'"{source.name}" and "{target.name}" have no landmarks in common that are on. Add some first.'
            )
        self._landmarks = found
        self._objects = (ReadSide.of(source), ReadSide.of(target))
        self._meshes = tuple(read_surface(obj, depsgraph, use_modifiers=False) for obj in (source, target))
        self._maps = _fresh_maps(source, target)
        self._images: list[NDArray[np.int64]] = []
        self.left_out = 0
        self.notes: list[str] = []
        super().__init__()

    def finish(self) -> list[Landmark]:
        """Add the mirror images as landmarks, except for those of landmarks in the middle or that are there already.

        Raises
        ------
        ObjectError
            If the objects have changed.
        """
        source, target = (read.unchanged() for read in self._objects)
        check_pair(None, source, target)
        taken = {vertex for landmark in find_landmarks(source, target) for vertex in [("s", landmark.source)]}
        taken |= {("t", landmark.target) for landmark in find_landmarks(source, target)}
        pairs: list[tuple[int, int]] = []
        astray = self._astray()
        for (x, y), image_x, image_y, wrong in zip(self._landmarks.tolist(), *self._images, astray, strict=True):
            if _in_middle(self._meshes[0], x, image_x) or _in_middle(self._meshes[1], y, image_y):
                continue
            new = {("s", int(image_x)), ("t", int(image_y))}
            if wrong:
                self.left_out += 1
            elif not new & taken:
                taken |= new
                pairs.append((int(image_x), int(image_y)))
        return add_landmarks(source, target, pairs)

    def _all_steps(self) -> Steps[None]:
        """Find the symmetry of one mesh after the other."""
        for number, mesh in enumerate(self._meshes):
            dense = yield from within(symmetry_map_steps(mesh), number / 2, (number + 1) / 2)
            name = self._objects[number].name
            self.notes.extend(filter(None, [asymmetry_note(name, dense.quality)]))
            self._images.append(dense.source_to_target.nearest_vertices[self._landmarks[:, number]])

    def _astray(self) -> NDArray[np.bool_]:
        """Tell which mirror images do not correspond by the match of the two meshes, if they carry one.

        A shape may be nearly symmetric in more than one way, and then the two meshes may be mirrored differently.
        """
        if self._maps is None:
            return np.zeros(len(self._landmarks), np.bool_)
        target = self._meshes[1]
        there = self._maps.between(*self._meshes).source_to_target.positions
        before, after = (
            np.linalg.norm(there[at] - target.vertices[to], axis=1) for at, to in (self._landmarks.T, self._images)
        )
        return after > before + _ASTRAY * np.sqrt(target.area)


def _fresh_maps(source: Side, target: Side) -> StoredMaps | None:
    """Read the dense maps of a match that is not out of date, from source to target; None if there is none."""
    for half, partner in find_common(source, target):
        if not (half.staleness() or partner.staleness()):
            first, second = in_order(half, partner)
            maps = StoredMaps.read(first.obj, second.obj, map_name(half.prefix))
            if maps is not None:
                return maps if first is half else maps.reverse
    return None


def _in_middle(mesh: TriangleMesh, vertex: int, image: int) -> bool:
    apart = float(np.linalg.norm(mesh.vertices[vertex] - mesh.vertices[image]))
    return apart <= _MIDDLE * float(np.sqrt(mesh.vertex_areas.sum()))
