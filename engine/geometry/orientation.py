# SPDX-License-Identifier: GPL-3.0-or-later
"""Orientation of a correspondence: whether it keeps that of the surface or mirrors it."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import csr_array

from ..mesh.triangle_mesh import TriangleMesh
from ..runtime.arrays import TINY, Floats, Ints, numbered, unit_vectors


def tangent_gradient(mesh: TriangleMesh, vertices: Ints) -> csr_array:
    """Build the operator that takes the gradient of a function at some vertices, in a tangent frame.

    Parameters
    ----------
    mesh : TriangleMesh
        The surface.
    vertices : (k,) array of int
        Where the gradient is wanted; distinct.

    Returns
    -------
    (2 k, n) csr_array of float
        Times the values of a function at the vertices of the mesh, it gives the two components of the gradient at
        vertex i in rows 2 i and 2 i + 1: the area-weighted mean over the triangles around it, in an orthonormal frame
        (e1, e2) of the tangent plane with e1 x e2 along the outward normal.  The choice of e1 is arbitrary.
    """
    number = numbered(vertices, mesh.vertex_count)
    owner = number[mesh.triangles.ravel()]  # the wanted vertex at each corner of each triangle, or -1
    corner = np.flatnonzero(owner >= 0)
    owner, triangle = owner[corner], corner // 3
    corners = mesh.triangles[triangle]
    a, b, c = (mesh.vertices[corners[:, i]] for i in range(3))
    # Twice the area times the gradient of a linear function: sum over corners of its value times (normal x the
    # opposite edge).
    opposite = np.stack([c - b, a - c, b - a], axis=1)  # (t, 3 corners, 3)
    rotated = np.cross(mesh.triangle_normals[triangle][:, None, :], opposite)
    weight = np.bincount(owner, mesh.triangle_areas[triangle], len(vertices))
    rotated /= np.maximum(2 * weight[owner], TINY)[:, None, None]
    frame = tangent_frames(mesh.vertex_normals[vertices])[:, :2]
    entries = np.einsum("tcd,tfd->tfc", rotated, frame[owner])  # (t, 2, 3 corners)
    rows = np.broadcast_to((2 * owner[:, None] + np.arange(2))[:, :, None], entries.shape)
    columns = np.broadcast_to(corners[:, None, :], entries.shape)
    shape = (2 * len(vertices), mesh.vertex_count)
    return csr_array((entries.ravel(), (rows.ravel(), columns.ravel())), shape=shape)


def tangent_frames(normals: Floats) -> Floats:
    """Find right-handed axes (k, 3, 3) at points of a surface, the last of which are its unit normals (k, 3)."""
    # Any axis that is not along the normal will do.
    first = unit_vectors(np.cross(normals, np.eye(3)[np.abs(normals).argmin(axis=1)]))
    return np.stack([first, np.cross(normals, first), normals], axis=1)


def tangent_directions(mesh: TriangleMesh, vertices: Ints, values: NDArray[np.float32]) -> Floats:
    """Directions in which functions (s, n) grow at vertices (k,), in their tangent planes, of length one: (k, s, 2)."""
    gradients = tangent_gradient(mesh, vertices) @ values.T.astype(np.float64)
    return unit_vectors(gradients.reshape(len(vertices), 2, -1).transpose(0, 2, 1))


def signed_areas(directions: Floats) -> Floats:
    """Signed area of the parallelogram of each pair of directions.

    Parameters
    ----------
    directions : (k, s, 2) array of float
        Directions at k points.

    Returns
    -------
    (k, s (s - 1) / 2) array of float
        u_j x u_l for j < l: independent of the tangent frame but for its orientation, so a mirrored surface shows the
        negative.
    """
    first, second = np.triu_indices(directions.shape[1], 1)
    u, v = directions[:, first], directions[:, second]
    return u[..., 0] * v[..., 1] - u[..., 1] * v[..., 0]


def signed_area_tables(directions: Floats) -> Floats:
    """Signed areas of the directions (k, s, 2) of all pairs in either order, (k, s, s); see `signed_areas`."""
    u, v = directions[:, :, None], directions[:, None]
    return u[..., 0] * v[..., 1] - u[..., 1] * v[..., 0]


def orientation_agreement(source_directions: Floats, target_directions: Floats) -> Floats:
    r"""Measure at each point whether a correspondence keeps or mirrors the surface.

    The directions u_j to the same places, seen from corresponding points, turn the same way on both surfaces if
    orientation is kept.  With the signed areas :math:`s_{jl} = u_j \times u_l` this is their correlation

    .. math:: \frac{\sum_{j<l} s_{jl} s'_{jl}}{\sqrt{\sum s_{jl}^2 \sum s'^2_{jl}}}
        = \frac{\det U^T U'}{\sqrt{\det U^T U \; \det U'^T U'}}

    (Cauchy-Binet), which needs no sum over pairs.

    Parameters
    ----------
    source_directions, target_directions : (k, s, 2) array of float
        Directions at each of k corresponding points towards the same s places.

    Returns
    -------
    (k,) array of float
        From -1 (mirrored) to 1 (kept); 0 where the directions say nothing.
    """
    u, v = source_directions, target_directions
    cross = np.linalg.det(np.einsum("ksf,ksg->kfg", u, v))
    size = np.linalg.det(np.einsum("ksf,ksg->kfg", u, u)) * np.linalg.det(np.einsum("ksf,ksg->kfg", v, v))
    root = np.sqrt(np.maximum(size, 0))
    return np.divide(cross, root, out=np.zeros_like(cross), where=root > 0)
