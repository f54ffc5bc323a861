# SPDX-License-Identifier: GPL-3.0-or-later
"""Write the other answer of a match that is kept on two meshes."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

import numpy as np

from ..engine import Shape, SurfacePoints
from ..engine.surface_distances import SurfaceDistances, to_all_vertices_steps
from . import writing
from .access import mesh_of, view_layer_of
from .errors import ObjectError
from .mesh_io import read_mesh, topology
from .pair import check_pair
from .stored_match import CornerPoints, StoredMatch

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    import bpy
    from numpy.typing import NDArray

    from ..engine import TriangleMesh

__all__ = ["Half", "find_half", "find_keyed", "flip"]


@dataclass(frozen=True)
class Half:
    """What one of the two objects carries of a match.

    Attributes
    ----------
    obj : bpy.types.Object
        The object.
    prefix : str
        What all names written start with.
    kept : dict
        Its part of the stored match.
    """

    obj: bpy.types.Object
    prefix: str
    kept: dict[str, Any]

    @property
    def name(self) -> str:
        """The object's name when it was matched."""
        return str(self.kept["names"][self.kept["role"]])

    @property
    def partner_name(self) -> str:
        """The other object's name then."""
        return str(self.kept["names"][self.partner_role])

    @property
    def partner_role(self) -> str:
        """What the other object is."""
        return "target" if self.kept["role"] == "source" else "source"


@dataclass(frozen=True, eq=False)
class _Points:
    """Stored points, placed on the mesh as it is now."""

    corners: NDArray[np.int64]
    barycentric: NDArray[np.float64]
    nearest_vertices: NDArray[np.int64]
    positions: NDArray[np.float64]

    def __len__(self) -> int:
        return len(self.corners)


@dataclass(frozen=True, eq=False)
class _Restored:
    """An answer as the engine had given it; a `Correspondence`."""

    source_points: _Points
    target_points: _Points
    point_distortion: NDArray[np.float64]
    source_distances: NDArray[np.float64]
    target_distances: NDArray[np.float64]


def find_half(obj: bpy.types.Object, prefix: str = "") -> Half:
    """Find the match that an object carries.

    Parameters
    ----------
    obj : bpy.types.Object
        The object.
    prefix : str
        What the names that the match wrote start with; may be empty if there is one match only.

    Raises
    ------
    ObjectError
        If there is no such match, or several.
    """
    candidates = [Half(obj, name, writing.kept(obj, name)) for name in _prefixes(obj) if prefix in ("", name)]
    found = [half for half in candidates if half.kept]
    if not found:
        of_prefix = f' with the Prefix "{prefix}"' if prefix else ""
        raise ObjectError(f'"{obj.name}" carries no match{of_prefix}. Match it first.')
    if len(found) > 1:
        prefixes = ", ".join(f'"{half.prefix}"' for half in found)
        raise ObjectError(f'"{obj.name}" carries several matches. Name the Prefix of one of them: {prefixes}.')
    return found[0]


def find_keyed(view_layer: bpy.types.ViewLayer, key: str, prefix: str, role: str, name: str) -> Half:
    """Find the object that carries one side of a match.

    Parameters
    ----------
    view_layer : bpy.types.ViewLayer
        Where to look.
    key, prefix : str
        Which match.
    role : str
        "source" or "target".
    name : str
        What the object was called; of several copies, the one that still has this name is meant.

    Raises
    ------
    ObjectError
        If there is none, or no telling which.
    """
    carriers = [
        Half(obj, prefix, kept)
        for obj in view_layer.objects
        if prefix in _prefixes(obj)
        and (kept := writing.kept(obj, prefix))
        and (kept["key"], kept["role"]) == (key, role)
    ]
    if not carriers:
        if name in view_layer.objects:
            raise ObjectError(
                f'"{name}" does not carry this match any more, because it was cleared or matched anew. '
                "Match the two again."
            )
        raise ObjectError(
            f'The {role} of this match, "{name}", was deleted or is not in the view layer "{view_layer.name}". '
            "Bring it back, or match again."
        )
    named = [half for half in carriers if half.obj.name == name] if len(carriers) > 1 else carriers
    if not named:
        names = ", ".join(f'"{half.obj.name}"' for half in carriers)
        raise ObjectError(f"Several objects are copies of the {role} of this match: {names}. Match the two again.")
    return named[0]


def flip(
    context: bpy.types.Context, half: Half, progress: Callable[[float], None]
) -> tuple[StoredMatch, tuple[str, str]]:
    """Write the other answer of a match in place of the one that is written.

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
    ObjectError
        If there is no other answer, or the meshes are not what they were; nothing is written then.
    """
    depsgraph = context.evaluated_depsgraph_get()  # brings world matrices up to date, too
    view_layer = view_layer_of(context)
    partner = find_keyed(view_layer, half.kept["key"], half.prefix, half.partner_role, half.partner_name)
    source, target = (half, partner) if half.kept["role"] == "source" else (partner, half)
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
    stored = replace(stored, mirrored=not half.kept["mirrored"])
    meshes = [read_mesh(obj, depsgraph, use_modifiers=stored.written.use_modifiers) for obj in objects]
    kinds = {name: getattr(stored.written, name) for name in ("vertex_groups", "match_colors", "distortion")}
    contents = writing.contents(_restore(stored, meshes, progress), half.prefix, **kinds)
    for obj, content, kept in zip(objects, contents, stored.to_plain(), strict=True):
        writing.check_names(obj, content)
        content.keep.update(kept)
    writing.write(list(zip(objects, contents, strict=True)), half.prefix, show=False)
    return stored, (objects[0].name, objects[1].name)


def _prefixes(obj: bpy.types.Object) -> tuple[str, ...]:
    return writing.prefixes(obj) if obj.type == "MESH" else ()


def _check_topology(half: Half) -> None:
    """Make sure that stored vertex numbers mean what they meant."""
    if topology(mesh_of(half.obj)) != half.kept["topology"]:
        raise ObjectError(
            f'"{half.obj.name}" has other vertices or faces than when it was matched, so the stored match does not '
            "fit it any more. Match again."
        )


def _restore(stored: StoredMatch, meshes: Sequence[TriangleMesh], progress: Callable[[float], None]) -> _Restored:
    """Put the chosen answer on the meshes."""
    answer, (source, target) = stored.answer, meshes
    source_points, target_points = _placed(stored.source_points, source), _placed(answer.target_points, target)
    source_distances = target_distances = np.empty((0, 0))
    if stored.written.match_colors or stored.written.distortion:
        source_distances = _distances(source, source_points, lambda done: progress(done / 2))
        target_distances = _distances(target, target_points, lambda done: progress((1 + done) / 2))
    return _Restored(source_points, target_points, answer.point_distortion, source_distances, target_distances)


def _placed(points: CornerPoints, mesh: TriangleMesh) -> _Points:
    positions = np.einsum("kc,kcd->kd", points.barycentric, mesh.vertices[points.corners])
    return _Points(points.corners, points.barycentric, points.nearest_vertices, positions)


def _distances(mesh: TriangleMesh, points: _Points, progress: Callable[[float], None]) -> NDArray[np.float64]:
    """Measure the distances from points to all vertices of a mesh, the same to the last bit as a match does."""
    shape = Shape(mesh)
    corners = np.searchsorted(shape.vertices, points.corners)
    steps = to_all_vertices_steps(
        SurfaceDistances(shape), SurfacePoints.from_corners(shape.mesh, corners, points.barycentric)
    )
    while True:
        try:
            progress(next(steps).fraction)
        except StopIteration as stop:
            rows: NDArray[np.float64] = stop.value
            return rows
