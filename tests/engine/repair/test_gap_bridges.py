# SPDX-License-Identifier: GPL-3.0-or-later
"""Solids that are near each other made one."""

import numpy as np
from scipy.ndimage import label

from engine.repair.gap_bridges import bridged


def blocks(*rows, wide=8):
    """Blocks along the first axis, from one row to another each."""
    values = np.zeros((60, 20, 20), np.float32)
    for begin, end in rows:
        values[begin:end, 6 : 6 + wide, 6 : 6 + wide] = 1
    return values


def count(values):
    return label(values > 0.4)[1]


def test_a_gap_is_filled_as_wide_as_what_it_parts():
    values = blocks((2, 20), (24, 40))
    result = bridged(values, 0.4, 8)
    assert count(values) == 2
    assert count(result) == 1
    inside = result[21:23] > 0.4
    assert inside[:, 6:14, 6:14].all()
    assert not inside[:, :4].any()
    assert not inside[:, 16:].any()
    assert np.array_equal(result[:19], values[:19])
    assert values.max() == 1
    assert values[22].max() == 0  # what was given stays


def test_gaps_of_a_chain_are_filled():
    values = blocks((2, 15), (18, 30), (35, 50))
    assert count(bridged(values, 0.4, 8)) == 1


def test_wide_gaps_stay():
    values = blocks((2, 15), (30, 50))
    assert bridged(values, 0.4, 8) is values


def test_one_solid_stays_as_it_is():
    values = blocks((2, 40))
    assert bridged(values, 0.4, 8) is values


def test_crumbs_are_not_joined():
    values = blocks((2, 40))
    values[44, 10, 10] = 1
    assert bridged(values, 0.4, 8) is values
