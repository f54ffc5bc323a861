# SPDX-License-Identifier: GPL-3.0-or-later
"""Few keys that say the same."""

from itertools import pairwise

import numpy as np
import pytest

from engine import RigError, reduced_keys, slopes_of


def curve(times, values, keys):
    """Values at all times of the cubic curves through the keys."""
    slopes = slopes_of(times, values)
    result = np.empty_like(values)
    for start, end in pairwise(keys):
        t = ((times[start : end + 1] - times[start]) / (times[end] - times[start]))[:, None]
        step = times[end] - times[start]
        result[start : end + 1] = (
            (2 * t**3 - 3 * t**2 + 1) * values[start]
            + (t**3 - 2 * t**2 + t) * step * slopes[start]
            + (3 * t**2 - 2 * t**3) * values[end]
            + (t**3 - t**2) * step * slopes[end]
        )
    return result


@pytest.mark.parametrize("tolerance", [1e-3, 1e-2])
def test_the_error_is_bounded_and_few_keys_are_left(tolerance):
    times = np.arange(300.0)
    values = np.stack([np.sin(times / 9), np.cos(times / 23)], axis=1)
    keys = reduced_keys(times, values, tolerance)
    assert np.abs(curve(times, values, keys) - values).max() <= tolerance + 1e-12
    assert len(keys) < 100
    assert keys[0] == 0
    assert keys[-1] == 299


def test_a_cubic_needs_two_keys_and_what_stands_still_one():
    times = np.linspace(0, 1, 50)
    assert len(reduced_keys(times, (3 * times**2 - times)[:, None], 1e-6)) == 2
    assert reduced_keys(times, np.full((50, 4), 0.3), 0.0).tolist() == [0]
    assert reduced_keys(times[:1], np.zeros((1, 2)), 0.0).tolist() == [0]


def test_what_is_no_motion_is_refused():
    for values in (np.zeros(3), np.zeros((2, 1)), np.full((3, 1), np.nan)):
        with pytest.raises(RigError, match="one row of finite values"):
            reduced_keys(np.arange(3.0), values, 0.1)
    for times in ([0.0, 1, 1], [0.0, 2, 1]):
        with pytest.raises(RigError, match="after the one before"):
            reduced_keys(np.array(times), np.eye(3), 0.1)
