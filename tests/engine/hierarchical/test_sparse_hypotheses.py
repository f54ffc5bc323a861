# SPDX-License-Identifier: GPL-3.0-or-later
from dataclasses import replace
from itertools import combinations

import numpy as np
import pytest

from engine import MatchSettings, Shape, TriangleMesh
from engine.hierarchical.sampled_pair import Pair
from engine.hierarchical.sparse_hypotheses import choose_steps, coarse_steps
from engine.runtime.progress import run
from tests.shapes import creature

SPARSE = MatchSettings(points=20, samples=100, coarse_points=8, coarse_candidates=16, hypotheses=5, dense=False)


@pytest.fixture(scope="module")
def shapes():
    found = [Shape(TriangleMesh(*creature(pose, 10)[:2])) for pose in (0.0, 0.6)]
    for shape in found:
        run(shape.sample_steps(SPARSE.samples))
    return found


def test_half_as_many_coarse_matchings_are_followed_where_a_dense_map_decides(shapes):
    many, few = (run(coarse_steps(Pair(*shapes, replace(SPARSE, dense=dense)))) for dense in (False, True))
    assert len(many) == 5
    assert len(few) == 3
    for first, second in zip(many, few, strict=False):
        assert first.matching.cost == pytest.approx(second.matching.cost)


def test_coarse_matchings_by_eigenfunctions_are_distinct_too(shapes):
    for shape in shapes:
        run(shape.spectrum_steps(30))
    coarse = run(coarse_steps(Pair(*shapes, replace(SPARSE, descriptor="eigenfunctions"))))
    assert len(coarse) == SPARSE.hypotheses
    for first, second in combinations([each.matching.assignment for each in coarse], 2):
        moved = shapes[1].samples.distances[first, second] > 0.2
        assert moved.sum() >= 4


def test_only_the_ratio_of_the_weights_matters(shapes):
    usual, small = (
        run(choose_steps(run(coarse_steps(Pair(*shapes, replace(SPARSE, linear_weight=w, quadratic_weight=w))))))
        for w in (1.0, 1e-3)
    )
    for first, second in zip(usual, small, strict=True):
        np.testing.assert_array_equal(first.assignment, second.assignment)


def test_mirrored_answers_of_a_bijective_match_need_no_more_candidates(shapes):
    few = replace(SPARSE, constraint="bijective", coarse_candidates=3)
    keeping, mirroring = run(choose_steps(run(coarse_steps(Pair(*shapes, few)))[:1]))
    assert keeping.orientation > 0.3
    assert mirroring.orientation < -0.3


@pytest.mark.parametrize("followed", [1, 3])
@pytest.mark.parametrize("dense", [False, True])
def test_the_better_answer_of_either_orientation_is_chosen(shapes, dense, followed):
    coarse = run(coarse_steps(Pair(*shapes, replace(SPARSE, dense=dense))))
    keeping, mirroring = run(choose_steps(coarse[:followed]))
    assert keeping.orientation > 0.3
    assert mirroring.orientation < -0.3


@pytest.mark.parametrize("dense", [False, True])
def test_more_coarse_points_than_are_screened_are_all_kept(shapes, dense):
    settings = replace(SPARSE, points=30, coarse_points=23, coarse_candidates=24, node_limit=2000, dense=dense)
    answers = run(choose_steps(run(coarse_steps(Pair(*shapes, settings)))[:1]))
    assert all(len(level.assignment) >= 23 for answer in answers for level in answer.levels)
    assert answers[0].orientation > 0.3
