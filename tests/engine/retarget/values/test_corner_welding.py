# SPDX-License-Identifier: GPL-3.0-or-later
"""Corner values that are made the same, or told apart."""

from __future__ import annotations

import numpy as np

from engine.retarget.values.corner_welding import jumps, weld
from tests.faces import grid


def test_values_that_nearly_agree_become_the_same():
    vertices, faces, uvs = grid(4, 4)
    noise = np.random.default_rng(1).uniform(-1e-3, 1e-3, uvs.shape)
    known = np.ones(len(uvs), bool)
    welded = weld(uvs + noise, faces, np.zeros(16, int), known, 1e-9)
    assert not jumps(welded, faces, 0).any()
    np.testing.assert_allclose(welded, uvs, atol=1e-3)
    assert len(np.unique(welded, axis=0)) == len(vertices)


def test_guesses_follow_what_is_known():
    _, faces, uvs = grid(2, 1)
    known = np.array([True] * 4 + [False] * 4)
    moved = uvs + 0.05 * ~known[:, None]
    welded = weld(moved, faces, np.zeros(2, int), known, 1e-9)
    np.testing.assert_allclose(welded[:4], uvs[:4], atol=1e-6)
    np.testing.assert_array_equal(welded[faces.meeting_corners[0, :, 0]], welded[faces.meeting_corners[0, :, 1]])


def test_what_is_far_apart_or_on_another_sheet_is_left_alone():
    _, faces, uvs = grid(2, 1)
    known = np.ones(8, bool)
    far = uvs + [0.3, 0] * (faces.corner_faces == 1)[:, None]
    np.testing.assert_array_equal(weld(far, faces, np.zeros(2, int), known, 1e-9), far)
    near = uvs + [0.01, 0] * (faces.corner_faces == 1)[:, None]
    np.testing.assert_array_equal(weld(near, faces, np.arange(2), known, 1e-9), near)
    assert jumps(near, faces, 1e-9).sum() == 1
    assert not jumps(near, faces, 0.1).any()
