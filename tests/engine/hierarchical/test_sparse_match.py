# SPDX-License-Identifier: GPL-3.0-or-later
"""The ways to match a pair, on the part of the target that is used."""

from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest

from engine import MatchSettings, Shape, SurfacePoints, TriangleMesh
from engine.hierarchical.compared.flat import flat_candidates
from engine.hierarchical.hierarchy import Refined
from engine.hierarchical.sampled_pair import Pair
from engine.hierarchical.sparse_match import at_samples, moved, solve_steps
from engine.runtime.progress import run
from tests.problems import brute_force
from tests.shapes import creature

SETTINGS = MatchSettings(
    points=16, samples=60, coarse_points=6, coarse_candidates=12, hypotheses=3, dense=False, settle=False
)


def solved(pair):
    laps = []
    return run(solve_steps(pair, laps.append)), laps


def numbers_of(answer):
    """Which samples of the target the images are."""
    samples = answer.coarse.pair.target.samples.vertices
    return np.array([np.flatnonzero(samples == vertex)[0] for vertex in answer.points.nearest_vertices])


@pytest.fixture(scope="module")
def shapes():
    found = [Shape(TriangleMesh(*creature(pose, 8)[:2])) for pose in (0.0, 0.6)]
    for shape in found:
        run(shape.sample_steps(SETTINGS.samples))
    return found


@pytest.fixture(scope="module")
def answers(shapes):
    return solved(Pair(*shapes, SETTINGS))[0]


def test_a_shape_is_matched_to_itself(shapes):
    (answer, *_), laps = solved(Pair(shapes[0], shapes[0], SETTINGS))
    np.testing.assert_array_equal(numbers_of(answer), np.arange(16))
    assert answer.distortion == pytest.approx(0, abs=1e-6)
    assert answer.orientation == pytest.approx(1)
    assert laps == ["coarse", "hierarchy"]


def test_there_is_an_answer_of_either_orientation(answers):
    assert [np.sign(answer.orientation) for answer in answers] == [1, -1]


def test_the_distortion_is_that_of_the_samples_that_are_the_images(answers):
    for answer in answers:
        numbers = numbers_of(answer)
        assert len(np.unique(numbers)) == 16
        problem = answer.coarse.pair.problem(16)
        assert answer.distortion == pytest.approx(problem.cost(numbers))
        assert answer.linear == pytest.approx(problem.linear_cost(numbers))
        assert answer.quadratic == pytest.approx(problem.quadratic_cost(numbers))
        assert answer.levels[-1].distortion == pytest.approx(answer.distortion)


def test_levels_grow_to_all_points(answers):
    for answer in answers:
        points = [level.points for level in answer.levels]
        assert points[-1] == 16
        assert all(after <= 2 * before for before, after in pairwise(points))
        assert [len(level.target_points) for level in answer.levels] == points
        np.testing.assert_array_equal(answer.levels[-1].target_points.positions, answer.points.positions)


def test_settling_lowers_the_distortion(shapes, answers):
    settled, laps = solved(Pair(*shapes, replace(SETTINGS, settle=True)))
    assert laps[-1] == "settling"
    assert settled[0].distortion < answers[0].distortion
    for before, after in zip(answers, settled, strict=True):
        assert after.distortion <= before.distortion
        assert after.levels[-1].distortion == pytest.approx(after.distortion)
    # And lets points leave the samples.
    assert (settled[0].points.barycentric.max(axis=1) < 0.999).any()


def test_gmds_that_turns_a_matching_over_is_told_by_its_orientation():
    bodies = [Shape(TriangleMesh(*creature(pose, 8)[:2])) for pose in (1.2, 0.0)]
    for shape in bodies:
        run(shape.sample_steps(SETTINGS.samples))
    pair = Pair(*bodies, replace(SETTINGS, solver="gmds", coarse_points=3))
    found, _ = solved(pair)
    for answer in found:
        nearest = pair.target.samples.rows[:, answer.points.nearest_vertices].argmin(axis=0)
        assert np.sign(answer.orientation) == np.sign(pair.orientation(nearest))
    assert [np.sign(answer.orientation) for answer in found] in ([1], [-1], [1, -1])


@pytest.mark.parametrize("solver", ["hierarchical", "gmds"])
def test_landmarks_stay_with_their_partners(shapes, solver):
    vertices = [shape.samples.vertices[[20, 30]] for shape in shapes]
    known = [shape.starting_with(own) for shape, own in zip(shapes, vertices, strict=True)]
    for shape in known:
        run(shape.sample_steps(SETTINGS.samples))
    found, _ = solved(Pair(*known, replace(SETTINGS, solver=solver, settle=True, points=10), landmarks=2))
    for answer in found:
        np.testing.assert_allclose(answer.points.positions[:2], shapes[1].mesh.vertices[vertices[1]], atol=1e-12)


@pytest.mark.parametrize("points", [3, 5])
def test_all_at_once_some_points_are_matched_as_well_as_can_be(shapes, points):
    pair = Pair(*shapes, replace(SETTINGS, solver="flat", points=points))
    found, laps = solved(pair)
    best = brute_force(pair.problem(points, flat_candidates(points, len(pair.target.samples))))
    assert min(answer.distortion for answer in found) == pytest.approx(best)
    assert laps == ["flat"]


def test_an_answer_takes_over_another_matching(answers):
    numbers = np.random.default_rng(0).permutation(60)[:16]
    other = at_samples(answers[0], [Refined(numbers, 3)])
    np.testing.assert_array_equal(numbers_of(other), numbers)
    assert other.distortion == pytest.approx(answers[0].coarse.pair.problem(16).cost(numbers))
    assert [(level.points, level.iterations) for level in other.levels] == [(16, 3)]
    assert other.coarse is answers[0].coarse


def test_moved_points_have_the_distances_between_where_they_are(answers):
    answer, pair = answers[0], answers[0].coarse.pair
    numbers = np.roll(numbers_of(answer), 1)
    places = SurfacePoints.at_vertices(pair.target.mesh, pair.target.samples.vertices[numbers])
    run(pair.target_metric.prepare_nearest_steps(places))
    other = moved(answer, places)
    np.testing.assert_allclose(other.distances, pair.target_distances[np.ix_(numbers, numbers)], atol=0.03)
    assert other.linear == pytest.approx(pair.problem(16).linear_cost(numbers))
    assert other.levels[-1].distortion == other.distortion > answer.distortion
    assert other.levels[:-1] == answer.levels[:-1]
