# SPDX-License-Identifier: GPL-3.0-or-later
"""The ways in which one surface may overlap with another: different ones, the right one among the first."""

import numpy as np
import pytest

from engine import TriangleMesh, run
from engine.matching.overlap import overlap_search
from engine.matching.overlap.oriented_patches import oriented_patches
from engine.matching.overlap.overlap_search import PATCHES, CoarsePair, overlap_fits_steps, regrown, scored_fit
from engine.matching.overlap.part_registration import FAST, register_parts
from engine.matching.overlap.part_surface import PartSurface
from tests.shapes import compacted, creature, rotation

CUT = 0.45
"""How far behind the middle the front part goes on, and before it the rear part does."""

COARSE = 800

LAST = 4
"""Rounds after which the last ones begin."""


@pytest.fixture(scope="module")
def parts():
    """The front and the rear of a creature, and where the vertices of either lie on the whole."""
    vertices, triangles, rest = creature(0.0, 10)
    vertices = vertices / np.sqrt(TriangleMesh(vertices, triangles).area)
    ahead = rest[triangles][:, :, 0]
    shown = ahead.max(axis=1) > -CUT, ahead.min(axis=1) < CUT
    return [compacted(vertices, triangles[each]) for each in shown]


@pytest.fixture(scope="module")
def turn():
    return rotation([1.0, -0.5, 2.0], 2.1)


@pytest.fixture(scope="module")
def pair(parts, turn):
    (front, faces), (rear, others) = parts
    surfaces = PartSurface(TriangleMesh(front, faces)), PartSurface(TriangleMesh(rear @ turn.T, others))
    coarse = tuple(run(surface.proxy_steps(COARSE)) for surface in surfaces)
    patches = tuple(oriented_patches(surface, PATCHES) for surface in surfaces)
    return CoarsePair(surfaces, coarse, patches)


@pytest.fixture(scope="module")
def fits(pair):
    return run(overlap_fits_steps(pair))


def test_the_most_credible_way_is_the_right_one(pair, fits, turn):
    truth = pair.coarse[0].vertices @ turn.T
    best = fits[0].fit
    errors = np.linalg.norm(best.positions - truth, axis=1)[best.members]
    assert best.members.any()
    assert np.median(errors) < 0.02


def test_a_right_way_that_is_lost_in_the_last_rounds_is_grown_again(pair, turn, monkeypatch):
    """Limbs that lie wrongly may strain the right way so much at last that others seem better."""
    truth = pair.coarse[0].vertices @ turn.T
    lost = []

    def strained(source, target, start, rounds, *, done=0, **options):
        fit = register_parts(source, target, start, rounds, done=done, **options)
        is_right = np.median(np.linalg.norm(fit.positions - truth, axis=1)) < 0.1
        if done == LAST and is_right:
            lost.append(fit)
            around = fit.positions.mean(axis=0)
            fit = register_parts(source, target, around + (fit.positions - around) * [-1, -1, 1], rounds, done=done)
        return fit

    monkeypatch.setattr(overlap_search, "register_parts", strained)
    best = run(overlap_fits_steps(pair))[0].fit
    assert lost
    assert np.median(np.linalg.norm(best.positions - truth, axis=1)[best.members]) < 0.02


def test_ways_differ_and_are_in_order(fits):
    scores = [each.score for each in fits]
    assert scores == sorted(scores, reverse=True)
    for number, one in enumerate(fits):
        for other in fits[:number]:
            either = one.fit.members | other.fit.members
            apart = np.linalg.norm(one.fit.positions - other.fit.positions, axis=1)[either]
            assert np.median(apart) > 0.05


def test_what_fits_badly_is_let_go_when_the_rest_grows_again(pair):
    """One surface lies on itself, but all that is far to one side lies beside its place."""
    coarse = pair.coarse[0]
    aside = coarse.vertices[:, 1] > np.quantile(coarse.vertices[:, 1], 0.75)
    start = coarse.vertices + np.where(aside[:, None], [0.0, 0.0, 0.15], 0.0)
    wrong = scored_fit(coarse, coarse, register_parts(coarse, coarse, start, FAST[-1:]))
    again = regrown(coarse, coarse, wrong)
    errors = [np.linalg.norm(each.fit.positions - coarse.vertices, axis=1)[aside].mean() for each in (wrong, again)]
    assert again.score > wrong.score + 1
    assert errors[1] < errors[0] / 2
