# SPDX-License-Identifier: GPL-3.0-or-later
"""The map between all points of two surfaces: the most credible start, laid onto the target by registration."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

from .closest_points import FoundPoints
from .deformable import DeformableSurface
from .functional_maps import PointMaps
from .limb_sides import exchanged_limbs, repaired_start
from .map_hypotheses import (
    MapHypothesis,
    map_hypotheses_steps,
    refined_hypothesis_steps,
    score_everywhere,
    unrefined_hypotheses_steps,
    unrefined_hypothesis,
)
from .progress import Steps, within
from .registration import CLOSE, FINE, GUIDED, LAST, SOFT, Registration, register_steps, restarted_steps, smooth_start
from .steering import agrees, steered_hypotheses_steps
from .surface import SurfacePoints
from .ties import Ties

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

    from .landmarks import LandmarkPlaces, Landmarks
    from .map_hypotheses import LandmarkStart
    from .shape import Shape

__all__ = ["EIGENPAIRS", "Candidate", "RegisteredPair", "are_distinct", "registered_pair_steps"]

EIGENPAIRS = 120
"""Laplace-Beltrami eigenpairs that the dense map is made with."""

_AMBIGUOUS = 2.0
"""Difference of scores up to which a hypothesis is registered before it is given up."""

_CONTRADICTED = 4.0
"""The same for a map whose limbs are where they belong, against one that exchanges them as seen from both surfaces."""

_DISTINCT = 0.07
"""Mean distance, in sqrt(area), from which on two registrations are different maps."""

_ELSEWHERE, _LIMB = 0.15, 0.02
"""Or they are different maps if they take so large a part of the source so far, in sqrt(area), from each other."""

_MOST_CANDIDATES = 3

_LIKE = 0.04
"""Mean distance, in sqrt(area), up to which a rough map would lead to where another one already has."""

_ELASTIC_WEIGHT = 4.0
_GAP_WEIGHT = 4.0
_LEAST_GAP = 1e-4  # in sqrt(area); surfaces that meet closer than that are all the same
_SMOOTH = 40
"""Eigenfunctions that the source is placed by before it is registered."""

_GUIDES = 10
"""Eigenfunctions of the target that guide the soft registration."""

_DETAILED = 100
"""The same before it is registered again."""

_STAGES = FINE, CLOSE, LAST
_MISFIT_WEIGHT = 20.0
"""How much the mean squared distance that is left counts against the elastic energy."""


@dataclass(frozen=True, eq=False)
class Candidate:
    """A hypothesis, softly registered.

    Attributes
    ----------
    hypothesis : MapHypothesis
        The map it started from; of the best, if that was rough, what functional maps make of where it led.
    registration : Registration
        The source on the target.
    score : float
        Smaller is more credible: the score of the registered map and the logarithms of the gaps that are left.
    likeness : float
        How much alike the surfaces are, if this is the map, larger for more: by the score of the hypothesis and the
        logarithm of what the deformation costs.
    """

    hypothesis: MapHypothesis
    registration: Registration
    score: float
    likeness: float


@dataclass(frozen=True, eq=False)
class RegisteredPair:
    """Two surfaces, one laid onto the other.

    Attributes
    ----------
    x, y : Shape
        The shapes.
    source, target : DeformableSurface
        Their surfaces.
    registration : Registration
        The source on the target.
    reverse : Registration
        The target on the source.
    candidates : tuple of Candidate
        What was compared, the most credible first.
    margin : float or None
        By how much the best candidate that is another map is less credible; None if there was none.
    landmarks : Landmarks or None
        What the registration was held at.
    mirrored : bool
        Whether `x` is the reflection of the shape that was given, because that is what the landmarks ask for.
    """

    x: Shape
    y: Shape
    source: DeformableSurface
    target: DeformableSurface
    registration: Registration
    reverse: Registration
    candidates: tuple[Candidate, ...]
    margin: float | None
    landmarks: Landmarks | None = None
    mirrored: bool = False

    @property
    def likeness(self) -> float | None:
        """How credible the best candidate was, whatever the others; None with landmarks, which know more."""
        return None if self.landmarks is not None else self.candidates[0].likeness


def registered_pair_steps(
    x: Shape,
    y: Shape,
    starts: Sequence[LandmarkStart] = (),
    *,
    search: bool = True,
    as_they_are: bool = False,
    landmarks: Landmarks | None = None,
) -> Steps[RegisteredPair]:
    """Find the map between two surfaces that keeps left on the left, and refine it.

    Parameters
    ----------
    x, y : Shape
        The surfaces X and Y; their samples have been taken.
    starts : sequence of LandmarkStart
        Sparse correspondences that the map may start from.
    search : bool
        Whether other starts are looked for as well.
    as_they_are : bool
        Whether the starts are followed up without being refined by functional maps, too.
    landmarks : Landmarks, optional
        What is known to correspond, and is held together; the samples of the shapes begin with them.

    Returns
    -------
    RegisteredPair
        The surfaces, laid onto one another.
    """
    yield from within(x.spectrum_steps(EIGENPAIRS), 0.0, 0.05)
    yield from within(y.spectrum_steps(EIGENPAIRS), 0.05, 0.1)
    mirrored = False
    if landmarks is None:
        # Mirrored maps serve only landmarks that ask for one.
        proposals = map_hypotheses_steps(x, y, starts, search=search, mirrored=False)
        hypotheses = yield from within(proposals, 0.1, 0.4)
    else:
        steered = yield from within(steered_hypotheses_steps(x, y, starts, landmarks, search=search), 0.1, 0.4)
        x, hypotheses, mirrored = steered.x, steered.hypotheses, steered.mirrored
    source, target = DeformableSurface(x.mesh, x.laplace), DeformableSurface(y.mesh, y.laplace)
    yield from within(source.prepare_steps(), 0.4, 0.41)
    yield from within(target.prepare_steps(), 0.41, 0.42)
    ties = None if landmarks is None else _ties(x, y, target, landmarks.source, landmarks.target)
    ties_back = None if landmarks is None else _ties(y, x, source, landmarks.target, landmarks.source)
    # Both surfaces are seen from outside, so the true map keeps the orientation.
    keeping = [h for h in hypotheses if h.orientation > 0] or hypotheses
    plausible = [h for h in keeping if h.score < keeping[0].score + _AMBIGUOUS][:_MOST_CANDIDATES]
    if as_they_are:
        plausible += [unrefined_hypothesis(hypotheses[0].domains, start) for start in starts]
    follow = _Follower(source, target, _functions(x, _SMOOTH), ties)
    candidates = []
    for number, hypothesis in enumerate(plausible):
        begin, end = (0.42 + 0.18 * (number + i) / len(plausible) for i in (0, 1))
        candidates.append((yield from within(follow.steps(hypothesis), begin, end)))
    candidates.sort(key=lambda candidate: candidate.score)
    if search and candidates[0].hypothesis.is_doubtful:
        proposals = unrefined_hypotheses_steps(candidates[0].hypothesis.domains)
        unrefined = yield from within(proposals, 0.6, 0.62)
        allowed = [h for h in unrefined if landmarks is None or agrees(x, y, landmarks, h)]
        candidates = yield from within(_unrefined_steps(follow, candidates, allowed), 0.62, 0.68)
    if search:
        # Where no map is looked for, the one that is given is followed as it is.
        repairing = _limbs_repaired_steps((x, y), follow, candidates[0])
        repaired = yield from within(repairing, 0.68, 0.7)
        if repaired is not None:
            hypotheses = [h for h in hypotheses if h is not candidates[0].hypothesis]
            candidates[0] = repaired
    best = candidates[0]
    first = yield from within(
        register_steps(source, target, best.registration.positions, (FINE,), ties=ties), 0.7, 0.76
    )
    matches = first.on_source, first.on_target
    steps = restarted_steps(target, source, _functions(y, _DETAILED), matches, stages=_STAGES, ties=ties_back)
    reverse = yield from within(steps, 0.76, 0.88)
    matches = reverse.on_source, reverse.on_target
    steps = restarted_steps(source, target, _functions(x, _DETAILED), matches, stages=_STAGES, ties=ties)
    final = yield from within(steps, 0.88, 1.0)
    margin = _margin(best, candidates, () if as_they_are else hypotheses, source.mass)
    return RegisteredPair(x, y, source, target, final, reverse, tuple(candidates), margin, landmarks, mirrored)


def _functions(shape: Shape, count: int) -> NDArray[np.float64]:
    """First eigenfunctions of a shape of unit area, (n, count)."""
    functions: NDArray[np.float64] = shape.spectrum.functions[:, :count] * np.sqrt(shape.laplace.area)
    return functions


def _ties(x: Shape, y: Shape, target: DeformableSurface, here: LandmarkPlaces, there: LandmarkPlaces) -> Ties:
    """Tie the landmarks of the source, wherever they are on its surface, to those of the target."""
    points, vertices = x.surface.proxy.points, here.main
    at = SurfacePoints.from_barycentric(x.mesh, points.triangles[vertices], points.barycentric[vertices])
    places = y.surface.proxy.points.positions[there.main]
    return Ties.at(x.mesh, at, target.in_unit_size(places))


def _unrefined_steps(
    follow: _Follower, candidates: list[Candidate], hypotheses: list[MapHypothesis]
) -> Steps[list[Candidate]]:
    """Follow up rough maps, too, that would not lead to where a candidate is; the most credible candidate first."""
    taken = [candidate.registration.positions for candidate in candidates]
    for number, hypothesis in enumerate(hypotheses):
        start = follow.start(hypothesis.images)
        if all(follow.apart(start, positions) > _LIKE for positions in taken):
            begin, end = (0.9 * (number + i) / len(hypotheses) for i in (0, 1))
            candidates = [*candidates, (yield from within(follow.steps(hypothesis), begin, end))]
            taken += [start, candidates[-1].registration.positions]
    ranked = sorted(candidates, key=lambda candidate: candidate.score)
    if any(ranked[0].hypothesis is h for h in hypotheses):
        # Others are compared with what functional maps make of it, not with the rough map.
        ranked[0] = yield from within(follow.refined_steps(ranked[0]), 0.9, 1.0)
    return ranked


@dataclass(frozen=True, eq=False)
class _Follower:
    """Follows hypotheses up by a soft registration."""

    source: DeformableSurface
    target: DeformableSurface
    smooth: NDArray[np.float64]
    ties: Ties | None

    def steps(self, hypothesis: MapHypothesis) -> Steps[Candidate]:
        """Register the source from where a hypothesis takes it, and judge what comes of it."""
        source, target = self.source, self.target
        images = yield from within(hypothesis.images_steps(), 0.0, 0.2)
        start = self.start(images)
        first = _at_vertices(target, images.on_y), _at_vertices(source, images.on_x)
        guides = self._guides(hypothesis, images)
        steps = register_steps(source, target, start, (GUIDED, SOFT), first, ties=self.ties, guides=guides)
        registration = yield from within(steps, 0.2, 1.0)
        cost = registration.energy + _MISFIT_WEIGHT * registration.misfit
        elastic = _ELASTIC_WEIGHT * float(np.log(max(cost, float(np.finfo(float).tiny))))
        # A rough map errs here and there, be it right or wrong as a whole; registered, it shows what it leads to.  The
        # true one may take more deforming than a wrong one where proportions differ, but the surfaces meet closer.
        gaps = np.maximum(registration.gaps, _LEAST_GAP)
        score = score_everywhere(hypothesis.domains, self.vertex_maps(registration))
        score += _GAP_WEIGHT * float(np.log(gaps).sum())
        return Candidate(hypothesis, registration, score, -(hypothesis.score + elastic))

    def start(self, images: PointMaps) -> NDArray[np.float64]:
        """Place the source where a map between all vertices puts it, smoothly."""
        return smooth_start(self.source, self.target, images.on_y, self.smooth)

    def apart(self, first: NDArray[np.float64], second: NDArray[np.float64]) -> float:
        """Mean distance, in sqrt(area), between two ways to place the source."""
        areas = self.source.mass
        return float(areas @ np.linalg.norm(first - second, axis=1) / areas.sum())

    def refined_steps(self, candidate: Candidate) -> Steps[Candidate]:
        """Let functional maps refine a registered map, and take that for the hypothesis that led to it."""
        was = candidate.hypothesis
        maps = self.vertex_maps(candidate.registration)
        hypothesis = yield from refined_hypothesis_steps(was.domains, maps, was.origin)
        likeness = candidate.likeness + was.score - hypothesis.score
        return replace(candidate, hypothesis=hypothesis, likeness=likeness)

    def _guides(self, hypothesis: MapHypothesis, images: PointMaps) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Take the lowest eigenfunctions of the target to both surfaces: a tail is far from a leg in them, in any pose.

        The higher ones count less, by the root of their eigenvalues: they err more, and say less about limbs.
        """
        domain, lowest = hypothesis.domains[1], slice(1, 1 + _GUIDES)
        values = domain.values[lowest]
        there = domain.functions[:, lowest] * np.sqrt(values[:1] / values)
        here = self.smooth @ (self.smooth.T @ (self.source.mass[:, None] * there[images.on_y]))
        return here, there

    def vertex_maps(self, registration: Registration) -> PointMaps:
        """Take the maps of a registration between all vertices."""
        on_target, on_source = registration.on_target, registration.on_source
        return PointMaps(
            self.target.triangles[on_target.triangles, on_target.barycentric.argmax(axis=1)],
            self.source.triangles[on_source.triangles, on_source.barycentric.argmax(axis=1)],
        )


def _limbs_repaired_steps(shapes: tuple[Shape, Shape], follow: _Follower, best: Candidate) -> Steps[Candidate | None]:
    """Follow the best candidate up anew if it exchanges limbs; None if it does not, or if that is no better."""
    wrong = follow.vertex_maps(best.registration)
    start = repaired_start(*shapes, wrong)
    if start is None:
        return None
    hypotheses = yield from within(map_hypotheses_steps(*shapes, (start,), search=False), 0.0, 0.3)
    repaired = yield from within(follow.steps(hypotheses[0]), 0.3, 1.0)
    right = follow.vertex_maps(repaired.registration)
    # What exchanges the ends of limbs may fit a little better by all other measures.
    clear = all(exchanged_limbs(*shapes, wrong)) and not any(exchanged_limbs(*shapes, right))
    return repaired if repaired.score < best.score + (_CONTRADICTED if clear else 0.0) else None


def _at_vertices(surface: DeformableSurface, vertices: NDArray[np.int64]) -> FoundPoints:
    points = SurfacePoints.at_vertices(surface.mesh, vertices)
    return FoundPoints(points.triangles, points.barycentric, np.zeros(len(points)))


def _margin(
    best: Candidate, candidates: list[Candidate], hypotheses: Sequence[MapHypothesis], areas: NDArray[np.float64]
) -> float | None:
    """By how much the second choice is less credible; hypotheses that were not registered count by their own score."""
    taken = [candidate.registration.positions for candidate in candidates]
    distinct = [are_distinct(best.registration.positions, positions, areas) for positions in taken]
    others = [candidate for candidate, other in zip(candidates, distinct, strict=True) if other]
    gaps = [candidate.score - best.score for candidate in others]
    tried = {id(candidate.hypothesis) for candidate in candidates}
    gaps += [h.score - best.hypothesis.score for h in hypotheses if id(h) not in tried and h.orientation > 0]
    # With limbs put right, the hypothesis is another one than those that were sorted out by their scores.
    return max(float(min(gaps)), 0.0) if gaps else None


def are_distinct(first: NDArray[np.float64], second: NDArray[np.float64], areas: NDArray[np.float64]) -> bool:
    """Say whether two registrations are different maps, as a whole or in where they take a limb.

    Parameters
    ----------
    first, second : (n, 3) array of float
        Where they take the vertices of the source, in units of the square root of the target's area.
    areas : (n,) array of float
        Areas of these vertices, in any unit.
    """
    apart = np.linalg.norm(first - second, axis=1)
    elsewhere = areas[apart > _ELSEWHERE].sum() / areas.sum()
    return bool(apart.mean() > _DISTINCT or elsewhere > _LIMB)
