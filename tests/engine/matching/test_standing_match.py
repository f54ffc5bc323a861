# SPDX-License-Identifier: GPL-3.0-or-later
"""Matches of bodies of very different proportions, by the ends of their limbs."""

from dataclasses import replace

import numpy as np
import pytest

from engine import MatchError, MatchSettings, Shape, TriangleMesh, match
from engine.matching.shape_matching import MatchTask, sampled_steps
from engine.matching.standing_match import standing_ends, standing_match_steps
from engine.runtime.progress import run
from tests.people import figure_surface
from tests.shapes import creature, icosphere, rotation

QUICK = MatchSettings(points=12, samples=200, hypotheses=2)
NOTE = "the ends of their limbs were taken for the same"


@pytest.fixture(scope="module")
def toy():
    """A figure with a large head on short legs, and the bone of each vertex."""
    return figure_surface(head=4.0, legs=0.3, arms=0.6, apart=0.12)


@pytest.fixture(scope="module")
def usual():
    return figure_surface()


@pytest.fixture(scope="module")
def result(toy, usual):
    return match(toy[0], usual[0], QUICK)


def paired(first, second):
    """Pair the ends of limbs of two meshes: vertices (k, 2)."""
    x, y = Shape(first), Shape(second)
    run(sampled_steps(x, y, QUICK))
    pairs = standing_ends(x, y)
    return np.stack([s.vertices[s.samples.vertices[own]] for s, own in zip((x, y), pairs.T, strict=True)], axis=1)


def limb(bones):
    """What each bone is part of, with its side."""
    limbs = {"upper_arm": "arm", "forearm": "arm", "hand": "arm", "thigh": "leg", "shin": "leg", "foot": "leg"}
    limbs |= {"toe": "leg", "head": "head"}
    return np.array([limbs.get(name.split(".")[0], "trunk") + name[-2:].replace("ad", "") for name in bones])


# --- ends


def test_hands_feet_and_heads_of_a_toy_and_a_usual_body_are_paired(toy, usual):
    pairs = paired(toy[0], usual[0])
    here, there = limb(toy[1])[pairs[:, 0]], limb(usual[1])[pairs[:, 1]]
    assert sorted(here) == ["arm.L", "arm.R", "head", "leg.L", "leg.R"]
    assert (here == there).all()


def test_pairs_do_not_depend_on_place_and_size(toy, usual):
    moved = TriangleMesh(30 * toy[0].vertices + [5.0, -2.0, 1.0], toy[0].triangles)
    assert {tuple(pair) for pair in paired(moved, usual[0])} == {tuple(pair) for pair in paired(toy[0], usual[0])}


@pytest.mark.parametrize(("axis", "angle"), [((1, 0, 0), np.pi), ((0, 1, 0), np.pi / 2)])
def test_bodies_that_do_not_stand_alike_have_no_pairs(toy, usual, axis, angle):
    lying = TriangleMesh(toy[0].vertices @ rotation(axis, angle).T, toy[0].triangles)
    assert len(paired(lying, usual[0])) == 0


def test_a_person_and_a_four_legged_creature_have_no_pairs(usual):
    assert len(paired(usual[0], TriangleMesh(*creature(0.0, 12)[:2]))) == 0


def test_a_ball_has_no_ends_to_pair(usual):
    assert len(paired(TriangleMesh(*icosphere(8)), usual[0])) == 0


# --- matches


def test_limbs_of_a_toy_go_to_those_of_a_usual_body_with_little_confidence(toy, usual, result):
    assert any(NOTE in note for note in result.notes)
    assert result.quality.confidence < 0.3
    found = result.source_to_target
    nearest = usual[0].triangles[found.triangles, found.barycentric.argmax(axis=1)]
    here, there = limb(toy[1]), limb(usual[1])[nearest]
    for each in ("arm.L", "arm.R", "leg.L", "leg.R"):
        assert (there[here == each] == each).mean() > 0.5


def test_what_was_only_tried_is_no_landmark(result):
    assert result.quality.likeness is not None
    assert result.source_to_target.confidence.max() < 0.5


@pytest.fixture
def tried(toy, usual, result, monkeypatch):
    """What comes of a match that is known so well (confidence, pieces alone), if the other match is this one."""
    shapes = Shape(toy[0]), Shape(usual[0])

    def standing(confidence, alone, other):
        def matched_steps(*_given):
            if other is None:
                raise MatchError("Two ends are at one vertex.")
            return replace(result, quality=replace(result.quality, confidence=other))
            yield

        monkeypatch.setattr("engine.matching.standing_match.matched_steps", matched_steps)
        known = replace(result, quality=replace(result.quality, confidence=confidence, pieces_alone=alone))
        return run(standing_match_steps(known, *shapes, MatchTask(QUICK, None)))

    return standing


@pytest.mark.parametrize(
    ("confidence", "alone", "other", "taken"),
    [
        (0.05, 0.0, 0.06, True),
        (0.05, 0.0, 0.05, False),
        (0.15, 0.0, 0.2, False),  # not hopeless
        (0.15, 0.3, 0.05, True),  # a main part that was taken for all of a body
        (0.35, 0.3, 0.4, False),  # beside which there is more, but it is clear
        (0.05, 0.0, None, False),  # the ends cannot be used
    ],
)
def test_the_more_credible_match_is_taken_if_the_known_one_is_hopeless(tried, confidence, alone, other, taken):
    assert (tried(confidence, alone, other) is not None) == taken


def test_where_landmarks_are_known_no_ends_are_paired(toy, usual):
    pairs = paired(toy[0], usual[0])[:1]
    assert not any(NOTE in note for note in match(toy[0], usual[0], QUICK, landmarks=pairs).notes)


def test_bodies_that_are_alike_are_matched_as_they_are(usual):
    posed = figure_surface(turn=0.8)[0]
    assert not any(NOTE in note for note in match(usual[0], posed, QUICK).notes)
