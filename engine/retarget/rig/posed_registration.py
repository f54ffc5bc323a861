# SPDX-License-Identifier: GPL-3.0-or-later
"""Registration of a body whose pose is known: the surface slides onto the target, held by its bones."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from scipy.sparse import csr_array, diags_array, eye_array, vstack

from ...geometry.laplacian import LaplaceBeltrami
from ...geometry.symmetric_factor import symmetric_factor
from ...mesh.closest_points import ClosestPoints, FoundPoints, facing
from ...mesh.surface_points import interpolation_matrix
from ...mesh.triangle_mesh import TriangleMesh
from ...registration.elastic import ElasticSurface
from ...runtime.arrays import Floats, unit_vectors
from .match_gate import Homes

_SLIDING = 0.01
"""How much a point's distance along the target's surface from where it was counts, against that across."""

_ROTATION_RADIUS = 0.04
_SCALE_RADIUS = 0.05
"""Over what distances rotations and scales are averaged, in units of the root of the target's area."""

_BACK, _REACH = 0.7, 0.015
"""How much the body's own vertices count that look for the target, and at what distance they count half."""

_SOLVES = 2
"""How often positions and rotations are found in turn for the same matches."""

_DESCENTS = 12
"""Conjugate gradient steps at most for each."""

_TOLERANCE = 1e-4
"""Relative residual at which they end."""


class _Target(NamedTuple):
    """What is known of the target, around the origin in units of the root of its area."""

    points: Floats
    normals: Floats
    shares: Floats
    centre: Floats
    scale: float


class PosedRegistration:
    r"""Lays a body onto another, given the pose.

    The positions y of the body's vertices minimise

    .. math:: \sum_j a_j \left( \langle n_j, B_j y - x_j \rangle^2 + \epsilon |B_j y - x_j|^2 \right) + \lambda E(y)

    over the vertices :math:`x_j` of the target with their normals :math:`n_j`, each matched with a point
    :math:`B_j y` of the body, where E is the elastic energy of `ElasticSurface` whose rest shape is the body *posed by
    its bones*, up to a smooth local scale.  Across its surface the body follows the target; along it the bones decide,
    which alone know where on a limb a point is [1]_.

    Parameters
    ----------
    body : TriangleMesh
        The body at rest, n vertices.
    laplace : LaplaceBeltrami
        Its operator.
    target : TriangleMesh
        The target, m vertices.
    homes : Homes, optional
        Where on the body the target's vertices belong, roughly: limbs that touch are not taken for one another then.

    References
    ----------
    .. [1] Y. Chen, G. Medioni, "Object modelling by registration of multiple range images", 1992, for the distance to
       planes.
    """

    def __init__(
        self, body: TriangleMesh, laplace: LaplaceBeltrami, target: TriangleMesh, homes: Homes | None = None
    ) -> None:
        self._body, self._homes = body, homes
        self._search, self._elastic = ClosestPoints(body), ElasticSurface(body.vertices, laplace)
        scale = float(np.sqrt(target.area))
        centre = np.average(target.vertices, axis=0, weights=target.vertex_areas)
        # Small triangles are where the detail is: by its area alone, a hand would not count.
        shares = np.sqrt(target.vertex_areas / target.area)
        points = (target.vertices - centre) / scale
        self._target = _Target(points, target.vertex_normals, shares / shares.sum(), centre, scale)
        self._target_search = ClosestPoints(target).moved(points)
        own = np.sqrt(body.vertex_areas / body.area)
        self._own_shares = own / own.sum()

    def slid(
        self, positions: Floats, posed: Floats, matches: FoundPoints, stiffness: float, *, seeking: Floats | None = None
    ) -> Floats:
        """Let the body slide once.

        Parameters
        ----------
        positions : (n, 3) array of float
            Where it is, in the target's space.
        posed : (n, 3) array of float
            Its rest shape: where the bones alone would have it.
        matches : FoundPoints
            For each vertex of the target the point of the body that lies there, m.
        stiffness : float
            How much the elastic energy counts, against distances in units of the root of the target's area.
        seeking : (n,) array of float, optional
            How much, 0 to 1, each vertex of the body looks for the target: not where the target lacks what it is of.

        Returns
        -------
        (n, 3) array of float
            Where it is then.
        """
        target = self._target
        elastic = self._elastic.posed(self._inside(posed))
        now = self._inside(positions)
        system = _SlidingSystem(self._planes(now, matches, seeking), stiffness * elastic.stiffness)
        for _ in range(_SOLVES):
            turned = elastic.rotations(now, _ROTATION_RADIUS)
            turned = turned * elastic.scales(now, _SCALE_RADIUS)[:, None, None]
            now = system.solved(system.wanted + stiffness * elastic.pull(turned), now)
        return now * target.scale + target.centre

    def _planes(self, now: Floats, matches: FoundPoints, seeking: Floats | None) -> _Planes:
        """Collect what both surfaces ask of one another."""
        target, count = self._target, len(now)
        there = interpolation_matrix(matches.barycentric, self._body.triangles[matches.triangles], count)
        normals = self._search.moved(now).vertex_normals
        found = facing(self._target_search, now, normals, 1.0)
        if self._homes is not None:
            found = self._homes.on_target(self._target_search, found, now)
        triangles = self._target_search.triangles
        places = found.interpolate(triangles, target.points)
        seen = unit_vectors(found.interpolate(triangles, target.normals))
        trust = np.clip(np.einsum("kd,kd->k", seen, normals), 0, 1) ** 2
        trust = trust / (1 + found.squared_distances / _REACH**2)
        trust = trust if seeking is None else trust * seeking
        return _Planes(
            csr_array(vstack([there, eye_array(count)])),
            np.concatenate([target.points, places]),
            np.concatenate([target.normals, seen]),
            np.concatenate([target.shares, _BACK * self._own_shares * trust]),
        )

    def matched(self, positions: Floats) -> FoundPoints:
        """Match every vertex of the target, m, with the closest point of the body, which is at positions (n, 3)."""
        target = self._target
        search = self._search.moved(self._inside(positions))
        found = facing(search, target.points, target.normals, 1.0)
        return found if self._homes is None else self._homes.on_body(search, found, target.points)

    def _inside(self, positions: Floats) -> Floats:
        """Turn coordinates of the target into units of the root of its area, around its centre."""
        return (positions - self._target.centre) / self._target.scale


class _Planes(NamedTuple):
    """Points of the body, rows of `evaluate` (k, n), and the planes (k, 3), (k, 3) that they are drawn to."""

    evaluate: csr_array
    points: Floats
    normals: Floats
    shares: Floats


class _SlidingSystem:
    """The linear equations of one round: for all three coordinates at once, because normals couple them."""

    def __init__(self, planes: _Planes, elastic: csr_array) -> None:
        self._evaluate, self._normals, self._elastic = planes.evaluate, planes.normals, elastic
        self._shares = planes.shares[:, None]
        self._transposed = csr_array(planes.evaluate.T)
        # A third of each squared normal component stands in for the planes in the preconditioner.
        mean = diags_array(planes.shares * (1 / 3 + _SLIDING))
        self._factor = symmetric_factor(elastic + self._transposed @ mean @ planes.evaluate)
        self.wanted: Floats = self._transposed @ self._pulled(planes.points)

    def solved(self, right: Floats, start: Floats) -> Floats:
        """Solve by preconditioned conjugate gradients from a start (n, 3)."""
        now = start.copy()
        residual = right - self._times(now)
        limit = _TOLERANCE * np.linalg.norm(right)
        step, before = np.zeros_like(now), 1.0
        for _ in range(_DESCENTS):
            if np.linalg.norm(residual) <= limit:
                break
            better = self._factor.solve(residual)
            product = float(np.vdot(residual, better))
            step = better + product / before * step
            before = product
            along = self._times(step)
            length = product / float(np.vdot(step, along))
            now += length * step
            residual -= length * along
        return now

    def _times(self, values: Floats) -> Floats:
        """Multiply by the matrix."""
        return self._transposed @ self._pulled(self._evaluate @ values) + self._elastic @ values

    def _pulled(self, points: Floats) -> Floats:
        """Pull of each match (m, 3): across the surface, and a little along it."""
        across = np.einsum("md,md->m", self._normals, points)[:, None] * self._normals
        return self._shares * (across + _SLIDING * points)
