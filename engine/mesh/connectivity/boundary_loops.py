# SPDX-License-Identifier: GPL-3.0-or-later
"""The closed curves in which a surface ends."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ...runtime.arrays import Floats, Ints, group_sums, numbered
from .components import joined_components
from .halfedges import triangle_slots


@dataclass(frozen=True, eq=False)
class BoundaryLoops:
    """Boundary half-edges, and the loop of each.

    Attributes
    ----------
    half_edges, tails, heads : (b,) array of int
        Half-edges at the boundary, and the vertices they lead from and to.
    labels : (b,) array of int
        The loop of each.  Loops that meet in a vertex count as one.
    centres : (l, 3) array of float
        Centre of gravity of each loop as a wire.
    areas : (l,) array of float
        Area of the fan from the loop to its centre.
    """

    half_edges: Ints
    tails: Ints
    heads: Ints
    labels: Ints
    centres: Floats
    areas: Floats

    @property
    def count(self) -> int:
        """Number of loops, l."""
        return len(self.areas)


def boundary_loops(vertices: Floats, triangles: Ints, half_edges: Ints) -> BoundaryLoops:
    """Find the boundary loops of an oriented surface.

    Parameters
    ----------
    vertices : (n, 3) array of float
        Positions.
    triangles : (m, 3) array of int
        Corners of each triangle.
    half_edges : (b,) array of int
        The half-edges at the boundary: 3 t + i leads from corner i of triangle t to corner i + 1.

    Returns
    -------
    BoundaryLoops
        The loops, numbered by their first half-edges.
    """
    tails, heads = (triangle_slots(triangles, half_edges, shift) for shift in (0, 1))
    ends, number = np.unique(np.concatenate([tails, heads]), return_inverse=True)
    start, end = np.split(number.ravel(), 2)
    raw = joined_components(len(ends), start, end)[start] if len(start) else start
    _, first, raw = np.unique(raw, return_index=True, return_inverse=True)
    labels = numbered(np.argsort(first), len(first))[raw.ravel()]

    a, b = vertices[tails], vertices[heads]
    lengths = np.linalg.norm(b - a, axis=1)
    # A loop of zero length has its centre at its vertices all the same.
    lengths = np.where(np.bincount(labels, lengths)[labels] > 0, lengths, 1.0) if len(labels) else lengths
    weights = np.bincount(labels, lengths, len(first))
    centres = group_sums(labels, lengths[:, None] * ((a + b) / 2), len(first)) / weights[:, None]
    fans = np.linalg.norm(np.cross(b - a, centres[labels] - a), axis=1) / 2
    areas: NDArray[Any] = np.bincount(labels, fans, len(first))
    return BoundaryLoops(half_edges, tails, heads, labels, centres, areas)
