# SPDX-License-Identifier: GPL-3.0-or-later
"""Mean curvature at a chosen scale."""

from __future__ import annotations

import numpy as np

from ..mesh.triangle_mesh import TriangleMesh
from ..runtime.arrays import TINY, Floats


def smoothed_mean_curvature(mesh: TriangleMesh, distances: Floats, radius: float) -> Floats:
    r"""Estimate the mean curvature of a surface that was smoothed within a radius.

    The barycentre of a patch lies below the surface where the surface bulges outwards, and above where it is hollow.
    Its displacement between patches of radius r and 2 r along the patch's normal, divided by r, approximates a
    multiple of r times the mean curvature at that scale [1]_; an integral, it is stable under noise and remeshing.
    Distances alone cannot see it: it tells front from back.

    Parameters
    ----------
    mesh : TriangleMesh
        The surface.
    distances : (s, n) array of float
        Geodesic distances from s places to all vertices, in the units of the mesh.
    radius : float
        Standard deviation of the Gaussian patch, in the same units.

    Returns
    -------
    (s,) array of float
        Positive where the surface bulges along its normals; without unit.

    References
    ----------
    .. [1] H. Pottmann, J. Wallner, Q.-X. Huang, Y.-L. Yang, "Integral invariants for robust geometry processing",
       Computer Aided Geometric Design 26, 2009.
    """
    values = np.concatenate([mesh.vertices, mesh.vertex_normals], axis=1)

    def mean_over_patch(size: float) -> Floats:
        """Average positions and normals over a Gaussian patch of that size."""
        weight = np.exp(-np.square(distances / size) / 2) * mesh.vertex_areas
        return (weight @ values) / np.maximum(weight.sum(axis=1, keepdims=True), TINY)

    small, large = mean_over_patch(radius), mean_over_patch(2 * radius)
    normal = small[:, 3:]
    length = np.maximum(np.linalg.norm(normal, axis=1), TINY)
    return np.einsum("sd,sd->s", small[:, :3] - large[:, :3], normal) / (length * radius)
