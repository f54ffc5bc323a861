# SPDX-License-Identifier: GPL-3.0-or-later
"""Skin weights for vertices whose own cannot be trusted, from those around them on the surface."""

from __future__ import annotations

import numpy as np
from scipy.sparse import csr_array, diags_array
from scipy.spatial import cKDTree

from ...geometry.laplacian import laplace_beltrami
from ...geometry.symmetric_factor import symmetric_factor
from ...mesh.connectivity.adjacency import pair_matrix
from ...mesh.connectivity.welded_parts import WeldedParts
from ...mesh.triangle_mesh import TriangleMesh
from ...runtime.arrays import Bools, Floats, Ints, marked
from ...runtime.errors import MeshError, RigError
from .skin_weights import with_rows

_LEAST_WEIGHT = 1e-7
"""Weights below this, which is what rounding leaves of a zero, are dropped."""

_LEAST_STIFFNESS = 1e-9
"""Weight of a bond between all neighbours, as a part of the mean stiffness."""


def filled(weights: csr_array, trusted: Bools, parts: WeldedParts) -> csr_array:
    r"""Give the vertices that are not trusted the weights of those around them.

    Parameters
    ----------
    weights : (n, g) csr_array of float
        The weights; rows of vertices that are not trusted may hold anything.
    trusted : (n,) array of bool
        Which rows to keep.
    parts : WeldedParts
        The surface.

    Returns
    -------
    (n, g) csr_array of float
        The same rows where they are trusted; if none is, all of them.

    Raises
    ------
    RigError
        If there is not one row for each vertex.

    Notes
    -----
    The weights of each bone are continued by the harmonic function, :math:`\Delta w = 0`, that takes the trusted values
    around the gap.  It has no extremum inside, so that weights stay between 0 and 1 and sum to what they sum to around,
    and knows only ways along the surface: nothing bleeds from finger to finger.

    A part without any trusted vertex takes the weights of the trusted vertices nearest to it in space: a small one as a
    whole, so that it keeps its shape, a large one vertex by vertex.
    """
    n = parts.mesh.vertex_count
    if weights.shape[0] != n or trusted.shape != (n,):
        raise RigError(
            f"To fill gaps, there should be weights and trust for each of the {n} vertices, but there are "
            f"{weights.shape[0]} rows and an array of the shape {trusted.shape}."
        )
    if trusted.all() or not trusted.any():
        return weights
    known = marked(parts.welded[trusted], parts.welded_count)
    values = csr_array(parts.mean_over(trusted) @ weights)
    reached = marked(parts.labels[known], parts.part_count)
    gaps = ~known & reached[parts.labels]
    values = with_rows(values, np.flatnonzero(gaps), continued(values, gaps, parts))
    apart = np.flatnonzero(~reached[parts.labels])
    values = with_rows(values, apart, _nearest(values, apart, known, parts))
    rejected = np.flatnonzero(~trusted)
    return with_rows(weights, rejected, values[parts.welded[rejected]])


def continued(values: csr_array, places: Bools, parts: WeldedParts, held: Floats | None = None) -> csr_array:
    r"""Continue values along the surface from where they are known.

    Parameters
    ----------
    values : (w, g) csr_array of float
        Values at the welded vertices.
    places : (w,) array of bool
        Those to find, k of them.
    parts : WeldedParts
        The surface.
    held : (k,) array of float, optional
        How much each of these is held at its own value, as a weight :math:`h` beside the stiffness of the surface; not
        at all if not given.  Each part then needs one that is, or is known.

    Returns
    -------
    (k, g) csr_array of float
        The values there: :math:`\Delta w = 0`, or :math:`h (w - w_0) = \Delta w`.
    """
    unknown = np.flatnonzero(places)
    if not len(unknown):
        return csr_array((0, values.shape[1]))
    # Only the triangles around the places matter.
    around = parts.triangles[places[parts.triangles].any(axis=1)]
    involved, corners = np.unique(around, return_inverse=True)
    stiffness = _stiffness(parts.positions[involved], corners.reshape(-1, 3))
    inside = places[involved]
    rows = stiffness[inside]
    given, matrix = values[involved[~inside]], rows[:, inside]
    right, most = csr_array(-rows[:, ~inside] @ given), given.data.max(initial=0.0)
    if held is not None:
        own = values[unknown]
        right, most = csr_array(right + diags_array(held) @ own), max(most, own.data.max(initial=0.0))
        matrix = matrix + diags_array(held)
    columns = np.unique(right.indices)
    if not len(columns):
        return csr_array((len(unknown), values.shape[1]))
    solved = symmetric_factor(matrix).solve(right[:, columns].toarray())
    # Where more than two triangles meet in an edge, and by rounding, a little may be out of bounds.
    result = csr_array(np.where(solved < _LEAST_WEIGHT, 0.0, np.minimum(solved, most)))
    return csr_array((result.data, columns[result.indices], result.indptr), (len(unknown), values.shape[1]))


def _stiffness(positions: Floats, triangles: Ints) -> csr_array:
    """Return the Laplacian (k, k) of a piece of surface; without an area, as if all edges were alike."""
    count = len(positions)
    sides = np.stack([triangles, np.roll(triangles, -1, axis=1)], axis=-1).reshape(-1, 2)
    neighbours = pair_matrix(sides, np.ones(len(sides)), count)
    alike = csr_array(diags_array(neighbours.sum(axis=1)) - neighbours)
    try:
        surface = laplace_beltrami(TriangleMesh(positions, triangles)).stiffness
    except MeshError:
        return alike
    # The least bit holds on to vertices between needles, whose weights are all but zero.
    return csr_array(surface + _LEAST_STIFFNESS * float(surface.diagonal().mean()) * alike)


def _nearest(values: csr_array, apart: Ints, known: Bools, parts: WeldedParts) -> csr_array:
    """Take for welded vertices (k,) the values (w, g) of the nearest known ones, for small parts one mean."""
    if not len(apart):
        return csr_array((0, values.shape[1]))
    positions, sources = parts.positions, np.flatnonzero(known)
    nearest = sources[cKDTree(positions[sources]).query(positions[apart])[1]]
    _, group = np.unique(parts.labels[apart], return_inverse=True)
    group = np.where(parts.small[parts.labels[apart]], group.ravel(), len(apart) + np.arange(len(apart)))
    _, group = np.unique(group, return_inverse=True)
    group = group.ravel()
    shares = 1 / np.bincount(group)[group]
    means = csr_array((shares, (group, np.arange(len(apart)))), shape=(int(group.max()) + 1, len(apart)))
    return csr_array((means @ values[nearest])[group])
