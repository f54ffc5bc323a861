# SPDX-License-Identifier: GPL-3.0-or-later
"""The ends of limbs: on a symmetric body in several poses and of several proportions."""

import numpy as np
import pytest
from scipy.spatial import cKDTree

from engine import Shape, TriangleMesh, run
from engine.shapes.extremities import limb_tips, mean_distances, prominent_ends, spread_extremities
from tests.bodies import mirrored_body, relative_of_creature
from tests.people import figure_surface
from tests.shapes import icosphere

ENDS = np.array([(side, sign, -2) for side in (1, -1) for sign in (1, -1)])  # directions in which the feet lie


def shape(vertices, triangles, samples=150):
    made = Shape(TriangleMesh(vertices, triangles))
    run(made.sample_steps(samples))
    return made


@pytest.fixture(scope="module", params=[(0.0, None), (0.9, 1)])
def body(request):
    """A body in a pose and triangulation: shape, and places at rest."""
    pose, seed = request.param
    vertices, triangles, rest = mirrored_body(pose, 9, seed=seed)
    return shape(vertices, triangles), rest


def ends(rest):
    """Places of the four feet and of the end of the tail, (5, 3)."""
    return np.concatenate([rest[(rest @ ENDS.T).argmax(axis=0)], rest[[rest[:, 0].argmin()]]])


# --- tips


def test_the_ends_of_legs_and_tail_are_tips(body):
    made, rest = body
    tips = rest[made.samples.vertices[limb_tips(made)]]
    assert cKDTree(tips).query(ends(rest))[0].max() < 0.1 * np.sqrt(made.mesh.area)


def test_tips_are_few_and_the_farthest_come_first(body):
    made, _ = body
    tips = limb_tips(made)
    assert 5 <= len(tips) <= 12
    assert (np.diff(mean_distances(made)[tips]) <= 0).all()


def test_tips_do_not_depend_on_units_or_place(body):
    made, _ = body
    moved = shape(1000 * made.mesh.vertices + [5.0, -3.0, 7.0], made.mesh.triangles)
    assert (moved.samples.vertices[limb_tips(moved)] == made.samples.vertices[limb_tips(made)]).all()


# --- extremities


@pytest.mark.parametrize("apart", [0.25, 0.4])
def test_each_leg_and_the_tail_have_an_extremity_of_their_own(body, apart):
    made, rest = body
    chosen = spread_extremities(made, 8, apart)
    distance, nearest = cKDTree(rest[made.samples.vertices[chosen]]).query(ends(rest))
    assert distance.max() < 0.1 * np.sqrt(made.mesh.area)
    assert len(set(nearest)) == 5


@pytest.mark.parametrize(("legs", "tail"), [(0.6, 1.0), (1.0, 0.5), (1.5, 1.3)])
def test_limbs_of_other_lengths_have_the_same_extremities(legs, tail):
    vertices, triangles = relative_of_creature(legs, tail)
    made = shape(vertices, triangles)
    chosen = vertices[made.samples.vertices[spread_extremities(made, 7, 0.25)]]
    assert cKDTree(chosen).query(ends(vertices))[0].max() < 0.15 * np.sqrt(made.mesh.area)


def test_without_filling_up_only_tips_are_chosen(body):
    made, _ = body
    tips = spread_extremities(made, 99, 0.4, filled=False)
    assert set(tips) <= set(limb_tips(made))
    np.testing.assert_array_equal(tips, spread_extremities(made, len(tips), 0.4))
    assert len(spread_extremities(made, 99, 0.4)) > len(tips)


def test_extremities_are_different_places_and_as_many_as_there_is_room_for():
    ball = shape(*icosphere(6))
    chosen = spread_extremities(ball, 6, 0.4)
    assert len(chosen) == len(set(chosen)) == 6
    between = ball.samples.distances[np.ix_(chosen, chosen)] + np.eye(6)
    assert between.min() > 0.3
    assert len(spread_extremities(ball, 100, 0.4)) < 20
    assert (spread_extremities(ball, 3, 0.4) == chosen[:3]).all()


# --- ends by prominence


def test_prominent_ends_are_hands_feet_and_head_and_nothing_else():
    mesh, bones = figure_surface()
    made = shape(mesh.vertices, mesh.triangles, 300)
    found = bones[made.samples.vertices[prominent_ends(made)]]
    assert sorted(found) == ["hand.L", "hand.R", "head", "toe.L", "toe.R"]


def test_the_ends_of_a_long_ellipsoid_are_its_two_poles():
    vertices, triangles = icosphere(8)
    made = shape(vertices * [1.0, 1.0, 3.0], triangles)
    places = made.mesh.vertices[made.samples.vertices[prominent_ends(made)]]
    assert sorted(np.sign(places[:, 2])) == [-1, 1]
    assert np.abs(places[:, 2]).min() > 2.9
