# SPDX-License-Identifier: GPL-3.0-or-later
"""Elastic energy of a deformation: as-rigid-as-possible, with smooth rotations."""

from __future__ import annotations

import copy
from collections.abc import Callable

import numpy as np
from scipy.sparse import coo_array, csr_array, diags_array

from ..geometry.laplacian import LaplaceBeltrami
from ..geometry.procrustes import nearest_rotations
from ..geometry.symmetric_factor import symmetric_factor
from ..mesh.connectivity.adjacency import averaging
from ..runtime.arrays import TINY, Floats, Ints

_LEAST_WEIGHT = 1e-4
"""Least weight of an edge: one without would let its ends drift apart where all triangles around are right-angled."""

_MOST_ROUNDS = 60
"""Rounds of smoothing at most: finer meshes are meant to be worked on through a coarser one."""

_DOUBTED, _MOST_STRETCHED = 0.1, float(np.log(2))
"""Logarithm of a stretch up to which it is not accepted as how bodies differ, and the most of it that is looked at."""

_PLANE = 1e-3
"""Part of the covariance of edges that is given to all directions, also those in which a flat surface has no edge."""


_LEAST_RATIO = 0.1
"""Least ratio of squared lengths that is believed: surfaces that collapse or explode locally are not followed there."""


class ElasticSurface:
    r"""A surface that resists deformation.

    The energy of positions x, for rest positions v and a rotation R at each vertex, is

    .. math:: \sum_{ij} w_{ij} | (x_i - x_j) - \tfrac{1}{2} (R_i + R_j) (v_i - v_j) |^2

    over the edges of the intrinsic Delaunay triangulation with their cotangent weights [1]_.  The rotations are those
    that fit the deformation best, averaged over a neighbourhood, so that bending costs too: without that, noise in
    what drives the deformation would be followed into every wrinkle.

    Parameters
    ----------
    vertices : (n, 3) array of float
        Rest positions v.
    laplace : LaplaceBeltrami
        The operator of the surface.

    Attributes
    ----------
    stiffness : (n, n) csr_array of float
        Matrix of the energy: its gradient is twice ``stiffness @ x - pull(rotations)``.

    References
    ----------
    .. [1] O. Sorkine, M. Alexa, "As-rigid-as-possible surface modeling", SGP 2007.
    """

    def __init__(self, vertices: Floats, laplace: LaplaceBeltrami) -> None:
        n, self._laplace = len(vertices), laplace
        self._tails, self._heads, self._weights = weighted_edges(laplace)  # (e,) each
        count = len(self._tails)
        ends = (np.concatenate([self._tails, self._heads]), np.tile(np.arange(count), 2))
        # Sums over the edges around each vertex: of what does not, and of what does change sign with the direction.
        self._around = csr_array((np.ones(2 * count), ends), shape=(n, count))
        self._divergence = csr_array((np.repeat([1.0, -1.0], count), ends), shape=(n, count))
        one_way = csr_array((np.ones(count), (self._tails, self._heads)), shape=(n, n))
        self._average = averaging(csr_array(one_way + one_way.T))
        self._resisting = self._weights
        self._rest(vertices[self._tails] - vertices[self._heads])

    def _rest(self, edges: Floats) -> None:
        """Let the edges (e, 3) at rest be these."""
        self._edges = edges
        self._edge_length = float(np.sqrt(np.square(edges).sum(axis=1).mean())) if len(edges) else 1.0
        self._covariance = self._covariances(self._weights)
        self._resist(self._resisting)

    def _resist(self, weights: Floats) -> None:
        """Let edges have weights (e,) in the energy."""
        self._resisting = weights
        self.stiffness = csr_array(self._divergence @ diags_array(weights) @ self._divergence.T)
        covariance = self._covariance if weights is self._weights else self._covariances(weights)
        self._pull = csr_array(covariance.T) / 2

    def _covariances(self, weights: Floats) -> csr_array:
        """Matrix (3 n, n) that makes of positions the covariances (3, 3) of rest edges and edges around each vertex."""
        weighted = weights[:, None] * self._edges  # (e, 3)
        ends = self._tails, self._heads
        rows = np.stack([[3 * here[:, None] + np.arange(3)] * 2 for here in ends])  # (2, 2, e, 3)
        columns = np.broadcast_to(np.stack(ends)[:, :, None], rows.shape)
        signed = np.broadcast_to(np.stack([weighted, -weighted]), rows.shape)
        n = len(self._laplace.mass)
        return csr_array((signed.ravel(), (rows.ravel(), columns.ravel())), shape=(3 * n, n))

    def rotations(self, positions: Floats, radius: float) -> Floats:
        """Fit a rotation to the deformation around each vertex.

        Parameters
        ----------
        positions : (n, 3) array of float
            Deformed positions x.
        radius : float
            Over what distance, in units of the rest positions, rotations are averaged.

        Returns
        -------
        (n, 3, 3) array of float
            Rotations, never reflections.
        """
        fit = (self._covariance @ positions).reshape(-1, 9)  # (n, 9)
        fit = self._averaged(fit, radius)
        # The rest edges come first: of such a matrix the nearest rotation is the inverse.
        return nearest_rotations(fit.reshape(-1, 3, 3)).transpose(0, 2, 1)

    def scales(self, positions: Floats, radius: float) -> Floats:
        """Measure by what factor the deformation lengthens edges, averaged over a radius around each vertex, (n,)."""
        now = np.square(positions[self._tails] - positions[self._heads]).sum(axis=1)
        before = self._around @ (self._weights * np.square(self._edges).sum(axis=1))
        ratio = (self._around @ (self._weights * now)) / np.maximum(before, TINY)
        logarithms = np.log(np.clip(ratio, _LEAST_RATIO, 1 / _LEAST_RATIO)) / 2
        return np.exp(self._averaged(logarithms, radius))

    def softened(
        self, positions: Floats, radius: float, power: float = 0.5, constant: float = 1.0, *, directed: float = 0.0
    ) -> ElasticSurface:
        r"""Take the surface as softer where a deformation strains it more, and the way it does.

        Poses stretch skin where it bends, and bodies differ more in some parts than in others: elsewhere little is to
        be strained.  With s the squared strain of an edge and m its mean over the surface, the energy of the edge is
        multiplied by :math:`(c + s / m)^{-p}`, which is a step of iteratively reweighted least squares [1]_ for the
        robust energy :math:`\sum (c + s / m)^{1 - p}`; then so that the mean stays one.  Rotations are fitted as
        before.

        Skin that a joint stretches along a limb is as stiff around it as ever.  So to the part `directed`, s is
        :math:`|(S - 1) e|^2 / |e|^2` for the edge e and the stretch S around it, see `strained`; for the rest, what
        the edges around its ends are strained by on average, whatever their directions.

        Parameters
        ----------
        positions : (n, 3) array of float
            Deformed positions.
        radius : float
            Over what distance, in units of the rest positions, strains are averaged.
        power, constant : float
            p and c: the more the strain is expected to be in few places, the larger is p, below 1, and the smaller c.
        directed : float
            From 0 to 1, how far it counts which way the surface is strained.

        Returns
        -------
        ElasticSurface
            The surface with other weights.

        References
        ----------
        .. [1] P. W. Holland, R. E. Welsch, "Robust regression using iteratively reweighted least-squares",
           Communications in Statistics 6(9), 1977.
        """
        lengths = self._weights * np.square(self._edges).sum(axis=1)
        relative = [
            strains / max(np.average(strains, weights=lengths), TINY)
            for strains in (self._strains_around(positions, radius, lengths), self._strains_along(positions, radius))
        ]
        factors = (constant + (1 - directed) * relative[0] + directed * relative[1]) ** -power
        factors /= np.average(factors, weights=lengths)
        softer = copy.copy(self)
        softer._resist(self._weights * factors)  # noqa: SLF001
        return softer

    def _strains_around(self, positions: Floats, radius: float, lengths: Floats) -> Floats:
        """Squared strain around the ends of each edge, whichever way, (e,); the weighted squared lengths are given."""
        misfits = self._weights * self._misfit(positions, self.rotations(positions, radius))
        strains = self._averaged(self._around @ misfits / np.maximum(self._around @ lengths, TINY), radius)
        return self._around.T @ strains / 2

    def _strains_along(self, positions: Floats, radius: float) -> Floats:
        """Squared strain of each edge by the stretch around its ends, (e,)."""
        apart = self._at_edges(self._stretches(positions, lambda values: self._averaged(values, radius)) - np.eye(3))
        return np.square(apart).sum(axis=1) / np.maximum(np.square(self._edges).sum(axis=1), TINY)

    def strained(self, positions: Floats, radius: float) -> ElasticSurface:
        r"""Take the surface as at rest when strained as it is on average over a neighbourhood.

        The arm of one body may be half as long again as that of another, and a stiff surface would pull it short.
        With A the linear map that best takes the edges around a vertex to where they are, and :math:`A = R S` its
        polar decomposition, the edges at rest are multiplied by S, whose eigenvalues are brought nearer to one by a
        tenth: so much a map may be wrong.

        Parameters
        ----------
        positions : (n, 3) array of float
            Deformed positions.
        radius : float
            Standard deviation, in units of the rest positions, of the neighbourhoods, which heat spreads over.

        Returns
        -------
        ElasticSurface
            The surface with other edges at rest.
        """
        # The operator may be that of a surface of another size.
        area = self._weights @ np.square(self._edges).sum(axis=1) / 2
        mass = area / self._laplace.area * self._laplace.mass
        factor = symmetric_factor(diags_array(mass) + radius**2 / 2 * self._laplace.stiffness)
        values, vectors = np.linalg.eigh(self._stretches(positions, factor.solve))
        logarithms = np.log(np.maximum(values, np.exp(-_MOST_STRETCHED)))
        accepted = np.clip(np.abs(logarithms), _DOUBTED, _MOST_STRETCHED) - _DOUBTED
        stretch = np.einsum("nab,nb,ncb->nac", vectors, np.exp(np.sign(logarithms) * accepted), vectors)
        return self._with_edges(self._at_edges(stretch))

    def resized(self, scales: Floats) -> ElasticSurface:
        """Take the surface as at rest in other sizes, so many times as large at each vertex (n,)."""
        return self._with_edges(self._at_edges(scales[:, None, None] * np.eye(3)))

    def posed(self, vertices: Floats) -> ElasticSurface:
        """Take the surface as at rest with its vertices (n, 3) elsewhere."""
        return self._with_edges(vertices[self._tails] - vertices[self._heads])

    def _with_edges(self, edges: Floats) -> ElasticSurface:
        """Take the surface as it is, but with other edges (e, 3) at rest."""
        other = copy.copy(self)
        other._rest(edges)  # noqa: SLF001
        return other

    def _stretches(self, positions: Floats, averaged: Callable[[Floats], Floats]) -> Floats:
        """Fit a linear map to the deformation around each vertex: the symmetric part of its polar decomposition.

        Sums over edges (n, 9) are averaged by the function that is given.
        """
        now = positions[self._tails] - positions[self._heads]
        weighted = self._weights[:, None, None] * self._edges[:, None, :]
        products = (ends[:, :, None] * weighted for ends in (now, self._edges))
        moved, rest = (averaged(self._around @ each.reshape(-1, 9)).reshape(-1, 3, 3) for each in products)
        least = np.maximum(_PLANE * np.einsum("nii->n", rest), TINY)[:, None, None]
        linear = (moved + least * nearest_rotations(moved)) @ np.linalg.inv(rest + least * np.eye(3))
        stretch = nearest_rotations(linear).transpose(0, 2, 1) @ linear
        return (stretch + stretch.transpose(0, 2, 1)) / 2

    def _at_edges(self, linear: Floats) -> Floats:
        """Map each edge at rest by the mean of the linear maps (n, 3, 3) of its ends, (e, 3)."""
        return np.einsum("eab,eb->ea", (linear[self._tails] + linear[self._heads]) / 2, self._edges)

    def pull(self, rotations: Floats) -> Floats:
        """Sum of the rotated edges at each vertex, (n, 3): the right-hand side of the equilibrium."""
        return self._pull @ rotations.transpose(0, 2, 1).reshape(-1, 3)

    def energy(self, positions: Floats, rotations: Floats) -> float:
        """Energy of a deformation, an area: a number without unit for a surface of unit area."""
        return float(self._resisting @ self._misfit(positions, rotations))

    def energies(self, positions: Floats, rotations: Floats) -> Floats:
        """Share of each vertex in the energy of a deformation, (n,): half of what its edges have."""
        return self._around @ (self._resisting * self._misfit(positions, rotations)) / 2

    def _averaged(self, values: Floats, radius: float) -> Floats:
        """Average values (n, ...) over a neighbourhood."""
        # Each round spreads by the root of half the squared edge length.
        rounds = round(2 * (radius / self._edge_length) ** 2)
        for _ in range(min(max(rounds, 1), _MOST_ROUNDS)):
            values = self._average @ values
        return values

    def _misfit(self, positions: Floats, rotations: Floats) -> Floats:
        """Squared distance of each edge from what it would be by the rotations alone, (e,)."""
        apart = positions[self._tails] - positions[self._heads] - self._at_edges(rotations)
        return np.square(apart).sum(axis=1)


def weighted_edges(laplace: LaplaceBeltrami) -> tuple[Ints, Ints, Floats]:
    """Both ends of the edges of an operator, (e,) each, and their weights, none below a least one, (e,)."""
    entries = coo_array(laplace.stiffness)
    between = entries.row < entries.col
    return entries.row[between], entries.col[between], np.maximum(-entries.data[between], _LEAST_WEIGHT)
