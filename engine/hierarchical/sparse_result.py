# SPDX-License-Identifier: GPL-3.0-or-later
"""The exact first step and the levels of a hierarchical match, as they are returned."""

from __future__ import annotations

from dataclasses import dataclass

from ..mesh.surface_points import SurfacePoints
from ..runtime.arrays import Ints


@dataclass(frozen=True, eq=False)
class CoarseMatch:
    """The exact first step.

    Attributes
    ----------
    source_vertices, target_vertices : (n,) array of int
        The matched farthest point samples.
    candidates : int
        How many points of the target were offered.
    cost : float
        Distortion of this matching.
    lower_bound : float
        No matching of these points to these candidates (and distinct from the better ones returned before it) costs
        less.
    proven : bool
        Whether `cost` is the optimum.
    nodes : int
        Nodes of the search tree visited.
    """

    source_vertices: Ints
    target_vertices: Ints
    candidates: int
    cost: float
    lower_bound: float
    proven: bool
    nodes: int

    def __repr__(self) -> str:
        proven = "proven" if self.proven else "not proven"
        return f"<CoarseMatch: {len(self.source_vertices)} points, cost {self.cost:.3g}, {proven}>"


@dataclass(frozen=True, eq=False)
class Level:
    """One level of the hierarchy, as it ended.

    Attributes
    ----------
    points : int
        Number of matched points.
    iterations : int
        Relaxed solves until convergence.
    distortion : float
        Distortion at the end of the level.
    target_points : SurfacePoints
        Where on the target the points lie at the end of the level.
    """

    points: int
    iterations: int
    distortion: float
    target_points: SurfacePoints

    def __repr__(self) -> str:
        return f"<Level: {self.points} points, distortion {self.distortion:.3g}>"
