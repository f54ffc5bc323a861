# SPDX-License-Identifier: GPL-3.0-or-later
"""Triangles that hang together."""

import numpy as np

from engine.mesh.connectivity.halfedges import group_half_edges, pair_half_edges
from engine.mesh.connectivity.triangle_components import triangle_components, triangle_neighbours
from tests.messes import together
from tests.shapes import icosphere, plane


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
