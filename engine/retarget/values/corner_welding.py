# SPDX-License-Identifier: GPL-3.0-or-later
"""Values at corners of faces that meet: made the same where they belong together, and told apart elsewhere."""

from __future__ import annotations

import numpy as np

from ...mesh.connectivity.components import joined_components
from ...mesh.polygons import Polygons
from ...runtime.arrays import Bools, Floats, Ints, group_sums, marked

_WELD = 0.25
"""Corners that meet on the same sheet belong together if they differ by less than this part of the edge there."""

_WELD_GUESSES = 0.5
"""The same where one of them was guessed."""

_UNKNOWN_WEIGHT = 1e-6
"""What a corner whose value was guessed counts where it is welded to one that is known."""


def weld(values: Floats, polygons: Polygons, labels: Ints, known: Bools, tolerance: float) -> Floats:
    """Give corners that meet at an edge of two faces on one sheet the same values, if they nearly are already.

    Parameters
    ----------
    values : (l, d) array of float
        Values at the corners.
    polygons : Polygons
        The faces.
    labels : (f,) array of int
        The sheet that each face is on.
    known : (l,) array of bool
        Which values are known; the others are guesses, and follow those that they are welded to.
    tolerance : float
        Corners that differ by less are welded in any case.

    Returns
    -------
    (l, d) array of float
        The values, where welded their mean.
    """
    meeting = polygons.meeting_corners  # (p, ends, sides)
    faces = polygons.corner_faces[meeting[:, 0]]
    lengths = np.linalg.norm(values[meeting[:, 1]] - values[meeting[:, 0]], axis=2)  # (p, sides)
    apart = np.linalg.norm(values[meeting[:, :, 1]] - values[meeting[:, :, 0]], axis=2)  # (p, ends)
    part = np.where(known[meeting].all(axis=(1, 2)), _WELD, _WELD_GUESSES)
    close = apart.max(axis=1) <= np.maximum(part * lengths.min(axis=1), tolerance)
    joined = meeting[close & (labels[faces[:, 0]] == labels[faces[:, 1]])].reshape(-1, 2)
    group = joined_components(polygons.corner_count, *joined.T)
    weights = np.where(known, 1.0, _UNKNOWN_WEIGHT)
    total = np.bincount(group, weights)
    means = group_sums(group, weights[:, None] * values, len(total)) / total[:, None]
    return means[group]


def jumps(values: Floats, polygons: Polygons, tolerance: float) -> Bools:
    """Say of each edge (e,) whether corner values (l, d) differ by more than a tolerance between its faces."""
    meeting = polygons.meeting_corners
    apart = (np.abs(values[meeting[:, :, 1]] - values[meeting[:, :, 0]]) > tolerance).any(axis=(1, 2))
    return marked(polygons.corner_edges[polygons.neighbours[apart, 0]], len(polygons.edges))
