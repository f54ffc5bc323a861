# SPDX-License-Identifier: GPL-3.0-or-later
"""Arrays of indices and of vectors."""

import numpy as np
import pytest
from scipy.spatial.distance import cdist

from engine.runtime.arrays import (
    eased,
    evenly,
    group_largest,
    group_means,
    group_smallest,
    group_sums,
    lengths_along,
    marked,
    numbered,
    ranges,
    slices,
    spread_rows,
    squared_differences,
    unit_vectors,
    weighted_quantile,
)


def test_places_are_marked_whatever_the_shape_of_their_array():
    np.testing.assert_array_equal(marked(np.array([[0, 2], [2, 3]]), 5), [True, False, True, True, False])
    assert not marked(np.empty(0, np.int64), 2).any()


def test_slices_part_all_rows():
    assert [list(range(10))[part] for part in slices(10, 4)] == [[0, 1, 2, 3], [4, 5, 6, 7], [8, 9]]
    assert list(slices(4, 4)) == [slice(0, 4)]
    assert list(slices(0, 4)) == []


def test_places_are_numbered_in_their_order():
    np.testing.assert_array_equal(numbered(np.array([3, 0]), 4), [1, -1, -1, 0])
    assert (numbered(np.empty(0, np.int64), 2) == -1).all()


def test_the_largest_and_the_smallest_of_each_group_are_found():
    groups, values = np.array([2, 0, 2]), np.array([5.0, -1, 7])
    np.testing.assert_array_equal(group_largest(groups, values, 4), [0, 0, 7, 0])
    np.testing.assert_array_equal(group_largest(groups, values, 3, -np.inf), [-1, -np.inf, 7])
    np.testing.assert_array_equal(group_smallest(groups, values, 4), [-1, np.inf, 5, np.inf])
    numbers = group_smallest(groups, np.array([4, 3, 1]), 3, 9)
    np.testing.assert_array_equal(numbers, [3, 9, 1])
    assert numbers.dtype == np.int64


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


def test_directions_stay_and_lengths_become_one():
    vectors = np.random.default_rng(0).normal(size=(50, 3)) * np.logspace(-150, 150, 50)[:, None]
    units = unit_vectors(vectors)
    np.testing.assert_allclose(np.linalg.norm(units, axis=1), 1, rtol=1e-12)
    np.testing.assert_allclose(np.cross(units, vectors) / np.linalg.norm(vectors, axis=1, keepdims=True), 0, atol=1e-12)
    assert (np.einsum("nd,nd->n", units, vectors) > 0).all()


def test_zero_and_what_is_as_short_as_said_become_zero():
    vectors = np.array([[0.0, 0, 0], [1e-7, 0, 0], [0, 2e-6, 0]])
    np.testing.assert_array_equal(unit_vectors(vectors), [[0, 0, 0], [1, 0, 0], [0, 1, 0]])
    np.testing.assert_array_equal(unit_vectors(vectors, 1e-6), [[0, 0, 0], [0, 0, 0], [0, 1, 0]])


@pytest.mark.parametrize("shape", [(1, 1, 1), (7, 4, 3), (5, 9, 20), (0, 3, 2), (4, 0, 2)])
def test_they_are_the_squares_of_the_distances(shape):
    n, m, d = shape
    rng = np.random.default_rng(0)
    first, second = rng.normal(size=(n, d)), rng.normal(size=(m, d))
    found = squared_differences(first, second)
    assert found.shape == (n, m)
    np.testing.assert_allclose(found, cdist(first, second, "sqeuclidean"), rtol=1e-10, atol=1e-12)


def test_exact_on_whole_numbers():
    first, second = np.array([[0.0, 0], [3, 4]]), np.array([[3.0, 4], [0, 0], [-3, 4]])
    np.testing.assert_array_equal(squared_differences(first, second), [[25, 0, 25], [0, 25, 36]])


def test_rounding_makes_none_negative():
    rows = np.random.default_rng(1).normal(size=(200, 3)) + 1e5
    found = squared_differences(rows, rows)
    # Without a limit, half of the zeros on the diagonal would be below.
    assert (found >= 0).all()
    assert np.isfinite(np.sqrt(found)).all()
    assert np.diag(found).max() < 1e-4


def test_exchanging_the_arrays_transposes():
    rng = np.random.default_rng(2)
    first, second = rng.random((6, 5)), rng.random((8, 5))
    np.testing.assert_allclose(squared_differences(first, second), squared_differences(second, first).T, atol=1e-14)


def test_rows_are_picked_each_the_farthest_from_those_before():
    rows = np.array([[0.0, 0], [1, 0], [10, 0], [10, 0], [0, 4]])
    assert spread_rows(rows, 0, 3).tolist() == [0, 2, 4]
    assert spread_rows(rows, 0, 5).tolist() == [0, 2, 4, 1]  # what lies on another row is never picked
    assert spread_rows(rows, 1, 5, least=5.0).tolist() == [1, 2]


def test_lengths_along_a_line_are_those_of_its_parts_so_far():
    assert lengths_along(np.array([[0.0, 0], [3, 4], [3, 4], [3, 10]])).tolist() == [0, 5, 5, 11]
    assert lengths_along(np.zeros((1, 3))).tolist() == [0]


def test_eased_shares_keep_their_ends_and_their_middle_and_stand_still_at_the_ends():
    assert eased(np.array([-1, 0, 0.5, 1, 2])).tolist() == [0, 0, 0.5, 1, 1]
    np.testing.assert_allclose(eased(np.array([1e-4, 1 - 1e-4])), [0, 1], atol=1e-7)


def test_some_of_many_are_chosen_evenly_and_all_of_few():
    assert evenly(3, 5).tolist() == [0, 1, 2]
    assert evenly(101, 3).tolist() == [0, 50, 100]
    assert evenly(0, 3).tolist() == []


def test_quantiles_count_values_as_often_as_they_weigh():
    values, counts = np.array([5.0, 1.0, 3.0, 2.0]), np.array([1, 4, 2, 0])
    assert weighted_quantile(values, counts) == np.quantile(np.repeat(values, counts), 0.5, method="inverted_cdf") == 1
    assert [weighted_quantile(values, counts, share) for share in (0.0, 0.6, 0.9, 1.0)] == [1, 3, 5, 5]
