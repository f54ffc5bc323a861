# SPDX-License-Identifier: GPL-3.0-or-later
"""Faces with any number of corners."""

from __future__ import annotations

import numpy as np
import pytest

from engine import MeshError, TriangleMesh
from engine.mesh.polygons import Polygons
from tests.faces import grid, polygons, triangulated

PENTAGON = [[0, 1, 2, 3, 4], [4, 3, 5]]
POSITIONS = np.array([[0, 0, 0], [2, 0, 0], [2, 1, 0], [1, 2, 0], [0, 1, 0], [0, 3, 0.0]])


def test_corners_edges_and_triangles():
    faces = polygons(PENTAGON)
    assert (faces.face_count, faces.corner_count) == (2, 8)
    np.testing.assert_array_equal(faces.face_sizes, [5, 3])
    np.testing.assert_array_equal(faces.corner_faces, [0] * 5 + [1] * 3)
    np.testing.assert_array_equal(faces.next_corners, [1, 2, 3, 4, 0, 6, 7, 5])
    assert len(faces.edges) == 7
    for corner in range(8):
        ends = {faces.corner_vertices[corner], faces.corner_vertices[faces.next_corners[corner]]}
        assert set(faces.edges[faces.corner_edges[corner]]) == ends
    np.testing.assert_array_equal(faces.triangle_faces, [0, 0, 0, 1])


def test_means_and_areas():
    faces = polygons(PENTAGON)
    np.testing.assert_allclose(faces.face_areas(POSITIONS), [3, 1])
    np.testing.assert_allclose(faces.face_means(POSITIONS[faces.corner_vertices])[1], [1 / 3, 2, 0])


@pytest.mark.parametrize("second", [[4, 3, 5], [5, 3, 4]], ids=["consistent", "turned around"])
def test_neighbours_meet_at_the_same_vertices(second):
    faces = polygons([PENTAGON[0], second])
    assert len(faces.neighbours) == 1
    meeting = faces.meeting_corners[0]
    np.testing.assert_array_equal(faces.corner_vertices[meeting[:, 0]], faces.corner_vertices[meeting[:, 1]])
    assert set(faces.corner_vertices[meeting[:, 0]]) == {3, 4}


def test_an_edge_of_three_faces_pairs_each_with_the_next():
    faces = polygons([[0, 1, 2], [1, 0, 3], [0, 1, 4]])
    assert len(faces.neighbours) == 2


def test_triangles_as_a_mesh_has_them():
    vertices, faces, _ = grid(3, 2)
    mesh = triangulated(vertices, faces)
    np.testing.assert_array_equal(faces.cut_as(mesh).triangle_corners, faces.triangle_corners)
    turned = faces.cut_as(TriangleMesh(vertices, mesh.triangles[:, ::-1]))
    np.testing.assert_array_equal(turned.triangle_corners, faces.triangle_corners[:, ::-1])


def test_triangles_that_use_a_vertex_twice_are_left_out():
    faces = polygons([[0, 1, 2], [2, 1, 1], [1, 3, 2]])
    mesh = TriangleMesh([[0, 0, 0], [1, 0, 0], [0, 1, 0], [1, 1, 0]], [[0, 1, 2], [1, 3, 2]])
    np.testing.assert_array_equal(faces.cut_as(mesh).triangle_faces, [0, 2])


def test_another_mesh_is_refused():
    vertices, faces, _ = grid(3, 2)
    mesh = TriangleMesh(vertices, triangulated(vertices, faces).triangles[1:])
    with pytest.raises(MeshError, match="Match again"):
        faces.cut_as(mesh)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"starts": [0, 2, 3]}, "fewer than three"),
        ({"starts": [0, 4]}, "divide 3 corners"),
        ({"corner_edges": [0, 1, 5]}, "one of 3 edges"),
        ({"triangle_corners": [[0, 1, 7]]}, "beyond the 3"),
        ({"triangle_corners": [[0, 1, -1]]}, "triangle_corners of faces should be numbers"),
        ({"corner_edges": [0, -1, 2]}, "corner_edges of faces should be numbers"),
        ({"corner_vertices": [0, 1.7, 2]}, "corner_vertices of faces should be numbers"),
    ],
)
def test_arrays_that_do_not_belong_together(change, message):
    arrays = {
        "starts": [0, 3],
        "corner_vertices": [0, 1, 2],
        "edges": [[0, 1], [1, 2], [2, 0]],
        "corner_edges": [0, 1, 2],
        "triangle_corners": [[0, 1, 2]],
    }
    with pytest.raises(MeshError, match=message):
        Polygons(**(arrays | change))
