# SPDX-License-Identifier: GPL-3.0-or-later
"""Quality of a dense map, in numbers and in a sentence."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from ..mesh.connectivity.adjacency import edge_means, neighbour_means
from ..mesh.surface_map import SurfaceMap
from ..mesh.surface_points import SurfacePoints
from ..mesh.triangle_mesh import TriangleMesh
from ..runtime.arrays import Bools, Floats
from .credibility import is_clear_choice, is_likely, probability_chosen, probability_right
from .missing_parts import round_trips, with_partner

_TRUSTED_ROUND_TRIP = 0.02
"""Distance, in sqrt(area), between a point and where both maps bring it at which its confidence is halved."""

_TRUSTED_STRETCH = 1.0
"""Logarithm of the stretch of the surface around a point at which its confidence is halved."""

_WHOLE = 0.995
"""Part of a surface that must have a partner for nothing to be missed: a hand of a person is two hundredths, and
fingertips that another body has not are no more than this."""

_NEARLY_WHOLE = 0.95
"""Part of one of two surfaces that overlap from which on it is a part of the other one."""

_FEW = 0.02
"""Part of a mesh in pieces without a counterpart up to which nothing is said: eyes, teeth and buttons."""

_SMALL_PART = 0.98
"""Part of a surface from which on what has no partner is small: less than a hand."""


@dataclass(frozen=True)
class MatchQuality:
    """How far a dense map may be trusted.

    Attributes
    ----------
    orientation : float
        Part of the source's area on which the map keeps left on the left, minus the part on which it mirrors: 1 if it
        does everywhere.  Of a map that is wanted to mirror (see `densify_steps`), seen in the mirror.
    distortion : float
        Mean of the absolute logarithm of the stretch of edges, by area: 0 for an isometry, 0.1 for some ten per cent.
    coverage : float
        Part of the target's area that has a partner on the source, see `with_partner`.
    disagreement : float
        Mean distance between a point of the source and where the two maps bring it, there and back, or brought it
        before one of them was made to follow the other, in units of the square root of the area.
    margin : float or None
        By how much the best other candidate, such as the map turned by 180 degrees, was less credible; None if there
        was no other.  Below one the choice was not clear.
    confidence : float
        All of this in one number, 0 to 1; that of pieces beside the main part counts by their areas.
    sentence : str
        The same for a person to read.
    source_coverage : float
        Like `coverage`, the part of the source's area that has a partner on the target.
    likeness : float or None
        How credible the map was before details were fitted, see `RegisteredPair.likeness`; None if that is not known.
    pieces_alone : float
        Part of the surface of either mesh, of the one that has more of it, that is in separate pieces without a
        counterpart on the other.
    alternatives : int
        How many other maps are about as credible, wherever things stand, and offered.
    in_place : float
        How probably the map is right because it leaves everything where it stands, see `probability_in_place`.
    """

    orientation: float
    distortion: float
    coverage: float
    disagreement: float
    margin: float | None
    confidence: float
    sentence: str
    source_coverage: float = 1.0
    likeness: float | None = None
    pieces_alone: float = 0.0
    alternatives: int = 0
    in_place: float = 0.0


@dataclass(frozen=True, eq=False)
class DenseMatch:
    """The maps between all vertices of two meshes.

    Attributes
    ----------
    source_to_target : SurfaceMap
        For every vertex of the source its point on the target.
    target_to_source : SurfaceMap
        For every vertex of the target its point on the source.
    quality : MatchQuality
        How far they may be trusted.
    """

    source_to_target: SurfaceMap
    target_to_source: SurfaceMap
    quality: MatchQuality

    def __repr__(self) -> str:
        sizes = f"{len(self.source_to_target)} and {len(self.target_to_source)} vertices"
        return f"<DenseMatch: {sizes}, confidence {self.quality.confidence:.2f}>"


@dataclass(frozen=True, eq=False)
class JudgedMap:
    """What is known of each vertex of a surface by the map from it and the map back.

    Attributes
    ----------
    partnered : (n,) array of bool
        Whether it has a partner on the other surface.
    errors : (n,) array of float
        How far its image may err, in sqrt(area): by the way there and back, or by what is known otherwise.
    confidence : (n,) array of float
        How far its image may be trusted if the map is right as a whole, 0 to 1: about the part of such vertices whose
        images are not farther than three hundredths of sqrt(area) from the true ones.  Zero without a partner.
    distortion : float
        Mean of the absolute logarithm of the stretch of edges, by area.
    """

    partnered: Bools
    errors: Floats
    confidence: Floats
    distortion: float


def judged_map(
    source: TriangleMesh,
    target: TriangleMesh,
    there: SurfacePoints,
    back: SurfacePoints,
    doubt: Floats | float = 0.0,
) -> JudgedMap:
    """Judge each vertex's image by whether the way back leads home, and by how much the surface is stretched there.

    Parameters
    ----------
    source, target : TriangleMesh
        The surfaces.
    there, back : SurfacePoints
        A point of the target for each vertex of the source, and the other way round.
    doubt : (n,) array of float, optional
        Distances, in sqrt(area), by which it is known otherwise that images may err: the longer of these and of the
        ways there and back count.
    """
    partnered = with_partner(source, target, there, back)
    errors = np.maximum(round_trips(source, there, back) / np.sqrt(source.area), doubt)
    stretch = np.abs(_log_stretch(source, target, there))
    confidence = trip_confidence(errors) / (1 + np.square(edge_means(source, stretch) / _TRUSTED_STRETCH))
    confidence = np.clip(neighbour_means(source, confidence), 0, 1) * partnered
    return JudgedMap(partnered, errors, confidence, float(np.average(stretch, weights=np.square(source.edge_lengths))))


def trip_confidence(distances: Floats) -> Floats:
    """Trust points, 0 to 1, by how far (k,) they are from where two maps bring them, there and back, in sqrt(area)."""
    return 1 / (1 + np.square(distances / _TRUSTED_ROUND_TRIP))


def assess_maps(
    surfaces: tuple[TriangleMesh, TriangleMesh],
    there: SurfacePoints,
    judged: tuple[JudgedMap, JudgedMap],
    margin: float | None,
    *,
    likeness: float | None = None,
    in_place: float = 0.0,
) -> MatchQuality:
    """Measure a pair of maps between two surfaces.

    Parameters
    ----------
    surfaces : pair of TriangleMesh
        The source and the target.
    there : SurfacePoints
        A point of the target for each vertex of the source.
    judged : pair of JudgedMap
        What is known of the map there, and of the one back.
    margin : float or None
        How clear the choice of the map was.
    likeness : float, optional
        How credible the map was.
    in_place : float
        How probably it is right because it leaves everything where it stands.
    """
    (source, target), (known, known_back) = surfaces, judged
    orientation = SurfaceMap.from_points(target, there).orientation(source, target)
    coverage = float(np.average(known_back.partnered, weights=target.vertex_areas))
    source_coverage, disagreement, confidence = (
        float(np.average(values, weights=source.vertex_areas))
        for values in (known.partnered, known.errors, known.confidence)
    )
    confidence *= max(orientation, 0.0) * probability_chosen(margin) * probability_right(likeness, in_place)
    numbers = orientation, known.distortion, coverage, disagreement, margin, confidence
    return _worded(MatchQuality(*numbers, "", source_coverage, likeness, in_place=in_place))


def with_pieces(quality: MatchQuality, alone: float, share: float) -> MatchQuality:
    """Say of a map of main parts, too, what is known of the pieces beside them.

    Parameters
    ----------
    quality : MatchQuality
        That of the main parts.
    alone : float
        What part of the surface is in separate pieces without a counterpart.
    share : float
        Mean confidence of the whole surface, as a part of that of the main part.
    """
    return _worded(replace(quality, pieces_alone=alone, confidence=min(share * quality.confidence, 1.0)))


def with_alternatives(quality: MatchQuality, count: int) -> MatchQuality:
    """Say of a map, too, how many others are about as credible, and offered."""
    return _worded(replace(quality, alternatives=count))


def of_covered_parts(quality: MatchQuality, shares: tuple[float, float]) -> MatchQuality:
    """Say of a map, too, that it was made with only so large a part of the source, and of the target."""
    source, target = shares
    return _worded(
        replace(quality, source_coverage=source * quality.source_coverage, coverage=target * quality.coverage)
    )


def _worded(quality: MatchQuality) -> MatchQuality:
    """Say in a sentence the worst of what is known."""
    return replace(quality, sentence=_doubt(quality) or _difference(quality))


def _doubt(quality: MatchQuality) -> str:
    """Say why the map as a whole may be wrong; nothing if there is no reason."""
    if quality.orientation < 0.3:
        return "The map turns large parts of the surface over: do not trust it; try landmarks."
    if not is_likely(quality.likeness, quality.in_place):
        return "The shapes have too little in common: leave out what only one of them has, or try landmarks."
    if quality.alternatives:
        count = quality.alternatives + 1
        if is_clear_choice(quality.margin):
            return f"{count} maps are about as likely by their shape, and this one leaves all in place: check it."
        return f"{count} maps are about as likely: choose another answer if this one is wrong, or add a landmark."
    if not is_clear_choice(quality.margin):
        return "Another map was almost as likely: check the sides and each limb, and add a landmark if one is wrong."
    return ""


def _difference(quality: MatchQuality) -> str:
    """Say how much the shapes differ."""
    distortion, disagreement = quality.distortion, quality.disagreement
    if min(quality.coverage, quality.source_coverage) < _WHOLE:
        return _missing(quality.source_coverage, quality.coverage)
    if quality.pieces_alone > _FEW:
        share = f"{quality.pieces_alone:.0%}"
        return f"Separate pieces, {share} of a mesh, have no counterpart on the other: check where they went."
    if disagreement > 0.02 or distortion > 0.5:
        return "The shapes differ much: the map is a good guess that keeps left and right, but details may slide."
    if disagreement > 0.008 or distortion > 0.2:
        return "The shapes correspond, with some stretching where they differ."
    return "The shapes correspond closely."


def _missing(source: float, target: float) -> str:
    """Say what part of the source has a partner, or of the target: of the one that has more that the other lacks."""
    if _SMALL_PART <= target <= source:
        return f"The shapes correspond, but for a small part of the target ({1 - target:.1%}) that the other lacks."
    if _SMALL_PART <= source < target:
        return f"The shapes correspond, but for a small part of the source ({1 - source:.1%}) that the other lacks."
    missing = "parts of one shape seem to be missing on the other."
    if target <= source:
        return f"Only {target:.0%} of the target is reached: {missing}"
    return f"Only {source:.0%} of the source has a partner: {missing}"


def overlap_sentence(shares: tuple[float, float], *, credible: bool) -> str:
    """Say what part of the source and of the target is shared, and whether that can be relied on."""
    if not credible:
        return "It is not clear what the shapes share: do not trust the map; add landmarks, or cut them alike."
    if max(shares) >= _NEARLY_WHOLE and min(shares) < _WHOLE:
        return _missing(*shares)
    return f"The shapes overlap: {shares[0]:.0%} of the source and {shares[1]:.0%} of the target have a partner."


def exchanged_sentence(sentence: str, shares: tuple[float, float]) -> str:
    """Say what a sentence on two maps says with source and target exchanged.

    Parameters
    ----------
    sentence : str
        That of a `MatchQuality`.
    shares : tuple of float
        What part of the new source and of the new target has a partner.
    """
    if "overlap" in sentence:
        return overlap_sentence(shares, credible=True)
    return _missing(*shares) if "the source" in sentence or "the target" in sentence else sentence


def _log_stretch(source: TriangleMesh, target: TriangleMesh, there: SurfacePoints) -> Floats:
    """Logarithm of mapped over original length of each edge, both in units of sqrt(area), (e,)."""
    first, second = source.edges.T
    mapped = np.linalg.norm(there.positions[first] - there.positions[second], axis=1) / np.sqrt(target.area)
    own = source.edge_lengths / np.sqrt(source.area)
    # Edges shorter than a thousandth of the mean say nothing about stretch.
    least = 1e-3 * float(own.mean())
    return np.log(np.maximum(mapped, least) / np.maximum(own, least))
