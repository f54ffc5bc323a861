# SPDX-License-Identifier: GPL-3.0-or-later
"""Farthest point sampling: points that cover a surface evenly, whatever its triangulation."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from scipy.sparse import csr_array
from scipy.sparse.csgraph import dijkstra

from ..runtime.arrays import Floats, Ints


class FarthestPointSampler:
    r"""Take one farthest point after the other, on the vertices of a weighted graph.

    Each new sample is the vertex farthest from all samples before it.  Every prefix of the sequence is 2-optimal: its
    covering radius, :math:`\max_v \min_s d(v, s)`, is at most twice the smallest that so many points allow [1]_, in
    the metric of the graph.

    Parameters
    ----------
    graph : (n, n) csr_array of float
        Connected graph with edge lengths, in both directions.
    start : int or sequence of int
        The first sample, or several to begin with.

    Attributes
    ----------
    samples : list of int
        The samples so far, in the order in which they were taken.
    distances : (n,) array of float
        Distance of every vertex to its nearest sample.

    Notes
    -----
    A new sample can be nearest only to vertices closer than the present covering radius, so its Dijkstra search stops
    there.  The balls shrink as the samples fill the surface, which makes a sample cost far less than a full search.

    References
    ----------
    .. [1] D. Hochbaum, D. Shmoys, "A best possible heuristic for the k-center problem", Math. Oper. Res. 10, 1985.
    """

    def __init__(self, graph: csr_array, start: int | Sequence[int] | Ints) -> None:
        self._graph = graph
        self.samples: list[int] = []
        self.distances: Floats = np.full(graph.shape[0], np.inf)
        for vertex in np.atleast_1d(start):
            self._add(int(vertex))

    def _add(self, vertex: int) -> None:
        # The limit is inclusive of ties, so a vertex exactly as far as the farthest one is never missed.
        row = dijkstra(self._graph, indices=vertex, limit=self.distances.max())
        closer = row < self.distances
        self.distances[closer] = row[closer]
        self.samples.append(vertex)

    def extend(self, count: int) -> None:
        """Take samples until there are `count`, no more than the graph has vertices."""
        while len(self.samples) < count:
            self._add(int(self.distances.argmax()))


def farthest_point_sampling(graph: csr_array, count: int, start: int) -> Ints:
    """Sample `count` vertices of a graph (see `FarthestPointSampler`), in the order in which they were taken."""
    sampler = FarthestPointSampler(graph, start)
    sampler.extend(count)
    return np.array(sampler.samples)
