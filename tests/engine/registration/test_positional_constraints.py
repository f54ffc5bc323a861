# SPDX-License-Identifier: GPL-3.0-or-later
"""Points tied to places in space."""

import numpy as np
import pytest
from scipy.sparse import diags_array
from scipy.sparse.linalg import splu

from engine import SurfacePoints, TriangleMesh
from engine.mesh.connectivity.adjacency import vertex_adjacency
from engine.registration.positional_constraints import Ties
from tests.shapes import icosphere


@pytest.fixture(scope="module")
def ball():
    return TriangleMesh(*icosphere(16))


@pytest.fixture(scope="module")
def points(ball):
    rng = np.random.default_rng(0)
    return SurfacePoints.from_barycentric(ball, np.array([3, 700, 1500, 4000]), rng.dirichlet([1.0, 1.0, 1.0], 4))


@pytest.fixture(scope="module")
def stiffness(ball):
    """A membrane on springs."""
    off = vertex_adjacency(ball)
    return (diags_array(off.sum(axis=1) + 0.1) - off).tocsc()


def held(ties, stiffness, positions):
    return ties.held(positions, splu(stiffness).solve(ties.forces))


def test_tied_points_are_evaluated_where_they_are(ball, points):
    ties = Ties.at(ball, points, points.positions)
    np.testing.assert_allclose(ties.evaluate @ ball.vertices, points.positions, atol=1e-12)
    np.testing.assert_allclose(ties.evaluate.sum(axis=1), 1)


def test_forces_are_spread_near_to_each_point_alone(ball, points):
    forces = Ties.at(ball, points, points.positions).forces
    np.testing.assert_allclose(forces.sum(axis=0), 1)
    assert (forces >= 0).all()
    nearest = ball.vertices[points.nearest_vertices]
    away = np.linalg.norm(ball.vertices[:, None] - nearest, axis=2)
    assert away[forces > 0].max() <= 0.03 * np.sqrt(ball.area)
    assert (forces.argmax(axis=0) == points.nearest_vertices).all()
    assert ((forces > 0).sum(axis=0) > 1).all()


def test_forces_of_neighbours_do_not_overlap(ball):
    vertices = ball.triangles[100]
    forces = Ties.at(ball, SurfacePoints.at_vertices(ball, vertices), ball.vertices[vertices]).forces
    assert ((forces > 0).sum(axis=1) <= 1).all()


def test_ties_hold_exactly_wherever_the_surface_was(ball, points, stiffness):
    rng = np.random.default_rng(1)
    places, free = rng.normal(size=(4, 3)), rng.normal(size=(ball.vertex_count, 3))
    moved = held(Ties.at(ball, points, places), stiffness, free)
    found = SurfacePoints.from_barycentric(TriangleMesh(moved, ball.triangles), points.triangles, points.barycentric)
    np.testing.assert_allclose(found.positions, places, atol=1e-9)


def test_where_they_hold_already_nothing_moves(ball, points, stiffness):
    moved = held(Ties.at(ball, points, points.positions), stiffness, ball.vertices)
    np.testing.assert_allclose(moved, ball.vertices, atol=1e-12)


def test_the_surface_moves_by_forces_on_the_tied_points_alone(ball, points, stiffness):
    ties = Ties.at(ball, points, points.positions + np.diag([0.1, 0.2, 0.1, 0.3])[:, :3])
    balance = stiffness @ (held(ties, stiffness, ball.vertices) - ball.vertices)
    unloaded = ~(ties.forces > 0).any(axis=1)
    assert np.abs(balance[unloaded]).max() < 1e-9
    assert np.abs(balance[~unloaded]).max() > 1e-3
    strengths, rest, *_ = np.linalg.lstsq(ties.forces, balance, rcond=None)
    assert rest.max() < 1e-12
    assert np.abs(strengths).max() > 0.01


def test_two_ties_at_one_point_that_say_the_same_are_one(ball, points, stiffness):
    place = points.positions[:1] + np.array([0.0, 0.3, 0.1])
    one = SurfacePoints.at_vertices(ball, np.array([40]))
    two = SurfacePoints.at_vertices(ball, np.array([40, 40]))
    alone, twice = (Ties.at(ball, at, np.repeat(place, len(at), axis=0)) for at in (one, two))
    assert np.isfinite(twice.forces).all()
    moved = held(twice, stiffness, ball.vertices)
    np.testing.assert_allclose(moved[40], place[0], atol=1e-9)
    np.testing.assert_allclose(held(alone, stiffness, ball.vertices)[40], place[0], atol=1e-9)


def test_two_ties_at_one_point_that_differ_meet_in_the_middle(ball, stiffness):
    at = SurfacePoints.at_vertices(ball, np.array([40, 40]))
    places = np.array([[0.0, 0, 2], [0, 0, 3]])
    moved = held(Ties.at(ball, at, places), stiffness, ball.vertices)
    np.testing.assert_allclose(moved[40], [0, 0, 2.5], atol=1e-9)
