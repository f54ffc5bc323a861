# SPDX-License-Identifier: GPL-3.0-or-later
"""Surfaces of equal value on a grid."""

import numpy as np
import pytest

from engine import TriangleMesh
from engine.repair.surface_nets import surface_net


def grid(*counts):
    return np.stack(np.meshgrid(*(np.arange(count, dtype=float) for count in counts), indexing="ij"), axis=-1)


def test_a_ball_is_closed_and_looks_outward():
    values = 8.3 - np.linalg.norm(grid(21, 22, 23) - [10.2, 10.1, 11.3], axis=-1)
    vertices, triangles = surface_net(values)
    mesh = TriangleMesh(vertices, triangles)
    assert mesh.is_closed
    assert mesh.component_count == 1
    assert mesh.vertex_count - len(mesh.edges) + mesh.triangle_count == 2
    assert np.linalg.norm(vertices - [10.2, 10.1, 11.3], axis=1) == pytest.approx(8.3, abs=0.15)
    assert mesh.area == pytest.approx(4 * np.pi * 8.3**2, rel=0.02)
    outward = vertices[triangles].mean(axis=1) - [10.2, 10.1, 11.3]
    assert (np.einsum("md,md->m", mesh.triangle_normals, outward) > 0).all()


@pytest.mark.parametrize("level", [0.0, 0.4])
def test_a_plane_is_exact(level):
    slope = np.array([0.3, -0.5, 0.8])
    vertices, triangles = surface_net(grid(12, 13, 14) @ slope - 3.0, level)
    inner = ((vertices > 0) & (vertices < [11, 12, 13])).all(axis=1)
    assert inner.sum() > 50
    assert vertices[inner] @ slope - 3.0 == pytest.approx(level)
    # Inside is where values are larger, so normals point against the slope.
    inside = inner[triangles].all(axis=1)
    assert (TriangleMesh(vertices, triangles).triangle_normals[inside] @ slope < 0).all()


def test_what_is_beyond_the_grid_is_outside():
    vertices, triangles = surface_net(np.ones((4, 5, 6)))
    mesh = TriangleMesh(vertices, triangles)
    assert mesh.is_closed
    assert mesh.vertices.min(axis=0) == pytest.approx(-0.5, abs=0.3)
    assert mesh.vertices.max(axis=0) == pytest.approx([3.5, 4.5, 5.5], abs=0.3)


def test_nothing_has_no_surface():
    vertices, triangles = surface_net(np.zeros((4, 4, 4)) - 1)
    assert vertices.shape == (0, 3)
    assert triangles.shape == (0, 3)
