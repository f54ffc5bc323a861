# SPDX-License-Identifier: GPL-3.0-or-later
"""Vertices at which sheets touch."""

import numpy as np

from engine.mesh.connectivity.halfedges import group_half_edges, pair_half_edges
from engine.mesh.connectivity.nonmanifold_vertices import split_fans
from tests.shapes import cone, icosphere, plane, torus


def split(vertices, triangles):
    twins = pair_half_edges(vertices, triangles, group_half_edges(triangles, len(vertices)))
    return split_fans(triangles, twins, len(vertices))


def test_a_manifold_is_not_split():
    # The hub of the cone has more triangles than a walk around it takes.
    for shape in (icosphere(4), torus(9, 7), plane(5), cone(1500, 1)):
        triangles, copied = split(*shape)
        assert triangles is shape[1] or np.array_equal(triangles, shape[1])
        assert len(copied) == 0


def test_each_fan_gets_a_vertex():
    """Three fans around one point: closed, open with two triangles, a single triangle."""
    angle = np.linspace(0, 2 * np.pi, 6)[:-1]
    vertices = np.concatenate([np.zeros((1, 3)), np.random.default_rng(0).normal(size=(10, 3))])
    closed = [(0, 1 + i, 1 + (i + 1) % 5) for i in range(len(angle))]
    triangles = np.array([(0, 9, 10), *closed, (0, 6, 7), (0, 7, 8)])
    result, copied = split(vertices, triangles)
    assert copied.tolist() == [0, 0]
    assert set(result[1:6, 0]) == {0}  # the largest fan keeps the vertex
    assert result[6, 0] == result[7, 0] == 11
    assert result[0, 0] == 12
    assert np.array_equal(result[:, 1:], triangles[:, 1:])
