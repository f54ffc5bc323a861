# SPDX-License-Identifier: GPL-3.0-or-later
"""Non-rigid registration of two surfaces of each of which only a part may have a partner on the other."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.sparse import diags_array
from scipy.spatial import cKDTree

from ...geometry.procrustes import nearest_rotations
from ...geometry.symmetric_factor import symmetric_factor
from ...runtime.arrays import Bools, Floats, Ints, group_sums
from .part_surface import PartSurface

_LEAST_FACING = 0.05
"""Least part of its area with which a point counts whose normal disagrees with that of its match."""

_ROTATION_RADIUS = 0.06
"""Over what distance rotations are averaged, in units of length."""

_HELD_ROUNDS = 3
"""Rounds in which the landmarks still hold."""

_GROWN, _GROWTH = 0.08, 0.1
"""Distance from the landmarks up to which points are matched in the first round, and by how much it grows in each."""

_SOLVES = 2
"""How often rotations and positions are found for the same matches."""

_TETHER = 1e-9
"""What keeps the system regular where nothing is matched."""

_LANDMARK_WEIGHT, _ROTATION_SPREAD, _SPREAD_RADIUS, _PLACINGS = 20.0, 4e-3, 0.08, 3
"""How a surface is first placed by landmarks: their weight, how long their rotations spread in units of area, the
distance that rotations are averaged over afterwards, and how often."""

_FEW_PAIRS = 1_000_000
"""Pairs up to which comparing all of them is faster than trees: twice as fast at 800 by 800."""

_MEMBER_GAP, _MEMBER_FACING, _MEMBER_SMOOTHING = 0.045, 0.2, 5e-4
"""Distance to its match up to which, and agreement of normals from which on, a vertex has a partner, and how long that
is smoothed, in units of area."""


@dataclass(frozen=True)
class Round:
    """One round of a registration.

    Attributes
    ----------
    weight : float
        How much the squared distance of matched points counts against the elastic energy.
    reach : float
        Distance, in units of length, at which a match counts exp(-1/2).
    normal_length, curvature_length : float
        How many units of length a unit of difference of the normals, and of the curvatures, counts when points are
        matched.
    """

    weight: float
    reach: float
    normal_length: float
    curvature_length: float


_ROUNDS = (
    Round(5, 0.2, 0.2, 0.2),
    Round(10, 0.2, 0.2, 0.2),
    Round(20, 0.15, 0.2, 0.2),
    Round(40, 0.15, 0.2, 0.2),
    Round(80, 0.12, 0.15, 0.15),
    Round(160, 0.1, 0.15, 0.15),
    Round(320, 0.08, 0.1, 0.05),
    Round(640, 0.08, 0.1, 0.05),
    Round(1280, 0.06, 0.1, 0.05),
)
"""From stiff and far to soft and close."""


def _rounds(*numbers: int) -> tuple[Round, ...]:
    return tuple(_ROUNDS[number] for number in numbers)


FAST = _rounds(0, 2, 4, 5, 5, 6, 7)
"""From a rough start, where there are many."""

REST = _rounds(1, 3, 4, 5, 6, 7, 8, 8)
"""Once more all the way from where a good one ended, to come to rest."""

FINE = _rounds(5, 6, 7, 8, 8)
"""In full resolution."""

TURNED = _rounds(4, 5, 5, 6, 7)
"""The other surface onto this one, from what was found."""

_FOUND = Round(0, 0.06, 0.1, 0.05)
"""How points are matched at last."""


@dataclass(frozen=True, eq=False)
class Marks:
    """Vertices (k,) that are to go to places (k, 3), and how much each counts, (k,)."""

    vertices: Ints
    places: Floats
    weights: Floats


@dataclass(frozen=True, eq=False)
class PartMatches:
    """What the vertices of one surface are matched to.

    Attributes
    ----------
    images : (n,) array of int
        The vertex of the other surface that is most like each.
    gaps : (n,) array of float
        How far that is.
    facing : (n,) array of float
        How far their normals agree, 0 to 1.
    credit : (n,) array of float
        How much the match counts: nothing if it is where the other surface was cut off, and this one was not.
    """

    images: Ints
    gaps: Floats
    facing: Floats
    credit: Floats


@dataclass(frozen=True, eq=False)
class Fit:
    """One surface laid onto another, as far as they overlap.

    Attributes
    ----------
    positions : (n, 3) array of float
        Where its vertices are.
    rotations : (n, 3, 3) array of float
        How each is turned.
    energies : (n,) array of float
        Share of each in the elastic energy.
    there, back : PartMatches
        Of its vertices, and of the other's.
    members, members_back : array of bool, (n,) and (n',)
        Which vertices of it, and of the other surface, have a partner.
    """

    positions: Floats
    rotations: Floats
    energies: Floats
    there: PartMatches
    back: PartMatches
    members: Bools
    members_back: Bools


def placed(surface: PartSurface, marks: Marks, rotations: Floats, paths: Floats) -> tuple[Floats, Marks]:
    """Place a surface by landmarks, all else following as rigidly as it can.

    Parameters
    ----------
    surface : PartSurface
        The surface, n vertices.
    marks : Marks
        Vertices that are known to go somewhere.
    rotations : (k, 3, 3) array of float
        How each of these is turned.
    paths : (k, n) array of float
        Lengths of paths from these to all vertices.

    Returns
    -------
    positions : (n, 3) array of float
        Where the vertices are.
    marks : Marks
        The landmarks with weights that sum to one.
    """
    nearest = rotations[paths.argmin(axis=0)]
    turned = nearest_rotations(surface.smoothed(nearest, _ROTATION_SPREAD))
    weights = marks.weights / marks.weights.sum()
    amounts = _LANDMARK_WEIGHT * weights
    elastic, count = surface.elastic, surface.count
    held = np.bincount(marks.vertices, amounts, count)
    factor = symmetric_factor(elastic.stiffness + diags_array(held + _TETHER))
    right = group_sums(marks.vertices, amounts[:, None] * marks.places, count)
    positions = factor.solve(elastic.pull(turned) + right)
    for _ in range(_PLACINGS):
        positions = factor.solve(elastic.pull(elastic.rotations(positions, _SPREAD_RADIUS)) + right)
    return positions, Marks(marks.vertices, marks.places, weights)


def register_parts(
    source: PartSurface,
    target: PartSurface,
    start: Floats,
    rounds: tuple[Round, ...],
    *,
    marks: Marks | None = None,
    from_marks: Floats | None = None,
    done: int = 0,
) -> Fit:
    """Deform a surface onto another, where both have a partner.

    As `register_steps` of whole surfaces, but the farther a match is, the less it counts, and one that is where the
    other surface was cut off does not at all: what lies beyond has no partner.

    Parameters
    ----------
    source, target : PartSurface
        The surfaces, n and n' vertices.
    start : (n, 3) array of float
        Positions of the source's vertices to begin with.
    rounds : tuple of Round
        How stiff the surface is, round after round.
    marks : Marks, optional
        What holds the surface in the first rounds.
    from_marks : (n,) array of float, optional
        Distance of each vertex from these: what is far is matched in later rounds only, when it is in place.
    done : int
        Rounds that went before.
    """
    positions, count, elastic = start, source.count, source.elastic
    for number, stage in enumerate(rounds, done):
        there, back = _matched(source, target, positions, stage)
        own, theirs = stage.weight * source.mass * there.credit, stage.weight * target.mass * back.credit
        if from_marks is not None:
            reached = from_marks < _GROWN + _GROWTH * number
            own, theirs = own * reached, theirs * reached[back.images]
        held = own + np.bincount(back.images, theirs, count) + _TETHER
        right = own[:, None] * target.vertices[there.images]
        right += group_sums(back.images, theirs[:, None] * target.vertices, count)
        if marks is not None and number < _HELD_ROUNDS:
            amounts = stage.weight * marks.weights
            held += np.bincount(marks.vertices, amounts, count)
            right += group_sums(marks.vertices, amounts[:, None] * marks.places, count)
        factor = symmetric_factor(elastic.stiffness + diags_array(held))
        for _ in range(_SOLVES):
            positions = factor.solve(elastic.pull(elastic.rotations(positions, _ROTATION_RADIUS)) + right)
    there, back = _matched(source, target, positions, _FOUND)
    rotations = elastic.rotations(positions, _ROTATION_RADIUS)
    energies = elastic.energies(positions, rotations)
    return Fit(positions, rotations, energies, there, back, *(_members(source, there), _members(target, back)))


def _matched(
    source: PartSurface, target: PartSurface, positions: Floats, stage: Round
) -> tuple[PartMatches, PartMatches]:
    """Find for each vertex of either surface the most similar one of the other."""
    normals = source.search.moved(positions).vertex_normals
    features = [
        np.concatenate([places, stage.normal_length * own, stage.curvature_length * surface.curvatures], axis=1)
        for surface, places, own in ((source, positions, normals), (target, target.vertices, target.normals))
    ]
    images = _nearest(features[0], features[1])
    gaps = (
        np.linalg.norm(positions - target.vertices[images[0]], axis=1),
        np.linalg.norm(target.vertices - positions[images[1]], axis=1),
    )
    facing = _facing(normals, target.normals[images[0]]), _facing(normals[images[1]], target.normals)
    ends = target.border[images[0]] & ~source.border, source.border[images[1]] & ~target.border
    there, back = (
        PartMatches(image, gap, facing, facing * np.exp(-np.square(gap / stage.reach) / 2) * ~end)
        for image, gap, facing, end in zip(images, gaps, facing, ends, strict=True)
    )
    return there, back


def _nearest(first: Floats, second: Floats) -> tuple[Ints, Ints]:
    """Find for each row of either of two arrays, (n, d) and (n', d), the nearest of the other, (n,) and (n',)."""
    if len(first) * len(second) > _FEW_PAIRS:
        trees = [cKDTree(each, balanced_tree=False, compact_nodes=False) for each in (first, second)]
        return trees[1].query(first)[1], trees[0].query(second)[1]
    # All pairs in one product: x y - |x|^2 / 2 - |y|^2 / 2, in half the memory, from the middle where digits are few.
    sides = [(each - second.mean(axis=0)).astype(np.float32) for each in (first, second)]
    halves = [np.square(side).sum(axis=1, keepdims=True) / -2 for side in sides]
    ones = [np.ones_like(half) for half in halves]
    likeness = np.hstack([sides[0], halves[0], ones[0]]) @ np.hstack([sides[1], ones[1], halves[1]]).T
    return likeness.argmax(axis=1), likeness.argmax(axis=0)


def _facing(first: Floats, second: Floats) -> Floats:
    """How far unit normals (k, 3) agree, (k,): their product squared, or little where they turn away."""
    return np.clip(np.einsum("kd,kd->k", first, second), _LEAST_FACING, 1) ** 2


def _members(surface: PartSurface, matches: PartMatches) -> Bools:
    """Say which vertices, (n,), have a partner: of these the largest connected piece, smooth in outline."""
    close = (matches.credit > 0) & (matches.gaps < _MEMBER_GAP) & (matches.facing > _MEMBER_FACING)
    return surface.largest_piece(surface.smoothed(close.astype(np.float64), _MEMBER_SMOOTHING) > 1 / 2)
