# SPDX-License-Identifier: GPL-3.0-or-later
"""Pairs of places that should correspond, and how many of them two maps lead to each other."""

from __future__ import annotations

import numpy as np
from scipy.spatial import cKDTree

from ..mesh.surface_map import SurfaceMap
from ..mesh.triangle_mesh import TriangleMesh
from ..runtime.arrays import Ints


def followed_share(
    maps: tuple[SurfaceMap, SurfaceMap], meshes: tuple[TriangleMesh, TriangleMesh], pairs: Ints
) -> float:
    """Tell how many places two maps take nearer to their partners than to the partner of any other.

    Parameters
    ----------
    maps : pair of SurfaceMap
        From the source to the target, and back.
    meshes : pair of TriangleMesh
        Source and target.
    pairs : (k, 2) array of int
        Vertices of the source and of the target that should correspond.

    Returns
    -------
    float
        Part of the places on both meshes, 0 to 1; 1 if there are no pairs.
    """
    if not len(pairs):
        return 1.0
    ways = zip(maps, meshes[::-1], pairs.T, pairs.T[::-1], strict=True)
    nearest = [cKDTree(image.vertices[to]).query(way.positions[of])[1] for way, image, of, to in ways]
    return float((np.array(nearest) == np.arange(len(pairs))).mean())
