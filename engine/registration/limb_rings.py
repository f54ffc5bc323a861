# SPDX-License-Identifier: GPL-3.0-or-later
"""Limbs, forked limbs and long bodies, and the rings around them."""

from __future__ import annotations

import itertools
from operator import itemgetter
from typing import NamedTuple

import numpy as np

from ..geometry.orientation import tangent_gradient
from ..runtime.arrays import Floats, Ints, unit_vectors
from ..shapes.extremities import mean_distances, spread_extremities
from ..shapes.shape import Shape
from .deformable import DeformableSurface

_LIMBS, _APART = 8, 0.25
"""How many limbs are looked at, and how far apart, in sqrt(area), their tips are at least."""

_LONGEST = 0.8
"""Length of limbs that is looked at, in sqrt(area)."""

SPACING = 0.03
"""Distance between two rings around a limb, and how far a ring reaches to either side, in sqrt(area)."""

_FEWEST_VERTICES, _FEWEST_RINGS = 15, 4
"""Vertices around a limb, and rings along it, that are needed to say which way round it lies."""

_WIDER = 2.5
"""How many times as wide as those before all rings are from where on the limb is the body."""

_WIDE_RINGS = 5
"""How many rings in a row may be wider than that though there is more of the limb beyond: those of a hand."""

_MOSTLY = 0.5
"""Part of a ring that must be of a limb, and not of another one, for the limb to go on."""

_STEM = 1.5
"""How many times as wide as all prongs together the stem of a forked limb is at joints; wider is the body (by
hand)."""

_THIN = 0.5
"""Part of the median radius of its rings up to which a limb has its tip."""

_LONG = 2.5
"""Ratio of the two lowest eigenvalues from which on a body is turned back like a limb; that of a rod is 4."""

_SLICES = 60
"""Parts of a long body, each of the same difference of its first eigenfunction, whose lengths are measured."""

_POINT = 1e-12
"""Squared radius, in units of the area, of what is no more than a point."""


class Ring(NamedTuple):
    """What lies around a limb at some distance from its tip."""

    distance: float
    vertices: Ints  # (m,)
    weights: Floats  # (m,), with the sum one
    area: float  # that the ring stands for


class Limb(NamedTuple):
    """A limb, or a whole body, and the rings around it.

    Attributes
    ----------
    vertices : (v,) array of int
        Its vertices.
    distances : (v,) array of float
        How far they are from the tip, along the limb.
    rings : list of Ring
        The rings, tip first.
    radii : (k,) array of float
        Their radii at rest.
    held : bool
        Whether the last ring stays where it is.
    is_forked : bool
        Whether rings lie around several prongs.
    """

    vertices: Ints
    distances: Floats
    rings: list[Ring]
    radii: Floats
    held: bool
    is_forked: bool = False


def separate_limbs(shape: Shape, source: DeformableSurface) -> list[Limb]:
    """Find limbs and the rings around them, as far as they are no wider than limbs are; no vertex is in two of them."""
    tips = spread_extremities(shape, _LIMBS, _APART, filled=False)
    found = []
    for row in shape.samples.rows[tips].astype(np.float64):
        rings = _rings(source, row, _LONGEST)
        if len(rings) >= _FEWEST_RINGS:
            radii = _radii(source, rings)
            chosen = _stout(radii[: _slender(radii)])
            found.append((row, rings[chosen], radii[chosen]))
    claims = np.full((len(found), len(source.vertices)), np.inf)
    for claim, (row, rings, radii) in zip(claims, found, strict=True):
        near = row < rings[-1].distance
        claim[near] = row[near] * np.interp(row[near], [ring.distance for ring in rings], radii) ** 3
    limbs = []
    for number, (row, rings, radii) in enumerate(found):
        # What two limbs reach is of the one that is thinner there; if they are alike, whose tip is nearer.
        others = np.delete(claims, number, axis=0).min(axis=0, initial=np.inf)
        lost = np.isfinite(claims[number]) & (others <= claims[number])
        kept = [ring.weights @ ~lost[ring.vertices] > _MOSTLY for ring in rings]
        own = rings[: kept.index(False) if False in kept else len(kept)]
        if len(own) >= _FEWEST_RINGS:
            inside = np.flatnonzero((row < own[-1].distance) & ~lost)
            limbs.append(Limb(inside, row[inside], own, radii[: len(own)], held=True))
    return limbs


def forked_limbs(shape: Shape, source: DeformableSurface) -> list[Limb]:
    r"""Find limbs that fork, such as wings with fingers, and the rings around all prongs at once.

    The stem of such a limb is round, but how its prongs lie around one another says which way round it is.  Two tips
    are on one stem if much of the way from the middle of the body is common to both: of lengths :math:`c_i`, and
    :math:`d_{ij}` between them, that is :math:`(c_i + c_j - d_{ij}) / 2` [1]_.  All that share as much with one of them
    are prongs of the same fork.

    Parameters
    ----------
    shape : Shape
        The source, with samples.
    source : DeformableSurface
        Its surface.

    Returns
    -------
    list of Limb
        Those that fork nearest to the middle first; one may be a prong of another.

    References
    ----------
    .. [1] M. Gromov, "Hyperbolic groups", Essays in Group Theory, Springer 1987.
    """
    tips, samples = spread_extremities(shape, _LIMBS, _APART, filled=False), shape.samples
    lengths = samples.distances[int(mean_distances(shape).argmin()), tips].astype(np.float64)
    common = (lengths[:, None] + lengths - samples.distances[np.ix_(tips, tips)]) / 2
    forks: dict[tuple[int, ...], float] = {}
    for i, j in itertools.combinations(range(len(tips)), 2):
        if common[i, j] >= _FEWEST_RINGS * SPACING:
            forks.setdefault(tuple(np.flatnonzero(common[i] >= common[i, j]).tolist()), float(common[i, j]))
    limbs = []
    for fork, length in sorted(forks.items(), key=itemgetter(1)):
        prongs = list(fork)
        limb = _forked(source, samples.rows[tips[prongs]].astype(np.float64), lengths[prongs] - length)
        limbs += [] if limb is None else [limb]
    return limbs


def _forked(source: DeformableSurface, rows: Floats, lengths: Floats) -> Limb | None:
    """Cut a forked limb into rings, by distances (k, n) from its tips, and how far these are from the fork, (k,)."""
    beyond = rows - lengths[:, None]  # how far from the fork, towards a tip below zero
    along, longest = beyond.min(axis=0) + float(lengths.max()), float(lengths.max())
    # Where a prong has come to its end, the middle of the others is elsewhere.
    rings = [
        _balanced(ring, beyond[:, ring.vertices].argmin(axis=0)) if ring.distance <= longest else ring
        for ring in _rings(source, along, longest + _LONGEST)
        if ring.distance >= longest - lengths.min()
    ]
    prongs = [_rings(source, row, length) for row, length in zip(rows, lengths, strict=True)]
    if min(map(len, prongs)) < 2 or len(rings) < _FEWEST_RINGS:  # an axis is through two rings
        return None
    # A stem is as wide as all of its prongs together; what is everywhere wider is a body.
    width = np.sqrt(len(prongs)) * np.median([np.median(_radii(source, prong)) for prong in prongs])
    radii, fork = _radii(source, rings), sum(ring.distance <= longest for ring in rings)
    wide = np.flatnonzero(radii[fork:] > _STEM * width)
    end = fork + int(wide[0]) if len(wide) else len(rings)
    if end - fork < _FEWEST_RINGS or radii[fork:end].min() > width:
        return None
    inside = np.flatnonzero(along < rings[end - 1].distance)
    return Limb(inside, along[inside], rings[:end], radii[:end], held=True, is_forked=True)


def _balanced(ring: Ring, prongs: Ints) -> Ring:
    """Weigh all prongs of a ring alike, however thick they are, where its vertices are on these (m,)."""
    shares = np.bincount(prongs, ring.weights)
    weights = ring.weights / shares[prongs]
    return ring._replace(weights=weights / weights.sum())


def _slender(radii: Floats) -> int:
    """How many of the rings of these radii (k,), from the tip on, are of the limb: the others are of the body."""
    # A hand is wider than its fingers, but the forearm is not: only what is wide from there on is the body.
    last = 0
    for number in range(1, len(radii)):
        if radii[number] <= _WIDER * np.median(radii[:number]):
            last = number
        elif number - last > _WIDE_RINGS:
            break
    return last + 1


def _stout(radii: Floats) -> slice:
    """Which rings of a limb say how it is turned: all but those at the tip that are so thin that any turn is cheap."""
    return slice(int(np.argmax(radii >= _THIN * np.median(radii))), len(radii))


def long_body(shape: Shape, source: DeformableSurface) -> list[Limb]:
    """Take a body that is long for a limb; empty if it is not."""
    values = shape.spectrum.values
    if values[2] < _LONG * values[1]:
        return []
    lengths = _lengthwise(shape)
    rings = _rings(source, lengths, float(lengths.max()))
    if len(rings) < _FEWEST_RINGS:
        return []
    return [Limb(np.arange(len(lengths)), lengths, rings, _radii(source, rings), held=False)]


def _lengthwise(shape: Shape) -> Floats:
    """Lengths, in sqrt(area), along a body up to each vertex, (n,): the first eigenfunction, made to grow evenly."""
    # Distances from an end would not do: a whale's fluke has two.
    function = shape.spectrum.functions[:, 1]
    gradients = tangent_gradient(shape.mesh, np.arange(len(function))) @ function
    slopes = np.linalg.norm(gradients.reshape(-1, 2), axis=1) * shape.scale
    edges = np.linspace(function.min(), function.max(), _SLICES + 1)
    slices = np.clip(np.searchsorted(edges, function) - 1, 0, _SLICES - 1)
    areas = np.bincount(slices, shape.mesh.vertex_areas, _SLICES)
    sums = np.bincount(slices, shape.mesh.vertex_areas * slopes, _SLICES)
    known = np.flatnonzero(sums > 0)
    steepness = np.interp(np.arange(_SLICES), known, sums[known] / areas[known])
    return np.interp(function, edges, np.append(0, np.cumsum(np.diff(edges) / steepness)))


def _rings(source: DeformableSurface, distances: Floats, length: float) -> list[Ring]:
    """Cut a surface into rings by the distances (n,) from the tip of a limb, up to where some are missing."""
    rings: list[Ring] = []
    for distance in (np.arange(int(length / SPACING)) + 0.5) * SPACING:
        away = np.abs(distances - distance)
        around = np.flatnonzero(away < SPACING)
        if len(around) >= _FEWEST_VERTICES:
            mass = source.mass[around]
            area = float(source.mass[away < SPACING / 2].sum())
            rings.append(Ring(float(distance), around, mass / mass.sum(), area))
        elif rings:
            break
    return rings


def _radii(source: DeformableSurface, rings: list[Ring]) -> Floats:
    """Root mean square distances of rings from the axis through their centres, at rest, (k,)."""
    centres, axes = axis_of(source.vertices, rings)
    radii = []
    for ring, centre, axis in zip(rings, centres, axes, strict=True):
        places = source.vertices[ring.vertices] - centre
        across = np.square(places).sum(axis=1) - np.square(places @ axis)
        radii.append(float(np.sqrt(max(ring.weights @ across, _POINT))))
    return np.array(radii)


def axis_of(positions: Floats, rings: list[Ring]) -> tuple[Floats, Floats]:
    """Centres (k, 3) of rings, and unit vectors (k, 3) along the curve through them."""
    centres = np.array([ring.weights @ positions[ring.vertices] for ring in rings])
    return centres, unit_vectors(np.gradient(centres, axis=0))
