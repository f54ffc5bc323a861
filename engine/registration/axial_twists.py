# SPDX-License-Identifier: GPL-3.0-or-later
"""Limbs and long bodies that a registration has turned about their own axes, and how they are turned back."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from scipy.ndimage import minimum_filter
from scipy.spatial import cKDTree
from scipy.spatial.transform import Rotation

from ..geometry.orientation import tangent_gradient
from ..geometry.procrustes import nearest_rotations
from ..runtime.arrays import Floats, Ints, unit_vectors
from ..runtime.worker import search_threads
from ..shapes.extremities import spread_extremities
from ..shapes.shape import Shape
from .deformable import DeformableSurface

_LIMBS, _APART = 8, 0.25
"""How many limbs are looked at, and how far apart, in sqrt(area), their tips are at least."""

_LONGEST = 0.8
"""Length of limbs that is looked at, in sqrt(area)."""

_WIDTH = 0.03
"""Distance between two rings around a limb, and how far a ring reaches to either side, in sqrt(area)."""

_FEWEST_VERTICES, _FEWEST_RINGS = 15, 4
"""Vertices around a limb, and rings along it, that are needed to say which way round it lies."""

_WIDER = 2.5
"""How many times as wide as those before all rings are from where on the limb is the body."""

_WIDE_RINGS = 5
"""How many rings in a row may be wider than that though there is more of the limb beyond: those of a hand."""

_MOSTLY = 0.5
"""Part of a ring that must be of a limb, and not of another one, for the limb to go on."""

_THIN = 0.5
"""Part of the median radius of its rings up to which a limb has its tip."""

_LONG = 2.5
"""Ratio of the two lowest eigenvalues from which on a body is turned back like a limb; that of a rod is 4."""

_SLICES = 60
"""Parts of a long body, each of the same difference of its first eigenfunction, whose lengths are measured."""

_TRIED, _ANGLES, _TURNS = 16, 32, 2
"""Angles about the axis that are tried in a turn, how many are told apart, and how many turns either way."""

_NORMAL_LENGTH = 0.05
"""How many units of length a unit of difference of the normals counts when points are matched."""

_POINT = 1e-12
"""Squared radius, in units of the area, of what is no more than a point."""

_GAIN, _GAIN_UNLIKE = 0.02, 0.2
"""Part of its cost that turning a limb must save, in one body posed otherwise and in bodies of unlike build: rings of
these are no rigid bodies, and meet hardly better one way than another."""

_LEAST_TURN = 0.8
"""Turn of any ring, in radians, below which a limb is left to the registration."""

_NEARLY, _MOST_OTHERS = 2.0, 2
"""How many times as much it may cost to wind a limb otherwise that is worth a try, and how many are tried at most."""

_LYING, _MOST_LYING = 3.0, 3
"""The same for a long body that might lie otherwise: what is bent the wrong way is not round its own axis any more."""


class Winding(NamedTuple):
    """Vertices (v,) of a limb, and their positions (v, 3) in each other way that it might be wound about its axis."""

    vertices: Ints
    positions: list[Floats]


class Untwisted(NamedTuple):
    """Positions (n, 3) with limbs turned back, and how else each of some limbs, or the body, might be turned."""

    positions: Floats
    otherwise: list[Winding]


class _Ring(NamedTuple):
    """What lies around a limb at some distance from its tip."""

    distance: float
    vertices: Ints  # (m,)
    weights: Floats  # (m,), with the sum one
    area: float  # that the ring stands for


class _Limb(NamedTuple):
    """A limb, or a whole body, and the rings around it.

    Attributes
    ----------
    vertices : (v,) array of int
        Its vertices.
    distances : (v,) array of float
        How far they are from the tip, along the limb.
    rings : list of _Ring
        The rings, tip first.
    radii : (k,) array of float
        Their radii at rest.
    held : bool
        Whether the last ring stays where it is.
    """

    vertices: Ints
    distances: Floats
    rings: list[_Ring]
    radii: Floats
    held: bool


def untwisted(
    shape: Shape, source: DeformableSurface, target: DeformableSurface, positions: Floats, isometry: float = 1.0
) -> Untwisted:
    r"""Turn back what a registration has turned about the axis of a limb.

    A thin limb that is placed by smooth functions is no more than a curve: which way round it lies is left to chance,
    and closest points do not turn it back.  So the rings around each limb are turned about its axis by the angles
    :math:`\theta_k` of least

    .. math:: \sum_k \frac{A_k}{r_k^2} D_k(\theta_k)
        + \sum_k \frac{\pi \bar r_k^3}{h} (\tau_k + \theta_{k+1} - \theta_k)^2,

    which dynamic programming finds [1]_, with the last ring, at the body, held: :math:`D_k` is the mean squared
    distance of a ring at rest, moved as a rigid body, from where it meets the target if it is turned; :math:`A_k` and
    :math:`r_k` are its area and radius.  The second sum is what it takes to twist a tube of the mean radius
    :math:`\bar r_k`, at most the median of the limb, between rings at the distance h, where they are turned by
    :math:`\tau_k` against each other already.

    An arm whose hand lies right may still be wound about itself by a full turn, and twisted by half a turn it costs as
    much as by half a turn the other way; and a flat hand fits nearly as well upside down.  So the best angles that turn
    the tip otherwise are found as well, and offered if they cost little more.

    Parameters
    ----------
    shape : Shape
        The source, with samples.
    source, target : DeformableSurface
        The surfaces.
    positions : (n, 3) array of float
        Where a registration takes the vertices of the source.
    isometry : float
        From 0, bodies of unlike build, to 1, one body in two poses: the less, the more turning a limb must save.

    Returns
    -------
    Untwisted
        The same, with limbs turned where that makes them fit better, and other windings of limbs, two for each at most.

    References
    ----------
    .. [1] R. Bellman, "Dynamic Programming", Princeton University Press 1957.
    """
    gain = _GAIN_UNLIKE + isometry * (_GAIN - _GAIN_UNLIKE)
    return _turned_back(_limbs(shape, source), source, target, positions, gain)


def rolled_back(shape: Shape, source: DeformableSurface, target: DeformableSurface, positions: Floats) -> Untwisted:
    """Turn back what a registration has turned about the axis of a long body: a snake's, a fish's, a whale's.

    The lowest eigenfunctions of such a body say where along it a point is, but not which way round it lies, and the
    tail may end the other way round than the head.  It is treated as `untwisted` treats limbs, with no ring held.

    Nor is it seen from there whether the whole of it lies on its back: where it does, it has been bent until it fits.
    So other turns that cost a minimum, up to three times the least, are offered, three at most.

    Parameters
    ----------
    shape : Shape
        The source, with its spectrum.
    source, target : DeformableSurface
        The surfaces.
    positions : (n, 3) array of float
        Where a registration takes the vertices of the source.

    Returns
    -------
    Untwisted
        The same, with parts of the body turned where that makes them fit better; `positions` themselves if there are
        none, or if the body is not long.  And other ways to turn all of its vertices.
    """
    return _turned_back(_long_body(shape, source), source, target, positions, _GAIN)


def _turned_back(
    limbs: list[_Limb], source: DeformableSurface, target: DeformableSurface, positions: Floats, gain: float
) -> Untwisted:
    """Turn back limbs that have no vertex in common; the positions themselves if there is nothing to be turned."""
    if not limbs:
        return Untwisted(positions, [])
    turned = positions
    otherwise = []
    normals = source.search.moved(positions).vertex_normals
    tree = cKDTree(np.concatenate([target.vertices, _NORMAL_LENGTH * target.normals], axis=1))
    for limb in limbs:
        centres, axes = _axis(positions, limb.rings)
        asked, costs, rotations = [], [], []
        for ring, centre, axis in zip(limb.rings, centres, axes, strict=True):
            places, seen = positions[ring.vertices] - centre, normals[ring.vertices]
            features = [_turned(places, axis) + centre, _NORMAL_LENGTH * _turned(seen, axis)]
            asked.append(np.concatenate(features, axis=2).reshape(-1, 6))
        # So many points are looked up by as many threads as may be.
        nearest = tree.query(np.concatenate(asked), workers=search_threads())[1]
        met = np.split(target.vertices[nearest], np.cumsum([len(each) for each in asked[:-1]]))
        for ring, radius, images in zip(limb.rings, limb.radii, met, strict=True):
            rest = source.vertices[ring.vertices]
            misfits, _ = _rigid_misfits(rest, images.reshape(_TRIED, -1, 3), ring.weights)
            costs.append(ring.area / radius**2 * misfits)
            rotations.append(_rigid_misfits(rest, positions[ring.vertices][None], ring.weights)[1][0])
        # Between the angles that were tried, costs change as waves do.
        waves = np.fft.rfft(costs, axis=1) * (_ANGLES / _TRIED)
        finer = np.fft.irfft(waves, _ANGLES, axis=1).clip(min=0)
        angles, others = _best_angles(limb, finer, _twists(np.array(rotations), axes), gain)
        if others:
            ways = [_moved(limb, centres, axes, other, positions) for other in others]
            otherwise.append(Winding(limb.vertices, ways))
        if np.abs(angles).max() > _LEAST_TURN:
            turned = turned.copy() if turned is positions else turned
            turned[limb.vertices] = _moved(limb, centres, axes, angles, positions)
    return Untwisted(turned, otherwise)


def _limbs(shape: Shape, source: DeformableSurface) -> list[_Limb]:
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
            limbs.append(_Limb(inside, row[inside], own, radii[: len(own)], held=True))
    return limbs


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


def _long_body(shape: Shape, source: DeformableSurface) -> list[_Limb]:
    """Take a body that is long for a limb; empty if it is not."""
    values = shape.spectrum.values
    if values[2] < _LONG * values[1]:
        return []
    lengths = _lengthwise(shape)
    rings = _rings(source, lengths, float(lengths.max()))
    if len(rings) < _FEWEST_RINGS:
        return []
    return [_Limb(np.arange(len(lengths)), lengths, rings, _radii(source, rings), held=False)]


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


def _rings(source: DeformableSurface, distances: Floats, length: float) -> list[_Ring]:
    """Cut a surface into rings by the distances (n,) from the tip of a limb, up to where some are missing."""
    rings: list[_Ring] = []
    for distance in (np.arange(int(length / _WIDTH)) + 0.5) * _WIDTH:
        away = np.abs(distances - distance)
        around = np.flatnonzero(away < _WIDTH)
        if len(around) >= _FEWEST_VERTICES:
            mass = source.mass[around]
            area = float(source.mass[away < _WIDTH / 2].sum())
            rings.append(_Ring(float(distance), around, mass / mass.sum(), area))
        elif rings:
            break
    return rings


def _radii(source: DeformableSurface, rings: list[_Ring]) -> Floats:
    """Root mean square distances of rings from the axis through their centres, at rest, (k,)."""
    centres, axes = _axis(source.vertices, rings)
    radii = []
    for ring, centre, axis in zip(rings, centres, axes, strict=True):
        places = source.vertices[ring.vertices] - centre
        across = np.square(places).sum(axis=1) - np.square(places @ axis)
        radii.append(float(np.sqrt(max(ring.weights @ across, _POINT))))
    return np.array(radii)


def _axis(positions: Floats, rings: list[_Ring]) -> tuple[Floats, Floats]:
    """Centres (k, 3) of rings, and unit vectors (k, 3) along the curve through them."""
    centres = np.array([ring.weights @ positions[ring.vertices] for ring in rings])
    return centres, unit_vectors(np.gradient(centres, axis=0))


def _turned(vectors: Floats, axis: Floats) -> Floats:
    """Turn vectors (m, 3) about a unit axis by the angles that are tried, (a, m, 3)."""
    angles = np.arange(_TRIED) * (2 * np.pi / _TRIED)
    rotations = Rotation.from_rotvec(angles[:, None] * axis).as_matrix()
    return vectors @ rotations.transpose(0, 2, 1)


def _rigid_misfits(rest: Floats, images: Floats, weights: Floats) -> tuple[Floats, Floats]:
    """Mean squared distances (a,) of points (m, 3), moved as a rigid body, from images (a, m, 3), and rotations."""
    rest = rest - weights @ rest
    images = images - np.einsum("m,amd->ad", weights, images)[:, None]
    products = np.einsum("m,amd,me->ade", weights, images, rest)
    rotations = nearest_rotations(products)
    spreads = weights @ np.square(rest).sum(axis=1) + np.square(images).sum(axis=2) @ weights
    return spreads - 2 * np.einsum("ade,ade->a", rotations, products), rotations


def _twists(rotations: Floats, axes: Floats) -> Floats:
    """Angles (k - 1,), -pi to pi, about the axis by which each of the rotations (k, 3, 3) turns more than the last."""
    between = Rotation.from_matrix(rotations[1:] @ rotations[:-1].transpose(0, 2, 1)).as_quat()
    along = np.einsum("kd,kd->k", between[:, :3], unit_vectors(axes[1:] + axes[:-1]))
    angles = 2 * np.arctan2(along, between[:, 3])
    return (angles + np.pi) % (2 * np.pi) - np.pi


def _best_angles(limb: _Limb, costs: Floats, twists: Floats, gain: float) -> tuple[Floats, list[Floats]]:
    """Find the angles (k,) of least cost to turn the rings by, all zero if they save no more than a gain, and others.

    The gain is a part of the cost as it is.  The others are the best that turn the tip otherwise, or the other end if
    that is not held, by a third of a turn or more, if these cost little more.
    """
    steps = np.arange(-_TURNS * _ANGLES, _TURNS * _ANGLES + 1)
    tried, costs = steps * (2 * np.pi / _ANGLES), costs[:, steps % _ANGLES]
    # Where a limb widens there is a joint, which turns more easily than a tube so wide.
    radii = np.minimum(limb.radii, np.median(limb.radii))
    stiffness = np.pi * ((radii[1:] + radii[:-1]) / 2) ** 3 / _WIDTH
    differences = tried[None, :] - tried[:, None]  # the next ring's angle less this one's
    # Angles of the last ring: all within a turn, and one more at either side, to tell which are minima.
    last = np.flatnonzero(np.abs(steps) <= (0 if limb.held else _ANGLES // 2 + 1))
    total = np.full((len(last), len(steps)), np.inf)
    total[np.arange(len(last)), last] = costs[-1, last]
    choices = []
    for number in range(len(stiffness) - 1, -1, -1):
        whole = total[:, None] + stiffness[number] * np.square(twists[number] + differences)
        choices.append(whole.argmin(axis=2))
        total = costs[number] + whole.min(axis=2)

    minima = total <= minimum_filter(total, 3, mode="constant", cval=np.inf)
    inside = slice(None) if limb.held else slice(1, -1)
    total, last, choices = total[inside], last[inside], [choice[inside] for choice in choices]
    minima = minima[inside] | (total == total.min())

    def angles(end: int, tip: int) -> Floats:
        """Follow the best choices from an angle of the tip to the last ring, which has one of its own."""
        path = [tip]
        for choice in choices[::-1]:
            path.append(int(choice[end, path[-1]]))
        return tried[path]

    ways = np.argwhere(minima)
    ways = ways[np.argsort(total[minima], kind="stable")]
    least, unturned = total[tuple(ways[0])], int(np.flatnonzero(steps == 0)[0])
    now = costs[:, unturned].sum() + (stiffness * np.square(twists)).sum()
    turning = least <= (1 - gain) * now
    taken = [ways[0] if turning else np.array([np.flatnonzero(last == unturned)[0], unturned])]
    # Whatever the angles, rings fit no better than that.  Of a body that is not held, none may be what it is to be.
    sure = costs.min(axis=1).sum() if limb.held else 0.0
    nearly, most = (_NEARLY, _MOST_OTHERS) if limb.held else (_LYING, _MOST_LYING)
    turns = np.arange(1) if limb.held else np.arange(-1, 2)
    for way in ways:
        if total[tuple(way)] - sure > nearly * (least - sure) or len(taken) > most:
            break
        apart = np.abs(way - np.array(taken)[:, None] + _ANGLES * turns[:, None]).max(axis=2)
        if apart.min() > _ANGLES // 3:
            taken.append(way)
    chosen = angles(*ways[0]) if turning else np.zeros(len(limb.radii))
    return chosen, [angles(*way) for way in taken[1:]]


def _moved(limb: _Limb, centres: Floats, axes: Floats, angles: Floats, positions: Floats) -> Floats:
    """Turn a limb: each vertex by the angle, and about the axis, between those of the rings beside it, (v, 3)."""
    centre, axis = (_between(limb, values) for values in (centres, axes))
    angle = np.interp(limb.distances, [ring.distance for ring in limb.rings], angles)
    turns = Rotation.from_rotvec(angle[:, None] * unit_vectors(axis))
    return centre + turns.apply(positions[limb.vertices] - centre)


def _between(limb: _Limb, values: Floats) -> Floats:
    """Interpolate values (k, 3) at the rings for the vertices, (v, 3)."""
    at = [ring.distance for ring in limb.rings]
    return np.stack([np.interp(limb.distances, at, column) for column in values.T], axis=1)
