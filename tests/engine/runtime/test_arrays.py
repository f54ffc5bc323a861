# SPDX-License-Identifier: GPL-3.0-or-later
"""Arrays made of indices."""

import numpy as np

from engine.runtime.arrays import group_means, group_sums, marked, numbered, ranges


def test_places_are_marked_whatever_the_shape_of_their_array():
    np.testing.assert_array_equal(marked(np.array([[0, 2], [2, 3]]), 5), [True, False, True, True, False])
    assert not marked(np.empty(0, np.int64), 2).any()


def test_places_are_numbered_in_their_order():
    np.testing.assert_array_equal(numbered(np.array([3, 0]), 4), [1, -1, -1, 0])
    assert (numbered(np.empty(0, np.int64), 2) == -1).all()


def test_rows_are_summed_by_group():
    values = np.array([[1.0, 2], [3, 4], [5, 6]])
    np.testing.assert_array_equal(group_sums(np.array([2, 0, 2]), values, 4), [[3, 4], [0, 0], [6, 8], [0, 0]])
    assert group_sums(np.empty(0, np.int64), np.empty((0, 3)), 2).shape == (2, 3)


def test_rows_are_averaged_by_group():
    values = np.array([[1.0, 2], [3, 4], [5, 6]])
    np.testing.assert_array_equal(group_means(np.array([1, 0, 1]), values, 2), [[3, 4], [3, 4]])


def test_ranges_follow_one_another():
    np.testing.assert_array_equal(ranges(np.array([5, 0, 9]), np.array([2, 0, 3])), [5, 6, 9, 10, 11])
    assert len(ranges(np.empty(0, np.int64), np.empty(0, np.int64))) == 0
