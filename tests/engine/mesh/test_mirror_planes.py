# SPDX-License-Identifier: GPL-3.0-or-later
"""Planes of symmetry of points, which are known."""

import numpy as np
import pytest

from engine.mesh.mirror_planes import MirrorPlane, mirror_planes
from tests.shapes import rotation

TURN, PLACE = rotation([1.0, -2.0, 0.5], 0.8), np.array([4.0, -2.0, 7.0])


def halves(seed, count=400):
    """Points of any form and their mirror images in the plane x = 0."""
    points = np.random.default_rng(seed).uniform([0.0, -2.0, -1.0], [3.0, 2.0, 4.0], (count, 3))
    return np.concatenate([points, points * [-1, 1, 1]])


@pytest.mark.parametrize("size", [1e-3, 1.0, 1e4])
@pytest.mark.parametrize("seed", [0, 1, 2])
def test_the_plane_of_mirrored_halves_is_found_wherever_they_lie(seed, size):
    (plane,) = mirror_planes(size * halves(seed) + size * PLACE)
    assert abs(plane.axis[0]) == pytest.approx(1)
    assert plane.middle[0] == pytest.approx(size * PLACE[0])


def test_reflection_takes_one_half_to_the_other():
    points = halves(3) @ TURN.T + PLACE
    plane = MirrorPlane(PLACE, TURN[:, 0])
    np.testing.assert_allclose(plane.reflected(points), np.roll(points, 400, axis=0), atol=1e-12)
    np.testing.assert_allclose(plane.reflected(plane.reflected(points)), points, atol=1e-12)


@pytest.mark.parametrize("seed", [0, 1, 2])
def test_the_plane_is_found_though_some_points_have_no_mirror_image(seed):
    (plane,) = mirror_planes(halves(seed)[50:] + PLACE)
    assert abs(plane.axis[0]) == pytest.approx(1, abs=1e-4)
    assert plane.middle[0] == pytest.approx(PLACE[0], abs=0.01)


def test_the_plane_of_a_body_that_stands_anyhow_is_found_by_its_own_axes():
    points = halves(5) * [3.0, 1.0, 0.4]
    (plane,) = mirror_planes(points @ TURN.T + PLACE)
    assert abs(plane.axis @ TURN[:, 0]) == pytest.approx(1, abs=1e-6)


def test_a_flat_body_is_not_its_own_mirror_image_in_the_plane_in_which_it_lies():
    points = halves(0) * [1.0, 0.01, 1.0]
    points[:, 1] += 0.02 * points[:, 2] ** 2  # bent, so that front and back differ
    (plane,) = mirror_planes(points)
    assert abs(plane.axis[0]) == pytest.approx(1, abs=1e-6)


def test_what_is_symmetric_in_two_planes_has_both_and_what_is_in_none_has_none():
    points = halves(0)
    both = np.concatenate([points, points * [1, 1, -1] + [0.0, 0.0, 9.0]])
    axes = np.abs([plane.axis for plane in mirror_planes(both)])
    np.testing.assert_allclose(axes[axes[:, 0].argsort()], [[0, 0, 1], [1, 0, 0]], atol=1e-6)
    assert not mirror_planes(points[:400])
