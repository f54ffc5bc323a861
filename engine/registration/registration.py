# SPDX-License-Identifier: GPL-3.0-or-later
"""Non-rigid registration: one surface is deformed until it lies on another."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cached_property, partial
from typing import Any, Literal

import numpy as np

from ..geometry.procrustes import nearest_rotations
from ..mesh.closest_points import ClosestPoints, FoundPoints
from ..runtime.arrays import TINY, Bools, Floats, Ints
from ..runtime.parallel_map import beside_steps
from ..runtime.progress import Progress, Steps, within
from .deformable import DeformableSurface
from .elastic import ElasticSurface
from .positional_constraints import Ties

Guides = tuple[Floats, Floats]
Matches = tuple[FoundPoints, FoundPoints]

_LEAST_AGREEMENT = 0.05
"""Least part of its area with which a point counts whose normal disagrees with that of its match."""

_ENDS = 1 - 1e-6
"""Part of a point's weights on vertices of the border from which on the point is taken to lie there."""

_MISFIT_WEIGHT = 20.0
"""How much the mean squared distance that is left counts against the elastic energy."""


@dataclass(frozen=True)
class Stage:
    """How a part of a registration goes.

    Attributes
    ----------
    weights : tuple of float
        How much the distance of matched points counts against the elastic energy, round after round.
    normal_length, curvature_length : float
        How many units of length (in sqrt(area)) a unit of difference of the normals, and of the curvatures, counts when
        points are matched.
    normal_radius : float
        Over what distance normals are averaged before they are compared, in sqrt(area).  Around a thin fold, such as
        the rim of an eyelid, normals depend on where the mesh has its vertices; averaged, they say less there.
    rotation_radius : float
        Over what distance the rotations are averaged, in sqrt(area), if not more because bodies are unlike.
    matched : str
        What points are matched with in each round: "vertices", the most similar one; the triangles "around" it; or
        points "anywhere" on the surface.  While the surface is stiff the cheap matches lead to the same place.  Where
        it has few vertices, and at the end of the registration, the next better is used; where it also ends somewhere,
        the best: what lies next to a border may lie beyond it.
    lead : float
        By what part of its way each round goes on in the same direction.  Closest points hold the surface where it is,
        so it would only creep to where it is less distorted.
    guide_length : float
        How many units of length a unit of difference of the guides counts, see `register_steps`.
    momentum : float
        What part of the way of the round before is gone once more [1]_, below one: steps that agree add up, so sliding
        takes a fraction of the rounds, also where fit counts most.
    softened : pair of float
        How much softer the surface is where it is strained to begin with, if bodies are unlike and if it is one body in
        two poses: the power in `ElasticSurface.softened`.

    References
    ----------
    .. [1] B. T. Polyak, "Some methods of speeding up the convergence of iteration methods", USSR Computational
       Mathematics and Mathematical Physics 4(5), 1964.
    """

    weights: tuple[float, ...]
    normal_length: float
    curvature_length: float
    normal_radius: float = 0.0
    rotation_radius: float = 0.03
    matched: Literal["vertices", "around", "anywhere"] = "anywhere"
    lead: float = 0.0
    guide_length: float = 0.0
    momentum: float = 0.0
    softened: tuple[float, float] = (0.0, 0.0)

    def stiffer(self, factor: float) -> Stage:
        """Let distances count less by a factor, so that the surface is stiffer beside them."""
        return replace(self, weights=tuple(weight / factor for weight in self.weights))


GUIDED = Stage((5, 5, 10, 10, 20, 20, 40, 40), 0.2, 0.2, matched="vertices", guide_length=0.05)
"""From a rough start, while the surface is stiff: guides keep limbs apart that are near to each other in space."""

SOFT = Stage((80, 80, 160, 160), 0.2, 0.2, matched="vertices", guide_length=0.02)
"""The normals and curvatures pull features together; guides err like the map that they are from, and count less, but
enough for the hands and feet of a body that crouches."""

FINE = Stage((40, 160, 640, 1280), 0.1, 0.05, matched="around")
"""Onto the target."""

AGAIN = Stage((80, 160, 640, 1280), 0.1, 0.05, matched="around", guide_length=0.03, softened=(0.0, 0.75))
"""The same from a map that is nearly right, and says where a pose strains the surface.  A leg that is far shorter than
the other body's does not reach its end yet, whose closest points may be on the next leg: guides keep them apart."""

CLOSE = Stage((1280,) * 2 + (2560,) * 6, 0.05, 0.0, matched="around", lead=0.5, momentum=0.95, softened=(0.5, 0.75))
"""Without the curvatures: features of unlike bodies are not alike to the last detail.  In eight rounds surfaces slide
as far as in eleven with a momentum of 0.9 (`dense_pairs`); in seven with a lead of 1 as well, but what is far from
where they are pulled does not come to rest (tests of landmarks)."""

LAST = Stage((2560,), 0.05, 0.0)
"""At last to rest, from exact matches, which turn fewer triangles over."""

POLISH = Stage((1280, 2560, 5120), 0.03, 0.0, normal_radius=0.01, matched="around", lead=0.5)
"""From a registration of coarser meshes: a stiffer surface would slide away again from where that brought it, at lids
and lips first, which differ from face to face by more than their surroundings."""

POLISHED = Stage((10_240,), 0.03, 0.0, normal_radius=0.01)
"""And at last to rest.  Of both, weights of a quarter and normals that count .05 and are not averaged slide by half as
much again on lids (`faces` of the benchmarks), and are worse on S3 and S5 of `artist_scenes`."""


@dataclass(frozen=True, eq=False)
class Registration:
    """A surface deformed onto another.

    Attributes
    ----------
    positions : (n_x, 3) array of float
        Vertices of the source in the space of the target, `DeformableSurface.vertices`.
    on_target : FoundPoints
        For each vertex of the source the matching point of the target, n_x.
    on_source : FoundPoints
        For each vertex of the target the matching point of the source, n_y.
    energy : float
        Elastic energy of the deformation.
    misfit : float
        Mean squared distance of the positions from their matches, in units of area.
    gaps : pair of float
        Mean distance of the source's vertices, deformed, from their matches, and of the target's from theirs, in units
        of the square root of the area.
    """

    positions: Floats
    on_target: FoundPoints
    on_source: FoundPoints
    energy: float
    misfit: float
    gaps: tuple[float, float]

    @property
    def cost(self) -> float:
        """What the deformation costs, and what is left to be deformed: its elastic energy and the misfit, weighted."""
        return self.energy + _MISFIT_WEIGHT * self.misfit


_MATCHED = ("vertices", "around", "anywhere")

_SPARSE = 0.3
"""Part of the mean strain up to which strain hardly softens the surface, where it is in few places; else the mean."""

_NARROWER = 0.7
"""Over what part of the distance of rotations strains are averaged: they say where skin is stretched, and which way."""

_EVENER = 0.04
"""What is added to the radius that rotations are averaged over between bodies of unlike build: these bend at joints, as
poses do, but for the rest they differ everywhere, and gently."""

COARSE = 2000
"""Below so many vertices, those of a surface are too far apart for it to slide from one to the next; and any search is
fast."""

_MORE_SOLVES = 1
"""How often rotations and positions are found once more for the same matches if vertices are few: on many, new matches
in each round lead just as far."""


class _Matcher:
    """Finds for each point of one surface the point of the other that is most like it, and the other way round."""

    is_sent_once = True
    """See `parallel_map.shared_steps`."""

    def __init__(
        self, source: DeformableSurface, target: DeformableSurface, stage: Stage, guides: Guides | None
    ) -> None:
        self.source, self.target, self.stage = source, target, stage
        # What does not count is left out: the searches take as long as there are coordinates.
        parts = [
            [stage.curvature_length * surface.curvatures[:, : None if stage.curvature_length else 0]]
            for surface in (source, target)
        ]
        if guides is not None and stage.guide_length:
            for part, guide in zip(parts, guides, strict=True):
                part.append(stage.guide_length * guide)
        # What does not change as the source is deformed.
        self._source_features, target_features = (np.concatenate(part, axis=1) for part in parts)
        self.target_features = np.concatenate(
            [target.vertices, self._normal_features(target, target.normals), target_features], axis=1
        )

    @cached_property
    def target_search(self) -> ClosestPoints:
        """Search on the target by features."""
        return self.target.search.moved(self.target_features)

    def source_search(self, positions: Floats) -> tuple[ClosestPoints, Floats]:
        """Search on the deformed source by features, and its normals (n_x, 3)."""
        normals = self.source.search.moved(positions).vertex_normals
        seen = self._normal_features(self.source, normals)
        return self.source.search.moved(np.concatenate([positions, seen, self._source_features], axis=1)), normals

    def _normal_features(self, surface: DeformableSurface, normals: Floats) -> Floats:
        """By what normals (n, 3) of a surface are compared."""
        return self.stage.normal_length * surface.averaged(normals, self.stage.normal_radius)

    def __getstate__(self) -> dict[str, Any]:
        """Leave out the search, which is hardly ever used elsewhere."""
        return {name: value for name, value in self.__dict__.items() if name != "target_search"}

    def fitted_steps(
        self, positions: Floats, source: ClosestPoints, rotate: Callable[[], Floats], *, last: bool = False
    ) -> Steps[tuple[Matches, Floats]]:
        """Match every vertex of either surface, by the features of the deformed source, and find rotations meanwhile.

        A helper matches the target, which takes longer.
        """
        ends = self.source.border.any() or self.target.border.any()
        better = last + _are_coarse(self.source, self.target) * (2 if ends else 1)
        matched = _MATCHED[min(_MATCHED.index(self.stage.matched) + better, 2)]

        def own_steps() -> Steps[tuple[FoundPoints, Floats]]:
            """Match the source, and find the rotations."""
            yield Progress(0.0, "Fitting the surfaces")
            return _found(self.target_search, source.vertices, matched), rotate()

        found = yield from beside_steps(own_steps(), _matched_back_steps, (self, matched), [positions])
        (there, rotations), (back,) = found
        return (there, back), rotations


def _matched_back_steps(common: tuple[_Matcher, str], positions: Floats) -> Steps[FoundPoints]:
    """Match the vertices of the target, where the source has these positions."""
    matcher, matched = common
    yield Progress(0.0, "Fitting the surfaces")
    return _found(matcher.source_search(positions)[0], matcher.target_features, matched)


def _are_coarse(source: DeformableSurface, target: DeformableSurface) -> bool:
    """Say whether one of two surfaces has so few vertices that what is between them counts."""
    return min(len(source.vertices), len(target.vertices)) < COARSE


def _found(search: ClosestPoints, points: Floats, matched: str) -> FoundPoints:
    """Find what is closest to points, as `Stage.matched` says."""
    if matched == "anywhere":
        return search.nearest(points)
    nearest = search.nearest_vertices(points)
    return search.at_vertices(points, nearest) if matched == "vertices" else search.walk(points, nearest, steps=1)


def smooth_start(source: DeformableSurface, target: DeformableSurface, images: Ints, functions: Floats) -> Floats:
    """Place the source where a map puts it, without the map's noise.

    Parameters
    ----------
    source, target : DeformableSurface
        The surfaces.
    images : (n_x,) array of int
        Vertex of the target for each vertex of the source.
    functions : (n_x, k) array of float
        The first Laplace-Beltrami eigenfunctions of the source, orthonormal under its unit mass: what the positions
        are made of.

    Returns
    -------
    (n_x, 3) array of float
        Positions in the space of the target.
    """
    return source.smoothed(target.vertices[images], functions)


def restarted_steps(
    source: DeformableSurface,
    target: DeformableSurface,
    functions: Floats,
    matches: Matches,
    *,
    stages: tuple[Stage, ...],
    isometry: float = 1.0,
    ties: Ties | None = None,
    guides: Guides | None = None,
) -> Steps[Registration]:
    """Register anew from the matches of an earlier registration, of these surfaces or of the two exchanged.

    The source is placed by the matches without their noise, so that folds of the earlier registration open again.  What
    one direction gets wrong, such as a point on the far side of a fold, the other often gets right.

    Parameters
    ----------
    source, target : DeformableSurface
        The surfaces.
    functions : (n_x, k) array of float
        Eigenfunctions to smooth by, see `smooth_start`.
    matches : pair of FoundPoints
        The matching point of the target for each vertex of the source, and the other way round.
    stages, isometry, ties, guides
        As in `register_steps`.
    """
    places = matches[0].interpolate(target.triangles, target.vertices)
    start = source.smoothed(places, functions)
    posed = (start + places) / 2
    return register_steps(
        source, target, start, stages, matches, posed=posed, isometry=isometry, ties=ties, guides=guides
    )


def register_steps(
    source: DeformableSurface,
    target: DeformableSurface,
    start: Floats,
    stages: tuple[Stage, ...] = (GUIDED, SOFT, FINE, CLOSE, LAST),
    first: Matches | None = None,
    *,
    posed: Floats | None = None,
    elastic: ElasticSurface | None = None,
    isometry: float = 1.0,
    ties: Ties | None = None,
    guides: Guides | None = None,
) -> Steps[Registration]:
    r"""Deform a surface onto another, from a rough map.

    In turn, the points of both surfaces are matched, and the source is moved to where its elastic energy and the
    squared distances of the matches, weighted by area, are least together.  Points are matched in the space of
    positions, normals and smoothed mean curvatures: in the manner of iterative closest points [1]_, but between
    vertices and points of triangles, in both directions, and with features that pull tangentially.

    Parameters
    ----------
    source, target : DeformableSurface
        The surfaces X and Y.
    start : (n_x, 3) array of float
        Positions of the source's vertices to begin with, see `smooth_start`.
    stages : tuple of Stage
        How stiff the surface is, round after round.
    first : pair of FoundPoints, optional
        Matches of the source's and of the target's vertices for the first round; by default the closest.
    posed : (n_x, 3) array of float, optional
        Positions that the first rotations are fitted to, less smooth than those to begin with, which have no
        cross-sections left where limbs are thin.  Not for surfaces of few vertices.
    elastic : ElasticSurface, optional
        How the source resists deformation, if not as it is: with the same stiffness, but other edges at rest.
    isometry : float
        From 0, bodies of unlike build, to 1, one body in two poses, which are strained in few places: how stages have
        the surface softened; and rotations are averaged over more, the less it is.
    ties : Ties, optional
        Points of the source that are held at places in the space of the target, in every round.
    guides : pair of arrays of float, (n_x, g) and (n_y, g), optional
        What corresponding vertices have in common by all that is known before; for stages that ask for guides.

    Yields
    ------
    Progress
        After each round, and while points are matched.

    Returns
    -------
    Registration
        The deformed source.

    References
    ----------
    .. [1] B. Amberg, S. Romdhani, T. Vetter, "Optimal step nonrigid ICP algorithms for surface registration",
       CVPR 2007.
    """
    positions, posed = start, start if posed is None else posed
    sparse, coarse = isometry, _are_coarse(source, target)
    if coarse:
        # The few vertices around a limb could not tell which way round it is, nor those of a joint how it is strained.
        posed, sparse = start, 0.0
    total = sum(len(stage.weights) for stage in stages)
    done = 0
    matches = first
    evened = [replace(each, rotation_radius=each.rotation_radius + _EVENER * (1 - isometry)) for each in stages]
    stiff = source.elastic if elastic is None else elastic
    for stage in evened:
        matcher = _Matcher(source, target, stage, guides)
        # A smooth start is strained by that wherever the source is thin: there it says nothing about poses yet.
        resisting = stiff if matches is not None else _softened(stiff, positions, stage, sparse)
        step = np.zeros_like(positions)
        for weight in stage.weights:
            search, normals = matcher.source_search(positions)
            rotate = partial(resisting.rotations, posed, stage.rotation_radius)
            if matches is None:
                fitting = matcher.fitted_steps(positions, search, rotate)
                found, rotations = yield from within(fitting, done / total, done / total)
            else:
                found, rotations = matches, rotate()
            solved = _solved(matcher, resisting, rotations, normals, found, weight=weight, ties=ties)
            step = (1 + stage.lead) * (solved - positions) + stage.momentum * step
            positions = posed = positions + step
            if matches is not None:
                resisting, matches = _softened(stiff, positions, stage, sparse), None
            done += 1
            yield Progress(done / total, "Fitting the surfaces")
    search, _ = matcher.source_search(positions)
    rotate = partial(source.elastic.rotations, positions, stages[-1].rotation_radius)
    fitting = matcher.fitted_steps(positions, search, rotate, last=True)
    (on_target, on_source), rotations = yield from within(fitting, 1.0, 1.0)
    squared = np.square(on_target.interpolate(target.triangles, target.vertices) - positions).sum(axis=1)
    squared_back = np.square(on_source.interpolate(source.triangles, positions) - target.vertices).sum(axis=1)
    gaps = float(source.mass @ np.sqrt(squared)), float(target.mass @ np.sqrt(squared_back))
    energy = source.elastic.energy(positions, rotations)
    return Registration(positions, on_target, on_source, energy, float(source.mass @ squared), gaps)


def _softened(elastic: ElasticSurface, positions: Floats, stage: Stage, sparse: float) -> ElasticSurface:
    """Take the surface as softer as a stage has it, from 0, strained everywhere, to 1, sparsely and one way."""
    spread, few = stage.softened
    power = spread + (few - spread) * sparse
    if power <= 0:
        return elastic
    radius = _NARROWER * stage.rotation_radius
    return elastic.softened(positions, radius, power, 1 - (1 - _SPARSE) * sparse, directed=sparse)


def _solved(
    matcher: _Matcher,
    elastic: ElasticSurface,
    rotations: Floats,
    normals: Floats,
    matches: Matches,
    *,
    weight: float,
    ties: Ties | None,
) -> Floats:
    """Positions of least energy for given matches, beginning with some rotations."""
    on_target, on_source = matches
    source, target = matcher.source, matcher.target
    wanted = on_target.interpolate(target.triangles, target.vertices)
    seen = on_target.interpolate(target.triangles, target.normals)
    own = weight * source.mass * _agreement(normals, seen)
    beyond = np.flatnonzero(_beyond(source, on_target, target))
    own[beyond] = 0
    theirs = weight * target.mass * _agreement(on_source.interpolate(source.triangles, normals), target.normals)
    theirs[_beyond(target, on_source, source)] = 0
    equations = source.equations
    solve = equations.solver(own, on_source, theirs, elastic.stiffness)
    right = own[:, None] * wanted + equations.pull(on_source, theirs[:, None] * target.vertices)
    response = None if ties is None else solve(ties.forces)

    def at_rest(rotations: Floats) -> Floats:
        """Positions of least energy for given rotations."""
        if len(beyond):
            # Harmonic extension: what has no partner turns with its surroundings, however it was squeezed before.
            extended = solve(own[:, None] * rotations.reshape(-1, 9))[beyond]
            rotations = rotations.copy()
            rotations[beyond] = nearest_rotations(extended.reshape(-1, 3, 3))
        positions = solve(elastic.pull(rotations) + right)
        return positions if ties is None or response is None else ties.held(positions, response)

    positions = at_rest(rotations)
    for _ in range(_MORE_SOLVES if _are_coarse(source, target) else 0):
        positions = at_rest(elastic.rotations(positions, matcher.stage.rotation_radius))
    return positions


def _beyond(surface: DeformableSurface, matches: FoundPoints, other: DeformableSurface) -> Bools:
    """Tell which vertices (n,) of a surface are matched to where the other ends, but not because they end themselves.

    What they would be matched to is missing: they are not to be drawn to what is left.  Where either was cut, it ends
    somewhere.
    """
    if not other.border.any():
        return np.zeros(len(surface.vertices), bool)
    ends, rim = (
        (where[other.triangles[matches.triangles]] * matches.barycentric).sum(axis=1) > _ENDS
        for where in (other.border, other.rim)
    )
    return ends & ~(rim & (surface.rim > 0))


def _agreement(first: Floats, second: Floats) -> Floats:
    """How far normals (k, 3) agree: their product squared, or little where they turn away, (k,)."""
    lengths = np.maximum(np.linalg.norm(second, axis=1) * np.linalg.norm(first, axis=1), TINY)
    return np.clip(np.einsum("kd,kd->k", first, second) / lengths, _LEAST_AGREEMENT, 1) ** 2
