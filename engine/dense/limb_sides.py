# SPDX-License-Identifier: GPL-3.0-or-later
"""Sides of limbs: where they belong by the middle of the body, and whether a map takes each to its own side."""

from __future__ import annotations

import numpy as np

from ..geometry.best_distinct import best_distinct
from ..runtime.arrays import Floats, Ints
from ..runtime.parallel_map import shared_steps
from ..runtime.progress import Steps
from ..shapes.extremities import limb_tips, mean_distances
from ..shapes.shape import Shape
from ..shapes.surface_distances import measured_steps
from .dense_hypotheses import SparseStart
from .functional_maps import PointMaps

_CENTRAL = 0.5
"""Part of the samples that make up the middle of the body: those least far from all others."""

_TRUSTED = 0.1
"""Distance between a place and where both maps bring it, in sqrt(area), up to which the map is believed there."""

_SIDE = 0.06
"""How far to one side a place counts at most, in sqrt(area): what is farther is on the limbs, and goes with them."""

_TOLD_APART = 0.03
"""How differently two tips must lie to the middle of the body, in sqrt(area), root mean square: more than maps err."""

_EXCHANGED = 0.1
"""Correlation of how two tips lie, and of how their images do, below which they seem to be exchanged: limbs that are,
from top to toe, have less, and the truth nearly always above 0.4."""

_FEWEST = 8
"""Places of the middle of the body that are needed to say anything."""

_ANCHORS = 40
"""Places of the middle of the body that the rest is found anew from."""


def repaired_start_steps(x: Shape, y: Shape, maps: PointMaps) -> Steps[SparseStart | None]:
    r"""Look for limbs that a map exchanges, and say where a map that does not would start.

    A pose changes hardly anything about how far the tip i of a limb is from places s of the middle of the body.  With
    two tips and their images, the differences

    .. math:: u_s = d_X(i, s) - d_X(j, s), \qquad v_s = d_Y(c(i), c(s)) - d_Y(c(j), c(s)),

    less their medians, which are those of the lengths of the limbs, say on which side of the body the limbs grow.  They
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
    SparseStart or None
        Tips, each with the image it should have had, and places of the middle of the body, with those they have.  None
        if no limbs are exchanged.
    """
    found = _exchange(x, y, maps.on_y, maps.on_x)
    if found is None:
        back = _exchange(y, x, maps.on_x, maps.on_y)
        if back is None:
            return None
        found = back[::-1]
    rows = yield from shared_steps(measured_steps, None, list(zip((x.solver, y.solver), found, strict=True)))
    return SparseStart(rows[0] / x.scale, rows[1] / y.scale, "limbs")


def _exchange(x: Shape, y: Shape, there: Ints, back: Ints) -> tuple[Ints, Ints] | None:
    """Find vertices of X and where they belong on Y, if the tips of X have got each other's images."""
    middle = _trusted_middle(x, there, back)
    if len(middle) < _FEWEST:
        return None
    samples = x.samples
    weights = samples.cell_areas[middle] / samples.cell_areas[middle].sum()
    tips = _told_apart(x, limb_tips(x), middle, weights)
    images = there[samples.vertices[tips]]
    here = _sides(samples.distances[np.ix_(tips, middle)])
    seen = _sides(_distances_between(y, images, there[samples.vertices[middle]]))
    order = _best_order(here, seen, weights)
    moved = np.flatnonzero(order != np.arange(len(order)))
    if not len(moved):
        return None
    # Where the limbs are exchanged from high up, some of the middle is on them.
    u, v = here[np.ix_(moved, moved)], seen[np.ix_(order[moved], order[moved])]
    opposite = (u * v < 0) & (np.minimum(np.abs(u), np.abs(v)) > _TOLD_APART)
    known = np.sort(middle[~opposite.any(axis=(0, 1))])[:_ANCHORS]  # the first samples are spread the best
    vertices = samples.vertices[np.concatenate([tips, known])]
    return vertices, np.concatenate([images[order], there[samples.vertices[known]]])


def _told_apart(x: Shape, tips: Ints, middle: Ints, weights: Floats) -> Ints:
    """Keep one tip of each limb: those that lie differently to the middle of the body than all before them."""
    sides = _from_mean(_sides(x.samples.distances[np.ix_(tips, middle)]), weights)
    clear = np.square(sides) @ weights > _TOLD_APART**2
    return tips[best_distinct(range(len(tips)), lambda tip, other: bool(clear[tip, other]))]


def _sides(distances: Floats) -> Floats:
    """By how much each place is nearer to the second of two tips than most places, (k, k, c), from distances (k, c)."""
    differences = distances[:, None] - distances
    return differences - np.median(differences, axis=2, keepdims=True)


def _best_order(here: Floats, there: Floats, weights: Floats) -> Ints:
    """Exchange images of tips that are at each other's place, the clearest first, no two tips twice.

    Parameters
    ----------
    here, there : (k, k, c) array of float
        The sides of places, seen from the tips and from their images.
    weights : (c,) array of float
        Weights of the places; they sum to one.

    Returns
    -------
    (k,) array of int
        For each tip the tip whose image it should have.
    """
    order = np.arange(len(here))
    fresh = ~np.eye(len(here), dtype=bool)
    while fresh.any():
        correlation = np.where(fresh, _correlations(here, there[np.ix_(order, order)], weights), np.inf)
        i, j = np.unravel_index(correlation.argmin(), correlation.shape)
        if correlation[i, j] >= _EXCHANGED:
            break
        order[[i, j]] = order[[j, i]]
        fresh[i, j] = fresh[j, i] = False
    return order


def _correlations(here: Floats, there: Floats, weights: Floats) -> Floats:
    """Correlate sides (k, k, c) seen from each two tips and from their images, (k, k); 1 where they say too little."""
    u, v = _from_mean(here, weights), _from_mean(there, weights)
    both, own, other = (np.einsum("ijc,ijc,c->ij", a, b, weights) for a, b in ((u, v), (u, u), (v, v)))
    clear = np.minimum(own, other) > _TOLD_APART**2
    return np.where(clear, both / np.sqrt(np.where(clear, own * other, 1.0)), 1.0)


def _from_mean(sides: Floats, weights: Floats) -> Floats:
    """Bound the sides of places, and take them from their weighted mean, (k, k, c)."""
    bounded = sides.clip(-_SIDE, _SIDE)
    return bounded - (bounded @ weights)[..., None]


def _trusted_middle(x: Shape, there: Ints, back: Ints) -> Ints:
    """Choose the samples in the middle of the body that both maps agree on."""
    means = mean_distances(x)
    middle = np.argsort(means, kind="stable")[: max(round(_CENTRAL * len(means)), 1)]
    returned = back[there[x.samples.vertices[middle]]]
    return middle[x.samples.rows[middle, returned] < _TRUSTED]


def _distances_between(shape: Shape, first: Ints, second: Ints) -> Floats:
    """Distances between vertices (k,) and (c,), from the samples nearest to the first, (k, c)."""
    nearest = shape.samples.rows[:, first].argmin(axis=0)
    return shape.samples.rows[np.ix_(nearest, second)].astype(np.float64)
