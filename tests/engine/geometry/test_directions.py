# SPDX-License-Identifier: GPL-3.0-or-later
"""Directions that are spread over the sphere."""

import numpy as np
from scipy.spatial.distance import pdist

from engine.geometry.directions import spread_directions


def test_directions_are_unit_vectors_spread_evenly():
    directions = spread_directions(40)
    np.testing.assert_allclose(np.linalg.norm(directions, axis=1), 1)
    np.testing.assert_allclose(directions.mean(axis=0), 0, atol=0.02)
    # Each has about an equal part of the sphere for itself.
    assert pdist(directions).min() > 0.75 * np.sqrt(4 * np.pi / 40)
