# SPDX-License-Identifier: GPL-3.0-or-later
"""Placements of a part, such as the bust of a body, on a whole surface."""

from __future__ import annotations

from functools import partial
from typing import NamedTuple

import numpy as np
from scipy.spatial import cKDTree

from ..dense.rough_maps.extremity_search import beam_matchings
from ..dense.rough_maps.lifted_matchings import described
from ..geometry.best_distinct import best_distinct
from ..geometry.orientation import signed_area_tables, signed_areas
from ..runtime.arrays import Floats, Ints, squared_differences
from ..runtime.progress import Progress, Steps
from ..shapes.shape import Shape

_MATCHED, _OFFERED = 6, 80
"""Samples of the part that are matched, and of the whole that they are matched to: the first, which are spread the
best.  Where the part was cut off, nothing says which places of the whole are extremities of it; so many are offered."""

_SHARES = (1.0, 0.85, 0.7, 0.58, 0.48, 0.4, 0.33)
"""What part of the whole it may be, by area: so distances on one are known in units of the other."""

_WIDTH = 1500
"""Partial matchings that are kept in the search at each size."""

_CARRIED = 80
"""Matchings of each size that are carried over to the whole surface."""

_SCOUTS = 64
"""Samples of the part that say how well a matching carries over."""

_SIGNED_WEIGHT = 0.5
"""Of signed areas beside distances in units of the part."""

_ALIKE, _APART = 0.1, 0.08
"""Mean distance between the images of what is matched, in units of the part, and between those of the scouts, in units
of the whole, up to which two matchings say the same."""


class _Matching(NamedTuple):
    """Numbers of the whole's samples that the first of the part go to, (m,), and those that its scouts do, (k,)."""

    images: Ints
    unit: float
    misfit: float
    landings: Ints


def part_placements_steps(whole: Shape, part: Shape, most: int) -> Steps[list[Ints]]:
    r"""Find ways to lay a surface onto another that has more, from distances on both.

    A few samples of the part are matched to samples of the whole in many ways, at several sizes: in units of its own
    area, the part is larger than on the whole.  Each matching describes the points of both surfaces, by distances to
    what is matched and the signed areas of the directions from there; it is as good as the samples of the part find
    their like on the whole.  Nothing is asked of the samples of the whole, most of which may have no partner [1]_.

    Parameters
    ----------
    whole, part : Shape
        The surfaces, with samples.
    most : int
        How many ways are wanted at most.

    Yields
    ------
    Progress
        After each size.

    Returns
    -------
    list of (s,) arrays of int
        For each way, the best first and no two nearly the same, the numbers of samples of the whole where those of the
        part go; none mirrors.

    References
    ----------
    .. [1] A. M. Bronstein, M. M. Bronstein, A. M. Bruckstein, R. Kimmel, "Partial similarity of objects, or how to
       compare a centaur to a horse", International Journal of Computer Vision 84, 2009.
    """
    distances = whole.samples.distances
    carrier = _Carrier(whole, part)
    found: list[_Matching] = []
    for number, unit in enumerate(np.sqrt(_SHARES)):
        differ = partial(_are_apart, distances, _ALIKE * unit)
        found += [carrier.carried(images, unit) for images in best_distinct(carrier.matchings(unit), differ, _CARRIED)]
        yield Progress((number + 1) / len(_SHARES), "Comparing maps")
    found.sort(key=lambda matching: matching.misfit)
    chosen = best_distinct(found, lambda one, other: _are_apart(distances, _APART, one.landings, other.landings), most)
    return [carrier.everywhere(matching) for matching in chosen]


def _are_apart(distances: Floats, least: float, images: Ints, other: Ints) -> bool:
    """Say whether two matchings (m,) take points farther than that from each other, in the mean."""
    return bool(distances[images, other].mean() > least)


class _Carrier:
    """Matches the first samples of the part, and carries matchings over to the others."""

    def __init__(self, whole: Shape, part: Shape) -> None:
        offered = np.arange(min(_OFFERED, len(whole.samples)))
        matched = np.arange(min(_MATCHED, len(part.samples), len(offered)))
        self._first, self._second = np.triu_indices(len(matched), 1)
        self._whole, self._part = whole.samples.distances, part.samples.distances[:, : len(matched)]
        sides = signed_areas(part.samples.directions[:, matched])
        self._part_rows = described(self._part, sides, _SIGNED_WEIGHT)
        self._scouts = self._part_rows[:_SCOUTS].astype(np.float32)
        self._sides = signed_area_tables(whole.samples.directions[:, offered])

    def matchings(self, unit: float) -> Ints:
        """Match samples of the part, whose distances are in `unit` of those of the whole: images (r, m)."""
        m, n = self._part.shape[1], self._sides.shape[1]
        own = unit * self._part[:m]
        return beam_matchings(own, self._whole[:n, :n], np.zeros((m, n)), _WIDTH)

    def carried(self, images: Ints, unit: float) -> _Matching:
        """Carry a matching over to the scouts."""
        squares = squared_differences(self._scouts, self._whole_rows(images, unit).astype(np.float32))
        return _Matching(images, unit, float(squares.min(axis=1).mean()), squares.argmin(axis=1))

    def everywhere(self, matching: _Matching) -> Ints:
        """Carry a matching over to all samples of the part: numbers of samples of the whole."""
        return cKDTree(self._whole_rows(matching.images, matching.unit)).query(self._part_rows)[1]

    def _whole_rows(self, images: Ints, unit: float) -> Floats:
        sides = self._sides[:, images[self._first], images[self._second]]
        return described(self._whole[:, images] / unit, sides, _SIGNED_WEIGHT)
