# SPDX-License-Identifier: GPL-3.0-or-later
"""How a dense map stretches the surface around each vertex."""

from __future__ import annotations

import numpy as np
import pytest
from hiermatch.engine import SurfaceMap, SurfacePoints, TriangleMesh
from hiermatch.hiermatch_addon.storage.views.stretch import DOUBLED, vertex_stretch


def grid(n=6, size=(1.0, 1.0), extra=0):
    """A rectangle of squares with one diagonal each, and some vertices without a triangle."""
    x, y = np.meshgrid(np.linspace(0, size[0], n), np.linspace(0, size[1], n), indexing="ij")
    i = np.arange(n * n).reshape(n, n)
    a, b, c, d = i[:-1, :-1].ravel(), i[1:, :-1].ravel(), i[1:, 1:].ravel(), i[:-1, 1:].ravel()
    vertices = np.stack([x.ravel(), y.ravel(), np.zeros(n * n)], axis=1)
    triangles = np.concatenate([np.stack([a, b, c], axis=1), np.stack([a, c, d], axis=1)])
    return TriangleMesh(np.concatenate([vertices, np.full((extra, 3), 0.3)]), triangles)


def same_vertices(domain, image):
    """Map each vertex to the vertex of the same number; those without a triangle to the first."""
    numbers = np.where(domain.vertex_areas > 0, np.arange(domain.vertex_count), 0)
    return SurfaceMap.from_points(image, SurfacePoints.at_vertices(image, numbers))


def stretch(domain, image):
    return vertex_stretch(same_vertices(domain, image), domain, image)


@pytest.mark.parametrize("scale", [1, 1e-3, 1e5])
def test_none_in_a_copy_of_any_size(scale):
    mesh = grid()
    copy = TriangleMesh(scale * mesh.vertices[:, [1, 2, 0]] + scale, mesh.triangles)
    assert stretch(mesh, copy) == pytest.approx(0, abs=1e-9)


def test_twice_as_wide():
    mesh, wide = grid(), grid(size=(2, 1))
    there, back = stretch(mesh, wide), stretch(wide, mesh)
    # In units of the area, edges along x become 2 ** 0.5 times as long, those along y 0.5 ** 0.5, the diagonals by:
    diagonal = np.log(np.sqrt(5) / np.sqrt(2) / np.sqrt(2))
    inner = np.sqrt((4 * (DOUBLED / 2) ** 2 + 2 * diagonal**2) / 6)
    assert there[7] == pytest.approx(inner)
    assert back == pytest.approx(there)  # twice and half as long are the same


def test_only_around_what_is_moved():
    mesh = grid()
    moved = mesh.vertices.copy()
    moved[14] += [0.05, 0.02, 0]
    values = stretch(mesh, TriangleMesh(moved, mesh.triangles))
    near = np.unique(mesh.edges[(mesh.edges == 14).any(axis=1)])
    assert (values[near] > 0.01).all()
    assert np.delete(values, near) == pytest.approx(0, abs=1e-9)
    assert values.argmax() == 14


def test_no_edges_no_value():
    values = stretch(grid(extra=2), grid(extra=2))
    assert np.isnan(values[-2:]).all()
    assert np.isfinite(values[:-2]).all()


def test_a_collapse_is_finite():
    mesh = grid()
    points = SurfacePoints.at_vertices(mesh, np.zeros(mesh.vertex_count, int))
    values = vertex_stretch(SurfaceMap.from_points(mesh, points), mesh, mesh)
    assert np.isfinite(values).all()
    assert (values > 2 * DOUBLED).all()


def test_edges_without_length_do_not_count():
    mesh = grid()
    vertices = mesh.vertices.copy()
    vertices[15] = vertices[14]
    values = stretch(TriangleMesh(vertices, mesh.triangles), mesh)
    assert np.isfinite(values).all()
