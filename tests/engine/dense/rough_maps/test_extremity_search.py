# SPDX-License-Identifier: GPL-3.0-or-later
from itertools import permutations

import numpy as np
import pytest

from engine.dense.rough_maps.extremity_search import beam_matchings


def problem(seed, m, n):
    rng = np.random.default_rng(seed)
    points = rng.uniform(size=(n, 3))
    distances = np.linalg.norm(points[:, None] - points, axis=2)
    return rng, distances, rng.uniform(size=(m, n))


def cost(distances_x, distances_y, dissimilarity, images, weight=0.3):
    total = 0.0
    for i, image in enumerate(images):
        total += weight * dissimilarity[i, image]
        for j, other in enumerate(images[:i]):
            a, b = distances_x[i, j], distances_y[image, other]
            total += 2 / i * abs(a - b) / ((a + b) / 2)
    return total


@pytest.mark.parametrize("seed", range(3))
def test_a_wide_beam_finds_the_best_of_all_matchings(seed):
    _, distances_y, dissimilarity = problem(seed, 4, 6)
    distances_x = problem(seed + 100, 4, 4)[1]
    found = beam_matchings(distances_x, distances_y, dissimilarity, 360)[:50]
    best = sorted(
        (cost(distances_x, distances_y, dissimilarity, images), images) for images in permutations(range(6), 4)
    )
    assert [tuple(images) for images in found] == [images for _, images in best[:50]]


def test_a_narrow_beam_finds_an_exact_copy_and_never_an_image_twice():
    rng, distances, dissimilarity = problem(7, 6, 10)
    order = rng.permutation(10)[:6]
    found = beam_matchings(distances[np.ix_(order, order)], distances, 0 * dissimilarity, 100)
    np.testing.assert_array_equal(found[0], order)
    assert found.shape == (100, 6)
    assert all(len(set(images)) == 6 for images in found.tolist())


def test_no_more_matchings_than_there_are():
    _, distances, dissimilarity = problem(3, 3, 3)
    assert len(beam_matchings(distances, distances, dissimilarity, 50)) == 6
