# SPDX-License-Identifier: GPL-3.0-or-later
"""The Laplace-Beltrami operator of a surface."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import coo_array, csr_array, diags_array

from ..mesh.triangle_mesh import TriangleMesh
from ..runtime.arrays import Floats, Ints
from .intrinsic_delaunay import corner_cotangents, intrinsic_delaunay

_LEAST_MASS = 1e-9
"""Least mass of a vertex with triangles, as a part of the mean."""


@dataclass(frozen=True, eq=False)
class LaplaceBeltrami:
    r"""The operator :math:`-\Delta f \approx M^{-1} W f` on functions linear inside triangles.

    Attributes
    ----------
    stiffness : (n, n) csr_array of float
        W, symmetric and positive semi-definite: :math:`f^T W f` is the integral of :math:`|\nabla f|^2`.  Rows sum to
        zero.  A vertex without a triangle has an empty row.
    mass : (n,) array of float
        M, the area that each vertex stands for: greater than zero at each vertex with a triangle, zero at others.

    Notes
    -----
    Free (Neumann) boundaries: the derivative across an open boundary is zero.
    """

    stiffness: csr_array
    mass: Floats

    @property
    def vertex_count(self) -> int:
        """Number of vertices, n."""
        return len(self.mass)

    @cached_property
    def area(self) -> float:
        """Area of the surface."""
        return float(self.mass.sum())

    @classmethod
    def from_lengths(cls, triangles: Ints, lengths: Floats, vertex_count: int) -> LaplaceBeltrami:
        r"""Build the operator from the lengths of the sides of triangles, all that it depends on.

        The weight of an edge is :math:`w = \tfrac{1}{2} \sum \cot\alpha` over the angles opposite to it [1]_; a third
        of each triangle's area is lumped to each of its corners.

        Parameters
        ----------
        triangles : (m, 3) array of int
            Corners of each triangle.
        lengths : (m, 3) array of float
            Side i leads from corner i to corner i + 1.  Every triangle must have an area (see
            `intrinsic_delaunay.mollified_lengths`).
        vertex_count : int
            Number of vertices, n.

        Returns
        -------
        LaplaceBeltrami
            The operator.

        References
        ----------
        .. [1] U. Pinkall, K. Polthier, "Computing discrete minimal surfaces and their conjugates", Exp. Math. 2, 1993.
        """
        n = vertex_count
        cotangents, areas = corner_cotangents(lengths)
        tail, head = triangles.ravel(), np.roll(triangles, -1, axis=1).ravel()
        one_way = csr_array(coo_array((cotangents.ravel() / 2, (tail, head)), shape=(n, n)))
        weights = csr_array(one_way + one_way.T)
        # An edge from a vertex to itself, which flips may leave, is in the sum as often as on the diagonal: it cancels.
        stiffness = csr_array(diags_array(weights.sum(axis=1)) - weights)
        mass: NDArray[Any] = np.bincount(triangles.ravel(), np.repeat(areas / 3, 3), n)
        used = np.bincount(triangles.ravel(), minlength=n) > 0
        mass[used] = np.maximum(mass[used], _LEAST_MASS * mass[used].mean())
        return cls(stiffness, mass)


def laplace_beltrami(mesh: TriangleMesh) -> LaplaceBeltrami:
    """Build the Laplace-Beltrami operator of a mesh, on its intrinsic Delaunay triangulation.

    There all edges but those at boundaries and of more than two triangles have weights that are not negative, so that
    the operator keeps the maximum principle however bad the triangles are [1]_.

    Parameters
    ----------
    mesh : TriangleMesh
        Any mesh: boundaries, edges of more than two triangles, triangles without area, several parts and vertices
        without a triangle are allowed.

    Returns
    -------
    LaplaceBeltrami
        The operator, on the vertices of the mesh.

    References
    ----------
    .. [1] A. Bobenko, B. Springborn, "A discrete Laplace-Beltrami operator for simplicial surfaces", Discrete and
       Computational Geometry 38, 2007.
    """
    triangulation = intrinsic_delaunay(mesh)
    return LaplaceBeltrami.from_lengths(triangulation.triangles, triangulation.lengths, mesh.vertex_count)
