# SPDX-License-Identifier: GPL-3.0-or-later
"""Whether a map takes each limb to its own side: what the middle of the body says of where limbs belong."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from .map_hypotheses import LandmarkStart

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from .functional_maps import PointMaps
    from .shape import Shape

__all__ = ["limb_tips", "repaired_start"]

_REACH = 0.15
"""Distance, in sqrt(area), in which a tip is farther from the rest of the surface than all else."""

_MOST_TIPS = 16
"""Tips that are looked at; of more, the farthest from the rest."""

_CENTRAL = 0.5
"""Part of the samples that make up the middle of the body: those least far from all others."""

_TRUSTED = 0.1
"""Distance between a place and where both maps bring it, in sqrt(area), up to which the map is believed there."""

_TOLD_APART = 0.04
"""How differently two tips must lie to the middle of the body, in sqrt(area), root mean square: more than maps err."""

_EXCHANGED = -0.2
"""Correlation of how two tips lie, and of how their images do, below which they are exchanged; the truth has above 0.4,
and an exchange the negative."""

_FEWEST = 8
"""Places of the middle of the body that are needed to say anything."""

_ANCHORS = 40
"""Places of the middle of the body that the rest is found anew from."""


def limb_tips(shape: Shape) -> NDArray[np.int64]:
    """Find the ends of limbs, of ears, of tails: samples that are farther from the rest than all around them.

    Parameters
    ----------
    shape : Shape
        With samples.

    Returns
    -------
    (k,) array of int
        Numbers of samples, those first whose mean distance from the rest is largest.
    """
    distances, means = shape.sample_distances, _mean_distances(shape)
    largest = np.where(distances < _REACH, means, -np.inf).max(axis=1)
    tips = np.flatnonzero(means >= largest)
    return tips[np.argsort(-means[tips], kind="stable")][:_MOST_TIPS]


def repaired_start(x: Shape, y: Shape, maps: PointMaps) -> LandmarkStart | None:
    r"""Look for limbs that a map exchanges, and say where a map that does not would start.

    A pose changes hardly anything about how far the tip i of a limb is from places s of the middle of the body.  With
    two tips and their images, the differences

    .. math:: u_s = d_X(i, s) - d_X(j, s), \qquad v_s = d_Y(c(i), c(s)) - d_Y(c(j), c(s)),

    less their means, which are those of the lengths of the limbs, say on which side of the body the limbs grow. They
    correlate if the limbs are where they belong, and if they are exchanged, u with -v, be the rest of the map ever so
    good.  Limbs that lie side by side in space are as far apart in this as any.

    Parameters
    ----------
    x, y : Shape
        The surfaces, with samples.
    maps : PointMaps
        Between all their vertices.

    Returns
    -------
    LandmarkStart or None
        Tips, each with the image it should have had, and places of the middle of the body, with those they have.  None
        if no limbs are exchanged.
    """
    found = _exchange(x, y, maps.on_y, maps.on_x)
    if found is not None:
        return LandmarkStart(_rows(x, found[0]), _rows(y, found[1]), "limbs")
    found = _exchange(y, x, maps.on_x, maps.on_y)
    if found is not None:
        return LandmarkStart(_rows(x, found[1]), _rows(y, found[0]), "limbs")
    return None


def _exchange(
    x: Shape, y: Shape, there: NDArray[np.int64], back: NDArray[np.int64]
) -> tuple[NDArray[np.int64], NDArray[np.int64]] | None:
    """Find vertices of X and where they belong on Y, if the tips of X have got each other's images."""
    tips, middle = limb_tips(x), _trusted_middle(x, there, back)
    if len(middle) < _FEWEST:
        return None
    images = there[x.samples[tips]]
    weights = x.cell_areas[middle] / x.cell_areas[middle].sum()
    here = _centred(x.sample_distances[np.ix_(tips, middle)], weights)
    seen = _centred(_distances_between(y, images, there[x.samples[middle]]), weights)
    order = _best_order(here, seen, weights)
    moved = np.flatnonzero(order != np.arange(len(order)))
    if not len(moved):
        return None
    # Where the limbs are exchanged from high up, some of the middle is on them.
    known = np.sort(middle[_consistent(here[moved], seen[order[moved]])])
    known = known[:_ANCHORS]  # the first samples are spread the best
    vertices = x.samples[np.concatenate([tips, known])]
    return vertices, np.concatenate([images[order], there[x.samples[known]]])


def _centred(distances: NDArray[np.float64], weights: NDArray[np.float64]) -> NDArray[np.float64]:
    """Distances (k, c) less the weighted mean of each row."""
    return distances - (distances @ weights)[:, None]


def _best_order(
    here: NDArray[np.float64], there: NDArray[np.float64], weights: NDArray[np.float64]
) -> NDArray[np.int64]:
    """Exchange images of tips as long as two are clearly at each other's place.

    Parameters
    ----------
    here, there : (k, c) array of float
        Distances of the tips, and of their images, from the middle of the body, less the mean of each.
    weights : (c,) array of float
        Weights of its places; they sum to one.

    Returns
    -------
    (k,) array of int
        For each tip the tip whose image it should have.
    """
    here, there = here * np.sqrt(weights), there * np.sqrt(weights)
    order = np.arange(len(here))
    for _ in range(len(here)):
        correlation = _correlations(here, there[order])
        i, j = np.unravel_index(correlation.argmin(), correlation.shape)
        if correlation[i, j] >= _EXCHANGED:
            break
        order[[i, j]] = order[[j, i]]
    return order


def _consistent(here: NDArray[np.float64], there: NDArray[np.float64]) -> NDArray[np.bool_]:
    """Whether places lie to the same side of each two of some tips as their images do, (c,), from (k, c) distances."""
    u, v = (rows[:, None] - rows for rows in (here, there))
    opposite = (u * v < 0) & (np.minimum(np.abs(u), np.abs(v)) > _TOLD_APART)
    return ~opposite.any(axis=(0, 1))


def _correlations(here: NDArray[np.float64], there: NDArray[np.float64]) -> NDArray[np.float64]:
    """Correlate the differences of each two rows with those of their images, (k, k); 1 where they say too little."""
    products, own, other = here @ there.T, here @ here.T, there @ there.T
    both, own, other = (
        np.diag(m)[:, None] + np.diag(m) - m - m.T for m in (products, own, other)
    )  # sums over places of u v, of u u and of v v
    clear = np.minimum(own, other) > _TOLD_APART**2
    return np.where(clear, both / np.sqrt(np.where(clear, own * other, 1.0)), 1.0)


def _trusted_middle(x: Shape, there: NDArray[np.int64], back: NDArray[np.int64]) -> NDArray[np.int64]:
    """Choose the samples in the middle of the body that both maps agree on."""
    means = _mean_distances(x)
    middle = np.argsort(means, kind="stable")[: max(round(_CENTRAL * len(means)), 1)]
    returned = back[there[x.samples[middle]]]
    return middle[x.sample_rows[middle, returned] < _TRUSTED]


def _mean_distances(shape: Shape) -> NDArray[np.float64]:
    """Mean distance of each sample from the whole surface, (S,)."""
    means: NDArray[np.float64] = shape.sample_distances @ shape.cell_areas
    return means / shape.cell_areas.sum()


def _distances_between(shape: Shape, first: NDArray[np.int64], second: NDArray[np.int64]) -> NDArray[np.float64]:
    """Distances between vertices (k,) and (c,), from the samples nearest to the first, (k, c)."""
    nearest = shape.sample_rows[:, first].argmin(axis=0)
    return shape.sample_rows[np.ix_(nearest, second)].astype(np.float64)


def _rows(shape: Shape, vertices: NDArray[np.int64]) -> NDArray[np.float64]:
    """Distances from vertices (k,) to all vertices, in sqrt(area), (k, n)."""
    rows: NDArray[np.float64] = shape.solver.distances(vertices) / shape.scale
    return rows
