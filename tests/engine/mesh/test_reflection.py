# SPDX-License-Identifier: GPL-3.0-or-later
"""Surfaces in a mirror: the same distances, but the other hand."""

import numpy as np
import pytest

from engine import SurfaceMap, SurfacePoints, TriangleMesh
from engine.mesh.reflection import reflected_map, reflected_mesh, reflected_points
from tests.shapes import creature, icosphere


def volume(mesh):
    return np.linalg.det(mesh.vertices[mesh.triangles]).sum() / 6


def some_points(mesh, count=50):
    rng = np.random.default_rng(0)
    return SurfacePoints.from_barycentric(
        mesh, rng.integers(0, mesh.triangle_count, count), rng.dirichlet([1.0, 1.0, 1.0], count)
    )


@pytest.fixture(scope="module")
def body():
    return TriangleMesh(*creature(0.3, 9)[:2])


def test_lengths_and_areas_stay(body):
    reflection = reflected_mesh(body)
    np.testing.assert_array_equal(reflection.edges, body.edges)
    np.testing.assert_allclose(reflection.edge_lengths, body.edge_lengths, rtol=1e-12)
    np.testing.assert_allclose(reflection.triangle_areas, body.triangle_areas, rtol=1e-12)


def test_normals_are_mirrored_too_and_so_still_point_outwards(body):
    reflection = reflected_mesh(body)
    np.testing.assert_allclose(reflection.vertex_normals, body.vertex_normals * [-1, 1, 1], atol=1e-12)
    assert volume(reflection) == pytest.approx(volume(body))
    assert volume(body) > 0


def test_no_rotation_does_the_same():
    # Four points that are not in a plane: their determinant tells the hand.
    mesh = TriangleMesh(*icosphere(2))
    corners = [0, 1, 4]
    before, after = (np.linalg.det(m.vertices[corners]) for m in (mesh, reflected_mesh(mesh)))
    assert after == pytest.approx(-before)
    assert abs(before) > 0.1


def test_twice_is_not_at_all(body):
    twice = reflected_mesh(reflected_mesh(body))
    np.testing.assert_array_equal(twice.vertices, body.vertices)
    np.testing.assert_array_equal(twice.triangles, body.triangles)


def test_points_are_mirrored_with_their_surface(body):
    points = some_points(body)
    mirrored = reflected_points(reflected_mesh(body), points)
    np.testing.assert_allclose(mirrored.positions, points.positions * [-1, 1, 1], atol=1e-12)
    np.testing.assert_array_equal(mirrored.triangles, points.triangles)
    np.testing.assert_array_equal(mirrored.nearest_vertices, points.nearest_vertices)


def test_points_come_back(body):
    points = some_points(body)
    back = reflected_points(body, reflected_points(reflected_mesh(body), points))
    np.testing.assert_array_equal(back.barycentric, points.barycentric)
    np.testing.assert_allclose(back.positions, points.positions, atol=1e-12)


def test_a_map_to_a_mesh_leads_to_the_same_places_of_its_reflection(body):
    reflection = reflected_mesh(body)
    led = SurfaceMap.from_points(body, some_points(body), np.linspace(0, 1, 50), np.arange(50) % 7 > 0)
    seen = reflected_map(reflection, led)
    np.testing.assert_allclose(seen.positions, led.positions * [-1, 1, 1], atol=1e-12)
    np.testing.assert_array_equal(seen.confidence, led.confidence)
    np.testing.assert_array_equal(seen.has_partner, led.has_partner)
    np.testing.assert_array_equal(reflected_map(body, seen).triangles, led.triangles)
