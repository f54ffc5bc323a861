# SPDX-License-Identifier: GPL-3.0-or-later
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.stats import wasserstein_distance

from engine.hierarchical.descriptors import distance_histograms, earth_movers_distance


@given(st.integers(0, 10_000), st.integers(4, 20))
def test_earth_movers_distance_is_the_optimal_transport(seed, bins):
    rng = np.random.default_rng(seed)
    first, second = rng.dirichlet(np.ones(bins), 3), rng.dirichlet(np.ones(bins), 2)
    centres = 0.1 * np.arange(bins)
    expected = [[wasserstein_distance(centres, centres, f, g) for g in second] for f in first]
    np.testing.assert_allclose(earth_movers_distance(first, second, 0.1), expected, atol=1e-12)


@given(st.integers(0, 10_000))
def test_histograms_hold_the_whole_mass_and_keep_its_mean(seed):
    rng = np.random.default_rng(seed)
    bins, reach = 16, 2.0
    # Away from the two ends, where a distance has only one bin to go to.
    distances = rng.uniform(0.1, 1.9, (40, 5))
    weights = rng.uniform(0.5, 2, 40)
    histograms = distance_histograms(distances, weights, bins, reach)
    assert histograms.min() >= 0
    np.testing.assert_allclose(histograms.sum(axis=1), 1)
    centres = (np.arange(bins) + 0.5) * reach / bins
    np.testing.assert_allclose(histograms @ centres, np.average(distances, axis=0, weights=weights))


def test_the_order_of_the_places_and_the_size_of_the_weights_do_not_matter():
    rng = np.random.default_rng(3)
    distances, weights, order = rng.uniform(0, 1, (30, 4)), rng.uniform(0.5, 2, 30), rng.permutation(30)
    np.testing.assert_allclose(
        distance_histograms(distances, weights, 8, 1.0),
        distance_histograms(distances[order], 7 * weights[order], 8, 1.0),
    )


def test_a_small_change_of_distance_makes_a_small_change_of_the_histogram():
    border = np.linspace(0.3, 0.7, 401)[None, :]
    histograms = distance_histograms(border, np.ones(1), 10, 1.0)
    assert np.abs(np.diff(histograms, axis=0)).max() == pytest.approx(0.01, abs=1e-9)


def test_the_distances_on_a_circle_give_the_same_histogram_everywhere():
    angle = np.linspace(0, 2 * np.pi, 64, endpoint=False)
    distances = np.abs((angle[:, None] - angle + np.pi) % (2 * np.pi) - np.pi)
    histograms = distance_histograms(distances, np.ones(64), 12, np.pi)
    np.testing.assert_allclose(earth_movers_distance(histograms, histograms, 1.0), 0, atol=1e-9)
