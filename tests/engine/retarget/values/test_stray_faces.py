# SPDX-License-Identifier: GPL-3.0-or-later
"""Faces on the wrong side of a seam."""

from __future__ import annotations

import numpy as np

from engine.retarget.values.stray_faces import splinters, teeth
from tests.faces import grid


def seams_between(faces, labels):
    """Edges between faces of different labels."""
    seams = np.zeros(len(faces.edges), bool)
    pairs = faces.neighbours
    apart = np.ptp(labels[faces.corner_faces[pairs]], axis=1) > 0
    seams[faces.corner_edges[pairs[apart, 0]]] = True
    return seams


def found_teeth(labels, movable=None):
    vertices, faces, _ = grid(20, 20)
    lengths = np.linalg.norm(np.diff(vertices[faces.edges], axis=1)[:, 0], axis=1)
    movable = np.ones(400, bool) if movable is None else movable
    return teeth(faces, seams_between(faces, labels), movable, faces.face_areas(vertices), lengths)


def test_a_face_that_reaches_into_another_part_is_a_tooth():
    labels = np.where(np.arange(400) % 20 < 10, 0, 1)
    assert not len(found_teeth(labels)[0])
    labels[210] = 0  # the first of the right half in the eleventh row
    stray, beside = found_teeth(labels)
    np.testing.assert_array_equal(stray, [210])
    assert labels[beside] == 1
    assert not len(found_teeth(labels, np.arange(400) != 210)[0])


def test_teeth_that_only_touch_at_a_corner_go_together():
    labels = np.where(np.arange(400) % 20 < 10, 0, 1)
    labels[210], labels[229] = 0, 1
    stray, beside = found_teeth(labels)
    np.testing.assert_array_equal(stray, [210, 229])
    np.testing.assert_array_equal(labels[beside], [1, 0])


def test_small_sheets_are_not_eaten_up():
    labels = np.zeros(400, int)
    labels[[210, 211, 230]] = 1
    assert not len(found_teeth(labels)[0])


def test_a_small_part_of_a_large_sheet_is_a_splinter():
    vertices, faces, _ = grid(20, 20)
    labels = np.where(np.arange(400) % 20 < 10, 0, 1)
    labels[[205, 206]] = 1
    areas = faces.face_areas(vertices)
    areas[[205, 206]] /= 10
    stray, beside = splinters(faces, seams_between(faces, labels), labels, areas)
    np.testing.assert_array_equal(stray, [205, 206])
    assert (labels[beside] == 0).all()


def test_a_small_sheet_is_none():
    vertices, faces, _ = grid(20, 20)
    labels = np.zeros(400, int)
    labels[210] = 1
    assert not len(splinters(faces, seams_between(faces, labels), labels, faces.face_areas(vertices))[0])
