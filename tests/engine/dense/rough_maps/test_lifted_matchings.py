# SPDX-License-Identifier: GPL-3.0-or-later
from itertools import permutations

import numpy as np
import pytest

from engine.dense.rough_maps.lifted_matchings import LiftedMatchings
from tests.domains import domain
from tests.shapes import creature

COUNT = 5


@pytest.fixture(scope="module")
def rest():
    return creature(0.0, 9)[2]


@pytest.fixture(scope="module")
def pair():
    return tuple(domain(*creature(pose, 9)[:2], eigenpairs=20) for pose in (0.0, 1.0))


@pytest.fixture(scope="module")
def all_matchings():
    return np.array(list(permutations(range(COUNT))))


def lifted(x, y, rest, **options):
    """Five farthest points of X, and the samples of Y that are nearest to them at rest."""
    of_x = np.arange(COUNT)
    places = rest[y.vertices[: y.coarse_count]]
    wanted = rest[x.vertices[of_x]]
    of_y = np.linalg.norm(wanted[:, None] - places, axis=2).argmin(axis=1)
    return LiftedMatchings(x, y, of_x, of_y, **options)


def error(x, y, rest, maps):
    images = rest[y.vertices[maps.on_y]]
    return np.linalg.norm(images - rest[x.vertices[: x.coarse_count]], axis=1).mean()


def test_of_all_permutations_the_truth_fits_best(pair, rest, all_matchings):
    found = lifted(*pair, rest)
    best = found.best(all_matchings, 1, 3)
    np.testing.assert_array_equal(best[0], np.arange(COUNT))
    assert error(*pair, rest, found.maps(best[0], 1)) < 0.15
    assert error(*pair, rest, found.maps(best[1], 1)) > 0.3


@pytest.mark.parametrize("axis", range(3))
def test_the_truth_fits_best_on_a_body_of_other_proportions_by_relative_distances(axis, rest, all_matchings):
    vertices, triangles, _ = creature(0.0, 9)
    stretched = vertices * np.where(np.arange(3) == axis, 1.7, 1.0)
    x, y = (domain(places, triangles, eigenpairs=20) for places in (vertices, stretched))
    best = lifted(x, y, rest, relative=True).best(all_matchings, 1, 1)
    np.testing.assert_array_equal(best[0], np.arange(COUNT))


def test_a_reflected_surface_is_matched_with_the_sides_reversed(pair, rest, all_matchings):
    x, y = pair
    mesh = y.shape.mesh
    reflected = domain(mesh.vertices * [1, -1, 1], mesh.triangles[:, ::-1], eigenpairs=20)
    found = lifted(x, reflected, rest)
    np.testing.assert_array_equal(found.best(all_matchings, -1, 1)[0], np.arange(COUNT))
    kept, mirrored = (error(x, reflected, rest, found.maps(np.arange(COUNT), sign)) for sign in (1, -1))
    assert mirrored < 0.15
    assert mirrored < kept


def test_what_says_the_same_is_chosen_once(pair, rest, all_matchings):
    found = lifted(*pair, rest)
    once, twice = (found.best(np.tile(all_matchings, (times, 1)), 1, 4) for times in (1, 2))
    np.testing.assert_array_equal(once, twice)
    assert len(np.unique(once, axis=0)) == 4


def test_no_more_are_chosen_than_there_are(pair, rest):
    found = lifted(*pair, rest)
    assert found.best(np.arange(COUNT)[None], 1, 9).shape == (1, COUNT)


def test_changes_lead_from_wrong_matchings_to_the_truth(pair, rest):
    found = lifted(*pair, rest)
    for wrong in ([1, 0, 2, 3, 4], [1, 2, 0, 3, 4], [3, 1, 4, 0, 2]):
        np.testing.assert_array_equal(found.improved(np.array(wrong), 1), np.arange(COUNT))


def test_an_image_that_is_nowhere_in_a_matching_is_taken_for_a_better_one(pair, rest):
    x, y = pair
    of_x = np.arange(COUNT)
    true = np.linalg.norm(rest[x.vertices[of_x]][:, None] - rest[y.vertices[: y.coarse_count]], axis=2).argmin(axis=1)
    others = np.setdiff1d(np.arange(40), true)[:4]
    found = LiftedMatchings(x, y, of_x, np.concatenate([others, true]))
    truth = np.arange(COUNT) + len(others)
    for wrong in ([0, *truth[1:]], [truth[1], truth[0], 2, *truth[3:]]):
        np.testing.assert_array_equal(found.improved(np.array(wrong), 1), truth)


def test_a_single_pair_has_nothing_to_change(pair):
    single = np.zeros(1, np.int64)
    np.testing.assert_array_equal(LiftedMatchings(*pair, single, single).improved(single, 1), single)
