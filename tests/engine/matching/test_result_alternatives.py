# SPDX-License-Identifier: GPL-3.0-or-later
"""Several right answers: bodies that look the same from several sides."""

from functools import cache

import numpy as np
import pytest

from engine import MatchSettings, TriangleMesh, densify, match, match_steps
from tests.bodies import mirrored_body, starfish, table, two_headed
from tests.shapes import creature, permuted, rotation

SETTINGS = MatchSettings(points=24, samples=120, hypotheses=2)
NEAR = 0.06
"""Mean distance, in sqrt(area), up to which an answer is one of the true ones."""


SHAPES = {"starfish": (starfish, 5, 3), "table": (table, 2, 1), "two heads": (two_headed, 2, 1)}
"""Bodies, in how many ways each can be turned about z, and how many of these are offered beside the best, at least."""


def turns(count):
    """The rotations that leave a body the same."""
    return [rotation([0.0, 0.0, 1.0], 2 * np.pi * number / count) for number in range(count)]


def turn_of(sources, images, scale, count):
    """Which turn takes places (k, 3) to images (k, 3) best, and how far it is from doing so, in sqrt(area)."""
    away = [np.linalg.norm(sources @ turn.T - images, axis=1).mean() / scale for turn in turns(count)]
    return int(np.argmin(away)), min(away)


@cache
def matched(name):
    """A body in two meshings, and its result."""
    meshes = TriangleMesh(*SHAPES[name][0](6)), TriangleMesh(*SHAPES[name][0](6, 0.4))
    return *meshes, match(*meshes, SETTINGS)


@pytest.fixture(params=SHAPES)
def symmetric(request):
    """A body in two meshings, its result, in how many ways it can be turned, and how many are offered at least."""
    return *matched(request.param), *SHAPES[request.param][1:]


def test_the_answers_are_right_and_different(symmetric):
    _, target, result, count, fewest = symmetric
    scale = np.sqrt(target.area)
    answers = [result, *(answer for answer in result.alternatives if answer is not result.mirrored)]
    assert len(answers) > fewest
    found = [
        turn_of(answer.source_points.positions, answer.target_points.positions, scale, count) for answer in answers
    ]
    assert max(away for _, away in found) < NEAR
    assert len({turn for turn, _ in found}) == len(answers)
    for answer in answers[1:]:
        np.testing.assert_array_equal(answer.source_points.positions, result.source_points.positions)
        assert not answer.alternatives
        assert answer.orientation > 0
        # Each point lies on the target.
        corners = target.vertices[answer.target_points.corners]
        places = np.einsum("kc,kcd->kd", answer.target_points.barycentric, corners)
        np.testing.assert_allclose(places, answer.target_points.positions, atol=1e-9)


def test_names_and_the_sentence_tell_of_them(symmetric):
    result = symmetric[2]
    turned = [answer.name for answer in result.alternatives if answer.name != "mirrored"]
    assert result.name == "direct"
    assert turned == [f"turned {number + 1}" for number in range(len(turned))]
    assert result.quality.alternatives == len(turned)
    assert result.quality.sentence.startswith(f"{len(turned) + 1} maps are about as likely")
    if result.mirrored is not None:
        assert result.alternatives[0] is result.mirrored


def test_progress_rises_where_there_are_several(symmetric):
    source, target, *_ = symmetric
    fractions = [progress.fraction for progress in match_steps(source, target, SETTINGS)]
    assert fractions == sorted(fractions)


def test_the_dense_map_of_an_answer_is_that_answer(symmetric):
    source, target, result, count, _ = symmetric
    answer = result.alternatives[-1]
    margin, others = result.quality.margin, result.quality.alternatives
    points = answer.source_points, answer.target_points
    dense = densify(source, target, *points, margin=margin, alternatives=others)
    scale = np.sqrt(target.area)
    turn, _ = turn_of(answer.source_points.positions, answer.target_points.positions, scale, count)
    for here, found, way in (
        (source, dense.source_to_target, turns(count)[turn]),
        (target, dense.target_to_source, turns(count)[turn].T),
    ):
        away = np.linalg.norm(here.vertices @ way.T - found.positions, axis=1) / scale
        assert away.mean() < NEAR / 2
    assert dense.quality.margin <= margin
    assert dense.quality.sentence == result.quality.sentence
    assert dense.quality.confidence == pytest.approx(result.quality.confidence, abs=0.05)


def test_the_order_of_vertices_does_not_matter():
    source, target, result = matched("starfish")
    vertices, triangles, _ = permuted(target.vertices, target.triangles, seed=3)
    again = match(source, TriangleMesh(vertices, triangles), SETTINGS)
    offered = [
        {
            turn_of(answer.source_points.positions, answer.target_points.positions, np.sqrt(target.area), 5)[0]
            for answer in (one, *one.alternatives)
            if answer.name != "mirrored"
        }
        for one in (result, again)
    ]
    assert offered[0] == offered[1]
    assert len(offered[0]) >= 4


def test_that_no_landmarks_correspond_may_be_assumed():
    source, target, result = matched("table")
    again = match(source, target, SETTINGS, landmarks=[], assumed=True)
    assert [answer.name for answer in again.alternatives] == [answer.name for answer in result.alternatives]
    assert again.quality.margin == result.quality.margin


@pytest.mark.parametrize("symmetric_to_itself", [False, True])
def test_bodies_without_such_symmetry_have_only_a_mirrored_answer(symmetric_to_itself):
    make = mirrored_body if symmetric_to_itself else creature
    first, second = make(0.0, 9), make(0.7, 9)
    result = match(TriangleMesh(*first[:2]), TriangleMesh(*second[:2]), SETTINGS)
    assert {answer.name for answer in result.alternatives} <= {"mirrored"}
    assert result.quality.alternatives == 0
    if symmetric_to_itself:
        assert result.mirrored is not None
