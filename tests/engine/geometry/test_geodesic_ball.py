# SPDX-License-Identifier: GPL-3.0-or-later
"""What is near to a vertex along the surface."""

import numpy as np
import pytest
from scipy.sparse.csgraph import dijkstra

from engine import TriangleMesh
from engine.geometry.geodesic_ball import distances_to_others, vicinity
from tests.shapes import icosphere, plane, plane_with_slit


def path_lengths(mesh, vertex):
    """Lengths of the shortest paths along edges from a vertex to all others."""
    graph = np.zeros((mesh.vertex_count, mesh.vertex_count))
    graph[tuple(mesh.edges.T)] = mesh.edge_lengths
    return dijkstra(graph, directed=False, indices=vertex)


@pytest.mark.parametrize("radius", [0.05, 0.4, 1.1, 4.0])
def test_it_is_all_that_paths_of_such_a_length_reach(radius):
    mesh = TriangleMesh(*icosphere(5))
    truth = path_lengths(mesh, 17)
    vertices, distances = vicinity(mesh, 17, radius)
    np.testing.assert_array_equal(vertices, np.flatnonzero(truth <= radius))
    np.testing.assert_allclose(distances, truth[vertices], rtol=1e-12)


def test_the_vertex_itself_is_always_there():
    mesh = TriangleMesh(*plane(5))
    vertices, distances = vicinity(mesh, 12, 0.0)
    assert vertices.tolist() == [12]
    assert distances.tolist() == [0.0]


def test_along_the_lines_of_a_grid_distances_are_exact():
    mesh = TriangleMesh(*plane(9, size=8.0))
    vertices, distances = vicinity(mesh, 0, 3.5)
    found = dict(zip(vertices.tolist(), distances.tolist(), strict=True))
    assert [found[9 * i] for i in range(4)] == [0, 1, 2, 3]
    assert 9 * 4 not in found


def test_what_is_near_across_a_slit_only_is_not_near():
    mesh = TriangleMesh(*plane_with_slit(20, 0.6))
    start = int(np.linalg.norm(mesh.vertices - [0.45, 0.1, 0], axis=1).argmin())
    vertices, _ = vicinity(mesh, start, 0.3)
    assert (mesh.vertices[vertices][:, 0] < 0.5 + 1e-9).all()
    assert np.isclose(mesh.vertices[vertices][:, 0], 0.5).any()
    right = mesh.triangles[mesh.vertices[mesh.triangles].mean(axis=1)[:, 0] > 0.5]
    tip = np.flatnonzero(np.isclose(mesh.vertices[:, :2], [0.5, 0.6]).all(axis=1))
    assert not np.isin(vertices, np.setdiff1d(right, tip)).any()
    # In a sheet without the slit they are.
    whole = TriangleMesh(*plane(21))
    start = int(np.linalg.norm(whole.vertices - [0.45, 0.1, 0], axis=1).argmin())
    assert (whole.vertices[vicinity(whole, start, 0.3)[0]][:, 0] > 0.5 + 1e-9).any()


def test_vertices_at_one_place_are_joined_by_an_edge_without_length():
    vertices = [[0, 0, 0], [1, 0, 0], [1, 0, 0], [1, 1, 0], [2, 0, 0]]
    mesh = TriangleMesh(vertices, [[0, 1, 3], [1, 2, 3], [2, 4, 3]])
    near, distances = vicinity(mesh, 0, 2.5)
    assert near.tolist() == [0, 1, 2, 3, 4]
    np.testing.assert_allclose(distances, [0, 1, 1, 2**0.5, 2], rtol=1e-12)


def test_the_nearest_other_point_is_found():
    points = np.array([[0.0, 0, 0], [0, 0, 2], [0, 3, 2], [10, 3, 2]])
    np.testing.assert_allclose(distances_to_others(points), [2, 2, 3, 10])


def test_a_single_point_has_no_other():
    assert distances_to_others(np.zeros((1, 3))).tolist() == [np.inf]


def test_points_at_one_place_are_others_all_the_same():
    np.testing.assert_array_equal(distances_to_others(np.array([[1.0, 0, 0], [1, 0, 0], [0, 0, 0]])), [0, 0, 1])
