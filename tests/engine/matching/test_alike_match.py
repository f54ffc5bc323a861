# SPDX-License-Identifier: GPL-3.0-or-later
"""Open surfaces that have about the same spectrum: matched as they are, unless they might still be parts."""

from types import SimpleNamespace

import numpy as np
import pytest

from engine import MatchError, MatchSettings, Shape, TriangleMesh, match
from engine.dense.credibility import ALL_ALIKE
from engine.matching.alike_match import alike_match_steps
from engine.matching.shape_matching import MatchTask
from engine.runtime.progress import run
from tests.shapes import compacted, creature

QUICK = MatchSettings(points=12, samples=100, hypotheses=2)
BEHIND = -0.45
"""Where, along the body at rest, what is behind is cut off."""


def front(pose, resolution, turn=0.0, behind=BEHIND):
    vertices, triangles, rest = creature(pose, resolution, turn=turn)
    both, faces = compacted(np.hstack([vertices, rest]), triangles[rest[triangles][:, :, 0].min(axis=1) > behind])
    return TriangleMesh(both[:, :3], faces), both[:, 3:]


@pytest.fixture(scope="module")
def fronts():
    """One part of a body in two poses, of other triangles: meshes, and where their vertices are at rest."""
    return front(0.0, 9), front(0.5, 10, turn=0.7)


@pytest.fixture
def tried(fronts, monkeypatch):
    """What comes of two poses of one part if the match as they are is this, and how it was asked for."""

    def result_of(other):
        asked = []

        def matched_steps(_x, _y, task):
            asked.append(task)
            if other is None:
                raise MatchError("The surfaces are not enough alike to be matched.")
            return other
            yield

        monkeypatch.setattr("engine.matching.alike_match.matched_steps", matched_steps)
        return run(alike_match_steps(*(Shape(mesh) for mesh, _ in fronts), MatchTask(QUICK, None))), asked

    return result_of


def test_one_surface_in_two_poses_is_matched_without_a_search_for_what_is_shared(fronts, monkeypatch):
    monkeypatch.setattr("engine.matching.matching.overlap_match_steps", lambda *_: pytest.fail("searched"))
    (source, rest), (target, image_rest) = fronts
    result = match(source, target, QUICK)
    found = result.source_to_target
    images = np.einsum("kc,kcd->kd", found.barycentric, image_rest[found.corners])
    assert np.linalg.norm(images - rest, axis=1).mean() / 2.4 < 0.02
    assert found.has_partner.mean() > 0.95
    assert result.quality.confidence > 0.8


def test_a_surface_of_which_much_more_is_missing_is_not_matched_as_it_is(fronts, monkeypatch):
    monkeypatch.setattr("engine.matching.alike_match.matched_steps", lambda *_: pytest.fail("matched"))
    shapes = Shape(fronts[0][0]), Shape(front(0.5, 9, behind=0.1)[0])
    assert run(alike_match_steps(*shapes, MatchTask(QUICK, None))) is None


def test_a_match_that_leaves_room_for_missing_parts_is_none(tried):
    result, (task,) = tried(None)
    assert result is None
    assert task.least == task.least_softly > 20


@pytest.mark.parametrize(("likeness", "taken"), [(ALL_ALIKE + 0.1, True), (ALL_ALIKE - 0.1, False)])
def test_a_match_is_the_result_if_nothing_can_be_missing_by_it(tried, likeness, taken):
    other = SimpleNamespace(dense=SimpleNamespace(quality=SimpleNamespace(likeness=likeness)))
    assert tried(other)[0] is (other if taken else None)
