# SPDX-License-Identifier: GPL-3.0-or-later
from __future__ import annotations

from dataclasses import replace

import pytest
from hiermatch.engine import DOUBTFUL, MatchQuality, TriangleMesh
from hiermatch.hiermatch_addon.jobs.verdict import Verdict, advice_on

from tests.shapes import cylinder, icosphere

WHOLE = MatchQuality(1.0, 0.1, 0.98, 0.005, None, 0.8, "The shapes correspond closely.", 0.97)
TUBE, BALL = TriangleMesh(*cylinder()), TriangleMesh(*icosphere())
NAMES = ("Shirt", "Body")


def test_two_whole_bodies_get_no_advice():
    assert not advice_on(WHOLE, NAMES, (TUBE, BALL))
    assert not advice_on(WHOLE, NAMES, (BALL, BALL))


@pytest.mark.parametrize("as_source", [True, False])
def test_a_garment_is_known_by_its_ends(as_source):
    half = {"coverage": 0.5} if as_source else {"source_coverage": 0.5}
    names, meshes = (NAMES, (TUBE, BALL)) if as_source else (NAMES[::-1], (BALL, TUBE))
    said = advice_on(replace(WHOLE, **half), names, meshes)
    assert said.startswith('"Shirt" is open at 2 ends')
    assert "if it is one, fit it with Wear" in said


def test_a_part_without_ends_is_to_be_left_out():
    said = advice_on(replace(WHOLE, coverage=0.5), ("Bust", "Body"), (BALL, BALL))
    assert said.startswith('"Bust" looks like a part of "Body"')
    assert "if the match is wrong" in said
    assert "Leave Out" in said
    assert not advice_on(replace(WHOLE, coverage=0.5, source_coverage=0.6), ("Bust", "Body"), (BALL, BALL))


def test_a_half_under_a_mirror_modifier_is_said_to_be_one_unless_the_match_is_good():
    doubtful = replace(WHOLE, confidence=0.4, coverage=0.5)
    said = advice_on(doubtful, ("Man", "Half"), (BALL, TUBE), halves=(False, True))
    assert said.startswith('"Half" has a Mirror modifier')
    assert not advice_on(WHOLE, ("Man", "Half"), (BALL, TUBE), halves=(False, True))


@pytest.mark.parametrize("own", [0, 1])
def test_what_hangs_on_bones_is_to_be_hidden_if_the_match_is_doubtful(own):
    hung = (["Sword", "Shield"], []) if own == 0 else ([], ["Sword", "Shield"])
    names = ("Knight", "Man") if own == 0 else ("Man", "Knight")
    said = advice_on(replace(WHOLE, confidence=0.1, source_coverage=0.5), names, (BALL, BALL), hung=hung)
    assert said.startswith('What hangs on single bones of "Knight": "Sword", "Shield". Hide what "Man" has not')
    assert not advice_on(WHOLE, names, (BALL, BALL), hung=hung)


def test_doubt_begins_below_the_limit():
    for confidence in (0.0, DOUBTFUL - 0.01, DOUBTFUL, 1.0):
        verdict = Verdict.of(replace(WHOLE, confidence=confidence), "Mind the gap.")
        assert verdict.doubtful == (confidence < DOUBTFUL)
        assert verdict.said == f"Confidence {confidence:.0%}: The shapes correspond closely. Note: Mind the gap."
