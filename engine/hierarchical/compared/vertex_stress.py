# SPDX-License-Identifier: GPL-3.0-or-later
"""The stress of one point while all others rest, and where in some triangles it is least."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...runtime.arrays import Floats, Ints
from ...shapes.surface_distances import squared_offsets

_NEWTON_STEPS = 3
_RIDGE = 1e-9  # of the curvature, added in all directions so that a flat direction can be divided by
_TINY = 1e-30  # against division by zero, where everything is zero
_ENTRIES = ((0, 0), (0, 1), (1, 1))
_NEAREST = 1e-3  # distances below this part of a triangle's side have no direction to move along


@dataclass(frozen=True, eq=False)
class LocalStress:
    """Stress of places in triangles, each for one of k points while the others rest; each pair counts twice.

    Parameters
    ----------
    owner : (q,) array of int
        For each triangle, the point that may go there.
    wanted : (k, q) array of float
        Wanted distance of that point to each point.
    squares : (3, k, q) array of float
        Squared distances from each point to the corners of the triangles.
    sides : (q, 3) array of float
        Squared lengths of the sides 01, 02, 12.
    linear : (q, 3) array of float
        Linear term of that point at the corners.
    """

    owner: Ints
    wanted: Floats
    squares: Floats
    sides: Floats
    linear: Floats

    def residuals(self, barycentric: Floats) -> tuple[Floats, Floats]:
        """Distances and their differences from the wanted ones, both (k, q), at coordinates (q, 3) in the triangles."""
        squares = sum(self.squares[c] * barycentric[:, c] for c in range(3)) - squared_offsets(barycentric, self.sides)
        distances = np.sqrt(np.maximum(squares, _NEAREST**2 * self.sides.max(axis=1) + _TINY))
        difference = distances - self.wanted
        difference[self.owner, np.arange(len(self.owner))] = 0
        return distances, difference

    def value(self, barycentric: Floats, difference: Floats) -> Floats:
        """Stress (q,) at coordinates (q, 3) with these differences of distances (k, q)."""
        return (self.linear * barycentric).sum(axis=1) + 2 * np.square(difference).sum(axis=0)

    def derivatives(self, barycentric: Floats, distances: Floats, difference: Floats) -> tuple[Floats, Floats]:
        """Gradient (2, q) by the last two coordinates, and Hessian (3, q: 11, 12, 22) with linearised distances."""
        _, s, t = barycentric.T
        first, second, third = self.sides.T
        at_0, at_1, at_2 = self.squares
        along = np.stack(
            [
                at_1 - at_0 - first * (1 - 2 * s - t) - (third - second) * t,
                at_2 - at_0 - second * (1 - s - 2 * t) - (third - first) * s,
            ]
        )
        along /= 2 * distances
        along[:, self.owner, np.arange(len(self.owner))] = 0
        gradient = 4 * np.einsum("jq,cjq->cq", difference, along)
        gradient += self.linear.T[1:] - self.linear.T[0]
        hessian = 4 * np.stack([np.einsum("jq,jq->q", along[a], along[b]) for a, b in _ENTRIES])
        return gradient, hessian

    def minimise(self) -> tuple[Floats, Floats]:
        """Minimise in every triangle by some Gauss-Newton steps from its centroid.

        Returns
        -------
        barycentric : (q, 3) array of float
            The best coordinates on the way.
        value : (q,) array of float
            The stress there.
        """
        barycentric = np.full(self.sides.shape, 1 / 3)
        best, least = barycentric, np.full(len(barycentric), np.inf)
        for step in range(_NEWTON_STEPS + 1):
            distances, difference = self.residuals(barycentric)
            value = self.value(barycentric, difference)
            better = value < least
            best, least = np.where(better[:, None], barycentric, best), np.where(better, value, least)
            if step < _NEWTON_STEPS:
                gradient, hessian = self.derivatives(barycentric, distances, difference)
                barycentric = minimum_in_triangle(gradient, hessian, barycentric)
        return best, least


def minimum_in_triangle(gradient: Floats, hessian: Floats, barycentric: Floats) -> Floats:
    """Minimise convex quadratic functions over a triangle, exactly.

    Parameters
    ----------
    gradient : (2, q) array of float
        Derivatives by the last two barycentric coordinates at `barycentric`.
    hessian : (3, q) array of float
        Second derivatives 11, 12 and 22; positive semidefinite.
    barycentric : (q, 3) array of float
        Where the gradient was taken.

    Returns
    -------
    (q, 3) array of float
        The minima.
    """
    ridge = _RIDGE * (hessian[0] + hessian[2]) + _TINY
    a, b, c = hessian[0] + ridge, hessian[1], hessian[2] + ridge
    here = barycentric.T[1:]
    # f(x) = x H x / 2 + h x in the last two coordinates
    h = gradient - np.stack([a * here[0] + b * here[1], b * here[0] + c * here[1]])
    determinant = np.maximum(a * c - b * b, np.square(ridge))
    free = np.stack([b * h[1] - c * h[0], b * h[0] - a * h[1]]) / determinant
    zero = np.zeros_like(a)
    part = np.clip((a - b + h[0] - h[1]) / (a - 2 * b + c), 0, 1)  # of the way from (1, 0) to (0, 1)
    edges = np.stack(
        [
            np.stack([zero, np.clip(-h[1] / c, 0, 1)]),
            np.stack([np.clip(-h[0] / a, 0, 1), zero]),
            np.stack([1 - part, part]),
        ]
    )
    s, t = edges.transpose(1, 0, 2)
    on_edges = (a * s * s + c * t * t) / 2 + b * s * t + h[0] * s + h[1] * t
    edge = on_edges.argmin(axis=0)
    inside = (free >= 0).all(axis=0) & (free.sum(axis=0) <= 1)
    s, t = np.where(inside, free, edges[edge, :, np.arange(len(edge))].T)
    return np.stack([np.maximum(1 - s - t, 0), s, t], axis=1)
