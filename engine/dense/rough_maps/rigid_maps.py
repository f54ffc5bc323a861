# SPDX-License-Identifier: GPL-3.0-or-later
"""Maps between surfaces of the same pose: one is laid onto the other as a rigid body."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np
from scipy.spatial import cKDTree
from scipy.spatial.transform import Rotation

from ...geometry.best_distinct import best_distinct
from ...geometry.procrustes import nearest_rotations
from ...runtime.arrays import Floats, Ints
from ..functional_maps import PointMaps
from ..spectral_domain import MapDomain

_TURNS = Rotation.create_group("I").as_matrix()
"""Rotations of an icosahedron, (60, 3, 3): any rotation is at most 45 degrees from one.  They contain those that turn
principal axes over, so that it does not matter which way round these are taken."""

_PLACES = 40
"""Samples of either surface that are laid onto the other."""

_ROUNDS = ((60, 8), (18, 8), (6, 14))
"""How many ways to lay it are followed, the best, and how often closest points are looked for."""

_NORMAL, _CURVATURE = 0.3, 0.15
"""Distances, in sqrt(area), that a difference of normals and one of mean curvatures count as: positions alone come to
rest at the next bump."""

_MET = 0.8
"""Part of the samples of either surface, the nearest, that the other is laid onto: what it lacks has no partner."""

_RESIZED = 1.3
"""How much larger or smaller a surface may become, as much of the area of one of them may be missing."""

_RIGID = 0.012
"""Mean distance of these, in sqrt(area), up to which surfaces are taken for the same rigid body.  It is measured along
the normals, as their samples lie elsewhere."""

_MOST = 2
_DISTINCT = 0.07  # mean distance, in sqrt(area), between the images of distinct maps


class _Motions(NamedTuple):
    """Ways to lay X onto Y: rotations (r, 3, 3), scales (r,), and translations (r, 3)."""

    rotations: Floats
    scales: Floats
    translations: Floats

    def of(self, numbers: Ints) -> _Motions:
        """Take some of them."""
        return _Motions(*(values[numbers] for values in self))

    def there(self, places: Floats) -> Floats:
        """Take places of X, (k, 3), to Y, (r, k, 3)."""
        turned = places @ self.rotations.transpose(0, 2, 1)
        return self.scales[:, None, None] * turned + self.translations[:, None]

    def back(self, places: Floats) -> Floats:
        """Take places of Y, (k, 3), to X, (r, k, 3)."""
        return (places - self.translations[:, None]) @ self.rotations / self.scales[:, None, None]


@dataclass(frozen=True, eq=False)
class _Matches:
    """What is closest to samples of either surface where X lies on Y in some ways.

    Attributes
    ----------
    on_y : (r, k) array of int
        The fine samples of Y closest to samples of X.
    on_x : (r, l) array of int
        The fine samples of X closest to samples of Y.
    lengths : pair of (r, k) and (r, l) arrays of float
        How far they are.
    """

    on_y: Ints
    on_x: Ints
    lengths: tuple[Floats, Floats]

    @cached_property
    def weights(self) -> tuple[Floats, Floats]:
        """Equal weights of those of either surface that are near, (r, k) and (r, l); of both they sum to one."""
        first, second = (_nearest(lengths) for lengths in self.lengths)
        return first / 2, second / 2

    @cached_property
    def mean_lengths(self) -> Floats:
        """How far those are apart that are near, (r,)."""
        first, second = (np.einsum("rk,rk->r", *pair) for pair in zip(self.weights, self.lengths, strict=True))
        return first + second

    @property
    def order(self) -> Ints:
        """Numbers of the ways, (r,), the one in which the surfaces are nearest to each other first."""
        return np.argsort(self.mean_lengths, kind="stable")


class _RigidPair:
    """Fine samples of two surfaces, by place, normal and mean curvature.

    Parameters
    ----------
    x, y : MapDomain
        The surfaces.
    """

    def __init__(self, x: MapDomain, y: MapDomain) -> None:
        self._x, self._y = x, y
        self._tree_x, self._tree_y = (cKDTree(_features(d.places, d.normals, d.curvature)) for d in (x, y))

    def starts(self) -> _Motions:
        """Lay principal axes onto each other, and turn them."""
        rotations = _axes(self._y) @ _TURNS @ _axes(self._x).T
        return _Motions(rotations, np.ones(len(rotations)), np.zeros((len(rotations), 3)))

    def matches(self, motions: _Motions, count: int | None = None) -> _Matches:
        """Find what is closest to the first samples of either surface, or to all."""
        x, y, turns = self._x, self._y, motions.rotations
        on = slice(count)
        there = _features(motions.there(x.places[on]), x.normals[on] @ turns.transpose(0, 2, 1), x.curvature[on])
        back = _features(motions.back(y.places[on]), y.normals[on] @ turns, y.curvature[on])
        (away, on_y), (behind, on_x) = self._tree_y.query(there), self._tree_x.query(back)
        return _Matches(on_y, on_x, (away, behind) if count else self._along_normals(motions, on_y, on_x))

    def nearer(self, matches: _Matches) -> _Motions:
        """Find the motions that bring closest points as near to each other as can be."""
        x, y = self._x.places, self._y.places
        (ways, k), k_y = matches.on_y.shape, matches.on_x.shape[1]
        own = np.concatenate([np.broadcast_to(x[:k], (ways, k, 3)), x[matches.on_x]], axis=1)
        other = np.concatenate([y[matches.on_y], np.broadcast_to(y[:k_y], (ways, k_y, 3))], axis=1)
        weights = np.concatenate(matches.weights, axis=1)
        middles = [np.einsum("rk,rkd->rd", weights, places) for places in (own, other)]
        own, other = own - middles[0][:, None], other - middles[1][:, None]
        rotations = nearest_rotations(np.einsum("rk,rkd,rke->rde", weights, other, own))
        sizes = [np.einsum("rk,rkd,rkd->r", weights, places, places) for places in (own, other)]
        scales = np.sqrt(sizes[1] / sizes[0]).clip(1 / _RESIZED, _RESIZED)
        turned = np.einsum("rde,re->rd", rotations, middles[0])
        return _Motions(rotations, scales, middles[1] - scales[:, None] * turned)

    def _along_normals(self, motions: _Motions, on_y: Ints, on_x: Ints) -> tuple[Floats, Floats]:
        """Distances of all samples from planes that touch the other surface in those closest to them, (r, k) each."""
        x, y = self._x, self._y
        there, back = motions.there(x.places) - y.places[on_y], motions.back(y.places) - x.places[on_x]
        away, behind = np.einsum("rkd,rkd->rk", there, y.normals[on_y]), np.einsum("rkd,rkd->rk", back, x.normals[on_x])
        return np.abs(away), np.abs(behind) * motions.scales[:, None]


def rigid_maps(x: MapDomain, y: MapDomain) -> list[PointMaps]:
    """Map surfaces that a similarity takes onto each other nearly everywhere, but for parts that one of them lacks.

    The extremities of a body without limbs tell little, and all distances along it change by a hole or where a part is
    missing.  If it is in the same pose, closest points find it, from many rotations [1]_; the farthest are left out
    [2]_.

    Parameters
    ----------
    x, y : MapDomain
        The surfaces.

    Returns
    -------
    list of PointMaps
        One or two distinct maps between the fine samples, best first; none if the surfaces are bent differently.

    References
    ----------
    .. [1] P. Besl, N. McKay, "A method for registration of 3-D shapes", IEEE PAMI 14(2), 1992.
    .. [2] D. Chetverikov, D. Stepanov, P. Krsek, "Robust Euclidean alignment of 3D point sets: the trimmed iterative
       closest point algorithm", Image and Vision Computing 23(3), 2005.
    """
    pair = _RigidPair(x, y)
    motions = pair.starts()
    for count, rounds in _ROUNDS:
        motions = motions.of(pair.matches(motions, _PLACES).order[:count])
        for _ in range(rounds):
            motions = pair.nearer(pair.matches(motions, _PLACES))
    found = pair.matches(motions)
    lengths = found.mean_lengths
    rigid = [PointMaps(found.on_y[n], found.on_x[n]) for n in found.order if lengths[n] <= _RIGID]
    return best_distinct(rigid, lambda points, other: y.apart(points, other) > _DISTINCT, _MOST)


def _nearest(lengths: Floats) -> Floats:
    """Give equal weights to the shortest of lengths (r, k); each row sums to one."""
    last = int(_MET * lengths.shape[1])
    near = lengths <= np.partition(lengths, last, axis=1)[:, last, None]
    return near / near.sum(axis=1, keepdims=True)


def _features(places: Floats, normals: Floats, curvatures: Floats) -> Floats:
    """Join places (..., k, 3), normals (..., k, 3) and mean curvatures (k,), (..., k, 7)."""
    bent = np.broadcast_to(_CURVATURE * curvatures[:, None], (*places.shape[:-1], 1))
    return np.concatenate([places, _NORMAL * normals, bent], axis=-1)


def _axes(domain: MapDomain) -> Floats:
    """Principal axes of the samples, in columns, right-handed."""
    axes: Floats = np.linalg.svd(domain.places, full_matrices=False)[2].T
    axes[:, 2] *= np.sign(np.linalg.det(axes))
    return axes
