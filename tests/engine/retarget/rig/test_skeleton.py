# SPDX-License-Identifier: GPL-3.0-or-later
import numpy as np
import pytest

from engine import RigError, Skeleton


def skeleton(parents):
    count = len(parents)
    return Skeleton(np.array(parents), np.zeros((count, 3)), np.ones((count, 3)))


def test_parents_come_before_their_children():
    bones = skeleton([2, -1, 1, 0, -1])
    place = np.argsort(bones.order)
    for bone, parent in enumerate(bones.parents):
        assert parent < 0 or place[parent] < place[bone]
    assert sorted(bones.order) == list(range(5))
    assert bones.children(1).tolist() == [2]


def test_no_bones_are_a_skeleton():
    assert len(skeleton([])) == 0


def test_points_on_bones_lie_between_their_ends():
    heads, tails = np.random.default_rng(0).random((2, 3, 3))
    bones = Skeleton(np.array([-1, 0, 1]), heads, tails)
    points = bones.points_along(np.array([0, 0.25, 1]))
    np.testing.assert_allclose(points, np.stack([heads, heads + bones.axes / 4, tails], axis=1))
    np.testing.assert_array_equal(bones.joints, [*heads, *tails])


@pytest.mark.parametrize(
    ("parents", "heads", "message"),
    [
        ([-1, 0], np.zeros((1, 3)), "2 bones needs 2 heads"),
        ([-1, 5], np.zeros((2, 3)), "from -1 to 1"),
        ([1, 0], np.zeros((2, 3)), "own ancestors"),
        ([-1, 0], np.full((2, 3), np.nan), "not a finite number"),
    ],
)
def test_what_is_no_skeleton_is_refused(parents, heads, message):
    with pytest.raises(RigError, match=message):
        Skeleton(np.array(parents), heads, np.ones((2, 3)))


def test_subtrees_hold_all_that_hangs_on_a_bone():
    tree = skeleton([2, 0, -1, 2])  # not in order
    found = [set(np.flatnonzero(row)) for row in tree.hanging]
    assert found == [{0, 1}, {1}, {0, 1, 2, 3}, {3}]
    assert all(
        set(tree.above(bone)) == {other for other in range(4) if bone in found[other]} - {bone} for bone in range(4)
    )


@pytest.mark.parametrize("unit", [0.01, 1.0, 100.0])
def test_bones_that_are_all_of_one_length_end_where_others_hang_on_them(unit):
    """An importer gives the bones of a leg a metre each."""
    heads = unit * np.array([[0, 0, 1.0], [0, 0, 0.9], [0, 0, 0.5], [0, 0, 0.1], [0, 0, 0.1], [0.5, 0, 0.1]])
    along = np.array([[0, 0, -1.0], [0, 0, -1], [0, 0.6, -0.8], [0, 1, 0], [0, 1, 0], [1, 0, 0]])
    parents = np.array([-1, 0, 1, 2, 3, -1])
    found = Skeleton(parents, heads, heads + unit * along).with_likely_tails()
    assert np.allclose(found.axes, unit * along * np.array([[0.1], [0.4], [0.4], [0.2], [0.0009], [0.0009]]))


def test_bones_of_lengths_that_mean_something_stay_as_they_are():
    """A root that stands out, a toe, and a leg that ends in its tail."""
    heads = np.array([[0, 0, 0.0], [0, 0, 1], [0, 0, 0.5], [0, 0, 0.1], [0, 0.2, 0.0]])
    tails = np.array([[0, 0, 2.0], [0, 0, 0.5], [0, 0, 0.1], [0, 0.2, 0.0], [0, 5.0, 0.0]])
    bones = Skeleton(np.array([-1, 0, 1, 2, 3]), heads, tails)
    assert bones.with_likely_tails() is bones
    assert skeleton([]).with_likely_tails().tails.shape == (0, 3)
