# SPDX-License-Identifier: GPL-3.0-or-later
"""Joints that are bent one by one."""

import numpy as np
from scipy.sparse import csr_array

from engine import Skeleton, TriangleMesh
from engine.retarget.wear.joint_bends import joint_bends
from tests.shapes import cylinder

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
