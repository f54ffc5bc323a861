# SPDX-License-Identifier: GPL-3.0-or-later
"""The terms of the distortion between the samples of two shapes."""

from dataclasses import replace
from itertools import permutations

import numpy as np
import pytest

from engine import MatchSettings, Shape, SurfacePoints, TriangleMesh
from engine.hierarchical.sampled_pair import Pair
from engine.runtime.progress import run
from tests.shapes import creature

SAMPLES = 40
PLAIN = MatchSettings()
DESCRIPTORS = {
    "histograms": {},
    "bins": {"comparison": "bin_to_bin"},
    "heat": {"descriptor": "heat_kernel"},
    "waves": {"descriptor": "wave_kernel"},
    "diffusion": {"metric": "diffusion"},
}


@pytest.fixture(scope="module")
def shapes():
    found = [Shape(TriangleMesh(*creature(pose, 8)[:2])) for pose in (0.0, 0.6)]
    for shape in found:
        run(shape.sample_steps(SAMPLES))
        run(shape.spectrum_steps(40))
    return found


@pytest.mark.parametrize("name", DESCRIPTORS)
def test_a_shape_is_at_no_distance_from_itself(name, shapes):
    pair = Pair(shapes[0], shapes[0], replace(PLAIN, **DESCRIPTORS[name]))
    assert pair.problem(SAMPLES).cost(np.arange(SAMPLES)) == pytest.approx(0, abs=1e-9)
    assert np.abs(np.diag(pair.linear)).max() < 1e-9
    assert pair.linear[~np.eye(SAMPLES, dtype=bool)].min() >= 0
    assert pair.linear.mean() > 0.01


@pytest.mark.parametrize("name", ["bins", "heat", "waves"])
def test_descriptors_without_a_unit_are_of_one_size(name, shapes):
    assert Pair(*shapes, replace(PLAIN, **DESCRIPTORS[name], linear_weight=1.0)).linear.mean() == pytest.approx(0.1)


@pytest.mark.parametrize("name", DESCRIPTORS)
def test_exchanging_the_shapes_transposes(name, shapes):
    settings = replace(PLAIN, **DESCRIPTORS[name])
    one, other = Pair(*shapes, settings), Pair(*shapes[::-1], settings)
    np.testing.assert_allclose(one.linear, other.linear.T, atol=1e-6)
    np.testing.assert_allclose(one.source_distances, other.target_distances, rtol=1e-6)


def test_the_weight_of_the_descriptors_is_a_factor(shapes):
    once, thrice = (Pair(*shapes, replace(PLAIN, linear_weight=weight)) for weight in (1.0, 3.0))
    np.testing.assert_allclose(thrice.linear, 3 * once.linear)


def test_shapes_with_other_numbers_of_eigenpairs_are_compared_at_the_same_energies(shapes):
    other = Shape(shapes[0].original)
    run(other.sample_steps(SAMPLES))
    run(other.spectrum_steps(70))
    pair = Pair(shapes[0], other, replace(PLAIN, descriptor="wave_kernel"))
    assert (pair.linear.argmin(axis=1) == np.arange(SAMPLES)).mean() > 0.9


def test_after_a_long_time_diffusion_distances_are_still_those_of_the_shape(shapes):
    pair = Pair(shapes[0], shapes[0], replace(PLAIN, metric="diffusion", diffusion_time=10.0))
    spectrum, vertices = shapes[0].spectrum, shapes[0].samples.vertices
    slowest = spectrum.functions[vertices, spectrum.zero_count]
    exact = np.abs(slowest[:, None] - slowest)
    assert np.corrcoef(pair.source_distances.ravel(), exact.ravel())[0, 1] > 0.99
    points = SurfacePoints.at_vertices(shapes[0].mesh, vertices)
    measured = np.sqrt(pair.target_metric.squares_between(points))
    np.testing.assert_allclose(measured, pair.target_distances, atol=1e-9)


def test_diffusion_distances_have_a_root_mean_square_of_one(shapes):
    pair = Pair(*shapes, replace(PLAIN, metric="diffusion"))
    squares = [np.square(distances).mean() for distances in (pair.source_distances, pair.target_distances)]
    assert np.mean(squares) == pytest.approx(1)


def test_geodesic_distances_are_those_of_the_shapes(shapes):
    pair = Pair(*shapes, PLAIN)
    np.testing.assert_array_equal(pair.source_distances, shapes[0].samples.distances)
    np.testing.assert_array_equal(pair.target_distances, shapes[1].samples.distances)


@pytest.mark.parametrize(
    ("changes", "needed"),
    [({}, False), ({"metric": "diffusion"}, True), ({"descriptor": "heat_kernel"}, True)],
)
def test_spectra_are_needed_for_what_is_made_of_them(changes, needed):
    assert Pair.needs_spectrum(replace(PLAIN, **changes)) is needed


def test_a_problem_is_of_the_first_samples(shapes):
    pair = Pair(*shapes, replace(PLAIN, quadratic_weight=2.0))
    problem = pair.problem(5, 9)
    assert problem.size == (5, 9)
    chosen, matched = np.arange(5), np.array([8, 2, 5, 0, 7])
    apart = pair.source_distances[np.ix_(chosen, chosen)] - pair.target_distances[np.ix_(matched, matched)]
    truth = pair.linear[chosen, matched].sum() + 2 * np.square(apart).sum()
    assert problem.cost(matched) == pytest.approx(truth)
    more = np.random.default_rng(0).random((5, SAMPLES))
    assert pair.problem(5, extra=more).cost(matched) == pytest.approx(truth + more[chosen, matched].sum())


def test_candidates_that_contradict_landmarks_are_forbidden(shapes):
    pair = Pair(*shapes, PLAIN, landmarks=2)
    linear = pair.problem(4, 6).linear
    for x in range(4):
        for y in range(6):
            assert np.isfinite(linear[x, y]) == (x == y if min(x, y) < 2 else True)
    with_landmarks, without = linear[2:, 2:], Pair(*shapes, PLAIN).problem(4, 6).linear[2:, 2:]
    np.testing.assert_array_equal(with_landmarks, without)


def test_among_all_candidates_no_contradiction_pays(shapes):
    pair = Pair(shapes[0].limited(4), shapes[1].limited(5), PLAIN, landmarks=2)
    problem = pair.problem(4)
    assert np.isfinite(problem.linear).all()
    every = [np.array(matching) for matching in permutations(range(5), 4)]
    keeping = [problem.cost(matching) for matching in every if (matching[:2] == [0, 1]).all()]
    breaking = [problem.cost(matching) for matching in every if (matching[:2] != [0, 1]).any()]
    assert len(keeping) == 6
    assert max(keeping) < min(breaking)


def test_a_mirrored_shape_is_turned_over(shapes):
    shape, numbers = shapes[0], np.arange(20)
    assert Pair(shape, shape, PLAIN).orientation(numbers) == pytest.approx(1)
    assert Pair(shape, shape.reflected(), PLAIN).orientation(numbers) == pytest.approx(-1, abs=1e-6)


def test_the_orientation_term_is_nothing_where_directions_turn_the_same_way(shapes):
    shape, coarse = shapes[0], np.arange(8)
    for other, right in ((shape, 1), (shape.reflected(), -1)):
        pair = Pair(shape, other, PLAIN)
        kept, mirrored = (pair.orientation_term(coarse, sign) for sign in (right, -right))
        assert kept.shape == (SAMPLES, SAMPLES)
        assert np.diag(kept).max() < 1e-9
        assert np.diag(mirrored).min() > 0.01
        assert (kept >= 0).all()


def test_the_orientation_counts_as_much_beside_small_weights(shapes):
    coarse = np.arange(8)
    small = Pair(*shapes, replace(PLAIN, linear_weight=0.01, quadratic_weight=0.02))
    np.testing.assert_allclose(
        small.orientation_term(coarse, 1), 0.02 * Pair(*shapes, PLAIN).orientation_term(coarse, 1)
    )


def test_a_descriptor_that_is_not_compared_yet_does_not_pass_for_histograms(shapes):
    settings = replace(PLAIN)
    object.__setattr__(settings, "descriptor", "torsion")
    with pytest.raises(NotImplementedError, match="torsion"):
        Pair(*shapes, settings)


def test_only_eigenfunctions_have_signs_to_choose(shapes):
    pair = Pair(*shapes, PLAIN)
    assert run(pair.variants_steps(5)) == [pair]


def test_of_the_signs_of_eigenfunctions_those_that_make_a_shape_itself_come_first(shapes):
    pair = Pair(shapes[0], shapes[0], replace(PLAIN, descriptor="eigenfunctions"))
    variants = run(pair.variants_steps(4))
    assert 1 < len(variants) <= 4
    differences = [np.diag(variant.linear).mean() for variant in variants]
    assert differences[0] == pytest.approx(0, abs=1e-6)
    assert min(differences[1:]) > 1e-3
    for variant in variants:
        assert variant.linear.mean() == pytest.approx(0.1 * PLAIN.linear_weight)
        assert variant.source_distances is pair.source_distances
