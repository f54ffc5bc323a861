# SPDX-License-Identifier: GPL-3.0-or-later
"""UVs carried from mesh to mesh."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from engine import MatchError, SurfaceMap, TriangleMesh, run
from engine.retarget.values.charts import cut_into_sheets
from engine.retarget.values.face_correspondence import FacePlaces
from engine.retarget.values.uv_transfer import carry_uvs_steps
from tests.faces import closest_map, grid, polygons, triangulated, tube
from tests.shapes import rotation


def carry(source, target, surface_map=None):
    """Carry UVs from (vertices, polygons, uvs) to (vertices, polygons, ...)."""
    image = triangulated(*source[:2])
    surface_map = surface_map or closest_map(target[0], image)
    places = FacePlaces(image, target[1], surface_map)
    return run(carry_uvs_steps(source[2], source[1], places, target[1].face_areas(target[0])))


def largest_sides(faces, uvs):
    """Longest extent of each face in UV space, (f, 2)."""
    low, high = (part.reduceat(uvs, faces.starts[:-1], axis=0) for part in (np.minimum, np.maximum))
    return high - low


def test_the_same_mesh_gets_the_same_uvs():
    source = tube(16, 6)
    carried = carry(source, source)
    np.testing.assert_allclose(carried.uvs, source[2], atol=1e-12)
    on_seam = np.isclose(source[0][source[1].edges][:, :, :2], [1, 0]).all(axis=(1, 2))
    np.testing.assert_array_equal(carried.seams, on_seam)
    assert (carried.island_count, carried.lost, carried.untrusted) == (1, 0, 0)


def test_a_linear_layer_arrives_exactly_on_any_mesh():
    source, target = grid(5, 4), grid(7, 9)
    carried = carry(source, target)
    np.testing.assert_allclose(carried.uvs, target[2], atol=1e-12)
    assert not carried.seams.any()


def test_an_island_that_meets_itself_is_not_smeared_around():
    source = tube(40, 10)
    target = tube(23, 11, turn=0.1)
    carried = carry(source, target)
    sides = largest_sides(target[1], carried.uvs)
    assert sides[:, 0].max() < 1.3 / 23
    assert sides[:, 1].max() < 1.1 / 11
    # One seam from end to end, and the rest in one piece.
    assert carried.seams.sum() == 11
    cut = cut_into_sheets(triangulated(*target[:2]), target[1], carried.uvs, 1e-9)
    assert cut.count == 1


def test_corners_beyond_the_seam_are_continued_linearly():
    source, target = tube(200, 20), tube(25, 10, turn=0.1)
    uvs = carry(source, target).uvs
    angle = np.arctan2(target[0][:, 1], target[0][:, 0])[target[1].corner_vertices] / (2 * np.pi)
    wrapped = (uvs[:, 0] - angle + 0.5) % 1 - 0.5
    assert abs(wrapped).max() < 0.002
    assert uvs[:, 0].min() < -0.01 or uvs[:, 0].max() > 1.01


def test_corners_at_a_vertex_of_one_island_are_bitwise_the_same():
    source, target = tube(40, 10), tube(23, 11, turn=0.1)
    carried = carry(source, target)
    uvs, meeting = carried.uvs, target[1].meeting_corners
    seam = carried.seams[target[1].corner_edges[target[1].neighbours[:, 0]]]
    inside = meeting[~seam].reshape(-1, 2)
    np.testing.assert_array_equal(uvs[inside[:, 0]], uvs[inside[:, 1]])


def test_a_quarter_of_a_face_does_not_matter():
    """Islands side by side: every face takes all of its corners from one."""
    vertices, faces, uvs = grid(8, 4)
    right = vertices[faces.corner_vertices[faces.starts[:-1] + 1], 0] > 0.51
    uvs = uvs + 5 * right[faces.corner_faces, None]
    target = grid(7, 5)
    carried = carry((vertices, faces, uvs), target)
    assert carried.island_count == 2
    centres = target[1].face_means(target[2])
    shift = np.where(centres[:, 0] > 0.5, 5.0, 0.0)[target[1].corner_faces, None]
    middle = np.isclose(centres[:, 0], 0.5)[target[1].corner_faces]
    np.testing.assert_allclose((carried.uvs - target[2])[~middle], np.broadcast_to(shift, (140, 2))[~middle], atol=1e-9)
    assert largest_sides(target[1], carried.uvs).max() < 0.21


def test_islands_that_overlap_do_not_mix():
    vertices, faces, uvs = grid(8, 4)
    uvs = uvs.copy()
    right = vertices[faces.corner_vertices[faces.starts[:-1] + 1], 0] > 0.51
    uvs[right[faces.corner_faces], 0] -= 0.5  # one half upon the other
    target = grid(12, 3)
    carried = carry((vertices, faces, uvs), target)
    expected = target[2] - [0.5, 0] * (target[1].face_means(target[2])[:, :1] > 0.5)[target[1].corner_faces]
    np.testing.assert_allclose(carried.uvs, expected, atol=1e-9)
    assert carried.seams.sum() == 3


@pytest.mark.parametrize("factor", [1e-3, 1e4])
def test_scale_and_place_do_not_matter(factor):
    source, target = tube(40, 10), tube(23, 11, turn=0.1)
    expected = carry(source, target)
    turn = factor * rotation([1, 2, 3], 0.7)
    moved = (source[0] @ turn.T + 3 * factor, source[1], 10 * source[2] + [7, -2])
    carried = carry(moved, (target[0] @ turn.T + 3 * factor, target[1]))
    np.testing.assert_allclose(carried.uvs, 10 * expected.uvs + [7, -2], atol=1e-6)
    np.testing.assert_array_equal(carried.seams, expected.seams)


def test_faces_of_any_size():
    source = grid(6, 6)
    vertices = np.array([[0, 0, 0], [0.5, 0, 0], [1, 0, 0], [1, 1, 0], [0.5, 1, 0], [0, 1, 0], [0.3, 0.5, 0]])
    faces = polygons([[0, 1, 2, 3, 4, 6], [0, 6, 4, 5]])
    carried = carry(source, (vertices, faces))
    np.testing.assert_allclose(carried.uvs, vertices[faces.corner_vertices, :2], atol=1e-12)


def test_a_layer_without_area():
    source, target = grid(5, 4), grid(7, 9)
    carried = carry((*source[:2], 0 * source[2] + 0.25), target)
    np.testing.assert_allclose(carried.uvs, 0.25)
    assert not carried.seams.any()


def test_loose_parts_of_the_target():
    vertices, faces, _ = grid(4, 4)
    scattered = (vertices[faces.corner_vertices], polygons(np.arange(64).reshape(16, 4).tolist()))
    carried = carry(grid(5, 5), scattered)
    np.testing.assert_allclose(carried.uvs, scattered[0][:, :2], atol=1e-12)


def test_islands_smaller_than_the_faces_are_not_called_lost():
    # Each face is an island of its own, with a place in a palette; the target has a ninth of the faces.
    (vertices, faces, _), target = grid(24, 24), grid(8, 8)
    palette = np.repeat(np.random.default_rng(0).random((faces.face_count, 2)), np.diff(faces.starts), axis=0)
    carried = carry((vertices, faces, palette), target)
    assert carried.island_count == faces.face_count
    assert carried.lost == 0


def test_islands_that_are_lost_or_not_to_be_trusted_are_counted():
    vertices, faces, uvs = grid(8, 4)
    column = np.arange(faces.face_count) % 8 // 2  # four islands
    uvs = uvs + 5 * column[faces.corner_faces, None]
    target = grid(6, 4)
    half = (target[0] * [0.5, 1, 1], target[1])
    image = triangulated(vertices, faces)
    exact = closest_map(half[0], image)
    doubtful = SurfaceMap(exact.points, np.where(half[0][:, 0] < 0.3, 0.0, 1.0), image.vertex_count)
    carried = carry((vertices, faces, uvs), half, doubtful)
    assert (carried.island_count, carried.lost, carried.untrusted) == (4, 2, 1)


def test_a_splinter_goes_with_what_is_around_it():
    vertices, faces, uvs = grid(40, 40)
    right = vertices[faces.corner_vertices[faces.starts[:-1] + 1], 0] > 0.51
    uvs = uvs + 5 * right[faces.corner_faces, None]
    image = triangulated(vertices, faces)
    places = FacePlaces(image, faces, SurfaceMap.identity(image))
    # One face in the middle of the left side has come to lie on the right side.
    stray, other = 40 * 20 + 15, 40 * 20 + 30
    triangles = places.seats.triangles.copy()
    triangles[stray] = triangles[other]
    places.seats = replace(places.seats, triangles=triangles)
    carried = run(carry_uvs_steps(uvs, faces, places, faces.face_areas(vertices)))
    np.testing.assert_allclose(carried.uvs, uvs, atol=1e-9)
    assert carried.seams.sum() == 40


def test_shapes_that_do_not_fit():
    source, target = grid(5, 4), grid(7, 9)
    with pytest.raises(MatchError, match=r"shape \(80, 2\)"):
        carry((*source[:2], source[2][1:]), target)
    image = triangulated(*source[:2])
    with pytest.raises(MatchError, match="Match again"):
        FacePlaces(image, target[1], SurfaceMap.identity(image))
    with pytest.raises(MatchError, match="leads to"):
        FacePlaces(TriangleMesh(target[0], image.triangles), source[1], SurfaceMap.identity(image))
