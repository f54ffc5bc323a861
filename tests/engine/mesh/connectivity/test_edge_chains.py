# SPDX-License-Identifier: GPL-3.0-or-later
"""Edges joined to chains."""

from __future__ import annotations

from itertools import pairwise

import numpy as np

from engine.mesh.connectivity.edge_chains import edge_chains, way_to_root


def test_chains_end_at_ends_and_junctions():
    edges = np.array([[0, 1], [2, 1], [2, 3], [2, 4], [6, 5], [7, 6], [5, 7]])
    chains = edge_chains(edges)
    assert [chain[0] for chain in chains] == [[0, 1, 2], [2, 3], [2, 4], [5, 6, 7, 5]]
    for vertices, numbers in chains:
        for number, ends in zip(numbers, pairwise(vertices), strict=True):
            assert set(edges[number]) == set(ends)
    assert edge_chains(np.zeros((0, 2), int)) == []


def test_a_way_leads_to_the_root_and_once_around_a_ring():
    before = np.array([-1, 0, 1, 4, 5, 3])
    assert way_to_root(before, 2) == [2, 1, 0]
    assert way_to_root(before, 4) == [4, 5, 3]
    assert way_to_root(before, -1) == []
