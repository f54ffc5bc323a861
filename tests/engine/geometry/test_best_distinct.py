# SPDX-License-Identifier: GPL-3.0-or-later
import pytest

from engine.geometry.best_distinct import best_distinct


def apart(first, second):
    return abs(first - second) > 1


@pytest.mark.parametrize(("most", "chosen"), [(None, [5, 3, 8, 1]), (3, [5, 3, 8]), (1, [5]), (0, [])])
def test_each_differs_from_all_better_ones_and_no_more_are_chosen(most, chosen):
    assert best_distinct([5, 5, 4, 3, 6, 8, 2, 1, 3], apart, most) == chosen


def test_what_is_like_something_that_was_left_out_alone_is_chosen():
    assert best_distinct([5, 4, 3], apart) == [5, 3]


def test_none_is_like_what_they_stand_beside_which_counts_for_nothing():
    assert best_distinct([5, 3, 1], apart, 2, beside=[4]) == [1]
    assert best_distinct([], apart, beside=[4]) == []


def test_no_more_is_read_than_is_needed():
    ranked = iter([1, 4, 7, 10])
    assert best_distinct(ranked, apart, 2) == [1, 4]
    assert list(ranked) == [10]
