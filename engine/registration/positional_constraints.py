# SPDX-License-Identifier: GPL-3.0-or-later
"""Points of a deforming surface that are tied to places in space."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.sparse import csr_array

from ..geometry.geodesic_ball import distances_to_others, vicinity
from ..mesh.surface_points import SurfacePoints, interpolation_matrix
from ..mesh.triangle_mesh import TriangleMesh
from ..runtime.arrays import TINY, Floats
from ..shapes.landmarks import LandmarkPlaces
from ..shapes.proxy import Proxy
from .deformable import DeformableSurface

_SPREAD = 0.03
"""Radius around a tied point, in sqrt(area), on which the force that holds it is spread: about that of a thumb."""

_ALONE = 0.5
"""The same radius at most, as a part of the distance to the next tied point."""

_REDUNDANT = 1e-3
"""Singular values, relative to the largest, of ties that are taken to say the same."""


@dataclass(frozen=True, eq=False)
class Ties:
    r"""Linear constraints on the positions of a surface.

    They hold exactly: as :math:`E x = p` for the positions x of the vertices, whatever drives the surface.  The forces
    are not applied at the tied points alone, where a membrane would give way in a spike and fold, but spread around
    them: x moves by :math:`A^{-1} F \mu`, where A is the surface's matrix of stiffness and the columns of F are
    smooth, with :math:`\mu` such that the constraints hold.

    Attributes
    ----------
    evaluate : (k, n) csr_array of float
        E, the tied points as weighted means of vertices.
    places : (k, 3) array of float
        p, where they are to be.
    forces : (n, k) array of float
        F, how the force on each is distributed over the vertices; columns sum to one.
    """

    evaluate: csr_array
    places: Floats
    forces: Floats

    @classmethod
    def at(cls, mesh: TriangleMesh, points: SurfacePoints, places: Floats) -> Ties:
        """Tie points (k,) of a mesh to places (k, 3)."""
        evaluate = interpolation_matrix(points.barycentric, points.corners, mesh.vertex_count)
        radii = np.minimum(_SPREAD * np.sqrt(mesh.area), _ALONE * distances_to_others(points.positions))
        radii = np.maximum(radii, TINY)  # where two are projected to the same place
        forces = np.zeros((mesh.vertex_count, len(points)))
        for i, vertex in enumerate(points.nearest_vertices):
            near, distances = vicinity(mesh, int(vertex), radii[i])
            forces[near, i] = mesh.vertex_areas[near] * np.square(1 - np.square(distances / radii[i]))
        return cls(evaluate, places, forces / forces.sum(axis=0))

    @classmethod
    def of_landmarks(
        cls, source: Proxy, target: Proxy, there: DeformableSurface, here: LandmarkPlaces, partners: LandmarkPlaces
    ) -> Ties:
        """Tie landmarks of a mesh, wherever on its proxy they are, to those of another, in the space of `there`."""
        vertices, points = here.main, source.points
        at = SurfacePoints.from_barycentric(source.mesh, points.triangles[vertices], points.barycentric[vertices])
        return cls.at(source.mesh, at, there.in_unit_size(target.points.positions[partners.main]))

    def held(self, positions: Floats, response: Floats) -> Floats:
        """Move free positions (n, 3) so that the ties hold, by the surface's own response."""
        missing = self.places - self.evaluate @ positions
        strengths, *_ = np.linalg.lstsq(self.evaluate @ response, missing, rcond=_REDUNDANT)
        return positions + response @ strengths
