# SPDX-License-Identifier: GPL-3.0-or-later
"""The score of an overlap of two surfaces, by the registration that it comes from."""

from __future__ import annotations

import numpy as np

from ...runtime.arrays import Bools, Ints
from .part_registration import Fit
from .part_surface import PartSurface

_GAP, _STRAIN, _CURVATURE, _INNER, _AREA = (
    (-4.0, 0.003, 0.0205),
    (-4.5, 0.03, 0.315),
    (-2.1, 0.01, 0.1),
    (-2.7, 0.5, 7.7),
    (1.9, 0.0, 0.49),
)
"""What counts, each as a weight of the logarithm of the sum of the value and a constant by another: the mean distance
that is left, elastic energy by area, mean difference of curvatures, length of the outline of the overlap that is at no
cut, and area of the overlap, in units of length."""

_BIAS = -5.1
"""Chosen so that two surfaces are laid onto each other rightly as often as not where the mean score is zero: by a
logistic fit on the parts of `docs/results.md`, of which 57 of 78 were matched rightly."""

_AT_CUT = 0.05
"""Distance to where a surface was cut up to which an outline ends there."""

_LEAST_AREA = 0.01


def shared_area(source: PartSurface, target: PartSurface, fit: Fit) -> float:
    """Return the area of the overlap, the mean of that on both surfaces."""
    return float(source.mass @ fit.members + target.mass @ fit.members_back) / 2


def overlap_score(source: PartSurface, target: PartSurface, fit: Fit) -> float:
    """Compare registrations: larger is more credible, and minus infinity if nothing overlaps.

    The overlap of two parts of a body ends where one of them was cut off.  The true one is closely matched, hardly
    strained, and has no other outline.
    """
    if not (fit.members.any() and fit.members_back.any()):
        return -np.inf
    here, there = source.mass * fit.members, target.mass * fit.members_back
    both = float(here.sum() + there.sum())
    differences = (
        np.abs(source.curvatures - target.curvatures[fit.there.images]).mean(axis=1),
        np.abs(target.curvatures - source.curvatures[fit.back.images]).mean(axis=1),
    )
    inner = _inner_outline(source, target, fit.members, fit.there.images)
    inner += _inner_outline(target, source, fit.members_back, fit.back.images)
    values = (
        float(here @ fit.there.gaps + there @ fit.back.gaps) / both,
        float(fit.energies @ fit.members) / float(here.sum()),
        float(here @ differences[0] + there @ differences[1]) / both,
        inner,
        max(shared_area(source, target, fit), _LEAST_AREA),
    )
    terms = zip((_GAP, _STRAIN, _CURVATURE, _INNER, _AREA), values, strict=True)
    return _BIAS + sum(weight * float(np.log((value + more) / unit)) for (weight, more, unit), value in terms)


def _inner_outline(surface: PartSurface, other: PartSurface, members: Bools, images: Ints) -> float:
    """Length of the outline of the overlap on a surface that is inside of both, about."""
    edges = surface.mesh.edges
    ends = members[edges]
    crossing = edges[ends[:, 0] != ends[:, 1]]
    inside = np.where(members[crossing[:, 0]], crossing[:, 0], crossing[:, 1])
    return float((other.border_distances[images[inside]] >= _AT_CUT).sum()) * surface.spacing
