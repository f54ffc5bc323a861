# SPDX-License-Identifier: GPL-3.0-or-later
"""Keeping away from a matching: what it allows, and what it must cost."""

import itertools

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from engine.hierarchical.exact.exclusion import Exclusion, exclusion_surcharge


def least_surcharge(unary, open_rows, moved, needed, multiplier):
    """By trying all labels of the open points that have enough moved: their cost beyond the cheapest labels."""
    rows = np.flatnonzero(open_rows)
    best = np.inf
    for labels in itertools.product(range(unary.shape[1]), repeat=len(rows)):
        away = int(moved[rows, list(labels)].sum())
        if away >= needed:
            spent = (unary[rows, list(labels)] - unary[rows].min(axis=1)).sum()
            best = min(best, spent + multiplier * (away - needed))
    return best


def test_it_allows_what_has_enough_points_moved():
    exclusion = Exclusion(np.array([[False, True, True], [True, False, True]]), 1)
    assert not exclusion.allows(np.array([0, 1]))
    assert exclusion.allows(np.array([0, 2]))
    assert exclusion.allows(np.array([2, 0]))
    assert not Exclusion(exclusion.moved, 2).allows(np.array([0, 2]))
    assert Exclusion(exclusion.moved, 0).allows(np.array([0, 1]))


@given(
    seed=st.integers(0, 10**6),
    points=st.integers(1, 4),
    needed=st.integers(-2, 4),
    multiplier=st.sampled_from([0.0, 0.3, 2.0]),
)
@settings(max_examples=150, deadline=None)
def test_it_is_just_what_the_cheapest_labels_that_keep_away_cost_more(seed, points, needed, multiplier):
    rng = np.random.default_rng(seed)
    unary = rng.random((3, points, 3))
    moved = np.zeros((points, 3), bool)
    moved[:, 0] = True
    moved[:, 1] = rng.random(points) < 0.5
    open_rows = rng.random((3, points)) < 0.8
    each = np.full(3, needed) - np.arange(3)
    found = exclusion_surcharge(unary, open_rows, moved, each, multiplier=multiplier, cap=1e3)
    for node in range(3):
        truth = least_surcharge(unary[node], open_rows[node], moved, each[node], multiplier)
        assert found[node] == pytest.approx(min(truth, 1e3), abs=1e-9)
        assert found[node] >= -1e-12


def test_where_too_few_points_are_open_it_is_impossible():
    unary = np.random.default_rng(0).random((2, 3, 2))
    open_rows = np.array([[True, False, False], [True, True, False]])
    moved = np.array([[True, False]] * 3)
    found = exclusion_surcharge(unary, open_rows, moved, np.array([2, 2]), multiplier=0.0, cap=50.0)
    assert found[0] == 50
    assert found[1] < 2


def test_where_the_cheapest_labels_keep_away_it_costs_nothing():
    unary = np.array([[[0.0, 1.0], [0.2, 1.0]]])
    moved = np.array([[True, False]] * 2)
    for needed, expected in ((2, 0.0), (1, 0.0), (0, 0.0)):
        found = exclusion_surcharge(unary, np.ones((1, 2), bool), moved, np.array([needed]), multiplier=0.0, cap=9.0)
        assert found[0] == pytest.approx(expected)
    # The other way round each point that has to move pays its difference, the cheapest first.
    for needed, expected in ((2, 1.8), (1, 0.8), (0, 0.0)):
        found = exclusion_surcharge(unary, np.ones((1, 2), bool), ~moved, np.array([needed]), multiplier=0.0, cap=9.0)
        assert found[0] == pytest.approx(expected)
