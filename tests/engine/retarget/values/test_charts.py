# SPDX-License-Identifier: GPL-3.0-or-later
"""Surfaces cut where corner values jump."""

from __future__ import annotations

import numpy as np
import pytest

from engine import MeshError, TriangleMesh
from engine.retarget.values.charts import cut_into_sheets
from tests.faces import grid, polygons, triangulated, tube


def test_continuous_values_cut_nothing():
    vertices, faces, uvs = grid(4, 3)
    sheets = cut_into_sheets(triangulated(vertices, faces), faces, uvs, 1e-6)
    assert sheets.count == 1
    assert sheets.surface.vertex_count == len(vertices)
    assert sheets.borders.sum() == 14  # the boundary of the square


def test_a_jump_cuts_the_surface_in_two():
    vertices, faces, uvs = grid(4, 3)
    uvs = uvs + 3 * (faces.corner_faces % 4 >= 2)[:, None]
    sheets = cut_into_sheets(triangulated(vertices, faces), faces, uvs, 1e-6)
    assert sheets.count == 2
    assert sheets.surface.vertex_count == len(vertices) + 4
    assert sheets.borders.sum() == 14 + 6
    middle = np.isclose(sheets.surface.vertices[sheets.border_edges][:, :, 0], 0.5).all(axis=1)
    assert middle.sum() == 6


def test_a_sheet_may_meet_itself():
    vertices, faces, uvs = tube(8, 3)
    sheets = cut_into_sheets(triangulated(vertices, faces), faces, uvs, 1e-6)
    assert sheets.count == 1
    assert sheets.surface.vertex_count == len(vertices) + 4


def test_values_within_the_tolerance_are_the_same():
    vertices, faces, uvs = grid(4, 3)
    noise = np.random.default_rng(1).uniform(-0.4, 0.4, uvs.shape)
    assert cut_into_sheets(triangulated(vertices, faces), faces, uvs + 1e-3 * noise, 1e-3).count == 1
    assert cut_into_sheets(triangulated(vertices, faces), faces, uvs + 1e-3 * noise, 1e-6).count > 1


def test_faces_that_are_turned_the_wrong_way_round_hang_together_as_well():
    faces = polygons([[0, 1, 2], [1, 2, 3]])
    mesh = TriangleMesh([[0, 0, 0], [1, 0, 0], [0, 1, 0], [1, 1, 0]], [[0, 1, 2], [1, 2, 3]])
    assert cut_into_sheets(mesh, faces, mesh.vertices[faces.corner_vertices], 1e-6).count == 1


def test_values_inside_and_beyond_are_exact_for_linear_ones():
    vertices, faces, _ = grid(4, 3)
    slope = np.array([[1.0, 2, 0], [-3, 0.5, 0]])
    values = vertices[faces.corner_vertices] @ slope.T
    mesh = triangulated(vertices, faces)
    sheets = cut_into_sheets(mesh, faces, values, 1e-6)
    random = np.random.default_rng(2)
    triangles, barycentric = random.integers(0, mesh.triangle_count, 20), random.dirichlet([1, 1, 1], 20)
    places = np.einsum("kc,kcd->kd", barycentric, mesh.vertices[mesh.triangles[triangles]])
    np.testing.assert_allclose(sheets.at(triangles, barycentric), places @ slope.T, atol=1e-12)
    offsets = random.normal(size=(20, 3))
    np.testing.assert_allclose(sheets.beyond(triangles, barycentric, offsets), offsets @ slope.T, atol=1e-12)


def test_places_at_a_border():
    vertices, faces, uvs = grid(1, 1)
    sheets = cut_into_sheets(triangulated(vertices, faces), faces, uvs, 1e-6)
    places = np.array([[0.5, 0.5, 0], [0.2, 0.3, 0.5], [1, 0, 0], [0.5, 0, 0.5]])
    # The first triangle is the lower right one; its side from the third corner back to the first is inside.
    np.testing.assert_array_equal(sheets.is_at_border(np.zeros(4, int), places), [True, False, True, False])


@pytest.mark.parametrize("values", [np.zeros((3, 2)), np.zeros(16), np.full((16, 2), np.nan)])
def test_values_that_do_not_fit(values):
    vertices, faces, _ = grid(2, 2)
    with pytest.raises(MeshError):
        cut_into_sheets(triangulated(vertices, faces), faces, values, 1e-6)
