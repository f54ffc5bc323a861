# SPDX-License-Identifier: GPL-3.0-or-later
"""Filling of small holes in a surface."""

from __future__ import annotations

import numpy as np

from ..mesh.connectivity.boundary_loops import BoundaryLoops
from ..runtime.arrays import Bools, Floats, Ints, group_sums, unit_vectors

_LARGEST_HOLE = 0.01
"""Area of the largest hole in a sheet that is filled, as a part of the surface."""

_LARGEST_END = 0.001
"""The same for openings that a tube ends in: eye sockets are less; the neck, wrists and ankles are more."""

_SHEET = 0.5
"""Cosine of the largest mean angle between the lid of a hole in a sheet and the surface around it."""


def small_holes(vertices: Floats, triangles: Ints, loops: BoundaryLoops, area: float) -> Bools:
    """Say which boundary loops are holes to fill rather than the ends of the surface.

    Parameters
    ----------
    vertices : (n, 3) array of float
        Positions.
    triangles : (m, 3) array of int
        Corners of each triangle.
    loops : BoundaryLoops
        The boundary of the manifold that they are.
    area : float
        Area of the surface.

    Returns
    -------
    (l,) array of bool
        Whether each loop is a hole.

    Notes
    -----
    The surface around a hole goes on in the direction of the lid that is missing; at a neck or a limb that is
    cut off, it is at right angles to it.
    """
    a, b = vertices[loops.tails], vertices[loops.heads]
    middle = loops.centres[loops.labels]
    # The lid runs against the boundary; its area vector is that of the loop, whatever surface spans it.
    lids = group_sums(loops.labels, np.cross(b - middle, a - middle), loops.count)
    corners = vertices[triangles[loops.half_edges // 3]]
    beside = unit_vectors(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]))
    lengths = np.linalg.norm(b - a, axis=1)
    cosines = np.einsum("bd,bd->b", beside, unit_vectors(lids)[loops.labels])
    in_sheet = np.bincount(loops.labels, lengths * (cosines - _SHEET), loops.count) > 0
    long_enough = np.bincount(loops.labels, minlength=loops.count) > 2
    return long_enough & (loops.areas <= np.where(in_sheet, _LARGEST_HOLE, _LARGEST_END) * area)


def fill_holes(loops: BoundaryLoops, chosen: Bools, vertex_count: int) -> tuple[Floats, Ints]:
    """Close boundary loops with fans around their centres.

    Parameters
    ----------
    loops : BoundaryLoops
        The boundary of a manifold.
    chosen : (l,) array of bool
        The loops to close.
    vertex_count : int
        Number of vertices of the manifold, n.

    Returns
    -------
    vertices : (h, 3) array of float
        A centre for each hole; their numbers are n and up.
    triangles : (f, 3) array of int
        The fans, which agree with the surface in orientation.
    """
    number = vertex_count + np.cumsum(chosen) - 1
    closing = chosen[loops.labels]
    triangles = [loops.heads, loops.tails, number[loops.labels]]
    return loops.centres[chosen], np.stack([corner[closing] for corner in triangles], axis=1)
