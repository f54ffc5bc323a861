# SPDX-License-Identifier: GPL-3.0-or-later
"""Where the bones of a fitted rig lie."""

import numpy as np

from engine import FittedRig, Skeleton, SurfaceMap, TriangleMesh
from tests.shapes import icosphere, rotation
from tests.skeletons import creature_bones, creature_weights

NAMES, PARENTS, HEADS, TAILS = creature_bones()


def fitted(linear, translations):
    body = TriangleMesh(*icosphere(2))
    weights, same = creature_weights(body.vertices), SurfaceMap.identity(body)
    scales = np.cbrt(np.abs(np.linalg.det(linear)))
    skeleton = Skeleton(PARENTS, HEADS, TAILS)
    return FittedRig(skeleton, weights, linear, translations, linear, scales, body.vertices, body.vertices, same, same)


def test_bones_that_do_not_move_stay():
    rig = fitted(np.tile(np.eye(3), (len(NAMES), 1, 1)), np.zeros((len(NAMES), 3)))
    np.testing.assert_array_equal(rig.heads, HEADS)
    np.testing.assert_array_equal(rig.tails, TAILS)


def test_each_bone_goes_where_its_own_transform_takes_it():
    rng = np.random.default_rng(0)
    linear, translations = rng.normal(size=(len(NAMES), 3, 3)), rng.normal(size=(len(NAMES), 3))
    rig = fitted(linear, translations)
    for bone in range(len(NAMES)):
        np.testing.assert_allclose(rig.heads[bone], linear[bone] @ HEADS[bone] + translations[bone], atol=1e-12)
        np.testing.assert_allclose(rig.tails[bone], linear[bone] @ TAILS[bone] + translations[bone], atol=1e-12)


def test_moved_as_one_body_bones_keep_their_lengths_and_connections():
    turn, shift = rotation([1, 2, 3], 0.8), np.array([3.0, -1, 2])
    rig = fitted(np.tile(2.5 * turn, (len(NAMES), 1, 1)), np.tile(shift, (len(NAMES), 1)))
    lengths = np.linalg.norm(rig.tails - rig.heads, axis=1)
    np.testing.assert_allclose(lengths, 2.5 * np.linalg.norm(TAILS - HEADS, axis=1))
    neck, head = NAMES.index("neck"), NAMES.index("head")
    np.testing.assert_allclose(rig.heads[head], rig.tails[neck], atol=1e-12)
