# SPDX-License-Identifier: GPL-3.0-or-later
"""Planes in which a surface is its own mirror image, whatever its vertices."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..runtime.arrays import TINY, Floats
from .area_samples import even_samples
from .closest_points import ClosestPoints
from .triangle_mesh import TriangleMesh

_SAMPLES = 1000
"""Places of a surface that are compared with their mirror images."""

_ROUNDS = 8
"""Rounds of looking for what is nearest to the mirror images, and of moving the plane."""

_FAR, _NEARER, _NEAR = 0.1, 0.4, 0.002
"""Distance from a mirror image, in units of the extent, at which a place counts a quarter: at first, its factor from
one round to the next, and in the end."""

_MOST_MISSED = 0.5
"""Part of the surface without a mirror image from which on a plane is none."""

_UNDETERMINED = 1e-4
"""Part of the largest singular value below which a motion of the plane changes nothing, as on a ball."""

_SAME_AXIS, _SAME_START = 0.9, 0.98
"""Cosine of the angle between planes from which on they are the same, and lead to the same."""


@dataclass(frozen=True, eq=False)
class MirrorPlane:
    """A plane, by a point (3,) in it and its unit normal (3,)."""

    middle: Floats
    axis: Floats

    def reflected(self, points: Floats) -> Floats:
        """Mirror points (n, 3)."""
        return points - 2 * np.outer((points - self.middle) @ self.axis, self.axis)

    def reflected_directions(self, directions: Floats) -> Floats:
        """Mirror directions (n, 3), which have no place."""
        return directions - 2 * np.outer(directions @ self.axis, self.axis)

    def is_along(self, other: MirrorPlane, cosine: float = _SAME_AXIS) -> bool:
        """Tell whether another plane has nearly the same direction."""
        return bool(abs(self.axis @ other.axis) > cosine)

    @classmethod
    def between(cls, points: Floats, images: Floats, counts: Floats) -> MirrorPlane:
        """Fit the plane between points (n, 3) and images (n, 3), which count (n,)."""
        ways = points - images
        axis = np.linalg.eigh((counts[:, None] * ways).T @ ways)[1][:, -1]
        return cls(counts @ (points + images) / (2 * max(float(counts.sum()), TINY)), axis)


def mirror_planes(mesh: TriangleMesh) -> list[MirrorPlane]:
    """Find the planes in which most of a surface is its own mirror image.

    Parameters
    ----------
    mesh : TriangleMesh
        The surface, whose vertices need not be mirrored; of one triangle with an area at least.

    Returns
    -------
    list of MirrorPlane
        The planes, of those that are found from the axes of space and of the surface; the best first.
    """
    points, search = even_samples(mesh, mesh.area / _SAMPLES).positions, ClosestPoints(mesh)
    middle = (mesh.vertices.min(axis=0) + mesh.vertices.max(axis=0)) / 2
    centred = points - points.mean(axis=0)
    extent = max(float(np.linalg.norm(np.ptp(mesh.vertices, axis=0))), TINY)
    found: list[tuple[float, MirrorPlane]] = []
    starts: list[MirrorPlane] = []
    for axis in np.concatenate([np.eye(3), np.linalg.eigh(centred.T @ centred)[1].T]):
        plane, far = MirrorPlane(middle, axis), _FAR
        if any(plane.is_along(start, _SAME_START) for start in starts):
            continue
        starts.append(plane)
        for _ in range(_ROUNDS):  # what has no mirror image counts less and less
            plane = _fitted(plane, points, search, mesh, far * extent)
            far = max(_NEARER * far, _NEAR)
        # A body that is flat is nearly its own mirror image in that plane, too, but not as exactly.
        away = np.sqrt(search.nearest(plane.reflected(points)).squared_distances)
        found.append((float((away > _NEAR * extent).mean()), plane))
    planes: list[MirrorPlane] = []
    for missed, plane in sorted(found, key=lambda each: each[0]):
        if missed < _MOST_MISSED and not any(plane.is_along(other) for other in planes):
            planes.append(plane)
    return planes


def _fitted(plane: MirrorPlane, points: Floats, search: ClosestPoints, mesh: TriangleMesh, far: float) -> MirrorPlane:
    """Move a plane by a step of Gauss and Newton that brings mirrored points (n, 3) nearer to the surface.

    To the planes that touch it where it is nearest: along those they may slide.  What is `far` away counts a quarter.
    """
    mirrored, places = plane.reflected(points), points - plane.middle
    nearest = search.nearest(mirrored)
    normals = mesh.triangle_normals[nearest.triangles]
    away = mirrored - nearest.interpolate(mesh.triangles, mesh.vertices)
    across = np.linalg.svd(plane.axis[None])[2][1:]  # (2, 3): the axis may tilt either way
    facing, unit = normals @ plane.axis, max(float(np.abs(places).max()), TINY)
    tilted = -(places @ across.T) * facing[:, None] - (places @ plane.axis)[:, None] * (normals @ across.T)
    changes = 2 * np.concatenate([tilted, unit * facing[:, None]], axis=1)
    counts = 1 / (1 + nearest.squared_distances / far**2)
    errors = np.einsum("ni,ni->n", away, normals)
    step = np.linalg.lstsq(counts[:, None] * changes, -counts * errors, rcond=_UNDETERMINED)[0]
    axis = plane.axis + step[:2] @ across
    return MirrorPlane(plane.middle + unit * step[2] * plane.axis, axis / np.linalg.norm(axis))
