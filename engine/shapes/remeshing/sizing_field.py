# SPDX-License-Identifier: GPL-3.0-or-later
"""Sizing field of a coarse mesh: the distance of its vertices from place to place."""

from __future__ import annotations

import numpy as np
from scipy.sparse import csr_array, diags_array, eye_array

from ...mesh.connectivity.adjacency import pair_matrix
from ...runtime.arrays import TINY, Floats, unit_vectors
from .surface_cells import SurfaceCells

_BY_CURVATURE = 0.75
"""Share of the vertices that go where the surface bends; the others are spread evenly."""

_MOST = 5.0
"""Density above which no more is asked for, in units of the mean: a region of a coarse mesh still has some cells."""

_NORMAL_ROUNDS = 2
"""Of averaging normals with those around, against noise."""

_CURVATURE_ROUNDS = 3
"""Of averaging the squared curvature, so that the density changes gradually."""

_FLAT = 1e-6
"""Mean curvature, in units of 1 / sqrt(area), below which there is none but rounding."""


def vertex_density(cells: SurfaceCells) -> Floats:
    r"""Tell how densely a surface should be covered with vertices, as it bends more in some places than in others.

    A triangle with sides h is about :math:`\kappa h^2 / 8` away from a surface with the curvature :math:`\kappa`, so
    that vertices come equally near everywhere if as many of them are in an area as it has curvature [1]_.  A part of
    them is spread evenly all the same, as what is flat has to be matched too.  Curvature is measured by how fast the
    normals of the cells turn; what noise adds to it is alike everywhere, and makes the vertices more even.

    Parameters
    ----------
    cells : SurfaceCells
        The surface, c cells.

    Returns
    -------
    (c,) array of float
        Vertices per area, in units of their mean over the surface.

    References
    ----------
    .. [1] P. S. Heckbert, M. Garland, "Optimal triangulation and quadric-based surface simplification", Computational
       Geometry 14, 1999.
    """
    a, b = cells.pairs.T
    count = cells.count
    areas = np.maximum(cells.areas, TINY)
    around = csr_array((pair_matrix(cells.pairs, np.ones(len(a)), count) + eye_array(count)) @ diags_array(areas))
    average = csr_array(diags_array(1 / around.sum(axis=1)) @ around)
    normals = cells.normals
    for _ in range(_NORMAL_ROUNDS):
        normals = average @ normals
    normals = unit_vectors(normals)

    turns = np.square(normals[a] - normals[b]).sum(axis=1)
    lengths = np.square(cells.positions[a] - cells.positions[b]).sum(axis=1)
    turned, reach = (np.bincount(a, squares, count) + np.bincount(b, squares, count) for squares in (turns, lengths))
    squared_curvature = np.divide(turned, reach, out=np.zeros(count), where=reach > 0)
    for _ in range(_CURVATURE_ROUNDS):
        squared_curvature = average @ squared_curvature
    curvature = np.sqrt(squared_curvature)
    mean = np.average(curvature, weights=areas)
    if mean * cells.unit < _FLAT:
        return np.ones(count)
    density = 1 - _BY_CURVATURE + _BY_CURVATURE * np.minimum(curvature / mean, _MOST)
    return density / np.average(density, weights=areas)
