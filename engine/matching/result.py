# SPDX-License-Identifier: GPL-3.0-or-later
"""What a match returns."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from ..dense.quality import MatchQuality
    from ..mesh.surface_map import SurfaceMap
    from ..mesh.surface_points import SurfacePoints

__all__ = ["CoarseMatch", "Level", "MatchResult"]


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

    source_vertices: NDArray[np.int64]
    target_vertices: NDArray[np.int64]
    candidates: int
    cost: float
    lower_bound: float
    proven: bool
    nodes: int


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


@dataclass(frozen=True, eq=False)
class MatchResult:
    """A sparse correspondence between two surfaces.

    Distances in costs are divided by the square root of each surface's area; distances in arrays are in the units of
    the mesh.

    Attributes
    ----------
    source_points, target_points : SurfacePoints
        Matched points, k on each surface: the i-th of one corresponds to the i-th of the other.  Coarse points first.
    distortion, linear, quadratic : float
        dis(C) = linear + quadratic_weight * quadratic (equation 2).
    point_distortion : (k,) array of float
        For each point, the root mean square difference of its distances to all others on the two surfaces, in units
        of the square root of the area.
    orientation : float
        Agreement of the orientation of the surfaces under the correspondence, averaged over the samples, -1 to 1:
        near 1 if left stays left, near -1 if the correspondence mirrors.
    levels : tuple of Level
        The hierarchy, coarse to fine.
    coarse : CoarseMatch
        The exact first step.
    mirrored : MatchResult or None
        The other answer for a symmetric shape: same source points, opposite orientation; None if there is none.
        Its own `mirrored` is None.
    source_distances : (k, n) array of float or None
        Geodesic distance from each matched point to every vertex of the source; inf where there is no path.  None if
        there are dense maps, which carry values to every vertex better.
    target_distances : (k, m) array of float or None
        The same on the target.
    source_to_target : SurfaceMap or None
        For every vertex of the source its point on the target, as far as the match was dense and this is not the
        mirrored answer.
    target_to_source : SurfaceMap or None
        For every vertex of the target its point on the source.
    quality : MatchQuality or None
        How far the dense maps may be trusted.
    notes : tuple of str
        What the user should know, such as parts that were left out: one sentence each.
    seconds : dict of str to float
        Time spent per stage; not part of what is reproducible.
    """

    source_points: SurfacePoints
    target_points: SurfacePoints
    distortion: float
    linear: float
    quadratic: float
    point_distortion: NDArray[np.float64]
    orientation: float
    levels: tuple[Level, ...]
    coarse: CoarseMatch
    mirrored: MatchResult | None
    source_distances: NDArray[np.float64] | None
    target_distances: NDArray[np.float64] | None
    notes: tuple[str, ...]
    seconds: dict[str, float]
    source_to_target: SurfaceMap | None = None
    target_to_source: SurfaceMap | None = None
    quality: MatchQuality | None = None
