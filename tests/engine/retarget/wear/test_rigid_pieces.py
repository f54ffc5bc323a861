# SPDX-License-Identifier: GPL-3.0-or-later
"""Rigid pieces of clothes: which parts they are."""

import itertools

import numpy as np

from engine import TriangleMesh
from engine.retarget.wear.rigid_pieces import moved_along, placed_rigidly, rigid_pieces
from tests.shapes import icosphere, plane, rotation


def ball(radius, centre):
    vertices, triangles = icosphere(2, radius)
    return TriangleMesh(vertices + np.array(centre), triangles)


def strand():
    """A strip of hair as long as a hand."""
    vertices, triangles = plane(4)
    return TriangleMesh(
        np.column_stack([0.02 * vertices[:, 0], 0.08 * vertices[:, 1] + 1, 0 * vertices[:, 0]]), triangles
    )


def test_small_solid_parts_are_found_and_others_are_not():
    parts = [ball(0.5, (0, 0, 0)), ball(0.02, (0.6, 0, 0)), ball(0.02, (-0.6, 0, 0)), strand()]
    item = TriangleMesh.concatenated(parts)
    pieces = rigid_pieces(item, 1.0)
    counts = np.cumsum([0, *(part.vertex_count for part in parts)])
    found = [set(pieces[first:last].tolist()) for first, last in itertools.pairwise(counts)]
    assert found == [{-1}, {0}, {1}, {-1}]


def test_parts_that_nearly_touch_are_one_piece():
    # The frame of glasses, and two lenses in it.
    item = TriangleMesh.concatenated([ball(0.02, (0, 0, 0)), ball(0.015, (0.037, 0, 0)), ball(0.015, (0.3, 0, 0))])
    pieces = rigid_pieces(item, 1.0)
    assert len(set(pieces[:42].tolist())) == 1
    assert len(set(pieces.tolist())) == 2


def test_it_does_not_depend_on_the_unit():
    item = TriangleMesh.concatenated([ball(0.5, (0, 0, 0)), ball(0.02, (0.6, 0, 0))])
    larger = TriangleMesh(300 * item.vertices, item.triangles)
    np.testing.assert_array_equal(rigid_pieces(item, 1.0), rigid_pieces(larger, 300.0))


def test_named_vertices_are_pieces_by_what_hangs_together():
    item = TriangleMesh.concatenated([ball(0.5, (0, 0, 0)), ball(0.5, (3, 0, 0))])
    named = np.abs(item.vertices[:, 0] - 1.5) > 1.2
    pieces = rigid_pieces(item, 1.0, named, search=False)
    assert (pieces[~named] == -1).all()
    assert set(pieces[named].tolist()) == {0, 1}


def test_a_piece_is_moved_by_a_similarity():
    points = np.random.default_rng(0).normal(size=(20, 3))
    moved = 2 * points @ rotation([0, 1, 2], 0.7).T + 5
    np.testing.assert_allclose(placed_rigidly(points, moved), moved)
    smaller = placed_rigidly(points, moved, 1.0)
    np.testing.assert_allclose(smaller.std(axis=0), moved.std(axis=0) / 2, rtol=1e-9)


def test_pieces_move_with_what_is_nearest_to_them():
    vertices = np.array([[0, 0, 0], [1, 0, 0], [2, 0, 0], [0, 0.1, 0], [1, 0.1, 0], [2, 0.1, 0.0]])
    moves = np.array([[1, 0, 0], [3, 0, 0], [0, 5, 0], [9, 9, 9], [9, 9, 9], [9, 9, 9.0]])
    pieces = np.array([-1, -1, -1, 0, 0, 1])
    np.testing.assert_allclose(moved_along(vertices, moves, pieces), [[2, 0, 0], [0, 5, 0]])
    np.testing.assert_array_equal(moved_along(vertices, moves, np.zeros(6, int)), np.zeros((1, 3)))
    assert moved_along(vertices, moves, np.full(6, -1)).shape == (0, 3)
