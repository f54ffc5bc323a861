# SPDX-License-Identifier: GPL-3.0-or-later
"""Matches that stay where a map has them, roughly: surfaces that touch are not taken for one another."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.sparse import csr_array, diags_array, eye_array
from scipy.spatial import cKDTree

from ...mesh.closest_points import ClosestPoints, FoundPoints
from ...mesh.connectivity.adjacency import pair_matrix
from ...mesh.triangle_mesh import TriangleMesh
from ...runtime.arrays import Floats

_REACH = 0.15
"""How far from its home a match may be, in units of the root of the body's area: about as far as a hand is long."""

_ROUNDS = 5
"""Rounds of averaging homes with those of their neighbors, so that a single point that went astray finds back."""


@dataclass(frozen=True, eq=False)
class Homes:
    """Where on the body at rest, roughly, each vertex of two surfaces belongs.

    At rest the limbs of a body are apart from one another.  In a pose hands are folded and thighs touch, and the
    closest point may be on another limb.

    Attributes
    ----------
    body : (n, 3) array of float
        Vertices of the body at rest: their own homes.
    target : (m, 3) array of float
        Homes of the target's vertices.
    reach : float
        How far from its home a match may be.
    """

    body: Floats
    target: Floats
    reach: float

    @classmethod
    def of(cls, body: TriangleMesh, target: TriangleMesh, matches: FoundPoints) -> Homes:
        """Take the homes from a map: the points of the body, m, that belong to the target's vertices.

        Each is averaged with its neighbours, as often as triangles lead to them: twice but along a border.
        """
        homes = matches.interpolate(body.triangles, body.vertices)
        sides = np.stack([target.triangles, np.roll(target.triangles, -1, axis=1)], axis=-1).reshape(-1, 2)
        around = csr_array(pair_matrix(sides, np.ones(len(sides)), len(homes)) + eye_array(len(homes)))
        average = csr_array(diags_array(1 / around.sum(axis=1)) @ around)
        for _ in range(_ROUNDS):
            homes = average @ homes
        return cls(body.vertices, homes, _REACH * float(np.sqrt(body.area)))

    def on_body(self, search: ClosestPoints, found: FoundPoints, points: Floats) -> FoundPoints:
        """Seek anew along the body what was found far from home for the target's vertices at points (m, 3)."""
        return self._near(search, found, points, self.body, self.target)

    def on_target(self, search: ClosestPoints, found: FoundPoints, points: Floats) -> FoundPoints:
        """Seek anew along the target what was found far from home for the body's vertices at points (n, 3)."""
        return self._near(search, found, points, self.target, self.body)

    def _near(
        self, search: ClosestPoints, found: FoundPoints, points: Floats, there: Floats, homes: Floats
    ) -> FoundPoints:
        """Seek anew what was found farther from its home (k, 3) than allowed, from the vertex nearest to that."""
        places = found.interpolate(search.triangles, there)
        far = np.flatnonzero(np.square(places - homes).sum(axis=1) > self.reach**2)
        if not len(far):
            return found
        used = np.unique(search.triangles)
        starts = used[cKDTree(there[used]).query(homes[far])[1]]
        return found.with_others(far, search.walk(points[far], starts))
