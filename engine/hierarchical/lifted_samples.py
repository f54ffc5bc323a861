# SPDX-License-Identifier: GPL-3.0-or-later
"""A matching of some samples carried to all samples of two shapes, and what says whether it is right there."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from ..geometry.orientation import orientation_agreement, signed_areas
from ..runtime.arrays import Floats, Ints, squared_differences
from ..shapes.shape import Shape
from .descriptors import weighted_correlation

CURVATURE_WEIGHT = 6.0
"""How much the agreement of curvatures counts beside the logarithm of the squared change of distances."""

_SIDE_WEIGHT = 0.01
"""Weight of the mean squared difference of signed areas beside that of distances."""

_ORIENTING = 20
"""How many matched points, the first, the orientation of the others is measured to."""


class Misfits(NamedTuple):
    """Mean squared change of the distances to matched points if sample x goes to sample y, and with that of sides.

    Both are (S, T) arrays of float.
    """

    distances: Floats
    all: Floats


def sample_misfits(x: Shape, y: Shape, images: Ints, sign: int) -> Misfits:
    """Compare all samples of two shapes by how they lie to matched points.

    Parameters
    ----------
    x, y : Shape
        The shapes.
    images : (k,) array of int
        The samples of Y that the first of X are matched to.
    sign : int
        Whether the orientation is kept (1) or mirrored (-1).
    """
    count = len(images)
    change = squared_differences(x.samples.distances[:, :count], y.samples.distances[:, images]) / count
    first = signed_areas(x.samples.directions[:, : min(count, _ORIENTING)])
    second = signed_areas(y.samples.directions[:, images[:_ORIENTING]])
    return Misfits(change, change + _SIDE_WEIGHT * squared_differences(first, sign * second) / first.shape[1])


def mean_orientation(x: Shape, y: Shape, images: Ints, lifted: Ints) -> float:
    """Mean agreement of orientation, -1 to 1, of a map of all samples (S,), as seen from matched ones, (k,)."""
    here, there = x.samples.directions[:, : min(len(images), _ORIENTING)], y.samples.directions[:, images[:_ORIENTING]]
    return float(orientation_agreement(here, there[lifted]).mean())


def curvature_agreement(x: Shape, y: Shape, lifted: Ints) -> float:
    """Mean correlation, at most 1, of the curvatures with those at the images (S,) of all samples."""
    pairs = zip(x.samples.curvatures, y.samples.curvatures, strict=True)
    return float(np.mean([weighted_correlation(own, other[lifted], x.samples.cell_areas) for own, other in pairs]))
