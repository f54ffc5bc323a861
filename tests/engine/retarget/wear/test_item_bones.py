# SPDX-License-Identifier: GPL-3.0-or-later
"""Bones that clothes have for themselves."""

import numpy as np
import pytest

from engine import RigError, SurfaceMap, TriangleMesh, run
from engine.retarget.wear.item_bones import bones_of_items, moved_with_items
from engine.retarget.wear.wearing import wear_steps
from engine.retarget.wear.worn_item import WornItem
from tests.engine.retarget.wear.test_wearing import BODY, SHIRT, TURN


def test_bones_that_move_no_body_belong_to_the_items():
    # A root, a spine with an arm, a skirt of two bones of which the lower alone has weights, and a bone of nobody.
    parents = np.array([3, -1, 1, 1, 1, 2])
    names = ["skirt end", "root", "spine", "skirt", "nobody", "arm"]
    body = np.array([name in ("spine", "arm") for name in names])
    items = np.array([name in ("spine", "skirt end") for name in names])
    assert [names[bone] for bone in bones_of_items(parents, body, items)] == ["skirt", "skirt end"]
    assert bones_of_items(parents, body, body) == []


def test_joints_go_along_with_a_similar_body():
    def moved(points):
        return 2.5 * points @ TURN.T + np.array([3.0, -1.0, 2.0])

    target = TriangleMesh(moved(BODY.vertices), BODY.triangles)
    steps = wear_steps(BODY, target, SurfaceMap.identity(target), target.vertices, [WornItem(SHIRT)])
    (fitted,) = run(steps)
    joints = np.array([[0.0, -1.1, 0.2], [0.3, 1.2, -0.4], [0.3, 1.2, -0.4]])
    positions, rotations = moved_with_items(joints, [(SHIRT.vertices, fitted)])
    np.testing.assert_allclose(positions, moved(joints), atol=1e-3)
    np.testing.assert_allclose(rotations, np.broadcast_to(TURN, rotations.shape), atol=1e-3)
    np.testing.assert_array_equal(positions[1], positions[2])


def test_without_items_joints_cannot_go_along():
    with pytest.raises(RigError, match="items"):
        moved_with_items(np.zeros((1, 3)), [])
