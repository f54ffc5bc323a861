# SPDX-License-Identifier: GPL-3.0-or-later
"""When two sets of candidates say the same, and when a set is too small."""

import numpy as np
import pytest

from engine.matching.overlap.consistent_sets import Plan, Together, _are_alike, consistent_sets
from engine.matching.overlap.oriented_patches import OrientedPatches
from engine.matching.overlap.patch_candidates import Candidates

LINE = np.abs(np.arange(20.0)[:, None] - np.arange(20.0)) / 50
"""Lengths of paths between places on a line, 0.02 from one to the next."""


def images(places, shift=0):
    """Take some places to those of their numbers, or to others beside them."""
    found = np.full(20, -1)
    found[places] = np.asarray(places) + shift
    return found


@pytest.mark.parametrize(("shift", "alike"), [(0, True), (2, True), (6, False)])
def test_sets_that_take_what_they_share_to_about_the_same_places_are_alike(shift, alike):
    one, other = images(np.arange(12)), images(np.arange(12), shift)
    assert _are_alike(one, other, LINE) == alike
    assert _are_alike(other, one, LINE) == alike


def test_sets_that_share_little_are_not_compared():
    assert not _are_alike(images(np.arange(10)), images(np.arange(8, 18)), LINE)
    assert _are_alike(images(np.arange(4)), images(np.arange(18)), LINE)


def sets_of(count, radius):
    """Sets of candidates, one for each of so many places in a row, all of which go together."""
    numbers, rotations = np.arange(count), np.tile(np.eye(3), (count, 1, 1))
    candidates = Candidates(numbers, numbers, np.ones(count), rotations)
    values = (1 - np.eye(count)).astype(np.float32)
    places = np.zeros((count, 3))
    patches = OrientedPatches(numbers, LINE[:count, :count], rotations, places, places)
    shares = np.full(count, 1 / count)
    return consistent_sets(candidates, Together(values, numbers), (patches, patches), shares, Plan(radius, 10, 5))


def test_a_set_has_all_that_goes_together_within_its_radius_and_four_members_at_least():
    (whole,) = sets_of(12, np.inf)
    np.testing.assert_array_equal(whole.members, np.arange(12))
    assert sets_of(12, 0.01) == []
    assert sets_of(3, np.inf) == []
    near = sets_of(12, 0.05)
    assert all(4 <= len(each.members) <= 5 for each in near)
    assert len(near) > 1
