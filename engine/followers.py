# SPDX-License-Identifier: GPL-3.0-or-later
"""From a map of the main part of a mesh to a map of every vertex: what is beside the main part follows it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from scipy.optimize import linear_sum_assignment

from .closest_points import ClosestPoints
from .surface import SurfacePoints
from .surroundings import Surroundings

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

    from .clean_surface import CleanSurface
    from .closest_points import FoundPoints
    from .mesh import TriangleMesh

__all__ = ["FollowedMap", "follow"]

_LARGEST_OFFSET = 1.5
"""How far from where it is expected a partner may be, in sums of the two radii."""

_BLUR = 0.01
"""How exactly the place of a part can be known from its surroundings, in units of the root of the main part's area."""

_LARGEST_RATIO = 2.0
"""By what factor the radii of partners may differ, once the scale of the surroundings is allowed for."""

_LARGEST_DEFORMATION = 0.3
"""How much the widths of partners along their main axes may differ, in radii."""

_TRUSTED_DISTANCE = 0.05
"""Distance from the main part at which confidence is halved, in units of the root of its area."""


@dataclass(frozen=True, eq=False)
class FollowedMap:
    """A map of every vertex of an original mesh.

    Attributes
    ----------
    points : SurfacePoints
        For each vertex of X, a point of the original mesh Y.
    confidence : (n,) array of float
        For each, a factor between 0 and 1 for the confidence of the map of the main part at `surroundings`: 1 for the
        vertices of the main part itself.
    surroundings : (n,) array of int
        The vertex of the main part of X that each is, or that is nearest to it.
    partners : (p,) array of int
        For each part of X, the part of Y that it is mapped to; 0 for the main part.  A part other than the main one
        with 0 follows its surroundings onto the main part of Y.
    """

    points: SurfacePoints
    confidence: NDArray[np.float64]
    surroundings: NDArray[np.int64]
    partners: NDArray[np.int64]


def follow(x: CleanSurface, y: CleanSurface, main_map: SurfacePoints) -> FollowedMap:
    """Extend a map of the main part to every vertex of the mesh.

    Parameters
    ----------
    x, y : CleanSurface
        The meshes.
    main_map : SurfacePoints
        For each vertex of ``x.mesh``, a point of ``y.mesh``.

    Returns
    -------
    FollowedMap
        A point of ``y.original`` for each vertex of ``x.original``.

    Notes
    -----
    Beside the main part there may be eyes, teeth, buttons, and loose vertices.  Where they are expected on Y is known
    from how the main part moves around them.  If Y has a part there of about the same size and shape, that part
    is the partner: the two are laid over each other, centre on centre, and each vertex is mapped to the closest point.
    What finds no partner goes to the closest point of the main part of Y, searched from the image of the nearest vertex
    along the surface, so that it does not jump to another limb.
    """
    n = x.original.vertex_count
    triangles, barycentric, confidence = np.empty(n, np.int64), np.empty((n, 3)), np.ones(n)
    surroundings = np.maximum(x.vertex_images, 0)
    partners = np.zeros(len(x.pieces), np.int64)
    main = np.flatnonzero(x.vertex_parts == 0)
    images = x.vertex_images[main]
    triangles[main], barycentric[main] = y.main.to_original(main_map.triangles[images], main_map.barycentric[images])
    others = np.flatnonzero(x.vertex_parts != 0)
    if len(others):
        around = Surroundings(x.mesh, y.mesh, main_map)
        distances, surroundings[others] = around.nearest(x.original.vertices[others])
        partners[1:], pairs = _partners(x.parts, y.parts, around, y.mesh)
        single = partners[x.vertex_parts[others]] == 0
        single |= x.vertex_parts[others] < 0
        alone = others[single]
        if len(alone):
            points, distances = x.original.vertices[alone], distances[single]
            moved = around.similarities(points, distances)(points)
            found = ClosestPoints(y.mesh).walk(moved, main_map.nearest_vertices[surroundings[alone]])
            triangles[alone], barycentric[alone] = y.main.to_original(found.triangles, found.barycentric)
            confidence[alone] = 1 / (1 + (distances / (_TRUSTED_DISTANCE * np.sqrt(x.mesh.area))) ** 2)
        members = others[~single]
        members = members[np.argsort(x.vertex_parts[members], kind="stable")]
        starts = np.searchsorted(x.vertex_parts[members], np.arange(len(x.pieces) + 1))
        for pair in pairs:
            vertices = members[starts[pair.part] : starts[pair.part + 1]]
            found = _onto_partner(x, y, pair, vertices)
            partner = y.pieces[pair.partner]
            triangles[vertices], barycentric[vertices] = partner.to_original(found.triangles, found.barycentric)
            confidence[vertices] = 1 / (1 + pair.difference)
    points = SurfacePoints.from_barycentric(y.original, triangles, barycentric)
    return FollowedMap(points, confidence, surroundings, partners)


@dataclass(frozen=True, eq=False)
class _Pair:
    """Parts that belong together, by their numbers: how x -> centre + ratio R (x - old centre) lays one on the other.

    `radius` is that of the partner, `difference` how far they are from alike: 0 if they are.
    """

    part: int
    partner: int
    rotation: NDArray[np.float64]
    ratio: float
    old_centre: NDArray[np.float64]
    centre: NDArray[np.float64]
    radius: float
    difference: float


@dataclass(frozen=True, eq=False)
class _Extents:
    """Centres (p, 3), areas (p,), root mean square radii (p,) and widths along the main axes in radii (p, 3)."""

    centres: NDArray[np.float64]
    areas: NDArray[np.float64]
    radii: NDArray[np.float64]
    widths: NDArray[np.float64]

    @classmethod
    def of(cls, parts: Sequence[TriangleMesh]) -> _Extents:
        """Integrate over the surfaces of parts."""
        centres, moments = np.empty((len(parts), 3)), np.empty((len(parts), 3, 3))
        areas = np.array([part.area for part in parts])
        for index, part in enumerate(parts):
            shares = part.triangle_areas / part.area
            corners = part.vertices[part.triangles]
            middles = corners.mean(axis=1)
            centres[index] = shares @ middles
            away, middles = corners - centres[index], middles - centres[index]
            moments[index] = np.einsum("m,mci,mcj->ij", shares, away, away) / 12
            moments[index] += np.einsum("m,mi,mj->ij", shares, middles, middles) * 9 / 12
        spreads = np.sqrt(np.linalg.eigvalsh(moments).clip(min=0))
        radii = np.linalg.norm(spreads, axis=1)
        return cls(centres, areas, radii, spreads / radii[:, None])


def _partners(
    x_parts: Sequence[TriangleMesh], y_parts: Sequence[TriangleMesh], around: Surroundings, y_main: TriangleMesh
) -> tuple[NDArray[np.int64], list[_Pair]]:
    """Find which parts of X and Y, numbered from 1, belong together: the partner of each or 0, and the pairs."""
    partners = np.zeros(len(x_parts), np.int64)
    if not x_parts or not y_parts:
        return partners, []
    x, y = _Extents.of(x_parts), _Extents.of(y_parts)
    distances, _ = around.nearest(x.centres)
    similarities = around.similarities(x.centres, np.maximum(x.radii, distances))
    expected, radii = similarities(x.centres), similarities.scales * x.radii

    gap = np.linalg.norm(expected[:, None] - y.centres, axis=2)
    offset = gap / (radii[:, None] + y.radii + _BLUR * np.sqrt(y_main.area))
    size = np.abs(np.log(radii[:, None] / y.radii)) / np.log(_LARGEST_RATIO)
    areas = similarities.scales**2 * x.areas
    size = np.maximum(size, np.abs(np.log(areas[:, None] / y.areas)) / np.log(_LARGEST_RATIO**2))
    shape = np.abs(x.widths[:, None] - y.widths).max(axis=2) / _LARGEST_DEFORMATION
    difference = offset / _LARGEST_OFFSET + size + shape
    possible = (offset <= _LARGEST_OFFSET) & (size <= 1) & (shape <= 1)
    # No pair costs more than leaving a part alone, so that as many as possible are made.
    rows, columns = linear_sum_assignment(np.where(possible, difference, 10.0))

    pairs = []
    for i, j in zip(rows, columns, strict=True):
        if possible[i, j]:
            partners[i] = j + 1
            ratio = float(y.radii[j] / x.radii[i])
            rotation, weight = similarities.rotations[i], float(difference[i, j])
            pair = _Pair(int(i) + 1, int(j) + 1, rotation, ratio, x.centres[i], y.centres[j], float(y.radii[j]), weight)
            pairs.append(pair)
    return partners, pairs


def _onto_partner(x: CleanSurface, y: CleanSurface, pair: _Pair, vertices: NDArray[np.int64]) -> FoundPoints:
    """Map vertices of a part to the closest points of its partner."""
    normals = x.pieces[pair.part].mesh.vertex_normals[x.vertex_images[vertices]] @ pair.rotation.T
    away = x.original.vertices[vertices] - pair.old_centre
    moved = pair.centre + pair.ratio * (away @ pair.rotation.T)
    # The normals tell the two sides of a thin part from each other.
    return ClosestPoints(y.pieces[pair.partner].mesh).nearest(
        moved, normals, normal_length=pair.radius / 4, normal_weight=pair.radius**2 / 4
    )
