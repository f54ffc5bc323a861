# SPDX-License-Identifier: GPL-3.0-or-later
"""Limbs that a map exchanges: on a symmetric body in several poses, whose true map is known at every vertex."""

import numpy as np
import pytest
from scipy.spatial import cKDTree

from engine import Shape, TriangleMesh, run
from engine.dense.functional_maps import PointMaps
from engine.dense.limb_sides import repaired_start_steps
from tests.bodies import mirrored_body
from tests.shapes import icosphere

SAMPLES = 150
MIRROR = np.array([1, -1, 1])
FORE, HIND = (1, -0.35), (-1, -0.35)  # side of x, and z below which a point is on a leg


def shape(vertices, triangles):
    made = Shape(TriangleMesh(vertices, triangles))
    run(made.sample_steps(SAMPLES))
    return made


class Body:
    """The body in a pose and triangulation."""

    def __init__(self, pose, seed=None):
        vertices, triangles, self.rest = mirrored_body(pose, 9, seed=seed)
        self.shape = shape(vertices, triangles)
        self.size = float(np.sqrt(self.shape.mesh.area))

    def nearest(self, places):
        """Vertices nearest to places at rest."""
        return cKDTree(self.rest).query(places)[1]

    def leg(self, end, top=None):
        """Vertices of both fore or hind legs, from some height down."""
        side, z = end
        return (self.rest[:, 0] * side > 0.2) & (self.rest[:, 2] < (z if top is None else top))


@pytest.fixture(scope="module")
def bodies():
    return Body(0.0), Body(0.9, seed=1)


def truth(x, y):
    return PointMaps(y.nearest(x.rest), x.nearest(y.rest))


def exchanged(x, y, end, top=None):
    """Take the true map, but each leg to the one of the other side."""
    there, back = truth(x, y)
    here, other = x.leg(end, top), y.leg(end, top)
    there[here] = y.nearest(x.rest[here] * MIRROR)
    back[other] = x.nearest(y.rest[other] * MIRROR)
    return PointMaps(there, back)


def pairs(start):
    """The vertices that a start pairs."""
    return start.source_distances.argmin(axis=1), start.target_distances.argmin(axis=1)


def is_seen_from(body, vertices):
    """Say whether a start was found by the tips of this body: then all of its vertices there are samples."""
    return np.isin(vertices, body.shape.samples.vertices).all()


def assert_true(x, y, start):
    here, there = pairs(start)
    assert np.linalg.norm(x.rest[here] - y.rest[there], axis=1).max() < 0.12 * x.size


# --- maps that are right


def test_the_true_map_is_left_alone(bodies):
    x, y = bodies
    assert run(repaired_start_steps(x.shape, y.shape, truth(x, y))) is None
    assert run(repaired_start_steps(y.shape, x.shape, truth(y, x))) is None


def test_a_rough_map_is_left_alone(bodies):
    x, y = bodies
    random = np.random.default_rng(0)
    there, back = (b.nearest(a.rest + 0.03 * a.size * random.normal(size=a.rest.shape)) for a, b in ((x, y), (y, x)))
    assert run(repaired_start_steps(x.shape, y.shape, PointMaps(there, back))) is None


def test_the_mirrored_map_is_left_alone(bodies):
    x, y = bodies
    mirrored = PointMaps(y.nearest(x.rest * MIRROR), x.nearest(y.rest * MIRROR))
    assert run(repaired_start_steps(x.shape, y.shape, mirrored)) is None


def test_a_body_without_limbs_is_left_alone():
    ball = shape(*icosphere(6))
    same = np.arange(ball.mesh.vertex_count)
    assert run(repaired_start_steps(ball, ball, PointMaps(same, same))) is None


def test_nothing_is_said_where_the_maps_do_not_agree(bodies):
    x, y = bodies
    maps = exchanged(x, y, FORE)
    nowhere = PointMaps(maps.on_y, np.full_like(maps.on_x, x.shape.samples.vertices[0]))
    assert run(repaired_start_steps(x.shape, y.shape, nowhere)) is None


# --- maps that are wrong


@pytest.mark.parametrize("end", [FORE, HIND])
@pytest.mark.parametrize("top", [None, -0.7])
def test_exchanged_legs_are_found_and_put_right(bodies, end, top):
    x, y = bodies
    maps = exchanged(x, y, end, top)
    start = run(repaired_start_steps(x.shape, y.shape, maps))
    assert start is not None
    assert start.origin == "limbs"
    # Either side sees it by itself.
    back = run(repaired_start_steps(y.shape, x.shape, PointMaps(maps.on_x, maps.on_y)))
    assert is_seen_from(x, pairs(start)[0])
    assert is_seen_from(y, pairs(back)[0])
    assert_true(x, y, start)
    assert {tuple(np.sign(x.rest[v, :2])) for v in pairs(start)[0] if x.leg(end)[v]} >= {(end[0], 1), (end[0], -1)}


def test_all_four_legs_exchanged_are_put_right(bodies):
    x, y = bodies
    fore, hind = exchanged(x, y, FORE), exchanged(x, y, HIND)
    there = np.where(x.leg(HIND), hind.on_y, fore.on_y)
    back = np.where(y.leg(HIND), hind.on_x, fore.on_x)
    assert_true(x, y, run(repaired_start_steps(x.shape, y.shape, PointMaps(there, back))))


def test_three_legs_that_went_round_are_put_right(bodies):
    x, y = bodies
    # Left fore leg to right fore leg to left hind leg, along the middle planes of the legs.
    corners = {(1, 1): (1, -1), (1, -1): (-1, 1), (-1, 1): (1, 1)}
    maps = []
    for a, b, moves in ((x, y, corners), (y, x, {v: k for k, v in corners.items()})):
        places, end = a.rest.copy(), np.array([0.475, 0.2, 0])
        for here, there in moves.items():
            leg = (a.rest[:, :2] * here > [0.2, 0]).all(axis=1) & (a.rest[:, 2] < -0.35)
            places[leg] += end * [there[0] - here[0], there[1] - here[1], 0]
        maps.append(b.nearest(places))
    assert_true(x, y, run(repaired_start_steps(x.shape, y.shape, PointMaps(*maps))))


def test_legs_that_only_the_way_back_exchanges_are_found(bodies):
    x, y = bodies
    maps = PointMaps(truth(x, y).on_y, exchanged(x, y, FORE, -0.6).on_x)
    start = run(repaired_start_steps(x.shape, y.shape, maps))
    assert start is not None
    assert not is_seen_from(x, pairs(start)[0])
    assert is_seen_from(y, pairs(start)[1])
    assert_true(x, y, start)
