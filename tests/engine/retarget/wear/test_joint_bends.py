# SPDX-License-Identifier: GPL-3.0-or-later
"""Joints that are bent one by one."""

import numpy as np
from scipy.sparse import csr_array

from engine import Skeleton, TriangleMesh
from engine.retarget.wear.joint_bends import Pose, joint_bends, poses_of, strides
from tests.shapes import cylinder, rotation

BONES = Skeleton(
    np.array([-1, 0, 1]),
    np.array([[0, 0, 0], [0, 0, 2.0], [0, 0, 3.99]]),
    np.array([[0, 0, 2.0], [0, 0, 3.99], [0, 0, 4.0]]),
)


def test_joints_bend_across_their_bones_both_ways_and_tips_do_not():
    body = TriangleMesh(*cylinder(24, 32, 0.5, 4.0))
    number = np.digitize(body.vertices[:, 2], [2, 4])
    weights = csr_array(np.eye(3)[number.clip(max=1)])
    lower, upper = joint_bends(body, weights, BONES, range(3))  # the last bone moves nothing
    assert lower.hanging.tolist() == [True, True, True]
    assert upper.hanging.tolist() == [False, True, True]
    np.testing.assert_array_equal(upper.on_skin, number > 0)
    tips = np.array([upper.bent(BONES.tails[1][None], np.ones(1), rotation)[0] for rotation in upper.rotations])
    np.testing.assert_allclose(np.linalg.norm(tips - upper.head, axis=1), 1.99)
    np.testing.assert_allclose(tips[:, 2] - 2, 1.99 * np.cos(np.radians(50)))
    np.testing.assert_allclose(tips.mean(axis=0)[:2], 0, atol=1e-12)


def test_what_is_partly_moved_goes_part_of_the_straight_way():
    body = TriangleMesh(*cylinder(24, 32, 0.5, 4.0))
    (bend,) = joint_bends(
        body, csr_array(np.ones((body.vertex_count, 1))), Skeleton([-1], [[0, 0, 0]], [[0, 0, 1]]), [0]
    )
    point, rotation = np.array([[0, 0, 1.0]]), bend.rotations[0]
    whole = bend.bent(point, np.ones(1), rotation)
    np.testing.assert_allclose(bend.bent(point, np.array([0.25]), rotation), point + 0.25 * (whole - point))


def test_limbs_that_hang_side_by_side_are_bent_against_each_other():
    vertices, triangles = cylinder(24, 32, 0.5, 4.0)
    body = TriangleMesh.concatenated([TriangleMesh(vertices + np.array([x, 0, 0]), triangles) for x in (-1, 1)])
    right = (body.vertices[:, 0] > 0).astype(float)
    weights = csr_array(np.stack([0 * right, 1 - right, right], axis=1))
    bones = Skeleton(
        np.array([-1, 0, 0]),
        np.array([[0, 0, 4.0], [-1, 0, 4], [1, 0, 4]]),
        np.array([[0, 0, 5.0], [-1, 0, 0], [1, 0, 0]]),
    )
    bends = list(joint_bends(body, weights, bones, range(3)))
    assert [bend.bone for bend in bends] == [0, 1, 2]
    assert len(poses_of(bends)) == 12
    poses = strides(bends, bones)
    assert len(poses) == 4  # of the two limbs alone
    for pose in poses:
        assert [bend.bone for bend in pose.bends] == [1, 2]
        middle, end = np.array([[0, 0, 2.0]]), np.array([[1, 0, 2.0]])
        none, half, whole = np.zeros(1), np.full(1, 0.5), np.ones(1)
        # What both move by halves only comes nearer to the joints, or goes down between them.
        stays, goes = pose.bent(middle, [half, half]) - middle, pose.bent(end, [none, whole]) - end
        assert np.abs(stays[0, 1]) < 1e-12
        assert np.abs(goes[0, :2]).max() > 1.5


def test_moves_come_back_from_a_pose():
    body = TriangleMesh(*cylinder(24, 32, 0.5, 4.0))
    bends = tuple(
        joint_bends(body, csr_array(np.ones((body.vertex_count, 1))), Skeleton([-1], [[0, 0, 0]], [[0, 0, 1]]), [0])
    )
    pose = Pose(bends, rotation([1, 2, 3], 0.7)[None])
    points, whole = np.array([[0.3, 0.2, 1.0], [1, 0, 0]]), [np.ones(2)]
    moves = np.array([[0.1, 0, 0], [0, 0.2, 0.1]])
    there = pose.bent(points, whole) + moves
    np.testing.assert_allclose(pose.bent(points + pose.brought_back(moves, whole), whole), there, atol=1e-12)
    direction = np.array([[0, 0, 1.0], [0, 1, 0]])
    np.testing.assert_allclose(pose.turned(direction, whole), direction @ pose.rotations[0].T, atol=1e-12)
