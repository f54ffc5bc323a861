# SPDX-License-Identifier: GPL-3.0-or-later
"""Places of one surface that look like places of another, and which of them go together."""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ...runtime.arrays import Floats, Ints, slices
from .oriented_patches import TURNS, OrientedPatches
from .part_surface import PartSurface

_RING_WEIGHTS = np.array([1.0, 1.0, 0.9, 0.7, 0.5, 0.35])
"""How much each ring counts, from the inside out: poses and cuts change what is far away."""

_BEST, _BEST_BACK = 9, 4
"""Candidates for each place of the first surface, and places of the first for each of the second."""

_ABSENT, _LEAST_SEEN, _UNSEEN = 0.25, 0.35, 0.5
"""How much what only one of two patches shows counts, as if it differed by so much; and part of the cells that both
must show for the pair not to count as differing by so much more."""

_SECOND_TURN = 0.1
"""How much worse than the best turn of two patches another may be."""

_FAIR, _DOUBT = 0.05, 0.5
"""Difference of two patches up to which they are as good as any, and by how much more they count e times less."""

_LENGTHS, _STRETCH, _PAST, _PAST_FROM = 0.03, 0.13, 0.06, 0.3
"""By how much lengths between two places may differ on the two surfaces: some, a part of them, and more if a path may
lead past a border, where one of the surfaces is cut off, from a length on wholly."""

_ROTATIONS, _FARTHEST_BEND = 0.35, 0.7
"""By how much, in radians, rotations of two places may differ: some, and as much more as their distance in units of
length, up to a distance: limbs bend."""

_DIRECTIONS, _BENT, _FARTHEST, _BESIDE = 0.4, 0.35, 0.8, 0.04
"""By how much, as a part of the distance, a place may lie beside where the rotation of another has it: some, and as
much more as a part of their distance, up to a distance; the last is added to short distances."""


_ROWS = 128
"""Rows of what goes together that are computed at once."""


@dataclass(frozen=True, eq=False)
class Candidates:
    """Pairs of a place of one surface and one of another, in the order of the former, k.

    Attributes
    ----------
    first, second : (k,) array of int
        Numbers of the patches.
    credit : (k,) array of float
        How alike they are, 0 to 1.
    rotations : (k, 3, 3) array of float
        What turns the surroundings of the former to lie like those of the latter.
    """

    first: Ints
    second: Ints
    credit: Floats
    rotations: Floats

    def __len__(self) -> int:
        return len(self.first)


def patch_candidates(first: OrientedPatches, second: OrientedPatches) -> Candidates:
    """Find for each patch of a surface some of the other that look like it, and how to turn it."""
    costs = _costs(first, second)  # (TURNS, s, t)
    best = costs.min(axis=0)
    chosen = np.zeros(best.shape, bool)
    np.put_along_axis(chosen, np.argsort(best, axis=1, kind="stable")[:, :_BEST], values=True, axis=1)
    np.put_along_axis(chosen, np.argsort(best, axis=0, kind="stable")[:_BEST_BACK], values=True, axis=0)
    here, there = np.nonzero(chosen)
    turned = costs[:, here, there].T  # (k, TURNS)
    valley = (turned <= np.roll(turned, 1, axis=1)) & (turned <= np.roll(turned, -1, axis=1))
    valley &= turned < turned.min(axis=1, keepdims=True) + _SECOND_TURN
    order = np.argsort(np.where(valley, turned, np.inf), axis=1, kind="stable")[:, :2]
    pairs, places = np.nonzero(np.take_along_axis(valley, order, axis=1))
    turns = order[pairs, places]
    angles = turns * (2 * np.pi / TURNS)
    about = np.zeros((len(pairs), 3, 3))
    about[:, 0, 0] = about[:, 1, 1] = np.cos(angles)
    about[:, 1, 0] = np.sin(angles)
    about[:, 0, 1] = -about[:, 1, 0]
    about[:, 2, 2] = 1
    here, there = here[pairs], there[pairs]
    rotations = second.frames[there].transpose(0, 2, 1) @ about @ first.frames[here]
    credit = np.exp(-np.maximum(turned[pairs, turns] - _FAIR, 0) / _DOUBT)
    return Candidates(here, there, credit, rotations)


def _costs(first: OrientedPatches, second: OrientedPatches) -> Floats:
    """Compare all patches of two surfaces, (TURNS, s, t), by the cells that both show."""
    rings = np.sqrt(_RING_WEIGHTS)[:, None]
    total = float(_RING_WEIGHTS.sum()) * TURNS

    def moments(patches: OrientedPatches, shift: int) -> tuple[Floats, ...]:
        """Weights of the cells, and with these the values and their squares, each in one row for a patch."""
        weights = np.roll(patches.weights * rings, shift, axis=2)
        values = np.roll(patches.values, shift, axis=2)
        each = weights, weights[..., None] * values, weights * np.square(values).sum(axis=-1)
        return tuple(part.reshape(len(patches), -1) for part in each)

    there = moments(second, 0)
    costs = np.empty((TURNS, len(first), len(second)))
    for turn in range(TURNS):
        here = moments(first, turn)
        common = here[0] @ there[0].T
        squares = here[2] @ there[0].T + here[0] @ there[2].T - 2 * here[1] @ there[1].T
        costs[turn] = squares / np.maximum(common, np.finfo(float).eps) + _ABSENT * (1 - common / total)
        costs[turn][common < _LEAST_SEEN * total] += _UNSEEN
    return costs


def compatibilities(
    candidates: Candidates, surfaces: tuple[PartSurface, PartSurface], patches: tuple[OrientedPatches, OrientedPatches]
) -> NDArray[np.float32]:
    """Say of each two candidates how well they go together, (k, k), 0 to 1; those of one place do not.

    Lengths of paths, rotations and directions are compared, the less strictly the farther the places are apart: poses
    and builds differ.
    """
    numbers = candidates.first, candidates.second
    sides = [
        _Side(
            surface.vertices[patch.vertices[number]].astype(np.float32),
            patch.between.astype(np.float32)[:, number],
            surface.border_distances[patch.vertices[number]].astype(np.float32),
            number,
        )
        for surface, patch, number in zip(surfaces, patches, numbers, strict=True)
    ]
    rotations, credit = candidates.rotations.astype(np.float32), candidates.credit.astype(np.float32)
    places = _place_terms(rotations, sides[0].places, sides[1].places)
    together = np.empty((len(candidates), len(candidates)), np.float32)
    for rows in slices(len(candidates), _ROWS):
        others = slice(rows.start, None)  # those before go together with them as they do with those
        block = np.exp(-_doubts((sides[0], sides[1]), rotations.reshape(-1, 9), places, rows))
        block[candidates.first[rows, None] == candidates.first[others]] = 0
        block *= credit[rows, None] * credit[others]
        together[rows, others] = block
        together[others, rows] = block.T
    return together


class _Side(NamedTuple):
    """The places of k candidates on one surface.

    Attributes
    ----------
    places : (k, 3) array of float
        Where they are.
    lengths : (s, k) array of float
        Lengths of paths from each patch.
    to_border : (k,) array of float
        Distances to where the surface was cut.
    patches : (k,) array of int
        Their patches.
    """

    places: NDArray[np.float32]
    lengths: NDArray[np.float32]
    to_border: NDArray[np.float32]
    patches: Ints


def _place_terms(
    rotations: NDArray[np.float32], here: NDArray[np.float32], there: NDArray[np.float32]
) -> tuple[NDArray[np.float32], NDArray[np.float32]]:
    """Take apart how far off two candidates lie by each other's rotations: (k, 34) twice, the products of which tell.

    The square of the distance between where the rotation of i, about its own place, has the place of j and where that
    is, is a sum of products of what is known of i and what is known of j; and so it is the other way round.
    """
    offsets = there - np.einsum("kab,kb->ka", rotations, here)
    back = np.einsum("kab,ka->kb", rotations, offsets)
    ones = np.ones((len(here), 1), np.float32)
    size = np.square(offsets).sum(axis=1, keepdims=True)
    turning = np.concatenate([-2 * rotations.reshape(-1, 9), 2 * back, -2 * offsets, size, ones], axis=1)
    sizes = (np.square(here) + np.square(there)).sum(axis=1, keepdims=True)
    products = (there[:, :, None] * here[:, None, :]).reshape(-1, 9)
    turned = np.concatenate([products, here, there, ones, sizes], axis=1)
    return np.concatenate([turning, turned], axis=1), np.concatenate([turned, turning], axis=1)


def _doubts(
    sides: tuple[_Side, _Side],
    rotations: NDArray[np.float32],
    places: tuple[NDArray[np.float32], NDArray[np.float32]],
    rows: slice,
) -> NDArray[np.float32]:
    """Say how much speaks against some candidates, the rows, going together with those from the first of them on.

    Parameters
    ----------
    sides : pair of _Side
        Of both surfaces.
    rotations : (k, 9) array of float
        The rotations.
    places : pair of (k, 34) arrays of float
        See `_place_terms`.
    rows : slice
        Which, r of k.

    Returns
    -------
    (r, c) array of float
        Sums of squares.
    """
    others = slice(rows.start, None)
    lengths = [side.lengths[side.patches[rows], others] for side in sides]
    far = (lengths[0] + lengths[1]) / 2
    past = np.zeros(far.shape, bool)
    for side, length in zip(sides, lengths, strict=True):
        past |= length > side.to_border[rows, None] + side.to_border[others] - np.float32(1e-3)  # that is rounding
    tolerance = _LENGTHS + _STRETCH * far + past * (_PAST * np.minimum(far / _PAST_FROM, 1))
    doubts = np.square((lengths[0] - lengths[1]) / tolerance)
    angles = np.arccos(np.clip((rotations[rows] @ rotations[others].T - 1) / 2, -1, 1))
    doubts += np.square(angles / (_ROTATIONS + np.minimum(far, _FARTHEST_BEND)))
    # Where the rotation of one has the other, and of the other the one, against where these are.
    apart = np.maximum(places[0][rows] @ places[1][others].T, 0)
    wide = (far + _BESIDE) * (_DIRECTIONS + _BENT * np.minimum(far, _FARTHEST))
    return doubts + apart / (np.square(wide) * 4)
