# SPDX-License-Identifier: GPL-3.0-or-later
"""The choice between maps by landmarks."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
import pytest

from engine.dense import landmark_selection
from engine.dense.dense_hypotheses import SparseStart
from engine.dense.functional_maps import PointMaps
from engine.dense.landmark_selection import agrees, landmark_distance, steered_hypotheses_steps
from engine.runtime.progress import Progress, run
from engine.shapes.landmarks import LandmarkPlaces, Landmarks

COUNT = 21
PLACES = np.linspace(-1, 1, COUNT)
"""Vertices along a line in place of a surface; mirrored, each is exchanged with the one opposite."""

SAME = np.arange(COUNT)
MIRROR = SAME[::-1].copy()


@dataclass(frozen=True)
class Samples:
    rows: np.ndarray


@dataclass(frozen=True)
class Line:
    samples: Samples
    is_reflection: bool = False

    def reflected(self):
        return replace(self, is_reflection=True)


@dataclass(frozen=True)
class LineMap:
    """A map that takes vertex i to on_y[i], and back."""

    on_y: np.ndarray
    on_x: np.ndarray
    score: float = 0.0
    orientation: float = 1.0
    origin: str = ""
    domains: tuple = ()

    @property
    def images(self):
        return PointMaps(self.on_y, self.on_x)


def scene(pairs):
    """Two lines whose samples begin with landmarks, and these."""
    ends = [np.array(vertices) for vertices in zip(*pairs, strict=True)]
    lines = [Line(Samples(np.abs(PLACES[end][:, None] - PLACES))) for end in ends]
    return *lines, Landmarks(*(LandmarkPlaces(end, end, end) for end in ends))


def proposing(monkeypatch, direct, mirrored, alone=()):
    """Let these maps be found of the source, of its reflection, and of starts alone; return what was asked for."""
    asked = []

    def steps(x, _, starts, *, search=True, domains=None):
        asked.append((x.is_reflection, [start.origin for start in starts], search, domains is not None))
        yield Progress(0.0, "Proposing")
        return list(alone if domains is not None else mirrored if x.is_reflection else direct)

    def laid(x, y, count):
        return SparseStart(x.samples.rows[:count], y.samples.rows[:count], "mirrored" if x.is_reflection else "laid")

    monkeypatch.setattr(landmark_selection, "map_hypotheses_steps", steps)
    monkeypatch.setattr(landmark_selection, "laid_start", laid)
    return asked


def test_the_distance_is_that_of_images_from_partners_in_both_directions():
    x, y, landmarks = scene([(0, 0), (10, 10), (20, 16)])
    assert landmark_distance(x, y, landmarks, LineMap(SAME, SAME)) == pytest.approx(0.4 / 3)
    shifted = np.minimum(SAME + 1, COUNT - 1)
    there = (abs(1 - 0) + abs(11 - 10) + abs(20 - 16)) * 0.1
    back = (abs(0 - 0) + abs(10 - 10) + abs(16 - 20)) * 0.1
    assert landmark_distance(x, y, landmarks, LineMap(shifted, SAME)) == pytest.approx((there + back) / 6)


def test_maps_agree_up_to_what_rough_ones_are_off():
    x, y, landmarks = scene([(5, 5), (15, 15)])
    assert agrees(x, y, landmarks, LineMap(SAME, SAME))
    one, two = (LineMap(moved, moved) for moved in ((SAME + off).clip(max=COUNT - 1) for off in (1, 2)))
    assert agrees(x, y, landmarks, LineMap(one.on_y, SAME))
    assert not agrees(x, y, landmarks, two)


def test_where_the_best_map_agrees_no_reflection_is_tried(monkeypatch):
    x, y, landmarks = scene([(5, 5)])
    right, wrong = LineMap(SAME, SAME, 3.0), LineMap(MIRROR, MIRROR, 0.5, -1.0)
    asked = proposing(monkeypatch, [wrong, right], [])
    found = run(steered_hypotheses_steps(x, y, [], landmarks))
    assert asked == [(False, [], True, False)]
    assert found.x is x
    assert not found.mirrored
    # What contradicts the landmark comes last though it seemed better.
    assert [h.score for h in found.hypotheses] == pytest.approx([3.0, 0.5 + 20 * 1.0])
    assert found.hypotheses[0].images.on_y is SAME


def test_a_landmark_on_the_other_side_mirrors_the_map(monkeypatch):
    x, y, landmarks = scene([(5, 15)])
    proposing(monkeypatch, [LineMap(SAME, SAME)], [LineMap(SAME, SAME, 9.0), LineMap(MIRROR, MIRROR, 0.3)])
    found = run(steered_hypotheses_steps(x, y, [], landmarks))
    assert found.mirrored
    assert found.x.is_reflection
    assert found.hypotheses[0].images.on_y is MIRROR
    assert found.hypotheses[0].score == pytest.approx(0.3)


@pytest.mark.parametrize(("excess", "mirrored"), [(0.9, False), (1.1, True)])
def test_a_mirrored_map_has_to_be_clearly_more_credible(monkeypatch, excess, mirrored):
    x, y, landmarks = scene([(5, 15)])
    # Both agree, but the one that is proposed first, which is not mirrored, does not.
    direct = [LineMap(SAME, SAME), LineMap(MIRROR, MIRROR, 2.0 + excess)]
    proposing(monkeypatch, direct, [LineMap(MIRROR, MIRROR, 2.0)])
    found = run(steered_hypotheses_steps(x, y, [], landmarks))
    assert found.mirrored is mirrored
    assert found.hypotheses[0].score == pytest.approx(2.0 + excess * (not mirrored))


def test_mirrored_maps_of_the_reflection_do_not_count(monkeypatch):
    x, y, landmarks = scene([(5, 15)])
    proposing(monkeypatch, [LineMap(SAME, SAME)], [LineMap(MIRROR, MIRROR, 0.0, -1.0)])
    assert not run(steered_hypotheses_steps(x, y, [], landmarks)).mirrored


@pytest.mark.parametrize(("count", "own"), [(2, []), (3, ["landmarks", "laid"])])
def test_enough_landmarks_are_starts_of_their_own(monkeypatch, count, own):
    x, y, landmarks = scene([(2, 2), (9, 9), (15, 15)][:count])
    asked = proposing(monkeypatch, [LineMap(SAME, SAME)], [])
    other = SparseStart(x.samples.rows[:1], y.samples.rows[:1], "elsewhere")
    run(steered_hypotheses_steps(x, y, [other], landmarks, search=False))
    assert asked == [(False, ["elsewhere", *own], False, False)]


def test_starts_are_followed_alone_where_no_map_agrees(monkeypatch):
    x, y, landmarks = scene([(2, 18), (9, 11), (15, 5)])
    better = LineMap(MIRROR, MIRROR, 5.0, 1.0, "alone")
    asked = proposing(monkeypatch, [LineMap(SAME, SAME)], [LineMap(SAME, SAME, 1.0)], [better])
    found = run(steered_hypotheses_steps(x, y, [], landmarks))
    assert [(mirrored, origins) for mirrored, origins, _, _ in asked] == [
        (False, ["landmarks", "laid"]),
        (False, ["landmarks"]),
        (False, ["laid"]),
        (True, ["landmarks", "mirrored"]),
        (True, ["landmarks"]),
        (True, ["mirrored"]),
    ]
    assert not any(search for _, _, search, alone in asked if alone)
    assert not found.mirrored
    assert found.hypotheses[0].origin == "alone"
    assert [h.score for h in found.hypotheses] == sorted(h.score for h in found.hypotheses)


def test_progress_grows(monkeypatch):
    x, y, landmarks = scene([(2, 18), (9, 11), (15, 5)])
    proposing(monkeypatch, [LineMap(SAME, SAME)], [LineMap(SAME, SAME)], [LineMap(SAME, SAME)])
    fractions = [step.fraction for step in steered_hypotheses_steps(x, y, [], landmarks)]
    assert fractions == sorted(fractions)
    assert len(set(fractions)) == 6


@pytest.mark.parametrize(("off", "mirrored"), [(2, True), (4, False)])
def test_a_mirrored_map_is_taken_only_if_it_is_clearly_nearer_to_the_landmarks(monkeypatch, off, mirrored):
    x, y, landmarks = scene([(4, 9)])  # five vertices from where the direct map leads
    other = np.full(COUNT, 9 + off)
    back = np.full(COUNT, 4 + off)
    proposing(monkeypatch, [LineMap(SAME, SAME, 9.0)], [LineMap(other, back, 1.0)])
    assert run(steered_hypotheses_steps(x, y, [], landmarks)).mirrored is mirrored
