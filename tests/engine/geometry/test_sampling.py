# SPDX-License-Identifier: GPL-3.0-or-later
from itertools import combinations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.sparse import csr_array
from scipy.sparse.csgraph import shortest_path

from engine.geometry.sampling import FarthestPointSampler, farthest_point_sampling


def random_graph(seed, n=14, extra=12):
    """A connected graph: a path through all vertices, and some more edges."""
    rng = np.random.default_rng(seed)
    order = rng.permutation(n)
    pairs = np.concatenate([np.stack([order[:-1], order[1:]], axis=1), rng.integers(0, n, (extra, 2))])
    pairs = np.unique(np.sort(pairs[pairs[:, 0] != pairs[:, 1]], axis=1), axis=0)
    lengths = rng.uniform(0.5, 2.0, len(pairs))
    a, b = pairs.T
    return csr_array((np.tile(lengths, 2), (np.r_[a, b], np.r_[b, a])), shape=(n, n))


@given(st.integers(0, 10_000))
def test_each_sample_is_a_farthest_vertex_and_every_prefix_is_2_optimal(seed):
    graph = random_graph(seed)
    exact = shortest_path(graph)
    samples = farthest_point_sampling(graph, 5, start=0)
    for count in range(1, 5):
        to_nearest = exact[samples[:count]].min(axis=0)
        assert to_nearest[samples[count]] == pytest.approx(to_nearest.max())
        best = min(exact[list(choice)].min(axis=0).max() for choice in combinations(range(len(exact)), count))
        assert to_nearest.max() <= 2 * best + 1e-12


@given(st.integers(0, 10_000))
def test_the_stopped_searches_give_the_same_cells_as_full_ones(seed):
    graph = random_graph(seed)
    sampler = FarthestPointSampler(graph, 3)
    sampler.extend(6)
    rows = shortest_path(graph)[sampler.samples]
    np.testing.assert_allclose(sampler.distances, rows.min(axis=0), atol=1e-12)


def test_sampling_on_is_the_same_as_sampling_at_once():
    graph = random_graph(1)
    sampler = FarthestPointSampler(graph, 0)
    for count in (2, 5, 9):
        sampler.extend(count)
    assert sampler.samples == farthest_point_sampling(graph, 9, start=0).tolist()


def test_all_vertices_are_taken_once():
    graph = random_graph(2)
    assert sorted(farthest_point_sampling(graph, 14, start=5)) == list(range(14))
