# SPDX-License-Identifier: GPL-3.0-or-later
"""Places that are recognised, and which of them go together: on a body and the same one elsewhere, which may be cut."""

import numpy as np
import pytest

from engine import TriangleMesh
from engine.matching.overlap.consistent_sets import Plan, Together, _seeds, consistent_sets
from engine.matching.overlap.oriented_patches import oriented_patches
from engine.matching.overlap.part_surface import PartSurface
from engine.matching.overlap.patch_candidates import compatibilities, patch_candidates
from tests.shapes import compacted, creature, rotation

COUNT = 40
TURN = rotation([1.0, 2.0, 0.5], 1.3)


@pytest.fixture(scope="module")
def body():
    vertices, triangles, rest = creature(0.0, 10)
    scale = np.sqrt(TriangleMesh(vertices, triangles).area)
    return vertices / scale, triangles, rest


@pytest.fixture(scope="module")
def compared(body):
    vertices, triangles, _ = body
    surfaces = tuple(PartSurface(TriangleMesh(each, triangles)) for each in (vertices, vertices @ TURN.T))
    patches = tuple(oriented_patches(surface, COUNT) for surface in surfaces)
    candidates = patch_candidates(*patches)
    return surfaces, patches, candidates, compatibilities(candidates, surfaces, patches)


def test_every_place_is_recognised_and_mostly_how_it_is_turned(compared):
    _, (first, second), candidates, _ = compared
    np.testing.assert_array_equal(first.vertices, second.vertices)
    own = candidates.first == candidates.second
    assert set(candidates.first[own]) == set(range(COUNT))
    right = np.abs(candidates.rotations[own] - TURN).max(axis=(1, 2)) < 0.25
    assert set(candidates.first[own][right]) == set(range(COUNT))
    assert np.linalg.det(candidates.rotations) == pytest.approx(1)


def test_the_true_places_go_together_and_others_do_not(compared):
    _, _, candidates, together = compared
    own = np.flatnonzero(candidates.first == candidates.second)
    assert together[np.ix_(own, own)].mean() > 20 * together.mean()
    assert (together[candidates.first[:, None] == candidates.first] == 0).all()
    assert together.min() >= 0
    assert together.max() <= 1


def test_the_true_places_are_found_as_a_set(compared):
    _, patches, candidates, together = compared
    shares = np.full(COUNT, 1 / COUNT)
    best = consistent_sets(candidates, Together(together, candidates.first), patches, shares, Plan(np.inf, 20, 5))[0]
    np.testing.assert_array_equal(candidates.first[best.members], np.arange(COUNT))
    np.testing.assert_array_equal(candidates.second[best.members], np.arange(COUNT))
    assert best.weights.max() == pytest.approx(1)


def test_small_sets_stay_around_their_seeds_and_differ(compared):
    _, patches, candidates, together = compared
    shares = np.full(COUNT, 1 / COUNT)
    found = consistent_sets(candidates, Together(together, candidates.first), patches, shares, Plan(0.5, 30, 8))
    assert 1 <= len(found) <= 8
    for each in found:
        places = candidates.first[each.members]
        assert len(np.unique(places)) == len(places)
        assert patches[0].between[np.ix_(places, places)].max() <= 1.0 + 1e-9


def test_what_is_cut_off_is_not_seen_and_does_not_count(body, compared):
    vertices, triangles, rest = body
    both, faces = compacted(np.hstack([vertices, rest]), triangles[rest[triangles][:, :, 0].min(axis=1) > 0.05])
    half = PartSurface(TriangleMesh(both[:, :3], faces))
    seen = oriented_patches(half, COUNT)
    at_cut = half.border_distances[seen.vertices] < 0.05
    weights = seen.weights.mean(axis=(1, 2))
    assert at_cut.any()
    assert weights[at_cut].mean() < weights[~at_cut].mean()
    candidates = patch_candidates(seen, compared[1][0])
    there = rest[compared[1][0].vertices][candidates.second]
    here = both[seen.vertices, 3:][candidates.first]
    near = np.linalg.norm(there - here, axis=1) < 0.35
    assert len(np.unique(candidates.first[near])) > 0.8 * COUNT


def test_every_place_is_a_seed_before_any_place_is_one_twice():
    support = np.array([9, 8, 7, 1, 3, 2], np.float32)
    first = np.array([0, 0, 0, 1, 2, 2])
    np.testing.assert_array_equal(_seeds(support, first, 6), [0, 4, 3, 1, 5, 2])
    np.testing.assert_array_equal(_seeds(support, first, 2), [0, 4])
