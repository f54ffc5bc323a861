# SPDX-License-Identifier: GPL-3.0-or-later
"""Bones from a deformation: the transforms with which skinning explains best where the vertices of a body went."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import pairwise
from typing import NamedTuple

import numpy as np
from scipy.sparse import csr_array, diags_array

from ...geometry.procrustes import nearest_rotations, nearest_similarity
from ...geometry.symmetric_factor import symmetric_factor
from ...runtime.arrays import TINY, Floats, Ints, numbered, ranges
from ..weights.skin_weights import row_sums
from .skeleton import Skeleton

_ROUNDS = 12
"""Rounds of finding transforms, their nearest similarities and the trust in each vertex in turn."""

_MORE_ROUNDS = 4
"""The same from what the transforms were before the body slid a little.  Of four pairs of ``python -m
tests.benchmarks.several_objects`` joints are as near as with all rounds, within 0.02 % of the height, if the last fit
has all of them; farther by 0.03 if not."""

_SIMILARITY = 1.0
"""How much a transform that is no similarity counts, against the second moment of the vertices that it moves."""

_JOINT = 3.0
"""How much the distance of the two ends at a joint counts, against the mass of the lighter bone there."""

_LEAST_MASS = 1e-4
"""Least part of the body's area with which a joint counts."""

_WEIGHTLESS = 1e-3
"""A bone that moves less than this part of a vertex altogether moves none."""

_DOUBT = 0.005
"""Residual, in units of the root of the target's area, at which a vertex counts half."""

_ROOT_OF_AREA = 3.0
"""Root of a body's area against the root mean squared distance of its surface from its middle: 3 to 4 for bodies."""

_LENIENT = 4.0
"""How many times as much the first round forgives: the first transforms are rough everywhere."""

_MOST_SCALE = 2.5
"""Largest factor between the scale of a bone and that of the whole body."""

_COMMON_LENGTH, _COMMON_WIDTH = 0.5, 0.1
"""How far a bone's stretch along itself, and that across, is drawn to the body's in each round."""


@dataclass(frozen=True, eq=False)
class BoneTransforms:
    """One affine transform per bone, b of them; `FittedRig` tells what they are.

    Attributes
    ----------
    linear : (b, 3, 3) array of float
        Linear parts.
    translations : (b, 3) array of float
        Translations.
    rotations : (b, 3, 3) array of float
        The nearest rotations.
    scales : (b,) array of float
        Mean scales.
    posed : (n, 3) array of float
        The vertices, moved by their bones.
    """

    linear: Floats
    translations: Floats
    rotations: Floats
    scales: Floats
    posed: Floats


def fit_bones(
    vertices: Floats,
    positions: Floats,
    areas: Floats,
    weights: csr_array,
    skeleton: Skeleton,
    *,
    begun: BoneTransforms | None = None,
) -> BoneTransforms:
    r"""Find the transforms of all bones at once.

    Skinning moves a vertex :math:`v_i` to :math:`\sum_b w_{ib} (M_b v_i + t_b)`.  The transforms are those that bring
    all vertices nearest to where they went, in least squares with robust weights, while parent and child agree at
    each joint and each :math:`M_b` is close to a similarity: everything is linear but the similarities, which are
    found in turn with the transforms.

    Parameters
    ----------
    vertices : (n, 3) array of float
        The body at rest.
    positions : (n, 3) array of float
        Where its vertices went.
    areas : (n,) array of float
        How much each vertex counts; 0 for one whose position is not known.
    weights : (n, b) csr_array of float
        How much each bone moves each vertex; rows sum to one or are empty.
    skeleton : Skeleton
        The bones, b.
    begun : BoneTransforms, optional
        What the transforms were when the vertices went nearly there: fewer rounds lead from there to nearly the same.

    Returns
    -------
    BoneTransforms
        A bone that moves nothing follows its nearest ancestor that does, or else the whole body.
    """
    areas = np.where(row_sums(weights) > 0, areas, 0.0)
    areas = areas / areas.sum()
    active = np.flatnonzero(areas @ weights > _WEIGHTLESS * areas[areas > 0].min())
    place = np.append(numbered(active, len(skeleton)), len(active))  # the last for the body as a whole
    above = place[skeleton.nearest_above(place[:-1] >= 0)]
    leaders = np.where(place[:-1] >= 0, place[:-1], above)
    child = np.flatnonzero(above[active] < len(active))
    joints = _Joints(child, above[active[child]], skeleton.heads[active[child]])
    axes = skeleton.axes[active]
    system = _System(vertices, positions, areas, csr_array(weights[:, active]), joints, axes=axes)
    if begun is None:
        linear, translations = system.solved()
    else:
        linear, translations = system.solved_from(begun.linear[active], begun.translations[active])
    whole = nearest_similarity(vertices, positions, areas)
    linear = np.concatenate([linear, whole[0][None]])[leaders]
    translations = np.concatenate([translations, whole[1][None]])[leaders]
    rotations = nearest_rotations(linear)
    scales = np.einsum("kij,kij->k", rotations, linear) / 3
    posed = skinned(vertices, weights, linear, translations)
    loose = row_sums(weights) <= 0
    posed[loose] = vertices[loose] @ whole[0].T + whole[1]
    return BoneTransforms(linear, translations, rotations, scales, posed)


def skinned(vertices: Floats, weights: csr_array, linear: Floats, translations: Floats) -> Floats:
    """Move vertices (n, 3) by bones with the weights (n, b): linear blend skinning."""
    blended = (weights @ linear.reshape(-1, 9)).reshape(-1, 3, 3)
    return np.einsum("nij,nj->ni", blended, vertices) + weights @ translations


class _Joints(NamedTuple):
    """Where active bones hang on their nearest active ancestors: numbers (j,) of both, and places (j, 3) at rest."""

    child: Ints
    above: Ints
    places: Floats


def _shared_vertices(weights: csr_array) -> tuple[Ints, csr_array]:
    """Pairs of bones (p, 2) that share vertices, both ways round, and products (p, n) of their weights (n, b) there."""
    counts, count = np.diff(weights.indptr), weights.shape[1]
    rows = np.repeat(np.arange(len(counts)), counts)
    first = np.repeat(np.arange(weights.nnz), counts[rows])
    second = ranges(weights.indptr[rows], counts[rows])
    keys = weights.indices[first].astype(np.int64) * count + weights.indices[second]
    pairs = np.flatnonzero(np.bincount(keys, minlength=count**2))
    number = numbered(pairs, count**2)[keys]
    products = weights.data[first] * weights.data[second]
    shared = csr_array((products, (number, rows[first])), shape=(len(pairs), len(counts)))
    return np.stack([pairs // count, pairs % count], axis=1), shared


class _System:
    """The least squares problem of k bones that move vertices."""

    def __init__(
        self, vertices: Floats, positions: Floats, areas: Floats, weights: csr_array, joints: _Joints, *, axes: Floats
    ) -> None:
        lengths = np.linalg.norm(axes, axis=1, keepdims=True)
        self._axes = np.where(lengths > 0, axes / np.maximum(lengths, TINY), [0.0, 0.0, 1.0])
        self._positions, self._areas, count = positions, areas, weights.shape[1]
        # Around the middle of the body and in its size, so that the four columns of a bone are of one magnitude.
        self._middle = areas @ vertices
        self._size = float(np.sqrt(areas @ np.square(vertices - self._middle).sum(axis=1)))
        local = (vertices - self._middle) / self._size
        self._lengths = float(np.sqrt(areas @ np.square(positions - areas @ positions).sum(axis=1)))
        self._weights = weights
        self._ends = np.concatenate([local, np.ones((len(local), 1))], axis=1)  # (n, 4)
        self._pairs, self._shared = _shared_vertices(weights)
        self._mass = mass = areas @ weights
        self._ties = self._tied(joints, mass)
        self._moved = weights.tocsc()
        moments = np.empty(count)
        for bone, (moved, share, _) in enumerate(self._each_bone()):
            centre = share @ local[moved] / max(share.sum(), TINY)
            moments[bone] = share @ np.square(local[moved] - centre).sum(axis=1) / 3
        self._pull = np.zeros((count, 4))
        self._pull[:, :3] = _SIMILARITY * np.maximum(moments, _LEAST_MASS**2)[:, None]

    def _tied(self, joints: _Joints, mass: Floats) -> csr_array:
        """Weighted rows that say that both bones of a joint take it to the same place, times their transpose."""
        child, above, places = joints
        count = len(child)
        ends = np.concatenate([(places - self._middle) / self._size, np.ones((count, 1))], axis=1)
        rows = np.repeat(np.arange(count), 8)
        columns = np.concatenate([4 * child[:, None] + np.arange(4), 4 * above[:, None] + np.arange(4)], axis=1)
        values = np.concatenate([ends, -ends], axis=1)
        ties = csr_array((values.ravel(), (rows, columns.ravel())), shape=(count, 4 * len(mass)))
        strength = _JOINT * np.maximum(np.minimum(mass[child], mass[above]), _LEAST_MASS)
        return csr_array(ties.T @ diags_array(strength) @ ties)

    def _each_bone(self) -> Iterator[tuple[Ints, Floats, Floats]]:
        """Name the vertices that each bone moves, their shares of the body in it, and its weights there."""
        for start, end in pairwise(self._moved.indptr):
            moved, weight = self._moved.indices[start:end], self._moved.data[start:end]
            yield moved, self._areas[moved] * weight, weight

    def solved(self) -> tuple[Floats, Floats]:
        """Find the transforms of the bones: linear parts (k, 3, 3) and translations (k, 3)."""
        similar = np.empty((len(self._mass), 3, 3))
        for bone, (moved, share, weight) in enumerate(self._each_bone()):
            sharp = np.maximum(share * weight, TINY)
            similar[bone] = nearest_similarity(self._ends[moved, :3], self._positions[moved], sharp)[0]
        return self._refined(similar, self._areas, range(_ROUNDS))

    def solved_from(self, linear: Floats, translations: Floats) -> tuple[Floats, Floats]:
        """Find them from what they nearly are."""
        blocks = np.concatenate(
            [self._size * linear.transpose(0, 2, 1), (translations + linear @ self._middle)[:, None]], axis=1
        )
        trust = self._trust(blocks, 1.0)
        return self._refined(self._stretched(self._size * linear), trust, range(_ROUNDS - _MORE_ROUNDS, _ROUNDS))

    def _trust(self, blocks: Floats, lenience: float) -> Floats:
        """Trust in each vertex, (n,), by how far it is from where transforms (k, 4, 3) take it."""
        moved = np.einsum("ni,nij->nj", self._ends, (self._weights @ blocks.reshape(-1, 12)).reshape(-1, 4, 3))
        missed = np.linalg.norm(moved - self._positions, axis=1)
        return self._areas / (1 + (missed / (lenience * _DOUBT * _ROOT_OF_AREA * self._lengths)) ** 2)

    def _refined(self, similar: Floats, trust: Floats, rounds: range) -> tuple[Floats, Floats]:
        """Find transforms, similarities (k, 3, 3) near them, and the trust (n,) in each vertex, in turn."""
        count = len(similar)
        blocks = np.zeros((count, 4, 3))
        squares = np.einsum("ni,nj->nij", self._ends, self._ends).reshape(-1, 16)
        images = np.einsum("ni,nj->nij", self._ends, self._positions).reshape(-1, 12)
        pull = diags_array(self._pull.ravel() + np.finfo(float).eps)
        for number in rounds:
            normal = self._normal(self._shared @ (trust[:, None] * squares)) + self._ties + pull
            wanted = np.concatenate([similar.transpose(0, 2, 1), np.zeros((count, 1, 3))], axis=1).reshape(-1, 3)
            right = (self._weights.T @ (trust[:, None] * images)).reshape(-1, 3) + self._pull.ravel()[:, None] * wanted
            blocks = symmetric_factor(normal).solve(right).reshape(count, 4, 3)
            similar = self._stretched(blocks[:, :3].transpose(0, 2, 1))
            trust = self._trust(blocks, max(1.0, _LENIENT * (1 - 2 * number / _ROUNDS)))
        linear = blocks[:, :3].transpose(0, 2, 1) / self._size
        return linear, blocks[:, 3] - linear @ self._middle

    def _normal(self, moments: Floats) -> csr_array:
        """Matrix (4 k, 4 k) of the second moments (p, 16) of what pairs of bones share, a block for each pair."""
        corners = np.arange(4)
        rows = np.broadcast_to(4 * self._pairs[:, 0, None, None] + corners[:, None], (len(moments), 4, 4)).ravel()
        columns = np.broadcast_to(4 * self._pairs[:, 1, None, None] + corners, (len(moments), 4, 4)).ravel()
        return csr_array((moments.ravel(), (rows, columns)), shape=self._ties.shape)

    def _stretched(self, linear: Floats) -> Floats:
        """Find rotations with a stretch along the bone and one across near linear parts (k, 3, 3).

        A limb that is thicker need not be longer: a similarity would make it so, and its points would slide along it.
        Neither stretch is much unlike that of the rest of the body.
        """
        rotations = nearest_rotations(linear)
        strain = np.einsum("kji,kjl->kil", rotations, linear)
        along = np.einsum("ki,kij,kj->k", self._axes, strain, self._axes)
        across = (np.trace(strain, axis1=1, axis2=2) - along) / 2
        along, across = self._usual(along, _COMMON_LENGTH), self._usual(across, _COMMON_WIDTH)
        outer = self._axes[:, :, None] * self._axes[:, None, :]
        stretch = across[:, None, None] * np.eye(3) + (along - across)[:, None, None] * outer
        return rotations @ stretch

    def _usual(self, scales: Floats, part: float) -> Floats:
        """Draw scales (k,) of bones to that of the body."""
        logarithms = np.log(np.maximum(scales, TINY))
        common = self._mass @ logarithms / self._mass.sum()
        most = np.log(_MOST_SCALE)
        return np.exp(common + np.clip((1 - part) * (logarithms - common), -most, most))
