# SPDX-License-Identifier: GPL-3.0-or-later
"""Arrays made of indices."""

import numpy as np

from engine.runtime.arrays import marked, numbered


def test_places_are_marked_whatever_the_shape_of_their_array():
    np.testing.assert_array_equal(marked(np.array([[0, 2], [2, 3]]), 5), [True, False, True, True, False])
    assert not marked(np.empty(0, np.int64), 2).any()


def test_places_are_numbered_in_their_order():
    np.testing.assert_array_equal(numbered(np.array([3, 0]), 4), [1, -1, -1, 0])
    assert (numbered(np.empty(0, np.int64), 2) == -1).all()
