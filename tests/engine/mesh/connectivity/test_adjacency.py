# SPDX-License-Identifier: GPL-3.0-or-later
"""Neighbours of vertices, and means over them."""

import numpy as np
import pytest

from engine import TriangleMesh
from engine.mesh.connectivity.adjacency import averaging, edge_graph, neighbour_means, vertex_adjacency
from tests.shapes import icosphere, permuted, plane


def neighbours(mesh):
    """For each vertex the set of those it shares a triangle with."""
    found = [set() for _ in range(mesh.vertex_count)]
    for triangle in mesh.triangles.tolist():
        for corner in triangle:
            found[corner] |= set(triangle) - {corner}
    return found


@pytest.fixture(params=["ball", "sheet", "loose vertex"])
def mesh(request):
    if request.param == "ball":
        return TriangleMesh(*icosphere(3))
    vertices, triangles = plane(5, jitter=0.3)
    loose = [[2.0, 2.0, 0.0]] if request.param == "loose vertex" else np.zeros((0, 3))
    return TriangleMesh(np.concatenate([vertices, loose]), triangles)


def test_the_matrix_joins_just_the_corners_of_triangles(mesh):
    matrix = vertex_adjacency(mesh).toarray()
    expected = np.zeros_like(matrix)
    for vertex, others in enumerate(neighbours(mesh)):
        expected[vertex, list(others)] = 1
    np.testing.assert_array_equal(matrix, expected)


def test_averaging_takes_half_of_each_and_half_of_its_neighbours(mesh):
    values = mesh.vertices @ [1.0, 2.0, 3.0]
    around = [np.mean(values[list(others)]) if others else 0.0 for others in neighbours(mesh)]
    np.testing.assert_allclose(averaging(vertex_adjacency(mesh)) @ values, (values + around) / 2, atol=1e-12)


def test_edges_have_their_lengths_in_both_directions(mesh):
    lengths = edge_graph(mesh).toarray()
    np.testing.assert_array_equal(lengths > 0, vertex_adjacency(mesh).toarray() > 0)
    np.testing.assert_array_equal(lengths, lengths.T)
    first, second = mesh.edges.T
    np.testing.assert_array_equal(lengths[first, second], mesh.edge_lengths)


def test_an_edge_of_many_triangles_counts_once():
    book = TriangleMesh([[0, 0, 0], [0, 0, 1], [1, 0, 0], [0, 1, 0], [-1, -1, 0]], [[0, 1, 2], [0, 1, 3], [1, 0, 4]])
    np.testing.assert_array_equal(vertex_adjacency(book).sum(axis=1), [4, 4, 2, 2, 2])
    assert vertex_adjacency(book)[0, 1] == 1


def test_powers_of_the_matrix_count_walks():
    # Each vertex of an icosahedron has five neighbours, two at each edge's sides, and one opposite.
    matrix = vertex_adjacency(TriangleMesh(*icosphere(1)))
    walks = (matrix @ matrix).toarray()
    assert (np.diag(walks) == 5).all()
    assert (walks[matrix.toarray() == 1] == 2).all()
    assert ((walks == 0).sum(axis=1) == 1).all()


def test_means_are_over_each_vertex_and_its_neighbours(mesh):
    values = np.random.default_rng(0).random(mesh.vertex_count)
    expected = [values[[vertex, *others]].mean() for vertex, others in enumerate(neighbours(mesh))]
    np.testing.assert_allclose(neighbour_means(mesh, values), expected, rtol=1e-12)


def test_inside_a_grid_linear_functions_stay():
    mesh = TriangleMesh(*plane(6))
    values = mesh.vertices @ [2.0, -3.0, 0.0] + 1
    inside = ((mesh.vertices[:, :2] > 0.01) & (mesh.vertices[:, :2] < 0.99)).all(axis=1)
    means = neighbour_means(mesh, values)
    np.testing.assert_allclose(means[inside], values[inside], atol=1e-12)
    assert abs(means - values)[~inside].max() > 0.1


def test_means_do_not_depend_on_the_numbering():
    vertices, triangles = icosphere(3)
    values = vertices[:, 0] ** 2 + vertices[:, 1]
    other_vertices, other_triangles, new = permuted(vertices, triangles)
    other_values = np.empty_like(values)
    other_values[new] = values
    means = neighbour_means(TriangleMesh(vertices, triangles), values)
    others = neighbour_means(TriangleMesh(other_vertices, other_triangles), other_values)
    np.testing.assert_allclose(others[new], means, atol=1e-12)
