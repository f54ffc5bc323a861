# SPDX-License-Identifier: GPL-3.0-or-later
"""Matchings of extremities carried over whole surfaces, and which of them fit there."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ...geometry.best_distinct import best_distinct
from ...geometry.orientation import signed_area_tables, signed_areas
from ...runtime.arrays import Floats, Ints, squared_differences
from ..functional_maps import PointMaps, nearest_both_ways
from ..spectral_domain import MapDomain

_SIGNED_WEIGHT, _RELATIVE_SIGNED_WEIGHT = 1.0, 2.0
"""Of signed areas beside distances, and beside relative distances."""

_SCOUTS = 64
"""Samples of either surface that say how well a matching fits: the first, which are spread the best."""

_APART = 0.04
"""Mean distance between the images of the scouts, in sqrt(area), up to which two matchings say the same."""


class LiftedMatchings:
    r"""What matchings of some samples of X to samples of Y say of all others.

    A point p is described by its distances to the m matched samples, and by the signed areas of the directions
    :math:`u_i` away from them, which tell the sides of the surface apart,

    .. math:: \Big( \frac{d_i(p)}{\sqrt m}, \; \pm \frac{u_i \times u_j}{\sqrt{m (m - 1) / 2}} \Big),

    and goes to the point of the other surface with the most similar description.  That some point is found which has
    the right distances to all of them, from the right sides, asks far more than that the distances between them agree:
    matchings that exchange limbs, or turn or mirror the surface, fail it.

    Parameters
    ----------
    x, y : MapDomain
        The surfaces.
    of_x, of_y : (m,), (n,) arrays of int
        The numbers of coarse samples that are matched, and that they may be matched to.
    relative : bool
        Whether distances to a sample are in units of their mean over the surface, and signed areas count twice: between
        different kinds of bodies, limbs are of different lengths.
    """

    def __init__(self, x: MapDomain, y: MapDomain, of_x: Ints, of_y: Ints, *, relative: bool = False) -> None:
        self._apart = y.shape.samples.distances
        here, there = (d.shape.samples.distances[:, of] for d, of in ((x, of_x), (y, of_y)))
        self._distances = _in_means(there) if relative else there
        self._weight = _RELATIVE_SIGNED_WEIGHT if relative else _SIGNED_WEIGHT
        # Those of all pairs in either order, so that each matching finds its own.
        self._sides = signed_area_tables(y.directions(of_y))
        own = _in_means(here) if relative else here
        self._rows_x = described(own, signed_areas(x.directions(of_x)), self._weight)

    def maps(self, images: Ints, sign: int) -> PointMaps:
        """Carry a matching over both surfaces.

        Parameters
        ----------
        images : (m,) array of int
            For each matched sample of X, the position of its image in `of_y`.
        sign : int
            Whether the orientation is kept (1) or mirrored (-1).
        """
        return nearest_both_ways(self._rows_x, self._rows_y(images, sign))

    def best(self, matchings: Ints, sign: int, most: int) -> Ints:
        """Choose those that fit best and say different things.

        Parameters
        ----------
        matchings : (r, m) array of int
            Images, see `maps`.
        sign : int
            As in `maps`.
        most : int
            How many are wanted at most.

        Returns
        -------
        (k, m) array of int
            The best first.
        """
        misfits, landings = self._assessed(matchings, sign)

        def differ(number: int, other: int) -> bool:
            """Say whether two matchings lead to different places on the mean."""
            return bool(self._apart[landings[number], landings[other]].mean() > _APART)

        return matchings[best_distinct(np.argsort(misfits, kind="stable").tolist(), differ, most)]

    def improved(self, images: Ints, sign: int) -> Ints:
        """Exchange two images of a matching, or one for another sample, as often as it fits better then.

        Always the change that helps the most is made.  Of limbs that are alike, as the arms of an octopus, there are
        too many matchings to try all of them; but the fit of those that change a few limbs says which, so different
        starts end at few matchings.

        Parameters
        ----------
        images : (m,) array of int
            See `maps`.
        sign : int
            As in `maps`.

        Returns
        -------
        (m,) array of int
            The best that was found.
        """
        least = self._assessed(images[None], sign)[0][0]
        while len(offered := self._changed(images)):
            misfits = self._assessed(offered, sign)[0]
            if misfits.min() >= least:
                break
            images, least = offered[misfits.argmin()], misfits.min()
        return images

    def _changed(self, images: Ints) -> Ints:
        """All matchings that differ from one in one image, or in two that are exchanged, (r, m)."""
        m = len(images)
        first, second = np.triu_indices(m, 1)
        exchanged = np.repeat(images[None], len(first), axis=0)
        rows = np.arange(len(first))
        exchanged[rows, first], exchanged[rows, second] = images[second], images[first]
        free = np.setdiff1d(np.arange(self._distances.shape[1]), images)
        changed, taken = np.repeat(np.arange(m), len(free)), np.tile(free, m)
        replaced = np.repeat(images[None], len(changed), axis=0)
        replaced[np.arange(len(changed)), changed] = taken
        return np.concatenate([exchanged, replaced])

    def _assessed(self, matchings: Ints, sign: int) -> tuple[NDArray[np.float32], Ints]:
        """Mean squared difference of descriptions of scouts and of what they go to, (r,), and where those of X go."""
        rows_x = self._rows_x.astype(np.float32)
        misfits = np.empty(len(matchings), np.float32)
        landings = np.empty((len(matchings), len(rows_x[:_SCOUTS])), np.int64)
        for number, images in enumerate(matchings):
            rows_y = self._rows_y(images, sign).astype(np.float32)
            there = squared_differences(rows_x[:_SCOUTS], rows_y)
            back = squared_differences(rows_y[:_SCOUTS], rows_x)
            landings[number] = there.argmin(axis=1)
            misfits[number] = there.min(axis=1).mean() + back.min(axis=1).mean()
        return misfits, landings

    def _rows_y(self, images: Ints, sign: int) -> Floats:
        first, second = np.triu_indices(len(images), 1)
        sides = sign * self._sides[:, images[first], images[second]]
        return described(self._distances[:, images], sides, self._weight)


def described(distances: Floats, sides: Floats, weight: float) -> Floats:
    """Describe points by their distances (k, m) to samples, and by the signed areas (k, m (m - 1) / 2), so weighted."""
    columns = distances / np.sqrt(max(distances.shape[1], 1)), weight * sides / np.sqrt(max(sides.shape[1], 1))
    return np.concatenate(columns, axis=1)


def _in_means(distances: Floats) -> Floats:
    """Distances (k, m) of points from samples in units of the mean from each sample."""
    means = distances.mean(axis=0)
    return np.divide(distances, means, out=np.zeros_like(distances, np.float64), where=means > 0)
