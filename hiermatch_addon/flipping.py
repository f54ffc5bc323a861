# SPDX-License-Identifier: GPL-3.0-or-later
"""Write the other answer of a match that is kept on two meshes."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, TypeVar, cast

from ..engine import Shape, densify_steps
from ..engine.progress import within
from ..engine.surface_distances import SurfaceDistances, to_all_vertices_steps
from .access import mesh_of, view_layer_of
from .answer_writing import contents_with_maps, restored, write_answer
from .contents import contents
from .errors import ObjectError
from .halves import find_keyed
from .mesh_io import read_mesh
from .pair import check_pair
from .stored_match import StoredMatch
from .vertex_maps import StoredMaps, map_name

if TYPE_CHECKING:
    from collections.abc import Callable

    import bpy
    import numpy as np
    from numpy.typing import NDArray

    from ..engine import SurfacePoints, TriangleMesh
    from ..engine.progress import Steps
    from .contents import Content
    from .halves import Half

__all__ = ["flip"]

_Result = TypeVar("_Result")


def flip(
    context: bpy.types.Context, half: Half, progress: Callable[[float], None]
) -> tuple[StoredMatch, tuple[str, str]]:
    """Write the other answer of a match in place of the one that is written.

    The dense maps of the answer that was written stay on the meshes, so that the way back takes no time.

    Parameters
    ----------
    context : bpy.types.Context
        Where the objects are.
    half : Half
        One side of the match.
    progress : callable
        Is told how much is done, from 0 to 1.

    Returns
    -------
    stored : StoredMatch
        The match as it is now.
    names : tuple of str
        What source and target are called now.

    Raises
    ------
    HierMatchError
        If there is no other answer, or the meshes are not what they were; nothing is written then.
    """
    depsgraph = context.evaluated_depsgraph_get()  # brings world matrices up to date, too
    view_layer = view_layer_of(context)
    partner = find_keyed(view_layer, half.key, half.prefix, half.partner_role, half.partner_name)
    source, target = (half, partner) if half.role == "source" else (partner, half)
    objects = (source.obj, target.obj)
    check_pair(view_layer, *objects)
    for side in (source, target):
        _check_topology(side)
    stored = StoredMatch.from_plain(source.kept, target.kept)
    if len(stored.answers) < 2:
        raise ObjectError(
            f'The match of "{source.obj.name}" and "{target.obj.name}" has no mirrored answer: '
            "the meshes are not symmetric enough for one."
        )
    stored = replace(stored, mirrored=not stored.mirrored)
    source_mesh, target_mesh = (
        read_mesh(obj, depsgraph, use_modifiers=stored.written.use_modifiers) for obj in objects
    )
    restore = _with_maps if stored.written.dense else _with_distances
    stored, prepared = restore(stored, objects, (source_mesh, target_mesh), half.prefix, progress)
    write_answer(objects, stored, prepared, half.prefix)
    return stored, (objects[0].name, objects[1].name)


def _check_topology(half: Half) -> None:
    """Make sure that stored vertex numbers mean what they meant."""
    if not half.has_same_faces():
        raise ObjectError(
            f'"{half.obj.name}" has other vertices or faces than when it was matched, so the stored match does not '
            "fit it any more. Match again."
        )


def _with_maps(
    stored: StoredMatch,
    objects: tuple[bpy.types.Object, bpy.types.Object],
    meshes: tuple[TriangleMesh, TriangleMesh],
    prefix: str,
    progress: Callable[[float], None],
) -> tuple[StoredMatch, tuple[Content, Content]]:
    """Prepare the chosen answer from its dense maps, which are made if the meshes do not keep them."""
    source, target = (mesh_of(obj) for obj in objects)
    shown = StoredMaps.read(source, target, map_name(prefix))
    maps = StoredMaps.read(source, target, map_name(prefix, other=True))
    if maps is None:
        points = restored(stored, meshes)
        dense = _drive(densify_steps(*meshes, points.source_points, points.target_points), progress)
        maps = StoredMaps.of(dense.source_to_target, dense.target_to_source)
        stored = stored.with_quality(dense.quality)
    return stored, contents_with_maps(stored, meshes, prefix, maps, shown)


def _with_distances(
    stored: StoredMatch,
    _objects: tuple[bpy.types.Object, bpy.types.Object],
    meshes: tuple[TriangleMesh, TriangleMesh],
    prefix: str,
    progress: Callable[[float], None],
) -> tuple[StoredMatch, tuple[Content, Content]]:
    """Prepare the chosen answer from the distances between its points and the vertices."""
    answer, (source, target) = restored(stored, meshes), meshes
    if stored.written.match_colors or stored.written.distortion:
        from_source = _drive(_distances_steps(source, answer.source_points), lambda done: progress(done / 2))
        from_target = _drive(_distances_steps(target, answer.target_points), lambda done: progress((1 + done) / 2))
        answer = replace(answer, source_distances=from_source, target_distances=from_target)
    return stored, contents(answer, prefix, stored.written, left_out=stored.left_out)


def _distances_steps(mesh: TriangleMesh, points: SurfacePoints) -> Steps[NDArray[np.float64]]:
    """Measure the distances from points to all vertices of a mesh, as a match does."""
    shape = yield from within(Shape.steps(mesh), 0.0, 0.2)
    own = points if shape.surface.is_whole else shape.surface.on_mesh(points)
    return (yield from within(to_all_vertices_steps(SurfaceDistances(shape), own), 0.2, 1.0))


def _drive(steps: Steps[_Result], progress: Callable[[float], None]) -> _Result:
    """Drive a computation to its end, telling how far it is."""
    while True:
        try:
            progress(next(steps).fraction)
        except StopIteration as stop:
            return cast("_Result", stop.value)
