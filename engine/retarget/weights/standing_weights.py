# SPDX-License-Identifier: GPL-3.0-or-later
"""Weights for bones that stand in a body and are not bound to it, by where they stand."""

from __future__ import annotations

import numpy as np
from scipy.sparse import csr_array, diags_array

from ...geometry.laplacian import laplace_beltrami
from ...geometry.symmetric_factor import symmetric_factor
from ...mesh.triangle_mesh import TriangleMesh
from ...runtime.arrays import TINY, Bools, Floats, Ints, shares_along
from ...runtime.errors import RigError
from ..rig.skeleton import Skeleton

_AGAINST = 5.0
"""How many times as far a bone counts that the surface faces away from, such as an arm beside the trunk."""

_ALIKE = 1.05
"""Bones up to this many times as far as the nearest one share a vertex."""

_LEAST_WEIGHT = 1e-3
"""Weights below this are dropped."""


def standing_weights(mesh: TriangleMesh, skeleton: Skeleton, deforming: Bools) -> csr_array:
    r"""Find out what each of some bones moves that stand in a body.

    Parameters
    ----------
    mesh : TriangleMesh
        The body, n vertices.
    skeleton : Skeleton
        The bones, b.
    deforming : (b,) array of bool
        Which of them may move anything.

    Returns
    -------
    (n, b) csr_array of float
        Weights whose rows sum to one.

    Raises
    ------
    RigError
        If no bone may move anything.

    Notes
    -----
    The heat of Baran and Popović [1]_: :math:`(-\Delta + H) w_b = H p_b`, where H is one over the squared distance to
    the nearest bone and :math:`p_b` one where that is b.  So weights change smoothly, and along limbs as fast as these
    are thin.

    References
    ----------
    .. [1] I. Baran, J. Popović, "Automatic rigging and animation of 3D characters", SIGGRAPH 2007.
    """
    bones = np.flatnonzero(deforming)
    if not len(bones):
        raise RigError("No bone deforms, so it is not known what the bones belong to.")
    distances = _distances(mesh, skeleton, bones)
    nearest = distances.min(axis=1, keepdims=True)
    sharing = distances <= _ALIKE * nearest
    shares = sharing / sharing.sum(axis=1, keepdims=True)
    operator = laplace_beltrami(mesh)
    extent = float(np.linalg.norm(np.ptp(mesh.vertices, axis=0)))
    heat = operator.mass / np.maximum(nearest[:, 0], 1e-4 * extent) ** 2
    heat[operator.mass <= 0] = 1.0
    weights = symmetric_factor(operator.stiffness + diags_array(heat)).solve(heat[:, None] * shares)
    weights[weights < _LEAST_WEIGHT] = 0.0
    weights /= weights.sum(axis=1, keepdims=True)
    kept = csr_array(weights)
    return csr_array((kept.data, bones[kept.indices], kept.indptr), shape=(mesh.vertex_count, len(skeleton)))


def _distances(mesh: TriangleMesh, skeleton: Skeleton, bones: Ints) -> Floats:
    """Distances of vertices from bones, (n, k); more where the surface faces away from the bone."""
    result = np.empty((mesh.vertex_count, len(bones)))
    for column, bone in enumerate(bones):
        head, axis = skeleton.heads[bone], skeleton.axes[bone]
        away = mesh.vertices - head - shares_along(mesh.vertices, head, axis)[:, None] * axis
        far = np.linalg.norm(away, axis=1)
        facing = (away * mesh.vertex_normals).sum(axis=1) / np.maximum(far, TINY)
        result[:, column] = far * (1 + (_AGAINST - 1) * np.clip(-facing, 0, 1))
    return result
