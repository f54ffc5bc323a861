# SPDX-License-Identifier: GPL-3.0-or-later
"""Local similarities fitted to a map of a surface: the motion of the space around it."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any, ClassVar

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from ...geometry.procrustes import nearest_orthogonal
from ...mesh.closest_points import spatial_order
from ...mesh.surface_points import SurfacePoints
from ...mesh.triangle_mesh import TriangleMesh
from ...runtime.arrays import Floats, Ints, group_sums, slices, unit_vectors

_NEIGHBOURS = 32
"""Places on the surface that a similarity is fitted to."""

_FEWEST = 4 * _NEIGHBOURS
"""No coarser set of places is made of fewer than these."""

_LARGEST_STRETCH = 4.0
"""By what factor the scale may differ from place to place: more is a place where the map has collapsed."""

_CHUNK = 20_000
"""Points treated at once, which bounds the memory."""


@dataclass(frozen=True, eq=False)
class Similarities:
    """Maps :math:`p -> t + s R (p - c)`, one for each point.

    Attributes
    ----------
    rotations : (k, 3, 3) array of float
        R: orthogonal, with a reflection if the map of the surface has one.
    scales : (k,) array of float
        s.
    sources, targets : (k, 3) array of float
        c and t.
    """

    rotations: Floats
    scales: Floats
    sources: Floats
    targets: Floats

    def __call__(self, points: Floats) -> Floats:
        """Apply each to a point, (k, 3)."""
        turned = np.einsum("kij,kj->ki", self.rotations, points - self.sources)
        return self.targets + self.scales[:, None] * turned


@dataclass(frozen=True, eq=False)
class _Places:
    """Places on the surface (k, 3), their images, the normals at both, and the area each stands for."""

    spacing: float
    positions: Floats
    images: Floats
    normals: Floats
    image_normals: Floats
    areas: Floats

    @cached_property
    def tree(self) -> cKDTree:
        """Search for the nearest places."""
        return cKDTree(self.positions, balanced_tree=False, compact_nodes=False)


class Surroundings:
    """Moving least squares around a mapped surface.

    Parameters
    ----------
    mesh : TriangleMesh
        The surface.
    other : TriangleMesh
        The surface that it is mapped to.
    images : SurfacePoints
        For each vertex of the one, a point of the other.

    Notes
    -----
    Around each point that similarity is taken which moves places on the surface nearby most closely to their images,
    in the sense of least squares [1]_; normals count like points one distance above the surface.  The further away a
    point, the coarser and wider the set of places: it follows the limb, not each ripple of the map.

    References
    ----------
    .. [1] S. Schaefer, T. McPhail, J. Warren, "Image deformation using moving least squares", SIGGRAPH 2006.
    """

    is_sent_once: ClassVar[bool] = True

    def __init__(self, mesh: TriangleMesh, other: TriangleMesh, images: SurfacePoints) -> None:
        image_normals = unit_vectors(images.interpolate(other.vertex_normals))
        vectors = mesh.vertices, images.positions, mesh.vertex_normals, image_normals
        self._levels = [_Places(float(np.sqrt(mesh.area / mesh.vertex_count)), *vectors, mesh.vertex_areas)]
        while (coarser := _coarser(self._levels[-1])) is not None:
            self._levels.append(coarser)
        a, b, c = (images.positions[corner] for corner in mesh.triangles.T)
        facing = image_normals[mesh.triangles].sum(axis=1)
        self._handedness = -1.0 if np.einsum("md,md->", np.cross(b - a, c - a), facing) < 0 else 1.0
        self._mean_scale = float(np.sqrt(other.area / mesh.area))

    def nearest(self, points: Floats) -> tuple[Floats, Ints]:
        """Find the nearest vertex of the surface to points (k, 3): distances (k,) and vertices (k,)."""
        distances, vertices = np.empty(len(points)), np.empty(len(points), np.int64)
        order = spatial_order(points)
        distances[order], vertices[order] = self._levels[0].tree.query(points[order])
        return distances, vertices

    def similarities(self, points: Floats, reach: Floats) -> Similarities:
        """Fit a similarity around each point.

        Parameters
        ----------
        points : (k, 3) array of float
            Points in space.
        reach : (k,) array of float
            How wide the surroundings are that each should follow: its distance from the surface, or the size of what
            it is the centre of.

        Returns
        -------
        Similarities
            One for each point.
        """
        k = len(points)
        result = Similarities(np.empty((k, 3, 3)), np.empty(k), np.empty((k, 3)), np.empty((k, 3)))
        spacings = np.array([level.spacing for level in self._levels])
        levels = (np.searchsorted(spacings, reach / 2, side="right") - 1).clip(min=0)
        order = spatial_order(points)
        for number, level in enumerate(self._levels):
            chosen = order[levels[order] == number]
            for rows in slices(len(chosen), _CHUNK):
                part = chosen[rows]
                self._fit(result, part, points[part], reach[part], level)
        return result

    def _fit(self, result: Similarities, part: Ints, points: Floats, reach: Floats, places: _Places) -> None:
        """Fit the similarities of some points."""
        count = min(_NEIGHBOURS, len(places.positions))
        distances, near = places.tree.query(points, count)
        distances, near = distances.reshape(-1, count), near.reshape(-1, count)
        width = np.maximum(reach, places.spacing)[:, None]
        # Relative to the width, so that the unit of length does not matter.
        weights = places.areas[near] / ((distances / width) ** 2 + 0.25) ** 2
        total = weights.sum(axis=1, keepdims=True)
        # Places without an area, at needles, are no reason to know nothing.
        weights = np.where(total > 0, weights / np.where(total > 0, total, 1), 1 / count)
        centre = np.einsum("kn,knd->kd", weights, places.positions[near])
        target = np.einsum("kn,knd->kd", weights, places.images[near])
        x, y = places.positions[near] - centre[:, None], places.images[near] - target[:, None]
        x_spread, y_spread = (np.sqrt(np.einsum("kn,knd,knd->k", weights, side, side)) for side in (x, y))
        scale = y_spread / np.where(x_spread > 0, x_spread, 1)
        scale = scale.clip(self._mean_scale / _LARGEST_STRETCH, self._mean_scale * _LARGEST_STRETCH)
        # Without units; where all places fell together the normals are what is left.
        x, y = (
            side / np.where(spread > 0, spread, 1)[:, None, None] for side, spread in ((x, x_spread), (y, y_spread))
        )
        moments = np.einsum("kn,kni,knj->kij", weights, y, x)
        moments += np.einsum("kn,kni,knj->kij", weights, places.image_normals[near], places.normals[near])
        result.rotations[part] = nearest_orthogonal(moments, self._handedness)
        result.scales[part], result.sources[part], result.targets[part] = scale, centre, target


def _coarser(places: _Places) -> _Places | None:
    """Average places in the cells of a grid, twice as far apart; none if too few would be left."""
    spacing = 2 * places.spacing
    cells = np.floor((places.positions - places.positions.min(axis=0)) / spacing).astype(np.int64)
    sides = cells.max(axis=0) + 1
    _, number = np.unique((cells[:, 0] * sides[1] + cells[:, 1]) * sides[2] + cells[:, 2], return_inverse=True)
    number = number.ravel()
    count = int(number.max()) + 1
    if count < _FEWEST:
        return None
    # A least area, so that cells of needles only have a mean as well.
    areas = np.maximum(places.areas, 1e-9 * places.areas.mean())
    totals: NDArray[Any] = np.bincount(number, areas, count)
    vectors = (places.positions, places.images, places.normals, places.image_normals)
    positions, images, normals, image_normals = (
        group_sums(number, areas[:, None] * values, count) / totals[:, None] for values in vectors
    )
    return _Places(spacing, positions, images, normals, image_normals, totals)
