# SPDX-License-Identifier: GPL-3.0-or-later
"""Triangles that hang together."""

import numpy as np

from engine.mesh.connectivity.components import (
    joined_components,
    triangle_components,
    triangle_neighbours,
    vertex_components,
)
from engine.mesh.connectivity.halfedges import group_half_edges, pair_half_edges
from tests.messes import together
from tests.shapes import icosphere, plane


def test_what_is_joined_in_pairs_hangs_together():
    labels = joined_components(6, np.array([4, 1, 1, 1]), np.array([2, 0, 0, 5]))
    assert len(set(labels.tolist())) == 3
    assert labels[0] == labels[1] == labels[5]
    assert labels[2] == labels[4]
    nothing = np.empty(0, np.int64)
    assert len(set(joined_components(3, nothing, nothing).tolist())) == 3


def test_vertices_of_one_triangle_hang_together():
    triangles = np.array([[0, 1, 2], [4, 5, 1], [6, 7, 8]])
    assert vertex_components(triangles, 10).tolist() == [0, 0, 0, 1, 0, 0, 2, 2, 2, 3]


def test_components_and_neighbours():
    vertices, triangles = together(icosphere(1), plane(3), icosphere(2))
    twins = pair_half_edges(vertices, triangles, group_half_edges(triangles, len(vertices)))
    components = triangle_components(twins)
    expected = np.repeat([0, 1, 2], [20, 8, 80])
    assert len({*zip(components.tolist(), expected.tolist(), strict=True)}) == 3
    neighbours = triangle_neighbours(twins)
    for triangle, others in enumerate(neighbours):
        for other in others:
            shared = np.intersect1d(triangles[triangle], triangles[other])
            assert len(shared) == (3 if other == triangle else 2)
    assert (neighbours == np.arange(len(triangles))[:, None]).sum() == 8  # sides of the square
