# SPDX-License-Identifier: GPL-3.0-or-later
"""The pair under the mouse: computed as plain data, so it needs no window."""

from __future__ import annotations

from types import SimpleNamespace

import bpy
import numpy as np
import pytest
from hiermatch.hiermatch_addon.overlay.hover import HIERMATCH_GT_hover
from hiermatch.hiermatch_addon.overlay.hover_data import hovered, pointed_at
from hiermatch.hiermatch_addon.overlay.overlay_data import Drawing, Marks, Shown, drawing

from tests.addon.scenes import QUICK, add_pair

SIZE = (200, 100)
"""Of the viewport; without perspective, normalised coordinates from -1 to 1 fill it."""

FLAT = np.eye(4)


def marks(source, target):
    return Marks(np.array(source, float), np.array(target, float), np.arange(5, 5 + len(source)))


PAIRS = marks([[-0.5, 0, 0], [0.5, 0, 0]], [[-0.5, 0.8, 0], [0.5, 0.8, 0]])
LANDMARKS = marks([[0, -0.8, 0]], [[0, 0.4, 0]])


@pytest.fixture
def drawn():
    return drawing(PAIRS, np.array([0.25, 0.5]), LANDMARKS, np.array([True]), Shown())


@pytest.mark.parametrize(
    ("mouse", "row"),
    [((50, 50), 0), ((53, 47), 0), ((150, 90), 1), ((100, 10), 2), ((100, 70), 2), ((100, 50), -1), ((60, 50), -1)],
)
def test_the_nearest_place_counts_on_either_mesh(drawn, mouse, row):
    assert pointed_at(drawn, FLAT, SIZE, mouse, 9.0) == row


def test_nothing_drawn_is_nothing_to_point_at():
    assert pointed_at(Drawing(), FLAT, SIZE, (50, 50), 1e9) == -1
    assert hovered(Drawing(), 0, FLAT, SIZE) is None


def test_points_that_are_not_drawn_cannot_be_pointed_at():
    landmarks = np.array([True])
    drawn = drawing(PAIRS, np.array([0.25, 0.5]), LANDMARKS, landmarks, Shown(points=False))
    assert pointed_at(drawn, FLAT, SIZE, (50, 50), 9.0) == -1
    assert pointed_at(drawn, FLAT, SIZE, (100, 70), 9.0) == 0


def test_what_is_shown_of_it(drawn):
    point, landmark = (hovered(drawn, row, FLAT, SIZE) for row in (1, 2))
    assert point.ends == pytest.approx(np.array([[150, 50, 0], [150, 90, 0]]))
    assert point.ends.dtype == np.float32
    assert (point.landmark, point.number, point.distortion) == (False, 6, 0.5)
    assert (landmark.landmark, landmark.number, landmark.distortion) == (True, 5, None)
    assert hovered(drawn, 3, FLAT, SIZE) is None
    assert hovered(drawn, -1, FLAT, SIZE) is None


def test_what_is_behind_the_eye_is_left_out():
    perspective = np.array([[1.0, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, -1, 0]])  # looks along -z
    drawn = drawing(marks([[0, 0, -1]], [[0, 0, 1]]), np.array([0.1]), LANDMARKS, np.array([True]), Shown())
    assert pointed_at(drawn, perspective, SIZE, (100, 50), 9.0) == 0
    assert hovered(drawn, 0, perspective, SIZE).ends == pytest.approx(np.array([[100, 50, 0]]))


@pytest.mark.parametrize(("row", "pair", "landmark"), [(3, 3, 0), (12, 0, 0), (13, 0, 1), (-1, 0, 0)])
def test_a_click_makes_it_the_active_one(row, pair, landmark):
    scene = bpy.context.scene
    scene.hiermatch.source, scene.hiermatch.target = add_pair()
    bpy.ops.hiermatch.match(**QUICK)
    for vertex in (0, 40):
        bpy.ops.hiermatch.add_landmark(source_vertex=vertex, target_vertex=vertex)
    steering = scene.hiermatch_steering
    steering.pair_index = steering.landmark_index = 0
    assert HIERMATCH_GT_hover.invoke(SimpleNamespace(row=row), bpy.context, None) == {"FINISHED"}
    assert (steering.pair_index, steering.landmark_index) == (pair, landmark)
