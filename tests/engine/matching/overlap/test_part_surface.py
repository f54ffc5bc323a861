# SPDX-License-Identifier: GPL-3.0-or-later
"""Surfaces of which something may have been cut off."""

import pickle

import numpy as np
import pytest

from engine import TriangleMesh
from engine.matching.overlap.part_surface import PartSurface
from tests.shapes import compacted, icosphere, permuted, plane, plane_with_hole


def surface(vertices, triangles):
    return PartSurface(TriangleMesh(vertices, triangles))


def test_where_nothing_was_cut_off_the_border_is_farther_than_any_place():
    closed = surface(*icosphere(4, radius=0.3))
    assert not closed.border.any()
    assert (closed.border_distances > 5).all()


def test_the_distance_to_the_border_is_that_along_the_surface():
    square = surface(*plane(20))
    assert square.border.sum() == 4 * 19 or square.border.sum() == 4 * 20
    expected = np.minimum(square.vertices[:, :2], 1 - square.vertices[:, :2]).min(axis=1)
    np.testing.assert_allclose(square.border_distances, expected, atol=1e-9)


@pytest.mark.parametrize(("half_width", "is_cut"), [(0.005, False), (0.15, True)])
def test_pinholes_are_no_cuts(half_width, is_cut):
    vertices, triangles = plane_with_hole(20, 0.45, 0.55)
    inner = (np.abs(vertices[:, :2] - 0.5) <= 0.05 + 1e-9).all(axis=1)
    # The hole, a tenth wide, is made as wide as wanted.
    vertices = vertices.copy()
    vertices[inner, :2] = 0.5 + (vertices[inner, :2] - 0.5) * (half_width / 0.05)
    assert surface(vertices, triangles).border[inner].any() == is_cut


def test_what_spreads_keeps_its_amount_and_constants_stay():
    ball = surface(*icosphere(4))
    values = np.random.default_rng(0).random((ball.count, 2))
    np.testing.assert_allclose(ball.mass @ ball.smoothed(values, 0.01), ball.mass @ values)
    np.testing.assert_allclose(ball.smoothed(np.ones(ball.count), 0.01), 1)


def test_samples_do_not_depend_on_the_order_of_the_vertices():
    vertices, triangles = compacted(*plane(15, jitter=0.2))
    vertices = vertices @ np.array([[1.0, 0.0, 0.0], [0.2, 1.4, 0.0], [0.0, 0.0, 1.0]])  # no two sides are alike
    other_vertices, other_triangles, _ = permuted(vertices, triangles, seed=3)
    one, other = surface(vertices, triangles), surface(other_vertices, other_triangles)
    np.testing.assert_allclose(one.vertices[one.samples(12)], other.vertices[other.samples(12)])


def test_of_what_is_chosen_the_largest_piece_is_kept():
    square = surface(*plane(20))
    x = square.vertices[:, 0]
    kept = square.largest_piece((x < 0.3) | (x > 0.55))
    np.testing.assert_array_equal(kept, x > 0.55)


def test_it_can_be_sent_after_use():
    ball = surface(*icosphere(3))
    before = ball.smoothed(ball.normals, 0.01)
    sent = pickle.loads(pickle.dumps(ball))  # noqa: S301 -- its own
    np.testing.assert_array_equal(sent.smoothed(ball.normals, 0.01), before)
