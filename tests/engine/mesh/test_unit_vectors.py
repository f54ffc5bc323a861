# SPDX-License-Identifier: GPL-3.0-or-later
"""Vectors of length one."""

import numpy as np

from engine.mesh.unit_vectors import unit_vectors


def test_directions_stay_and_lengths_become_one():
    vectors = np.random.default_rng(0).normal(size=(50, 3)) * np.logspace(-150, 150, 50)[:, None]
    units = unit_vectors(vectors)
    np.testing.assert_allclose(np.linalg.norm(units, axis=1), 1, rtol=1e-12)
    np.testing.assert_allclose(np.cross(units, vectors) / np.linalg.norm(vectors, axis=1, keepdims=True), 0, atol=1e-12)
    assert (np.einsum("nd,nd->n", units, vectors) > 0).all()


def test_zero_and_what_is_as_short_as_said_become_zero():
    vectors = np.array([[0.0, 0, 0], [1e-7, 0, 0], [0, 2e-6, 0]])
    np.testing.assert_array_equal(unit_vectors(vectors), [[0, 0, 0], [1, 0, 0], [0, 1, 0]])
    np.testing.assert_array_equal(unit_vectors(vectors, 1e-6), [[0, 0, 0], [0, 0, 0], [0, 1, 0]])
