# SPDX-License-Identifier: GPL-3.0-or-later
"""Whether maps keep the pieces of a body together."""

import numpy as np
import pytest
from scipy.spatial import cKDTree

from engine import SurfaceMap, SurfacePoints, TriangleMesh
from engine.matching.pieced_body import PiecedBody, common_cut, resized_share, torn_share, without_partner
from tests.limbs import modular_creature


@pytest.fixture(scope="module")
def body():
    creature = modular_creature()
    return PiecedBody(creature.mesh, creature.pieces)


def to_vertices(body, images):
    return SurfaceMap(SurfacePoints.at_vertices(body.mesh, images), np.ones(len(images)), body.mesh.vertex_count)


def test_shares_are_those_of_the_area(body):
    assert body.shares.sum() == pytest.approx(1)
    its = body.pieces[body.mesh.triangles[:, 0]]
    assert body.shares == pytest.approx(np.bincount(its, body.mesh.triangle_areas) / body.mesh.area)
    assert body.unit == pytest.approx(np.sqrt(body.mesh.area))


def test_what_is_not_of_the_body_does_not_count(body):
    less = PiecedBody(body.mesh, np.where(body.pieces == 6, -1, body.pieces))
    assert less.unit == pytest.approx(body.unit * np.sqrt(1 - body.shares[6]))
    assert less.shares == pytest.approx(body.shares[:6] / (1 - body.shares[6]))


def test_bodies_cut_alike_have_all_of_their_cut_in_common_whatever_their_order(body):
    numbers = np.random.default_rng(1).permutation(len(body.shares))
    other = PiecedBody(body.mesh, numbers[body.pieces])
    assert common_cut(body, other) == pytest.approx(1)
    uncut = PiecedBody(body.mesh, np.zeros_like(body.pieces))
    assert common_cut(body, uncut) == common_cut(uncut, body) == pytest.approx(body.shares.max())


def test_nothing_is_torn_or_resized_as_it_is(body):
    found = to_vertices(body, np.arange(body.mesh.vertex_count))
    assert torn_share(body, body, found) == 0
    assert resized_share(body, body, found) == pytest.approx(0, abs=1e-12)


def test_a_piece_that_is_brought_elsewhere_is_torn(body):
    images = np.arange(body.mesh.vertex_count)
    images[body.pieces == 2] = np.flatnonzero(body.pieces == 3)[0]
    found = to_vertices(body, images)
    assert torn_share(body, body, found) == pytest.approx(body.shares[2])
    assert resized_share(body, body, found) == pytest.approx(body.shares[2])


def test_what_is_beside_its_place_in_the_same_piece_is_not(body):
    """Some of the trunk is carried to the nearest vertex of a leg: that much is resized, but nothing is torn."""
    images = np.arange(body.mesh.vertex_count)
    leg = np.flatnonzero(body.pieces == 2)
    places = body.mesh.vertices
    near = np.linalg.norm(places - places[leg][places[leg][:, 2].argmax()], axis=1) < 0.15
    moved = near & (body.pieces == 0)
    assert moved.any()
    images[moved] = leg[places[leg][:, 2].argmax()]
    found = to_vertices(body, images)
    assert torn_share(body, body, found) == 0
    assert resized_share(body, body, found) == pytest.approx(body.areas[moved].sum())


def test_pieces_that_go_to_the_trunk_have_no_partner(body):
    images = np.arange(body.mesh.vertex_count)
    assert not len(without_partner(body, body, to_vertices(body, images)))
    images[body.pieces == 4] = np.flatnonzero(body.pieces == 0)[0]
    images[body.pieces == 5] = np.flatnonzero(body.pieces == 6)[0]
    assert np.array_equal(without_partner(body, body, to_vertices(body, images)), [4])


def test_a_body_without_some_pieces(body):
    less = body.without(np.array([2, 5]))
    assert less.shares[[2, 5]] == pytest.approx(0)
    assert less.shares[0] == pytest.approx(body.shares[0] / (1 - body.shares[2] - body.shares[5]))


def moved_body(body, vertices):
    """The body with its vertices elsewhere."""
    return PiecedBody(TriangleMesh(vertices, body.mesh.triangles), body.pieces)


def as_numbered(target):
    """The map that takes each vertex to the one of its number."""
    return to_vertices(target, np.arange(target.mesh.vertex_count))


def test_a_piece_that_grows_from_where_it_touches_is_not_torn(body):
    vertices, leg = body.mesh.vertices.copy(), body.pieces == 2
    away = cKDTree(vertices[~leg]).query(vertices[leg])[0]
    joint = vertices[leg][away < away.min() + 0.02 * body.unit].mean(axis=0)
    vertices[leg] = joint + [1, 1, 2.5] * (vertices[leg] - joint)
    assert torn_share(body, moved_body(body, vertices), as_numbered(moved_body(body, vertices))) == 0
    vertices[leg] += 0.2 * body.unit
    target = moved_body(body, vertices)
    assert torn_share(body, target, as_numbered(target)) == pytest.approx(body.shares[2])


def test_a_piece_that_touches_nothing_keeps_its_distance_in_units_of_the_body(body):
    vertices = body.mesh.vertices.copy()
    vertices[body.pieces == 2] += [0, 0, -0.4 * body.unit]
    floating = moved_body(body, vertices)
    larger = moved_body(body, 3 * vertices)
    assert torn_share(floating, larger, as_numbered(larger)) == 0
    assert torn_share(larger, floating, as_numbered(floating)) == 0
    vertices[body.pieces == 2] += [0, 0, -0.4 * body.unit]
    target = moved_body(body, vertices)
    assert torn_share(floating, target, as_numbered(target)) == pytest.approx(floating.shares[2])


def test_a_piece_of_which_less_than_half_goes_to_the_trunk_has_a_partner(body):
    images, leg = np.arange(body.mesh.vertex_count), np.flatnonzero(body.pieces == 4)
    some = leg[np.cumsum(body.areas[leg]) < 0.4 * body.shares[4]]
    images[some] = np.flatnonzero(body.pieces == 0)[0]
    assert len(some) > 5
    assert not len(without_partner(body, body, to_vertices(body, images)))
