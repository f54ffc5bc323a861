# SPDX-License-Identifier: GPL-3.0-or-later
"""Planes of symmetry of surfaces, which are known, whatever their vertices."""

from functools import cache

import numpy as np
import pytest

from engine.mesh.mirror_planes import MirrorPlane, mirror_planes
from engine.mesh.triangle_mesh import TriangleMesh
from tests.shapes import capsule_surface, icosphere, irregular, rotation

TURN, PLACE = rotation([1.0, -2.0, 0.5], 0.8), np.array([4.0, -2.0, 7.0])
TRUNK = ((0.0, 0.0, -0.7), (0.0, 0.0, 0.5), 0.35, 0.3)
HEAD = ((0.0, 0.05, 0.9), (0.0, 0.3, 0.9), 0.2, 0.15)
ARM = ((0.3, 0.0, 0.45), (1.1, -0.1, 0.4), 0.13, 0.09)
LEG = ((0.2, 0.0, -0.7), (0.3, 0.1, -1.4), 0.16, 0.12)


def mirrored(capsule):
    """The same on the other side of the plane x = 0."""
    start, end, *radii = capsule
    return (-start[0], *start[1:]), (-end[0], *end[1:]), *radii


@cache
def body(*more, turn=0.0):
    """A body that is its own mirror image in the plane x = 0 but for what more it has; its vertices only unturned."""
    capsules = (TRUNK, HEAD, ARM, LEG, mirrored(ARM), mirrored(LEG), *more)
    return capsule_surface(capsules, [[-1.4, -0.6, -1.8], [1.4, 0.8, 1.4]], 14, turn)


def placed(vertices, triangles, turn=None, place=(0.0, 0.0, 0.0), size=1.0):
    return TriangleMesh(size * (vertices @ (np.eye(3) if turn is None else turn).T + place), triangles)


@pytest.mark.parametrize("turn", [0.0, 0.4, 1.1])
@pytest.mark.parametrize("size", [1e-3, 1.0, 1e4])
def test_the_plane_of_a_symmetric_body_is_found_whatever_its_vertices(turn, size):
    plane = mirror_planes(placed(*body(turn=turn), place=PLACE, size=size))[0]
    assert abs(plane.axis[0]) > np.cos(0.002)
    assert plane.middle[0] == pytest.approx(size * PLACE[0], abs=0.002 * size)


def test_the_plane_of_mirrored_vertices_is_found_to_the_last_digit():
    vertices, triangles = icosphere(10)
    vertices = vertices * [1.0, 1.5, 2.2]
    vertices[:, 1] += 0.2 * vertices[:, 2] ** 2 - 0.1 * vertices[:, 2] ** 3
    (plane,) = mirror_planes(TriangleMesh(vertices + PLACE, triangles))
    assert abs(plane.axis[0]) == pytest.approx(1, abs=1e-9)
    assert plane.middle[0] == pytest.approx(PLACE[0], abs=1e-6)


def test_reflection_takes_one_half_to_the_other():
    half = np.random.default_rng(3).uniform([0.0, -2.0, -1.0], [3.0, 2.0, 4.0], (400, 3))
    points = np.concatenate([half, half * [-1, 1, 1]]) @ TURN.T + PLACE
    plane = MirrorPlane(PLACE, TURN[:, 0])
    np.testing.assert_allclose(plane.reflected(points), np.roll(points, 400, axis=0), atol=1e-12)
    np.testing.assert_allclose(plane.reflected(plane.reflected(points)), points, atol=1e-12)


def test_what_a_body_has_on_one_side_alone_does_not_move_the_plane():
    bag = ((0.5, -0.2, -0.5), (0.55, -0.2, -0.8), 0.2, 0.2)
    plane = mirror_planes(placed(*body(bag, turn=0.4), place=PLACE))[0]
    assert abs(plane.axis[0]) > np.cos(0.003)
    assert plane.middle[0] == pytest.approx(PLACE[0], abs=0.003)


def test_the_plane_of_a_body_that_stands_anyhow_is_found_by_its_own_axes():
    plane = mirror_planes(placed(*body(turn=0.4), turn=TURN, place=PLACE))[0]
    assert abs(plane.axis @ TURN[:, 0]) > np.cos(0.002)


def test_a_flat_body_is_not_its_own_mirror_image_in_the_plane_in_which_it_lies():
    vertices, triangles = body(turn=0.4)
    flat = vertices * [1.0, 0.02, 1.0]
    flat[:, 1] += 0.05 * vertices[:, 2] ** 2  # bent, so that front and back differ
    plane = mirror_planes(TriangleMesh(flat, triangles))[0]
    assert abs(plane.axis[0]) > np.cos(0.002)


def test_what_is_symmetric_in_three_planes_has_them_all_and_a_ball_whichever_are_tried():
    vertices, triangles = irregular(*icosphere(10))
    planes = mirror_planes(TriangleMesh(vertices * [1.0, 1.5, 2.2], triangles))
    axes = np.abs([plane.axis for plane in planes])
    np.testing.assert_allclose(axes[axes.argmax(axis=1).argsort()], np.eye(3), atol=0.01)
    assert len(mirror_planes(TriangleMesh(vertices, triangles))) >= 3


def test_what_is_not_symmetric_has_no_plane():
    capsules = (TRUNK, HEAD, ARM, ((-0.3, 0.0, 0.3), (-0.5, 0.7, 0.8), 0.2, 0.15), LEG)
    assert not mirror_planes(TriangleMesh(*capsule_surface(capsules, [[-1.4, -0.6, -1.8], [1.4, 1.2, 1.4]], 14)))
