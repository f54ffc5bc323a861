# SPDX-License-Identifier: GPL-3.0-or-later
"""In-betweens of two poses of one surface: parts that turn do so, and do not shrink on a straight way."""

from __future__ import annotations

import numpy as np
from scipy.sparse import csr_array, diags_array
from scipy.spatial import cKDTree
from scipy.spatial.transform import Rotation

from ..geometry.laplacian import laplace_beltrami
from ..geometry.symmetric_factor import symmetric_factor
from ..mesh.connectivity.welded_parts import WeldedParts
from ..mesh.triangle_mesh import TriangleMesh
from ..registration.elastic import weighted_edges
from ..runtime.arrays import TINY, Floats, Ints
from .values.deformation_gradients import surface_frames

_HOLD = 1e-6
"""How much the straight way counts, per area: just enough to say where the whole is."""

_TIES = 3
"""Vertices by which a loose part is tied to the largest one."""

_RADIUS = 0.03
"""Over what distance rotations are averaged, in sqrt(area)."""


def in_between(mesh: TriangleMesh, positions: Floats, fractions: Floats) -> Floats:
    r"""Interpolate between a surface and a deformed one.

    Each edge is turned by the part t of the rotation around it while its length and shear change evenly, and the
    vertices are put where the edges fit best, in the sense of least squares [1]_.  Vertices at a seam that the surface
    was cut open at are one point in between.

    Parameters
    ----------
    mesh : TriangleMesh
        The surface, t = 0.
    positions : (n, 3) array of float
        Its vertices when deformed, t = 1.
    fractions : (k,) array of float
        The t in between.

    Returns
    -------
    (k, n, 3) array of float
        Positions for each.

    Raises
    ------
    MeshError
        If there is not one finite position for each vertex.

    References
    ----------
    .. [1] D. Xu, H. Zhang, Q. Wang, H. Bao, "Poisson shape interpolation", Graphical Models 68, 2006.
    """
    if np.shape(positions) == mesh.vertices.shape:
        parts = WeldedParts.of(mesh)
        if parts.seams:
            return _in_between(parts.closed, parts.means @ positions, fractions)[:, parts.welded]
    return _in_between(mesh, positions, fractions)


def _in_between(mesh: TriangleMesh, positions: Floats, fractions: Floats) -> Floats:
    """Interpolate; see `in_between`."""
    frames = surface_frames(mesh, positions, radius=_RADIUS)
    tails, heads, weights = _edges(mesh)
    count, n = len(tails), mesh.vertex_count
    incidence = (np.concatenate([tails, heads]), np.tile(np.arange(count), 2))
    divergence = csr_array((np.repeat([1.0, -1.0], count), incidence), shape=(n, count))
    hold = np.full(n, _HOLD * max(mesh.vertex_areas.mean(), TINY) / mesh.area)
    factor = symmetric_factor(divergence @ diags_array(weights) @ divergence.T + diags_array(hold))
    # The turn of the whole, and that of each vertex beside it: less than half a turn in most poses.
    whole = Rotation.from_matrix(frames.rotations).mean(np.maximum(mesh.vertex_areas, 1e-9 * mesh.area))
    own = Rotation.from_matrix(frames.rotations) * whole.inv()
    before, after = mesh.vertices[tails] - mesh.vertices[heads], positions[tails] - positions[heads]
    found = np.empty((len(fractions), n, 3))
    for number, t in enumerate(fractions):
        now = (Rotation.from_rotvec(t * own.as_rotvec()) * Rotation.from_rotvec(t * whole.as_rotvec())).as_matrix()
        edges = np.zeros((count, 3))
        for ends in (tails, heads):
            straight = (1 - t) * before + t * np.einsum("eji,ej->ei", frames.rotations[ends], after)
            edges += np.einsum("eij,ej->ei", now[ends], straight) / 2
        even = (1 - t) * mesh.vertices + t * positions
        found[number] = factor.solve(divergence @ (weights[:, None] * edges) + hold[:, None] * even)
    return found


def _edges(mesh: TriangleMesh) -> tuple[Ints, Ints, Floats]:
    """Edges with their weights, (e,) each, and ties from loose parts to the largest."""
    tails, heads, weights = weighted_edges(laplace_beltrami(mesh))
    labels = mesh.component_labels
    loose = np.flatnonzero(labels > 0)
    if not len(loose):
        return tails, heads, weights
    main = np.flatnonzero(labels == 0)
    distances, nearest = cKDTree(mesh.vertices[main]).query(mesh.vertices[loose])
    order = np.lexsort((distances, labels[loose]))
    ranked = labels[loose][order]
    first = np.searchsorted(ranked, ranked)  # where the part of each begins
    chosen = order[np.arange(len(order)) - first < _TIES]
    tails = np.concatenate([tails, loose[chosen]])
    heads = np.concatenate([heads, main[nearest[chosen]]])
    return tails, heads, np.concatenate([weights, np.ones(len(chosen))])
