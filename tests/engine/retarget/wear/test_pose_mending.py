# SPDX-License-Identifier: GPL-3.0-or-later
"""Weights of clothes that are tried in poses."""

import time

import numpy as np
import pytest
from scipy.sparse import csr_array

from engine import Skeleton, TriangleMesh, run
from engine.retarget.wear.pose_mending import WeightedItem, mend_weights_steps
from engine.retarget.wear.wearing import dressed_steps
from engine.retarget.wear.worn_item import WornItem
from engine.runtime.worker import call_helpers, close_helpers, present_helpers, use_processes
from tests.shapes import cylinder

PATIENCE = 60

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


@pytest.fixture
def helper():
    """A second process that is ready, once it is called for."""
    use_processes(1)

    def called():
        use_processes(2)
        call_helpers()
        (found,) = present_helpers()
        end = time.monotonic() + PATIENCE
        while not found.is_ready:
            assert time.monotonic() < end
            found.look(0.01)
        return found

    yield called
    close_helpers()
    use_processes()


def test_two_processes_find_the_same(limb, helper):
    """To the last bit; so they do of how a body wears items."""
    body, sleeve = limb
    weights = [smooth_weights(sleeve.vertices, sharpness) for sharpness in (4.0, 40.0)]

    def found():
        return mend(limb, *weights), run(dressed_steps(body, [WornItem(sleeve), WornItem(sleeve, fit="LOOSE")]))

    mended, dressed = found()
    helper()
    other_mended, other_dressed = found()
    for one, other in zip(mended, other_mended, strict=True):
        assert abs(one.weights - other.weights).max() == 0
        np.testing.assert_array_equal(one.changed, other.changed)
    for one, other in zip(dressed.items, other_dressed.items, strict=True):
        np.testing.assert_array_equal(one.carriers.away, other.carriers.away)
        np.testing.assert_array_equal(one.below.distances, other.below.distances)
        assert abs(one.carriers.places - other.carriers.places).max() == 0
