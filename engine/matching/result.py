# SPDX-License-Identifier: GPL-3.0-or-later
"""The result of a match."""

from __future__ import annotations

from dataclasses import dataclass, replace

from ..dense.quality import DenseMatch, MatchQuality
from ..hierarchical.sparse_result import CoarseMatch, Level
from ..mesh.surface_map import SurfaceMap
from ..mesh.surface_points import SurfacePoints
from ..runtime.arrays import Floats

DIRECT, MIRRORED = "direct", "mirrored"
"""Names of the answer that was chosen and of the one that exchanges left and right."""


def turned_name(number: int) -> str:
    """Name the alternatives that keep left and right, counted from 1."""
    return f"turned {number}"


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
    source_distances : (k, n) array of float or None
        Geodesic distance from each matched point to every vertex of the source; inf where there is no path.  None if
        there are dense maps, which carry values to every vertex better.
    target_distances : (k, m) array of float or None
        The same on the target.
    source_to_target : SurfaceMap or None
        For every vertex of the source its point on the target, as far as the match was dense and this is not an
        alternative.
    target_to_source : SurfaceMap or None
        For every vertex of the target its point on the source.
    quality : MatchQuality or None
        How far the dense maps may be trusted.
    notes : tuple of str
        What the user should know, such as parts that were left out: one sentence each.
    seconds : dict of str to float
        Time spent per stage; not part of what is reproducible.
    name : str
        "direct", or as one of the alternatives "mirrored", "turned 1", "turned 2" and so on.
    alternatives : tuple of MatchResult
        Other right answers for shapes that look the same from several sides, with the same source points: the mirrored
        one first, if there is one, then those that are about as credible as this one, the most credible first.  Their
        points are what is known of them: `densify` makes their dense maps.  They have no alternatives themselves.
    """

    source_points: SurfacePoints
    target_points: SurfacePoints
    distortion: float
    linear: float
    quadratic: float
    point_distortion: Floats
    orientation: float
    levels: tuple[Level, ...]
    coarse: CoarseMatch
    source_distances: Floats | None
    target_distances: Floats | None
    notes: tuple[str, ...]
    seconds: dict[str, float]
    source_to_target: SurfaceMap | None = None
    target_to_source: SurfaceMap | None = None
    quality: MatchQuality | None = None
    name: str = DIRECT
    alternatives: tuple[MatchResult, ...] = ()

    @property
    def mirrored(self) -> MatchResult | None:
        """The alternative of the opposite orientation, of a symmetric shape; None if there is none."""
        return next((answer for answer in self.alternatives if answer.name == MIRRORED), None)

    @property
    def dense(self) -> DenseMatch:
        """The dense maps and how far they can be trusted, of a match that was asked for them."""
        if self.source_to_target is None or self.target_to_source is None or self.quality is None:
            raise RuntimeError("The match has no dense map: ask for one in its settings.")
        return DenseMatch(self.source_to_target, self.target_to_source, self.quality)

    def with_dense(self, dense: DenseMatch) -> MatchResult:
        """Return the match with other dense maps."""
        there, back = dense.source_to_target, dense.target_to_source
        return replace(self, source_to_target=there, target_to_source=back, quality=dense.quality)

    def __repr__(self) -> str:
        dense = "" if self.quality is None else f", dense with confidence {self.quality.confidence:.2f}"
        return f"<MatchResult: {len(self.source_points)} points, distortion {self.distortion:.3g}{dense}>"
