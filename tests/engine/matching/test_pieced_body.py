# SPDX-License-Identifier: GPL-3.0-or-later
"""Whether maps keep the pieces of a body together."""

import numpy as np
import pytest

from engine import SurfaceMap, SurfacePoints
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
