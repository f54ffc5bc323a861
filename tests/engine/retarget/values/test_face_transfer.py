# SPDX-License-Identifier: GPL-3.0-or-later
"""Values of faces, carried from mesh to mesh."""

from __future__ import annotations

import numpy as np
import pytest

from engine import MatchError, SurfaceMap
from engine.retarget.values.face_correspondence import FacePlaces
from engine.retarget.values.face_transfer import carry_face_values, majority
from tests.faces import closest_map, grid, triangulated


def carry(values, source, target):
    image = triangulated(*source[:2])
    return carry_face_values(values, source[1], FacePlaces(image, target[1], closest_map(target[0], image)))


def test_a_majority_is_counted_by_weight():
    codes, owners = np.array([3, 1, 1, 2, 0, 0]), np.array([0, 0, 0, 1, 1, 1])
    np.testing.assert_array_equal(majority(codes, owners, np.array([1.5, 1, 1, 3, 1, 1]), 2), [1, 2])
    np.testing.assert_array_equal(majority(codes, owners, np.ones(6), 2), [1, 0])


def test_a_large_face_takes_what_most_of_it_lies_on():
    source, target = grid(15, 15), grid(1, 1)
    values = np.full(225, 4)
    values[112] = 9  # the one under its centre
    assert carry(values, source, target).tolist() == [4]


def test_names_and_vectors_are_never_mixed():
    source, target = grid(6, 6), grid(5, 4)
    names = np.array([f"part {number % 7}" for number in range(36)])
    assert set(carry(names, source, target)) <= set(names)
    pairs = np.stack([np.arange(36), -np.arange(36)], axis=1)
    carried = carry(pairs, source, target)
    np.testing.assert_array_equal(carried[:, 0], -carried[:, 1])


def test_one_value_for_each_face():
    source = grid(3, 3)
    image = triangulated(*source[:2])
    with pytest.raises(MatchError, match="each of 9 faces"):
        carry_face_values(np.zeros(8), source[1], FacePlaces(image, source[1], SurfaceMap.identity(image)))
