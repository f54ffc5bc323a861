# SPDX-License-Identifier: GPL-3.0-or-later
"""Weights of clothes that are tried in poses."""

import numpy as np
import pytest
from scipy.sparse import csr_array

from engine import Skeleton, TriangleMesh, run
from engine.retarget.wear.pose_mending import WeightedItem, mend_weights_steps
from tests.shapes import cylinder

BONES = Skeleton(np.array([-1, 0]), np.array([[0, 0, 0], [0, 0, 2.0]]), np.array([[0, 0, 2.0], [0, 0, 4.0]]))


def smooth_weights(vertices, sharpness):
    """Weights of a limb with a joint at the height 2."""
    upper = 1 / (1 + np.exp(-sharpness * (vertices[:, 2] - 2)))
    return csr_array(np.stack([1 - upper, upper], axis=1))


@pytest.fixture(scope="module")
def limb():
    body = TriangleMesh(*cylinder(24, 32, 0.5, 4.0))
    sleeve = TriangleMesh(*cylinder(20, 24, 0.52, 3.6))
    return body, TriangleMesh(sleeve.vertices + np.array([0, 0, 0.2]), sleeve.triangles)


def mend(limb, *weights):
    body, sleeve = limb
    items = [WeightedItem(sleeve.vertices, sleeve.triangles, each) for each in weights]
    skin = smooth_weights(body.vertices, 4.0)
    return run(mend_weights_steps(items, body=body, skin_weights=skin, skeleton=BONES))


def test_weights_like_those_of_the_skin_stay(limb):
    weights = smooth_weights(limb[1].vertices, 4.0)
    (mended,) = mend(limb, weights)
    assert not mended.changed.any()
    assert abs(mended.weights - weights).max() == 0


def test_others_are_brought_closer_where_the_skin_pokes_through(limb):
    sleeve = limb[1]
    wrong = smooth_weights(sleeve.vertices - [0, 0, 0.5], 4.0)  # its elbow is too high
    right = smooth_weights(sleeve.vertices, 4.0)
    (mended,) = mend(limb, wrong)
    assert mended.changed.any()
    assert abs(mended.weights - right).sum() < 0.6 * abs(wrong - right).sum()
    np.testing.assert_allclose(mended.weights.sum(axis=1), 1)
    ends = np.abs(sleeve.vertices[:, 2] - 2) > 1.7
    assert not mended.changed[ends].any()


def test_weights_that_let_hardly_more_skin_through_stay(limb):
    """A cuff that is stiffer than the arm below digs in a little: that is how it was made."""
    sleeve = limb[1]
    stiff = smooth_weights(sleeve.vertices, 6.0)
    (mended,) = mend(limb, stiff)
    assert not mended.changed.any()


def test_each_item_is_mended_by_itself(limb):
    sleeve = limb[1]
    right, wrong = smooth_weights(sleeve.vertices, 4.0), smooth_weights(sleeve.vertices - [0, 0, 0.5], 4.0)
    kept, mended = mend(limb, right, wrong)
    (alone,) = mend(limb, wrong)
    assert not kept.changed.any()
    np.testing.assert_allclose(mended.weights.toarray(), alone.weights.toarray())
    assert mend(limb) == []
