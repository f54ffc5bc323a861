# SPDX-License-Identifier: GPL-3.0-or-later
"""Weights of clothes for the bones of another rig."""

import numpy as np
import pytest
from scipy.sparse import csr_array

from engine import BonePairing, RigError, Skeleton
from engine.retarget.wear.handed_weights import handed_weights

HEADS = np.array([[0, 0, 0], [0, 0, 2.0]])
BONES = Skeleton(np.array([-1, 0]), HEADS, HEADS + np.array([0, 0, 2.0]))
SWAPPED = Skeleton(np.array([1, -1]), HEADS[::-1], HEADS[::-1] + np.array([0, 0, 2.0]))
PAIRS = BonePairing(
    np.array([1, 0]), np.array([0, 1]), np.ones(2), np.tile(np.eye(3), (2, 1, 1)), HEADS[::-1], np.eye(3)
)
POSITIONS = np.array([[0, 0, 1.0], [0, 0, 1.9], [0, 0, 3.0]])


def handed(own, below, on_skin):
    arrays = (csr_array(np.array(each, float)) for each in (own, below, on_skin))
    return handed_weights(*arrays, POSITIONS, pairing=PAIRS, bones=(BONES, SWAPPED)).toarray()


def test_what_was_weighted_as_the_skin_gets_those_of_the_other_skin():
    skin = [[0.1, 0.9], [0.4, 0.6], [0.8, 0.2]]
    below = [[0.8, 0.2], [0.5, 0.5], [0.2, 0.8]]
    np.testing.assert_allclose(handed(below, below, skin), skin)


def test_what_had_weights_of_its_own_keeps_them_in_the_paired_bones():
    found = handed([[1, 0]] * 3, [[0, 1]] * 3, [[1, 0]] * 3)
    np.testing.assert_allclose(found, [[0, 1]] * 3)
    half = handed([[1, 0]] * 3, [[0.5, 0.5]] * 3, [[0.5, 0.5]] * 3)
    np.testing.assert_allclose(half, [[0.25, 0.75]] * 3)


def test_what_had_none_gets_those_of_the_skin_and_far_from_any_those_of_its_own():
    found = handed([[0, 0], [1, 0], [1, 0]], [[1, 0], [0, 0], [1, 0]], [[0.3, 0.7], [1, 0], [0, 0]])
    np.testing.assert_allclose(found, [[0.3, 0.7], [0, 1], [0, 1]])


def test_arrays_that_do_not_fit_are_refused():
    with pytest.raises(RigError, match="do not fit together"):
        handed([[1, 0]] * 3, [[1, 0]] * 2, [[1, 0]] * 3)
