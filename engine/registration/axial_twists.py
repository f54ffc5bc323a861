# SPDX-License-Identifier: GPL-3.0-or-later
"""Limbs and long bodies that a registration has turned about their own axes, and how they are turned back."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from scipy.ndimage import minimum_filter
from scipy.spatial import cKDTree
from scipy.spatial.transform import Rotation

from ..geometry.procrustes import nearest_rotations
from ..runtime.arrays import Floats, Ints, unit_vectors
from ..runtime.worker import search_threads
from ..shapes.shape import Shape
from .deformable import DeformableSurface
from .limb_rings import SPACING, Limb, axis_of, forked_limbs, long_body, separate_limbs

_TRIED, _ANGLES, _TURNS = 16, 32, 2
"""Angles about the axis that are tried in a turn, how many are told apart, and how many turns either way."""

_NORMAL_LENGTH = 0.05
"""How many units of length a unit of difference of the normals counts when points are matched."""

_GAIN, _GAIN_UNLIKE = 0.02, 0.2
"""Part of its cost that turning a limb must save, in one body posed otherwise and in bodies of unlike build: rings of
these are no rigid bodies, and meet hardly better one way than another."""

_GAIN_FORKED = 0.5
"""The same for a forked limb, of what its cost is more than that of all rings at their best angles: prongs bend against
each other in any pose, so these are no rigid bodies either.  Half turns of wings save 0.5 to 0.8 of that (`python -m
tests.benchmarks.built_figures --kinds winged --pairs 10 --style even`)."""

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


def untwisted(
    shape: Shape, source: DeformableSurface, target: DeformableSurface, positions: Floats, isometry: float = 1.0
) -> Untwisted:
    r"""Turn back what a registration has turned about the axis of a limb.

    A thin limb that is placed by smooth functions is no more than a curve: which way round it lies is left to chance,
    and closest points do not turn it back.  So the rings around each limb, forked ones first, are turned about its axis
    by the angles :math:`\theta_k` of least

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
    for fork in forked_limbs(shape, source):
        positions = _turned_back([fork], source, target, positions, _GAIN_FORKED).positions
    return _turned_back(separate_limbs(shape, source), source, target, positions, gain)


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
    return _turned_back(long_body(shape, source), source, target, positions, _GAIN)


def _turned_back(
    limbs: list[Limb], source: DeformableSurface, target: DeformableSurface, positions: Floats, gain: float
) -> Untwisted:
    """Turn back limbs that have no vertex in common; the positions themselves if there is nothing to be turned."""
    if not limbs:
        return Untwisted(positions, [])
    turned = positions
    otherwise = []
    normals = source.search.moved(positions).vertex_normals
    tree = cKDTree(np.concatenate([target.vertices, _NORMAL_LENGTH * target.normals], axis=1))
    for limb in limbs:
        centres, axes = axis_of(positions, limb.rings)
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


def _best_angles(limb: Limb, costs: Floats, twists: Floats, gain: float) -> tuple[Floats, list[Floats]]:
    """Find the angles (k,) of least cost to turn the rings by, all zero if they save no more than a gain, and others.

    The gain is a part of the cost as it is, or of what that can be less if the limb forks.  The others are the best
    that turn the tip otherwise, or the other end if that is not held, by a third of a turn or more, if these cost
    little more.
    """
    steps = np.arange(-_TURNS * _ANGLES, _TURNS * _ANGLES + 1)
    tried, costs = steps * (2 * np.pi / _ANGLES), costs[:, steps % _ANGLES]
    # Where a limb widens there is a joint, which turns more easily than a tube so wide.
    radii = np.minimum(limb.radii, np.median(limb.radii))
    stiffness = np.pi * ((radii[1:] + radii[:-1]) / 2) ** 3 / SPACING
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
    # Whatever the angles, rings fit no better than that.
    best = costs.min(axis=1).sum()
    base = best if limb.is_forked else 0.0
    turning = least - base <= (1 - gain) * (now - base)
    taken = [ways[0] if turning else np.array([np.flatnonzero(last == unturned)[0], unturned])]
    # Of a body that is not held, none of the angles may be what it is to be.
    sure = best if limb.held else 0.0
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


def _moved(limb: Limb, centres: Floats, axes: Floats, angles: Floats, positions: Floats) -> Floats:
    """Turn a limb: each vertex by the angle, and about the axis, between those of the rings beside it, (v, 3)."""
    centre, axis = (_between(limb, values) for values in (centres, axes))
    angle = np.interp(limb.distances, [ring.distance for ring in limb.rings], angles)
    turns = Rotation.from_rotvec(angle[:, None] * unit_vectors(axis))
    return centre + turns.apply(positions[limb.vertices] - centre)


def _between(limb: Limb, values: Floats) -> Floats:
    """Interpolate values (k, 3) at the rings for the vertices, (v, 3)."""
    at = [ring.distance for ring in limb.rings]
    return np.stack([np.interp(limb.distances, at, column) for column in values.T], axis=1)
