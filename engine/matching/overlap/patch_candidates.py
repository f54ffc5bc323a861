# SPDX-License-Identifier: GPL-3.0-or-later
"""Places of one surface that look like places of another, and which of them go together."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from .oriented_patches import TURNS

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from .oriented_patches import OrientedPatches
    from .part_surface import PartSurface

__all__ = ["Candidates", "compatibilities", "patch_candidates"]

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

    first: NDArray[np.int64]
    second: NDArray[np.int64]
    credit: NDArray[np.float64]
    rotations: NDArray[np.float64]

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


def _costs(first: OrientedPatches, second: OrientedPatches) -> NDArray[np.float64]:
    """Compare all patches of two surfaces, (TURNS, s, t), by the cells that both show."""
    rings = np.sqrt(_RING_WEIGHTS)[:, None]
    total = float(_RING_WEIGHTS.sum()) * TURNS

    def moments(patches: OrientedPatches, shift: int) -> tuple[NDArray[np.float64], ...]:
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
    candidates: Candidates,
    surfaces: tuple[PartSurface, PartSurface],
    patches: tuple[OrientedPatches, OrientedPatches],
) -> NDArray[np.float32]:
    """Say of each two candidates how well they go together, (k, k), 0 to 1; those of one place do not.

    Lengths of paths, rotations and directions are compared, the less strictly the farther the places are apart: poses
    and builds differ.
    """
    numbers = candidates.first, candidates.second
    places, lengths, to_border = [], [], []
    for surface, patch, number in zip(surfaces, patches, numbers, strict=True):
        vertices = patch.vertices[number]
        places.append(surface.vertices[vertices].astype(np.float32))
        lengths.append(patch.between.astype(np.float32)[np.ix_(number, number)])
        to_border.append(surface.border_distances[vertices].astype(np.float32))
    far = (lengths[0] + lengths[1]) / 2
    past = np.zeros(far.shape, bool)
    for length, border in zip(lengths, to_border, strict=True):
        past |= length > border[:, None] + border - np.float32(1e-3)  # that is rounding
    tolerance = _LENGTHS + _STRETCH * far + past * (_PAST * np.minimum(far / _PAST_FROM, 1))
    doubt = np.square((lengths[0] - lengths[1]) / tolerance)
    del past, tolerance, lengths
    flat = candidates.rotations.astype(np.float32).reshape(-1, 9)
    angles = np.arccos(np.clip((flat @ flat.T - 1) / 2, -1, 1))
    doubt += np.square(angles / (_ROTATIONS + np.minimum(far, _FARTHEST_BEND)))
    del angles
    # Where the rotation of one has the other, against where that is.
    apart = np.zeros_like(far)
    for axis in range(3):
        along = flat[:, 3 * axis : 3 * axis + 3] @ places[0].T
        along -= np.diagonal(along)[:, None].copy()
        apart += np.square(along - (places[1][:, axis][None] - places[1][:, axis][:, None]))
    wide = (far + _BESIDE) * (_DIRECTIONS + _BENT * np.minimum(far, _FARTHEST))
    apart /= np.square(wide) * 4
    doubt += apart + apart.T
    together: NDArray[np.float32] = np.exp(-doubt, dtype=np.float32)
    together[candidates.first[:, None] == candidates.first] = 0
    credit = candidates.credit.astype(np.float32)
    together *= credit[:, None] * credit
    return together
