# SPDX-License-Identifier: GPL-3.0-or-later
"""Edges as lines: marked ones as chains from one end or junction to the next, and ways in a tree of edges."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from ...runtime.arrays import Ints


def edge_chains(edges: Ints) -> list[tuple[list[int], list[int]]]:
    """Join edges to chains.

    Parameters
    ----------
    edges : (k, 2) array of int
        The two vertices of each edge.

    Returns
    -------
    list of (vertices, edges)
        Each chain as the vertices along it and the edges between them.  Chains end where one edge ends or more than
        two meet.  A loop without such a place begins and ends at its smallest vertex.
    """
    around: dict[int, list[int]] = {}
    pairs: list[list[int]] = np.asarray(edges).tolist()
    for number, pair in enumerate(pairs):
        for vertex in pair:
            around.setdefault(vertex, []).append(number)
    left = set(range(len(pairs)))

    def follow(start: int, first: int) -> tuple[list[int], list[int]]:
        """Go on from a vertex along an edge until the chain ends: its vertices and edges."""
        vertices, passed, edge = [start], [], first
        while True:
            left.discard(edge)
            passed.append(edge)
            a, b = pairs[edge]
            vertices.append(b if vertices[-1] == a else a)
            onward = [other for other in around[vertices[-1]] if other in left]
            if len(around[vertices[-1]]) != 2 or not onward:
                return vertices, passed
            edge = onward[0]

    ends = sorted(vertex for vertex, numbers in around.items() if len(numbers) != 2)
    chains: list[tuple[list[int], list[int]]] = []
    for vertices in (ends, sorted(around)):
        for vertex in vertices:
            chains.extend(follow(vertex, edge) for edge in around[vertex] if edge in left)
    return chains


def way_to_root(before: NDArray[np.integer[Any]], vertex: int) -> list[int]:
    """Follow a tree from a vertex to its root, by the vertex before each one, or in a ring once around.

    That before the root is negative; from there the way is empty.
    """
    way: dict[int, None] = {}
    while vertex >= 0 and vertex not in way:
        way[int(vertex)] = None
        vertex = int(before[vertex])
    return list(way)
