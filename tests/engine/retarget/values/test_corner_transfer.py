# SPDX-License-Identifier: GPL-3.0-or-later
"""Values at corners and points, and normals, carried from mesh to mesh."""

from __future__ import annotations

import numpy as np
import pytest

from engine import MeshError, SurfaceMap, TriangleMesh
from engine.retarget.values.corner_transfer import carry_corner_values, carry_normals, carry_point_marks
from engine.retarget.values.face_correspondence import FacePlaces
from tests.faces import closest_map, grid, triangulated, tube
from tests.shapes import rotation


@pytest.mark.parametrize("unit", [1e-5, 1.0, 1e5])
def test_what_jumps_from_face_to_face_does_so_there_as_well_in_any_unit(unit):
    source, target = grid(4, 4), grid(7, 5)
    mesh = triangulated(*source[:2])
    places = FacePlaces(mesh, target[1], closest_map(target[0], mesh))
    ramp, side = source[2][:, 1], source[0][source[1].corner_vertices, 0].reshape(-1, 4).mean(axis=1) > 0.25
    values = unit * (ramp + 3 * np.repeat(side, 4))
    carried = carry_corner_values(values, source[1], places) / unit
    middles = target[2][:, 0].reshape(-1, 4).mean(axis=1)
    np.testing.assert_allclose(carried, target[2][:, 1] + 3 * np.repeat(middles > 0.25, 4), atol=1e-9)


def test_normals_of_the_surface_become_those_of_the_other():
    source, target = tube(24, 6), tube(31, 5)
    turn = rotation([1, 2, 3], 1.1)
    mesh = triangulated(*source[:2])
    moved = TriangleMesh(target[0] @ turn.T, triangulated(*target[:2]).triangles)
    places = FacePlaces(mesh, target[1], closest_map(target[0], mesh))
    rotations = np.broadcast_to(turn, (moved.vertex_count, 3, 3))
    normals = mesh.vertex_normals[source[1].corner_vertices]
    carried = carry_normals(normals, source[1], places, moved, rotations)
    np.testing.assert_allclose(carried, moved.vertex_normals[target[1].corner_vertices], atol=0.02)


def test_deviating_normals_turn_with_the_surface():
    source = tube(24, 6)
    turn = rotation([1, 2, 3], 1.1)
    mesh = triangulated(*source[:2])
    moved = TriangleMesh(mesh.vertices @ turn.T, mesh.triangles)
    places = FacePlaces(mesh, source[1], SurfaceMap.identity(mesh))
    flat = mesh.triangle_normals[::2][source[1].corner_faces]  # as if each face were flat
    rotations = np.broadcast_to(turn, (moved.vertex_count, 3, 3))
    carried = carry_normals(flat, source[1], places, moved, rotations)
    np.testing.assert_allclose(carried, flat @ turn.T, atol=1e-9)


def test_one_normal_for_each_corner():
    side = grid(2, 2)
    image = triangulated(*side[:2])
    places = FacePlaces(image, side[1], SurfaceMap.identity(image))
    with pytest.raises(MeshError, match="each of 16 corners"):
        carry_normals(np.zeros((9, 3)), side[1], places, image, np.zeros((9, 3, 3)))


def test_the_largest_of_marks_that_meet_counts():
    source, target = grid(4, 4), grid(1, 1)
    values = np.zeros(25)
    values[[0, 1, 5]] = [0.2, 0.9, 0.3]
    carried = carry_point_marks(values, closest_map(source[0], triangulated(*target[:2])))
    assert carried.tolist() == [0.9, 0, 0, 0]
