# SPDX-License-Identifier: GPL-3.0-or-later
"""Points on surfaces."""

import numpy as np
import pytest

from engine import MeshError, SurfacePoints, TriangleMesh
from tests.shapes import icosphere, plane, torus


@pytest.fixture
def mesh():
    return TriangleMesh(*torus(16, 10))


@pytest.fixture
def points(mesh):
    random = np.random.default_rng(0)
    triangles = random.integers(0, mesh.triangle_count, 50)
    return SurfacePoints.from_barycentric(mesh, triangles, random.dirichlet([1, 1, 1], 50))


def test_positions_lie_in_their_triangles(mesh, points):
    assert len(points) == 50
    a, b, c = mesh.vertices[points.corners].transpose(1, 0, 2)
    assert np.array_equal(points.corners, mesh.triangles[points.triangles])
    normal = mesh.triangle_normals[points.triangles]
    assert np.allclose(np.einsum("ij,ij->i", points.positions - a, normal), 0)
    # Areas of the three parts of the triangle are the barycentric coordinates.
    whole = mesh.triangle_areas[points.triangles]
    for index, (p, q) in enumerate(((b, c), (c, a), (a, b))):
        part = np.linalg.norm(np.cross(p - points.positions, q - points.positions), axis=1) / 2
        assert np.allclose(part / whole, points.barycentric[:, index])


def test_nearest_vertices_have_the_largest_coordinate(points):
    largest = points.barycentric.argmax(axis=1)
    assert np.array_equal(points.nearest_vertices, points.corners[np.arange(50), largest])


def test_linear_functions_are_interpolated_exactly(mesh, points):
    slope = np.array([1.0, -2.0, 0.5])
    assert np.allclose(points.interpolate(mesh.vertices @ slope + 3), points.positions @ slope + 3)
    assert np.allclose(points.interpolate(mesh.vertices), points.positions)
    assert points.interpolate(np.zeros((mesh.vertex_count, 2, 4))).shape == (50, 2, 4)


def test_at_vertices_stays_at_the_vertices(mesh):
    vertices = np.array([7, 0, 159, 7])
    points = SurfacePoints.at_vertices(mesh, vertices)
    assert np.array_equal(points.nearest_vertices, vertices)
    assert np.array_equal(points.positions, mesh.vertices[vertices])
    assert (points.barycentric.sum(axis=1) == 1).all()
    assert (points.barycentric.max(axis=1) == 1).all()


@pytest.mark.parametrize("vertex", [-1, 160, 10**6])
def test_there_is_no_surface_at_a_vertex_that_there_is_not(mesh, vertex):
    with pytest.raises(MeshError, match=f"Vertex {vertex} of the mesh is in no face"):
        SurfacePoints.at_vertices(mesh, np.array([0, vertex]))


def test_at_vertices_takes_the_first_triangle():
    mesh = TriangleMesh(*plane(6))
    everywhere = SurfacePoints.at_vertices(mesh, np.arange(mesh.vertex_count))
    for vertex, triangle in enumerate(everywhere.triangles):
        assert triangle == np.flatnonzero((mesh.triangles == vertex).any(axis=1))[0]


def test_no_points(mesh):
    none = SurfacePoints.at_vertices(mesh, np.empty(0, np.int64))
    assert len(none) == 0
    assert none.positions.shape == (0, 3)
    assert none.interpolate(mesh.vertices).shape == (0, 3)


def test_points_are_found_by_the_corners_of_their_triangle():
    mesh = TriangleMesh(*icosphere(3))
    rng = np.random.default_rng(0)
    points = SurfacePoints.from_barycentric(
        mesh, rng.permutation(mesh.triangle_count)[:9], rng.dirichlet(np.ones(3), 9)
    )
    turned = np.array([1, 2, 0])
    again = SurfacePoints.from_corners(mesh, points.corners[:, turned], points.barycentric[:, turned])
    np.testing.assert_array_equal(again.triangles, points.triangles)
    np.testing.assert_array_equal(again.barycentric, points.barycentric)
    with pytest.raises(MeshError, match="no triangle"):
        SurfacePoints.from_corners(mesh, np.array([[0, 1, 2]]), np.array([[1.0, 0, 0]]))


def test_a_vertex_without_a_triangle_is_on_no_surface(mesh):
    loose = TriangleMesh(np.vstack([mesh.vertices, [[9.0, 9.0, 9.0]]]), mesh.triangles)
    with pytest.raises(MeshError, match=f"Vertex {mesh.vertex_count} .*no face"):
        SurfacePoints.at_vertices(loose, np.array([3, mesh.vertex_count]))
    assert SurfacePoints.at_vertices(loose, np.array([3])).nearest_vertices.tolist() == [3]


def test_triangles_of_very_many_vertices_are_told_apart():
    # Numbers made of all three vertices of these two triangles are the same in 64 bits.
    middle = np.array([2**21, 2**21 + 1])
    triangles = np.array([[5, *middle], [5 + 2**20, *middle]])
    count = 2**22
    mesh = TriangleMesh.__new__(TriangleMesh)
    object.__setattr__(mesh, "vertices", np.broadcast_to(np.zeros(3), (count, 3)))
    object.__setattr__(mesh, "triangles", triangles)
    found = SurfacePoints.from_corners(mesh, triangles[:, [1, 2, 0]], np.full((2, 3), 1 / 3))
    assert found.triangles.tolist() == [0, 1]
    with pytest.raises(MeshError, match="no triangle"):
        SurfacePoints.from_corners(mesh, triangles[:1] + np.array([2**19, 0, 0]), np.full((1, 3), 1 / 3))
