# SPDX-License-Identifier: GPL-3.0-or-later
"""Maps of all vertices of two meshes, there and back, from those of their main parts, and their confidence."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...mesh.surface_points import SurfacePoints
from ...repair.clean_surface import CleanSurface
from ...runtime.arrays import Floats
from ...runtime.progress import Progress, Steps, within
from ..missing_parts import round_trips
from ..quality import trip_confidence
from .component_maps import FollowedMap, follow_steps


@dataclass(frozen=True, eq=False)
class WholeMap:
    """A map of all vertices of a mesh.

    Attributes
    ----------
    points : SurfacePoints
        For each vertex of X, a point of ``y.original``.
    confidence : (n,) array of float
        For each, from 0 to 1, how far to trust it.
    alone : float
        Part of the surface of X that is in separate pieces without one of Y.
    share : float
        Mean confidence of the whole surface, as a part of that of its main part.
    """

    points: SurfacePoints
    confidence: Floats
    alone: float
    share: float


def whole_maps_steps(
    x: CleanSurface,
    y: CleanSurface,
    there: SurfacePoints,
    back: SurfacePoints,
    *,
    confidences: tuple[Floats, Floats],
    credibility: float,
) -> Steps[tuple[WholeMap, WholeMap]]:
    """Extend maps of the main parts to all vertices of the meshes.

    Parameters
    ----------
    x, y : CleanSurface
        The meshes.
    there, back : SurfacePoints
        For each vertex of ``x.mesh`` a point of ``y.mesh``, and the other way round.
    confidences : pair of arrays of float
        How far the images of the vertices of ``x.mesh`` and of ``y.mesh`` may be trusted, see `JudgedMap`.
    credibility : float
        How credible the maps are as a whole, see `vertex_credibility`.

    Returns
    -------
    pair of WholeMap
        The maps of all vertices of X, and of Y.

    Notes
    -----
    What is of the main part is trusted as its map is.  A piece that found one of the other mesh may be laid onto it
    anyhow, or onto the wrong one: it is trusted as far as the way there and back leads home.  What follows its
    surroundings is trusted as far as these are, and as it is near to them.
    """
    yield Progress(0.0, "Mapping every vertex")
    forward = yield from within(follow_steps(x, y, there), 0.0, 0.5)
    yield Progress(0.5, "Mapping every vertex")
    backward = yield from within(follow_steps(y, x, back), 0.5, 1.0)
    forth = _judged(x, forward, backward, credibility * confidences[0], credibility)
    return forth, _judged(y, backward, forward, credibility * confidences[1], credibility)


def _judged(x: CleanSurface, forward: FollowedMap, backward: FollowedMap, main: Floats, credibility: float) -> WholeMap:
    """Say how far to trust a map of all vertices, by that of the main part, (k,), and by the way back."""
    confidence = forward.confidence * main[forward.surroundings]
    share = 1.0
    if len(x.pieces) > 1:
        laid = (x.vertex_parts > 0) & (forward.partners[x.vertex_parts] > 0)
        trips = round_trips(x.original, forward.points, backward.points) / np.sqrt(x.original.area)
        confidence[laid] = credibility * trip_confidence(trips[laid])
        known = main @ x.mesh.vertex_areas / x.mesh.area
        whole = confidence @ x.original.vertex_areas / x.original.area
        share = float(whole / known) if known > 0 else 1.0
    return WholeMap(forward.points, confidence, forward.alone, share)
