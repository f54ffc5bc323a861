# SPDX-License-Identifier: GPL-3.0-or-later
"""Single vertices that stick out far from all of their neighbours, as scanners and slips of the hand leave them."""

from __future__ import annotations

import numpy as np

from ..runtime.arrays import Floats, Ints, group_sums, marked

_SLENDER = 1.0
"""Length of the shortest edge of a spike by the length of the ring around its foot: a horn is broader at its tip."""

_LONG = 5.0
"""The same by the mean length of the mesh's edges: what is shorter does no harm."""


def find_spikes(vertices: Floats, triangles: Ints) -> Ints:
    """Find the tips of spikes of one vertex.

    Parameters
    ----------
    vertices : (n, 3) array of float
        Positions.
    triangles : (m, 3) array of int
        An oriented manifold.

    Returns
    -------
    (k,) array of int
        Vertices all of whose edges are longer than the whole ring around them, and than most other edges.
    """
    n = len(vertices)
    # Edge c of a triangle leads from its corner c to the next; it lies opposite to corner c + 2.
    edges = np.linalg.norm(vertices[np.roll(triangles, -1, axis=1)] - vertices[triangles], axis=2)
    long = edges > _LONG * edges.mean()
    suspects = np.flatnonzero(long.sum(axis=1) > 1)  # two sides of each triangle of a spike
    if not len(suspects):
        return suspects
    corners, lengths = triangles[suspects], edges[suspects]
    ring = np.bincount(np.roll(corners, -2, axis=1).ravel(), lengths.ravel(), n)
    least = np.maximum(_SLENDER * ring, _LONG * edges.mean())
    slim = (lengths > least[corners]) & (np.roll(lengths, 1, axis=1) > least[corners])
    around = np.bincount(triangles.ravel(), minlength=n)
    slims = np.bincount(corners.ravel(), slim.ravel(), n)
    return np.flatnonzero((slims == around) & (around > 2))


def pulled_in(vertices: Floats, triangles: Ints, spikes: Ints) -> Floats:
    """Move the tips of spikes (k,) into the middle of the rings around them: the new positions (n, 3)."""
    tip = marked(spikes, len(vertices))
    tails, heads = triangles.ravel(), np.roll(triangles, -1, axis=1).ravel()
    used = tip[tails] & ~tip[heads]  # one edge for each triangle around a tip
    tails, heads = tails[used], heads[used]
    sums = group_sums(tails, vertices[heads], len(vertices))
    counts = np.bincount(tails, minlength=len(vertices))
    moved = np.flatnonzero(counts)
    result = vertices.copy()
    result[moved] = sums[moved] / counts[moved, None]
    return result
