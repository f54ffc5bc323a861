# SPDX-License-Identifier: GPL-3.0-or-later
"""Weights of clothes for the bones of another rig."""

import numpy as np
import pytest
from scipy.sparse import csr_array

from engine import BonePairing, RigError, Skeleton, TriangleMesh, run
from engine.retarget.wear.handed_weights import handed_weights, shares_below_steps
from tests.shapes import cylinder

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


LEG = TriangleMesh(*cylinder(32, 40, 0.5, 4.0))
"""Along z, from 0 to 4."""


def heights_below(positions, body=LEG, carrier=2.0):
    """How high the skin is on the mean that moves points which skin of some height carried, (k,)."""
    at = np.argmin(np.linalg.norm(body.vertices - [body.vertices[:, 0].max(), 0, carrier], axis=1))
    entries = np.ones(len(positions)), (np.arange(len(positions)), np.full(len(positions), at))
    carried = csr_array(entries, shape=(len(positions), body.vertex_count))
    (shares,) = run(shares_below_steps([(np.array(positions, float), carried)], body))
    np.testing.assert_allclose(shares.sum(axis=1), 1)
    return shares @ body.vertices[:, 2]


def test_what_lies_on_the_skin_moves_as_the_skin_just_below_it():
    np.testing.assert_allclose(heights_below([[0.51, 0, 2.83], [0.5, 0, 1.26], [0.49, 0, 2]]), [2.83, 1.26, 2])


def test_what_hangs_away_moves_as_what_carried_it_and_there_is_no_step_between():
    away = np.linspace(0, 0.2, 60)
    found = heights_below([[0.5 + each, 0, 3.0] for each in away])
    np.testing.assert_allclose(found[away < 0.03], 3.0, atol=1e-6)
    np.testing.assert_allclose(found[away > 0.1], 2.0, atol=1e-6)
    assert np.abs(np.diff(found)).max() < 0.1


def test_what_lies_between_two_legs_moves_with_its_own():
    other = TriangleMesh(LEG.vertices + np.array([1.02, 0, 1.0]), LEG.triangles)
    both = TriangleMesh.concatenated([other, LEG])
    at = other.vertex_count + int(np.argmin(np.linalg.norm(LEG.vertices - [0.5, 0, 2.0], axis=1)))
    carried = csr_array(([1.0], ([0], [at])), shape=(1, both.vertex_count))
    (shares,) = run(shares_below_steps([(np.array([[0.515, 0, 2.0]]), carried)], both))  # nearer to the other
    assert shares[:, : other.vertex_count].sum() == 0


def test_seams_of_the_body_and_units_change_nothing():
    corners = LEG.triangles.ravel()  # every triangle by itself
    cut = TriangleMesh(LEG.vertices[corners], np.arange(len(corners)).reshape(-1, 3))
    places = np.array([[0.51, 0, 2.83], [0.55, 0, 2.5]])
    np.testing.assert_allclose(heights_below(places, cut), heights_below(places), atol=1e-6)
    bigger = TriangleMesh(100 * LEG.vertices, LEG.triangles)
    np.testing.assert_allclose(heights_below(100 * places, bigger, 200.0), 100 * heights_below(places), atol=1e-6)
