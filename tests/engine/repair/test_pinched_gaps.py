# SPDX-License-Identifier: GPL-3.0-or-later
"""Single faces that are missing where gaps meet."""

import numpy as np
import pytest

from engine import TriangleMesh
from engine.mesh.connectivity.halfedges import group_half_edges, pair_half_edges
from engine.repair.pinched_gaps import pinched_gaps
from tests.shapes import icosphere, plane


def found_gaps(vertices, triangles):
    twins = pair_half_edges(vertices, triangles, group_half_edges(triangles, len(vertices)))
    return pinched_gaps(vertices, triangles, twins, TriangleMesh(vertices, triangles).area)


def in_order(faces):
    """Triangles as a set, whatever corner they start at, but not turned over."""
    return {tuple(np.roll(face, -int(np.argmin(face))).tolist()) for face in faces}


def sharing_a_vertex(triangles, first, count):
    """Numbers of triangles around one vertex, no two of which share an edge."""
    chosen = []
    for number in np.flatnonzero((triangles == first).any(axis=1)):
        if all(len(np.intersect1d(triangles[number], triangles[other])) == 1 for other in chosen):
            chosen.append(int(number))
    return np.array(chosen[:count])


@pytest.fixture
def ball():
    return icosphere(8)


@pytest.mark.parametrize("count", [2, 3])
def test_the_faces_that_were_taken_out_are_found(ball, count):
    vertices, triangles = ball
    gone = sharing_a_vertex(triangles, 200, count)
    assert len(gone) == count
    faces, half_edges = found_gaps(vertices, np.delete(triangles, gone, axis=0))
    assert faces.shape == half_edges.shape == (count, 3)
    assert in_order(faces) == in_order(triangles[gone])


def test_their_half_edges_run_against_those_they_are_the_twins_of(ball):
    vertices, triangles = ball
    rest = np.delete(triangles, sharing_a_vertex(triangles, 200, 2), axis=0)
    faces, half_edges = found_gaps(vertices, rest)
    tails, heads = rest.ravel(), np.roll(rest, -1, axis=1).ravel()
    np.testing.assert_array_equal(tails[half_edges], np.roll(faces, -1, axis=1))
    np.testing.assert_array_equal(heads[half_edges], faces)


def test_with_them_the_surface_is_closed(ball):
    vertices, triangles = ball
    rest = np.delete(triangles, sharing_a_vertex(triangles, 300, 3), axis=0)
    faces, _ = found_gaps(vertices, rest)
    assert TriangleMesh(vertices, np.concatenate([rest, faces])).is_closed


def test_a_whole_surface_lacks_nothing(ball):
    faces, half_edges = found_gaps(*ball)
    assert faces.shape == half_edges.shape == (0, 3)


def test_gaps_that_meet_no_other_are_left_to_others(ball):
    vertices, triangles = ball
    pair = sharing_a_vertex(triangles, 200, 2)
    lone = int((vertices[triangles].mean(axis=1) @ vertices[200]).argmin())
    assert len(found_gaps(vertices, np.delete(triangles, lone, axis=0))[0]) == 0
    faces, _ = found_gaps(vertices, np.delete(triangles, [*pair, lone], axis=0))
    assert in_order(faces) == in_order(triangles[pair])


def test_of_gaps_that_meet_only_those_of_one_face_are_found(ball):
    vertices, triangles = ball
    single, other = sharing_a_vertex(triangles, 200, 2)
    corners = triangles[other]
    away = corners[corners != 200]
    beside = np.flatnonzero(np.isin(triangles, away).sum(axis=1) == 2)
    gone = np.unique([single, other, *beside])
    assert len(gone) == 3
    faces, _ = found_gaps(vertices, np.delete(triangles, gone, axis=0))
    assert in_order(faces) == in_order(triangles[[single]])


def test_large_gaps_are_left():
    vertices, triangles = icosphere(2)  # each face more than a hundredth of the surface
    gone = sharing_a_vertex(triangles, 20, 2)
    assert len(gone) == 2
    assert len(found_gaps(vertices, np.delete(triangles, gone, axis=0))[0]) == 0


def test_of_a_net_of_triangles_that_touch_in_corners_just_the_others_are_gaps():
    vertices, triangles = plane(12)
    rest, gone = np.split(triangles, 2)
    # At the border of the sheet gaps are open.
    edges = {tuple(edge) for face in rest.tolist() for edge in zip(face, np.roll(face, -1).tolist(), strict=True)}
    closed = [all((b, a) in edges for a, b in zip(face, np.roll(face, -1), strict=True)) for face in gone]
    assert 50 < sum(closed) < len(gone)
    assert in_order(found_gaps(vertices, rest)[0]) == in_order(gone[closed])


def test_the_numbering_of_the_triangles_does_not_matter(ball):
    vertices, triangles = ball
    rest = np.delete(triangles, sharing_a_vertex(triangles, 200, 3), axis=0)
    shuffled = np.random.default_rng(0).permutation(rest)
    assert in_order(found_gaps(vertices, shuffled)[0]) == in_order(found_gaps(vertices, rest)[0])
