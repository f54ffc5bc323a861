# SPDX-License-Identifier: GPL-3.0-or-later
"""Corresponding places by laying one surface onto the other in space, so that landmarks coincide."""

from __future__ import annotations

import numpy as np
from scipy.interpolate import RBFInterpolator
from scipy.spatial import cKDTree

from ..geometry.procrustes import nearest_similarity
from ..shapes.shape import Shape
from .dense_hypotheses import SparseStart

_PLACES = 32
"""How many samples of each surface, the farthest first, are taken to the nearest one of the other: landmarks alone,
such as those of hands and feet, may not tell front from back.  Twice as many led to the same maps of a knight and a man
of ``python -m tests.benchmarks.maker_rigs --guided``, tried once."""

_SMOOTHING = 1e-6
"""By how much the system that bends the source is regularised, in sqrt(area), so that landmarks may be at one place:
they coincide but for about as much."""


def laid_start(x: Shape, y: Shape, count: int) -> SparseStart:
    """Take places of either surface to the nearest ones of the other where landmarks lie on each other.

    The source is moved by the similarity that brings its landmarks nearest to their partners, and then bent so that
    they coincide: by radial functions, the distance from each.  How limbs that differ in length are stretched along
    the surface does not matter for that, so that it leads where distances along surfaces do not agree.

    Parameters
    ----------
    x, y : Shape
        The surfaces, whose samples begin with the landmarks.
    count : int
        How many landmarks there are, 3 at least.

    Returns
    -------
    SparseStart
        The landmarks and these places.
    """
    here, there = (s.mesh.vertices[s.samples.vertices] / np.sqrt(s.mesh.area) for s in (x, y))
    linear, translation = nearest_similarity(here[:count], there[:count])
    moved = here @ linear.T + translation
    pull = RBFInterpolator(moved[:count], there[:count] - moved[:count], kernel="linear", smoothing=_SMOOTHING)
    bent = moved + pull(moved)
    landmarks = np.arange(count)
    of_x, of_y = (np.arange(count, min(count + _PLACES, len(s.samples))) for s in (x, y))
    to_y, to_x = cKDTree(there).query(bent[of_x])[1], cKDTree(bent).query(there[of_y])[1]
    rows = np.concatenate([landmarks, of_x, to_x]), np.concatenate([landmarks, to_y, of_y])
    return SparseStart(x.samples.rows[rows[0]], y.samples.rows[rows[1]], "landmarks in space")
