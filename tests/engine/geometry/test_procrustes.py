# SPDX-License-Identifier: GPL-3.0-or-later
"""Tests of nearest rotations and similarities."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from engine.geometry import procrustes
from engine.geometry.procrustes import agreement_in_place, mirrored_across, nearest_rotations, nearest_similarity

SMALL = 1e-12


@pytest.fixture
def rng():
    return np.random.default_rng(5)


def agreement(rotations, matrices):
    return np.einsum("nij,nij->n", rotations, matrices)


def best_agreement(matrices):
    """The most that any rotation can reach: the sum of the singular values, the last with the determinant's sign."""
    values = np.linalg.svd(matrices, compute_uv=False)
    values[:, 2] *= np.sign(np.linalg.det(matrices))
    return values.sum(axis=1)


def assert_rotations(rotations):
    assert np.allclose(rotations @ rotations.transpose(0, 2, 1), np.eye(3), atol=SMALL)
    assert np.allclose(np.linalg.det(rotations), 1, atol=SMALL)


def test_rotations_of_any_angle_are_their_own_nearest():
    rotations = Rotation.random(9000, random_state=1).as_matrix()
    assert np.allclose(nearest_rotations(rotations), rotations, atol=SMALL)


def test_half_turns_and_no_turn_are_exact():
    turns = np.array([np.diag(signs) for signs in ((1, 1, 1), (1, -1, -1), (-1, 1, -1), (-1, -1, 1))], float)
    assert np.allclose(nearest_rotations(turns), turns, atol=SMALL)


def test_no_rotation_agrees_better_with_random_matrices_reflections_among_them(rng):
    matrices = rng.standard_normal((5000, 3, 3))
    rotations = nearest_rotations(matrices)
    assert_rotations(rotations)
    assert np.allclose(agreement(rotations, matrices), best_agreement(matrices), atol=SMALL)


def test_covariances_of_edges_in_a_plane_have_a_nearest_rotation(rng):
    flat = rng.standard_normal((300, 3, 3)) * [1, 1, 0]
    rotations = nearest_rotations(flat)
    assert_rotations(rotations)
    assert np.allclose(agreement(rotations, flat), np.linalg.svd(flat, compute_uv=False).sum(axis=1), atol=SMALL)


@pytest.mark.filterwarnings("error")
def test_covariances_of_edges_along_a_line_have_a_nearest_rotation(rng, monkeypatch):
    monkeypatch.setattr(procrustes, "_FEW", 0)
    for _ in range(2000):  # one after the other: the search ends when all are found
        matrix = -np.outer(*rng.standard_normal((2, 3)))[None]
        rotations = nearest_rotations(matrix)
        assert_rotations(rotations)
        assert np.allclose(agreement(rotations, matrix), best_agreement(matrix))


def test_few_get_the_rotations_that_they_get_among_many(rng):
    matrices = rng.standard_normal((1000, 3, 3))
    few = np.concatenate([nearest_rotations(matrices[i : i + 10]) for i in range(0, 1000, 10)])
    assert np.allclose(few, nearest_rotations(matrices), atol=1e-9)


def test_size_does_not_matter(rng):
    matrices = rng.standard_normal((200, 3, 3))
    for size in (1e-170, 1e-100, 1e-9, 1e9):
        assert np.allclose(nearest_rotations(size * matrices), nearest_rotations(matrices), atol=1e-9)


def test_turning_the_matrices_turns_the_rotations(rng):
    matrices = rng.standard_normal((200, 3, 3))
    turn = Rotation.random(random_state=2).as_matrix()
    assert np.allclose(nearest_rotations(turn @ matrices), turn @ nearest_rotations(matrices), atol=1e-9)


@pytest.mark.parametrize("matrix", [np.zeros((3, 3)), np.outer([1, 2, 3], [4, 5, 6]), -np.eye(3)])
@pytest.mark.parametrize("count", [1, 200])
def test_matrices_without_a_single_nearest_rotation_get_one_of_them(matrix, count):
    rotations = nearest_rotations(np.array([matrix] * count, float))
    assert_rotations(rotations)
    values = np.linalg.svd(matrix, compute_uv=False)
    assert agreement(rotations, [matrix] * count)[-1] == pytest.approx(values @ [1, 1, np.sign(np.linalg.det(matrix))])


def test_none_have_none():
    assert nearest_rotations(np.empty((0, 3, 3))).shape == (0, 3, 3)


@pytest.mark.parametrize("scale", [None, 1.7])
def test_a_similarity_is_found_again_and_never_mirrors(rng, scale):
    points, weights = rng.standard_normal((20, 3)), rng.random(20)
    linear, shift = 1.7 * Rotation.from_rotvec([1.0, -2.0, 0.5]).as_matrix(), np.array([3.0, -1.0, 2.0])
    found = nearest_similarity(points, points @ linear.T + shift, weights, scale)
    np.testing.assert_allclose(found[0], linear, atol=1e-12)
    np.testing.assert_allclose(found[1], shift, atol=1e-12)
    mirrored, _ = nearest_similarity(points, points * [1, 1, -1], weights, scale)
    assert np.linalg.det(mirrored) > 0


def test_weights_say_which_points_count(rng):
    points = rng.standard_normal((6, 3))
    astray = np.where(np.arange(6)[:, None] == 5, 100.0, points)
    linear, shift = nearest_similarity(points, astray, np.array([1.0, 1, 1, 1, 1, 0]))
    np.testing.assert_allclose(points @ linear.T + shift, points, atol=1e-12)


def test_points_at_one_place_are_moved_as_they_are():
    linear, shift = nearest_similarity(np.ones((3, 3)), np.full((3, 3), 2.0))
    assert np.linalg.det(linear) == pytest.approx(1)
    np.testing.assert_allclose(np.ones(3) @ linear.T + shift, 2)


@pytest.mark.parametrize("axis", range(3))
@pytest.mark.parametrize("angle", [30, 45, 90, 120, 135, 180, 270])
def test_what_is_flat_along_axes_of_space_is_turned_in_its_plane(rng, axis, angle):
    flat = rng.standard_normal((300, 3, 3))
    flat = flat @ flat.transpose(0, 2, 1)
    flat[:, axis] = flat[:, :, axis] = 0
    matrices = Rotation.from_rotvec(np.deg2rad(angle) * np.eye(3)[axis]).as_matrix() @ flat
    rotations = nearest_rotations(matrices)
    assert_rotations(rotations)
    np.testing.assert_allclose(agreement(rotations, matrices), best_agreement(matrices), rtol=1e-9)


@pytest.fixture
def cloud(rng):
    """Points that spread to another extent along every axis, and how much each counts."""
    return rng.standard_normal((200, 3)) * [1, 3, 0.5], rng.random(200)


def test_after_the_half_turn_that_fits_best_all_is_in_place(cloud, rng):
    points, weights = cloud
    axes = rng.standard_normal((500, 3))
    turns = Rotation.from_rotvec(np.pi * axes / np.linalg.norm(axes, axis=1)[:, None]).as_matrix()
    assert agreement_in_place(points, points @ turns[0].T + 3, weights, half_turn=True) == pytest.approx(1)
    assert agreement_in_place(points, points, weights, half_turn=True) == pytest.approx(-1 / 3)
    images = points @ Rotation.from_rotvec([0.3, 1, 2]).as_matrix().T
    best = agreement_in_place(points, images, weights, half_turn=True)
    turned = max(agreement_in_place(points @ turn.T, images, weights) for turn in turns)
    assert best - 0.05 < turned < best + SMALL


def test_the_plane_in_which_points_are_mirrored_is_found(cloud, rng):
    points, weights = cloud
    axis = Rotation.from_rotvec([1, 2, 3]).as_matrix()[0]
    mirrored = points - 2 * np.outer(points @ axis, axis) + 3
    noise = rng.normal(0, 0.05, points.shape)
    for images, most in ((mirrored, 1e-9), (5 * mirrored + noise, 0.05)):
        assert 1 - abs(mirrored_across(points, images, weights) @ axis) < most


def test_what_is_stretched_and_moved_is_in_place(cloud):
    points, weights = cloud
    assert agreement_in_place(points, points * 7 + [1, 2, 3], weights) == pytest.approx(1)
    axes = Rotation.from_rotvec([0.3, -1, 0.4]).as_matrix()
    points = points @ np.linalg.inv(np.linalg.cholesky(np.cov(points.T, aweights=weights))).T
    assert agreement_in_place(points, points @ (axes * [1, 4, 0.2]) @ axes.T, weights) == pytest.approx(1)


@pytest.mark.parametrize("axis", range(3))
def test_what_makes_half_a_turn_is_not(cloud, axis):
    points, weights = cloud
    middle = np.average(points, axis=0, weights=weights)
    _, axes = np.linalg.eigh(np.cov(points.T, aweights=weights))
    turn = Rotation.from_rotvec(np.pi * axes[:, axis]).as_matrix()
    assert agreement_in_place(points, (points - middle) @ turn, weights) == pytest.approx(-1 / 3)


def test_turning_both_alike_changes_nothing(cloud, rng):
    points, weights = cloud
    images = points + rng.standard_normal(points.shape)
    turn = Rotation.from_rotvec([1, 2, -0.5]).as_matrix()
    before = agreement_in_place(points, images, weights)
    assert agreement_in_place(points @ turn, images @ turn, weights) == pytest.approx(before)
    assert 0.2 < before < 0.95


def test_what_is_flat_or_at_one_place_has_an_agreement(cloud):
    points, weights = cloud
    flat = points * [1, 1, 0]
    assert agreement_in_place(flat, flat, weights) == pytest.approx(2 / 3)
    assert agreement_in_place(points, np.zeros_like(points), weights) == pytest.approx(0)
