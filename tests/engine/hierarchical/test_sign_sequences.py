# SPDX-License-Identifier: GPL-3.0-or-later
import tracemalloc

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from engine.hierarchical.sign_sequences import consistent_sequences_steps
from engine.runtime.progress import at_once

consistent_sequences = at_once(consistent_sequences_steps)


@given(st.integers(0, 10_000))
def test_flipped_and_exchanged_functions_are_read_back(seed):
    rng = np.random.default_rng(seed)
    source = rng.standard_normal((60, 5))
    signs = rng.choice([1, -1], 5)
    order = np.array([0, 2, 1, 3, 4]) if seed % 2 else np.arange(5)
    target = np.empty_like(source)
    target[:, order] = source * signs
    # The descriptor without signs is not sure: every point looks like nine others as well.
    likeness = rng.uniform(1, 2, (60, 60))
    likeness[np.arange(60), np.arange(60)] = 1.1
    best = consistent_sequences(source, target, likeness, [[1, 2]], 3)[0]
    np.testing.assert_allclose(best.apply(target), source)


def test_a_symmetric_shape_has_two_sequences():
    # On a line symmetric about 0, even functions keep their sign under the mirror, odd ones flip together.
    x = np.linspace(-1, 1, 41)
    functions = np.stack([np.sin(np.pi * x / 2), np.cos(np.pi * x), np.sin(1.5 * np.pi * x)], axis=1)
    likeness = np.abs(np.abs(x)[:, None] - np.abs(x))
    first, second, third = consistent_sequences(functions, functions, likeness, [], 3)
    found = {tuple(first.signs.tolist()), tuple(second.signs.tolist())}
    assert found == {(1, 1, 1), (-1, 1, -1)}
    assert first.disagreement == pytest.approx(0, abs=1e-6)
    assert second.disagreement == pytest.approx(0, abs=1e-6)
    assert third.disagreement > 0.1


def test_no_more_than_asked_for_in_order():
    rng = np.random.default_rng(0)
    found = consistent_sequences(rng.random((20, 3)), rng.random((25, 3)), rng.random((20, 25)), [[0, 1, 2]], 10)
    values = [sequence.disagreement for sequence in found]
    assert len(found) == 10
    assert values == sorted(values)


def test_it_can_be_stopped_between_two_orders():
    rng = np.random.default_rng(0)
    steps = consistent_sequences_steps(
        rng.random((20, 6)), rng.random((25, 6)), rng.random((20, 25)), [[0, 1, 2], [3, 4, 5]], 5
    )
    fractions = [progress.fraction for progress in steps]
    assert len(fractions) == 36
    assert fractions == sorted(fractions)


def test_only_what_is_asked_for_is_kept_of_a_hundred_thousand_sequences():
    rng = np.random.default_rng(0)
    source, target, likeness = rng.random((20, 9)), rng.random((25, 9)), rng.random((20, 25))
    tracemalloc.start()
    found = consistent_sequences(source, target, likeness, [[0, 1, 2], [3, 4, 5], [6, 7, 8]], 5)
    peak = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    assert len(found) == 5
    assert peak < 8e6  # bytes; objects for all of the sequences would take more than 20 MB
