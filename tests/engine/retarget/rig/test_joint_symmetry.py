# SPDX-License-Identifier: GPL-3.0-or-later
from __future__ import annotations

import numpy as np

from engine import Skeleton, TriangleMesh
from engine.retarget.rig.joint_symmetry import mirrored_joints
from tests.people import person
from tests.shapes import rotation

PLACE = np.array([3.0, -2, 1])


def ball(points=40):
    """A mesh that is symmetric in x, and in nothing else."""
    u, v = np.meshgrid(np.linspace(0, 2 * np.pi, points, endpoint=False), np.linspace(0.05, np.pi - 0.05, points))
    places = np.stack([np.cos(u) * np.sin(v), 1.4 * np.sin(u) * np.sin(v), np.cos(v)], axis=-1)
    places[..., 1] += 0.4 * places[..., 2] ** 2 + 0.3 * places[..., 0] ** 2
    number = np.arange(points * points).reshape(points, points)
    a, b = number[:-1], np.roll(number, -1, axis=1)[:-1]
    c, d = np.roll(number, -1, axis=1)[1:], number[1:]
    triangles = np.concatenate([np.stack([a, d, b], -1).reshape(-1, 3), np.stack([b, d, c], -1).reshape(-1, 3)])
    return TriangleMesh(places.reshape(-1, 3), triangles)


def rig():
    heads = np.array([[0, 0, -0.5], [0.3, 0.1, 0.2], [-0.3, 0.1, 0.2]])
    tails = np.array([[0, 0, 0.3], [0.7, 0.2, 0.1], [-0.7, 0.2, 0.1]])
    return Skeleton(np.array([-1, 0, 0]), heads, tails)


def noisy(turn, seed=1):
    """The bones turned and placed elsewhere, not quite symmetric any more, with axes across them."""
    random, before = np.random.default_rng(seed), rig()
    heads, tails = (
        points @ turn.T + PLACE + 0.01 * random.standard_normal((3, 3)) for points in (before.heads, before.tails)
    )
    across = np.cross(tails - heads, turn[:, 1])
    return heads, tails, across / np.linalg.norm(across, axis=1, keepdims=True)


def test_symmetric_in_a_symmetric_body_wherever_it_stands():
    turn = rotation(np.array([1.0, 2, 3]), 1.1)
    body = ball()
    target = TriangleMesh(body.vertices @ turn.T + PLACE, body.triangles)
    space = np.eye(4)
    space[:3, :3], space[:3, 3] = 4 * turn, PLACE  # the size of a space does not matter
    heads, tails, across = mirrored_joints(rig(), target, noisy(turn), space)
    back = [(points - PLACE) @ turn for points in (heads, tails)]
    for points in back:
        np.testing.assert_allclose(points[2], points[1] * [-1, 1, 1], atol=1e-9)
        np.testing.assert_allclose(points[0, 0], 0, atol=1e-9)
    np.testing.assert_allclose((across @ turn)[2], -(across @ turn)[1] * [-1, 1, 1], atol=1e-9)
    np.testing.assert_allclose(((tails - heads) * across).sum(axis=1), 0, atol=1e-9)


def test_a_body_that_stands_askew_in_its_space_is_symmetric_too():
    turn = rotation(np.array([1.0, 2, 3]), 1.1)
    body = ball()
    target = TriangleMesh(body.vertices @ turn.T + PLACE, body.triangles)
    heads, _, _ = mirrored_joints(rig(), target, noisy(turn))
    between = heads[1] - heads[2]
    middle = (heads[1] + heads[2]) / 2
    assert abs((heads[0] - middle) @ between) / np.linalg.norm(between) < 1e-9


def test_a_body_that_is_not_symmetric_keeps_its_joints():
    body = ball()
    vertices = body.vertices.copy()
    vertices[:, 2] += 0.5 * vertices[:, 0]
    placed = noisy(np.eye(3))
    target = TriangleMesh(vertices + PLACE, body.triangles)
    for before, after in zip(placed, mirrored_joints(rig(), target, placed), strict=True):
        np.testing.assert_array_equal(before, after)


def test_a_rig_that_is_not_symmetric_is_left_alone():
    tree = rig()
    heads = tree.heads.copy()
    heads[1] += [0, 0.2, 0]
    placed = noisy(np.eye(3))
    body = ball()
    target = TriangleMesh(body.vertices + PLACE, body.triangles)
    found = mirrored_joints(Skeleton(tree.parents, heads, tree.tails), target, placed)
    for before, after in zip(placed, found, strict=True):
        np.testing.assert_array_equal(before, after)


def test_people_are_symmetric():
    someone = person(resolution=20, fingers=False)
    tree, names = someone.rig.skeleton, someone.rig.names
    random = np.random.default_rng(3)
    heads, tails = (points + 0.004 * random.standard_normal(points.shape) for points in (tree.heads, tree.tails))
    across = np.tile([0.0, 1, 0], (len(tree), 1))
    heads, _, _ = mirrored_joints(tree, someone.mesh, (heads, tails, across))
    left, right = names.index("forearm.L"), names.index("forearm.R")
    np.testing.assert_allclose(heads[left] * [-1, 1, 1], heads[right], atol=1e-9)
    assert abs(heads[names.index("hips"), 0]) < 1e-9
