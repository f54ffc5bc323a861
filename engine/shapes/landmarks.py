# SPDX-License-Identifier: GPL-3.0-or-later
"""Pairs of corresponding vertices that the user names, and where they are on what is matched."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike
from scipy.optimize import linear_sum_assignment

from ..mesh.surface_points import SurfacePoints
from ..mesh.triangle_mesh import TriangleMesh
from ..runtime.arrays import Ints
from ..runtime.errors import MatchError
from .prepared_surface import PreparedSurface
from .shape import Shape


@dataclass(frozen=True, eq=False)
class LandmarkPlaces:
    """Landmarks on one of the two meshes.

    Attributes
    ----------
    original : (k,) array of int
        Their vertices on the mesh as it was given.
    main : (k,) array of int
        The same on its main part, cleaned; all differ.
    matched : (k,) array of int
        Vertices of the surface that is matched that stand for them; all differ.  Where that surface is a coarse proxy,
        they are only near to the landmarks.
    """

    original: Ints
    main: Ints
    matched: Ints

    def __len__(self) -> int:
        return len(self.original)


@dataclass(frozen=True, eq=False)
class Landmarks:
    """Corresponding landmarks, k on each mesh.

    Attributes
    ----------
    source, target : LandmarkPlaces
        Where they are: the i-th of one corresponds to the i-th of the other.
    assumed : bool
        Whether that is not known, but tried.
    """

    source: LandmarkPlaces
    target: LandmarkPlaces
    assumed: bool = False

    def __len__(self) -> int:
        return len(self.source)


def locate_landmarks(x: Shape, y: Shape, pairs: ArrayLike, most: int, *, assumed: bool = False) -> Landmarks:
    """Find landmarks on the surfaces that are matched.

    Parameters
    ----------
    x, y : Shape
        Source and target.
    pairs : (k, 2) array_like of int
        Vertices of the original source and of the original target.
    most : int
        How many there may be.
    assumed : bool
        Whether it is only tried that they correspond.

    Raises
    ------
    MatchError
        If they are no such pairs, are too many, name a vertex twice, one that does not exist, or one that is not on the
        main part of its mesh.
    """
    source, target = landmark_pairs(x, y, pairs, most).T
    return Landmarks(_places(x.surface, source, "source"), _places(y.surface, target, "target"), assumed)


def landmark_pairs(x: Shape, y: Shape, pairs: ArrayLike | None, most: int) -> Ints:
    """Check what can be checked of landmarks before it is known which parts of the surfaces are matched.

    Parameters
    ----------
    x, y, pairs, most
        As in `locate_landmarks`; None stands for no landmarks.

    Returns
    -------
    (k, 2) array of int
        The pairs.

    Raises
    ------
    MatchError
        If they are no such pairs, are too many, name a vertex twice, or one that does not exist.
    """
    array = vertex_pairs(pairs)
    if len(array) > most:
        raise MatchError(
            f"{len(array)} landmarks are more than the {most} points that are matched. "
            "Use more points or fewer landmarks."
        )
    for surface, vertices, name in zip((x.surface, y.surface), array.T, ("source", "target"), strict=True):
        _check_vertices(vertices, surface.original.vertex_count, name)
    return array


def vertex_pairs(pairs: ArrayLike | None) -> Ints:
    """Return landmarks as an array (k, 2) of vertices of the source and of the target; None stands for no landmarks.

    Raises
    ------
    MatchError
        If they are no such pairs.
    """
    try:
        array = np.asarray([] if pairs is None else pairs)
    except ValueError:  # rows of different lengths
        array = np.array(None)
    if array.size == 0:
        return np.empty((0, 2), np.int64)
    whole = np.issubdtype(array.dtype, np.integer) and array.max() <= np.iinfo(np.int64).max
    if array.ndim != 2 or array.shape[1] != 2 or not whole:
        raise MatchError(
            "Landmarks should be pairs of vertex numbers, first of the source and then of the target: whole numbers in "
            f"an array of the shape (k, 2), not {array.dtype} in the shape {array.shape}."
        )
    return array.astype(np.int64)


def placed_at_vertices(points: SurfacePoints, mesh: TriangleMesh, rows: Ints, vertices: Ints) -> SurfacePoints:
    """Put some points of a mesh, `rows` (q,), exactly at vertices (q,); each of these must have a triangle."""
    exact = SurfacePoints.at_vertices(mesh, vertices)
    triangles, barycentric = points.triangles.copy(), points.barycentric.copy()
    triangles[rows], barycentric[rows] = exact.triangles, exact.barycentric
    return SurfacePoints.from_barycentric(mesh, triangles, barycentric)


def _check_vertices(vertices: Ints, count: int, name: str) -> None:
    """Raise an error if vertices (k,) of a mesh of so many are named twice, or are none."""
    for bad in np.flatnonzero((vertices < 0) | (vertices >= count))[:1]:
        raise MatchError(
            f"Landmark {bad + 1} is at vertex {vertices[bad]} of the {name}, which has no such vertex: they are "
            f"numbered from 0 to {count - 1}."
        )
    for first, second in _repeated(vertices):
        raise MatchError(
            f"Landmarks {first + 1} and {second + 1} are both at vertex {vertices[first]} of the {name}. "
            "Use a vertex for one landmark only."
        )


def _places(surface: PreparedSurface, vertices: Ints, name: str) -> LandmarkPlaces:
    """Find landmarks on one mesh, or raise an error."""
    for bad in np.flatnonzero(surface.cleaned.vertex_parts[vertices] != 0)[:1]:
        raise MatchError(
            f"Landmark {bad + 1} is at vertex {vertices[bad]} of the {name}, which is not on its main part, "
            "the one that is matched. Choose a vertex on that part that is not left out."
        )
    main = surface.cleaned.vertex_images[vertices]
    for first, second in _repeated(main):
        raise MatchError(
            f"Landmarks {first + 1} and {second + 1} are at the same place of the {name}, at its vertices "
            f"{vertices[first]} and {vertices[second]}. Remove one of them."
        )
    return LandmarkPlaces(vertices, main, main if surface.proxy.is_identity else _on_proxy(surface, main))


def _repeated(numbers: Ints) -> list[tuple[int, int]]:
    """Places of the first two numbers that are the same, if there are any."""
    order = np.argsort(numbers, kind="stable")
    same = np.flatnonzero(np.diff(numbers[order]) == 0)[:1]
    return [(int(order[i]), int(order[i + 1])) for i in same]


def _on_proxy(surface: PreparedSurface, main: Ints) -> Ints:
    """Choose a vertex of the proxy for each vertex of the main part: the nearest, or one beside it if that is taken."""
    nearest = surface.proxy.points.nearest_vertices[main]
    if len(np.unique(nearest)) == len(nearest):
        return nearest
    offsets = surface.cleaned.mesh.vertices[main][:, None] - surface.mesh.vertices
    _, chosen = linear_sum_assignment(np.square(offsets).sum(axis=2))
    return np.asarray(chosen, np.int64)
