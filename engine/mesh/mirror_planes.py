# SPDX-License-Identifier: GPL-3.0-or-later
"""Planes in which points are mirror images of each other."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.spatial import cKDTree

from ..runtime.arrays import TINY, Floats

_MOST_POINTS = 1000
"""Points that are compared with their mirror images."""

_ROUNDS = 16
"""Rounds of pairing and fitting."""

_FAR, _NEARER, _NEAR = 0.1, 0.6, 0.002
"""Distance from a mirror image, in units of the extent, at which a pair counts a quarter: at first, its factor from one
round to the next, and in the end."""

_MOST_MISSED = 0.5
"""Part of the points without a mirror image from which on a plane is none."""

_SAME_AXIS = 0.9
"""Cosine of the angle between planes from which on they are the same."""


@dataclass(frozen=True, eq=False)
class MirrorPlane:
    """A plane, by a point (3,) in it and its unit normal (3,)."""

    middle: Floats
    axis: Floats

    def reflected(self, points: Floats) -> Floats:
        """Mirror points (n, 3)."""
        away: Floats = points - 2 * np.outer((points - self.middle) @ self.axis, self.axis)
        return away

    def reflected_directions(self, directions: Floats) -> Floats:
        """Mirror directions (n, 3), which have no place."""
        away: Floats = directions - 2 * np.outer(directions @ self.axis, self.axis)
        return away

    def is_along(self, other: MirrorPlane) -> bool:
        """Tell whether another plane has nearly the same direction."""
        return bool(abs(self.axis @ other.axis) > _SAME_AXIS)

    @classmethod
    def between(cls, points: Floats, images: Floats, counts: Floats) -> MirrorPlane:
        """Fit the plane between points (n, 3) and images (n, 3), which count (n,)."""
        ways = points - images
        axis = np.linalg.eigh((counts[:, None] * ways).T @ ways)[1][:, -1]
        return cls(counts @ (points + images) / (2 * max(float(counts.sum()), TINY)), axis)


def mirror_planes(points: Floats) -> list[MirrorPlane]:
    """Find the planes in which most of some points are mirror images of others.

    Parameters
    ----------
    points : (n, 3) array of float
        Such as the vertices of a mesh, n > 0.

    Returns
    -------
    list of MirrorPlane
        The planes, of those that are found from the axes of space and of the points; the best first.
    """
    middle = (points.min(axis=0) + points.max(axis=0)) / 2
    centred = points - points.mean(axis=0)
    chosen = points[np.linspace(0, len(points) - 1, min(len(points), _MOST_POINTS)).astype(np.int64)]
    extent = max(float(np.linalg.norm(np.ptp(points, axis=0))), TINY)
    tree, found = cKDTree(points), list[tuple[float, MirrorPlane]]()
    for axis in np.concatenate([np.eye(3), np.linalg.eigh(centred.T @ centred)[1].T]):
        plane, far = MirrorPlane(middle, axis), _FAR
        for _ in range(_ROUNDS):  # what has no mirror image counts less and less
            distances, nearest = tree.query(plane.reflected(chosen))
            plane = MirrorPlane.between(chosen, points[nearest], 1 / (1 + np.square(distances / (far * extent))) ** 2)
            far = max(_NEARER * far, _NEAR)
        # A body that is flat is nearly its own mirror image in that plane, too, but not as exactly.
        found.append((float((tree.query(plane.reflected(chosen))[0] > _NEAR * extent).mean()), plane))
    planes: list[MirrorPlane] = []
    for missed, plane in sorted(found, key=lambda each: each[0]):
        if missed < _MOST_MISSED and not any(plane.is_along(other) for other in planes):
            planes.append(plane)
    return planes
