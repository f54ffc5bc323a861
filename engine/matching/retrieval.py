# SPDX-License-Identifier: GPL-3.0-or-later
"""Retrieval: which of many shapes is most like a given one, whatever its pose."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from ..hierarchical.hierarchy import level_sizes, refine_steps
from ..hierarchical.sampled_pair import Pair
from ..hierarchical.settings import CheckedSettings, MatchSettings, setting
from ..hierarchical.sparse_hypotheses import coarse_steps
from ..mesh.surface_points import SurfacePoints
from ..mesh.triangle_mesh import TriangleMesh
from ..runtime.arrays import Floats, Ints, squared_differences
from ..runtime.background import can_go_beside
from ..runtime.errors import MatchError, SettingsError
from ..runtime.progress import Progress, Steps, at_once, part_of, within
from ..shapes.shape import Shape, check_surface, check_vertex_count, shape_steps

_LEVELS = (np.arange(64) + 0.5) / 64  # at which the quantiles of distances are taken


@dataclass(frozen=True)
class RetrievalSettings(CheckedSettings):
    """Settings of `retrieve`.

    The defaults were measured on 55 bodies of seven classes (`python -m tests.benchmarks.retrieval`): the class of the
    nearest neighbour was right for 89%, for 82% to 89% with fewer points or samples, and for no more with more of
    them, with several hypotheses for each match, with its opposite direction or with twice as many shapes matched.

    Raises
    ------
    SettingsError
        If a value is out of its range or contradicts another.
    """

    matched: int = setting(
        8, "Matched Shapes", 1, 10_000, "How many shapes are matched: those that look best by their distances alone"
    )
    points: int = setting(40, "Points", 3, 256, "How many points of the query are matched to each of these shapes")
    samples: int = setting(200, "Samples", 16, 4096, "Among how many samples of a shape the points are matched")
    signature_samples: int = setting(
        40, "Signature Samples", 4, 1024, "By the distances around how many samples shapes are compared before matching"
    )
    coarse_points: int = setting(8, "Coarse Points", 3, 24, "How many points are matched exactly before all others")

    def __post_init__(self) -> None:
        super().__post_init__()
        if self.samples < self.points:
            raise SettingsError(f"{self.points} Points need at least as many Samples, not {self.samples}.")

    @cached_property
    def match(self) -> MatchSettings:
        """The settings of the match of one pair."""
        return replace(
            MatchSettings(),
            points=self.points,
            samples=self.samples,
            hypotheses=1,
            coarse_points=min(self.coarse_points, self.points),
        )


@dataclass(frozen=True, eq=False)
class RetrievedMatch:
    """A match between the query and one shape.

    Attributes
    ----------
    shape : int
        Which shape, as its place in the list that was searched.
    source_points, target_points : SurfacePoints
        Matched points on the query and on the shape.  Of a symmetric shape it may be the mirrored match: its
        distortion is the same.  For the true one see `match`.
    score : float
        Root mean square difference between the distances of two points on the query and on the shape, in units of the
        square root of each area.
    """

    shape: int
    source_points: SurfacePoints
    target_points: SurfacePoints
    score: float

    def __repr__(self) -> str:
        return f"<RetrievedMatch: shape {self.shape}, {len(self.source_points)} points, score {self.score:.3g}>"


@dataclass(frozen=True, eq=False)
class Retrieval:
    """Shapes in the order of their likeness to a query.

    Attributes
    ----------
    order : (n,) array of int
        Places in the list of shapes, most like the query first: those that were matched by their scores, then the
        others by their bounds.
    scores : (n,) array of float
        For each shape of the list, distortion of its match, in units of the square root of the area; NaN if it was
        not matched.  See `RetrievedMatch.score`.
    bounds : (n,) array of float
        For each shape of the list, a lower bound on the distortion of any correspondence that keeps areas, in the
        same units, as estimated from the samples: two samplings of one surface have about 0.02 instead of 0.
    matches : tuple of RetrievedMatch
        The matches, in the order of their scores.
    """

    order: Ints
    scores: Floats
    bounds: Floats
    matches: tuple[RetrievedMatch, ...]

    def __repr__(self) -> str:
        return f"<Retrieval: {len(self.order)} shapes, {len(self.matches)} of them matched>"


@can_go_beside
def retrieve_steps(
    query: TriangleMesh | Shape, shapes: Sequence[TriangleMesh | Shape], settings: RetrievalSettings | None = None
) -> Steps[Retrieval]:
    r"""Rank shapes by the distortion of a sparse match with a query.

    Matching is spared where it has little to find: first all shapes are ranked by a lower bound of the distortion,
    and only the best are matched.  The bound compares the distributions of distances around each sample [1]_: a
    correspondence that keeps areas and takes x to y changes the distances from x by at least the distance between the
    two distributions, so

    .. math:: D^2 \ge \sum_x a_x \min_y \int_0^1 (Q_x(u) - Q_y(u))^2 du

    with quantiles Q, cells of area a, and X and Y in either role.

    Parameters
    ----------
    query : TriangleMesh or Shape
        What is looked for.
    shapes : sequence of TriangleMesh or Shape
        Where it is looked for.  Pass `Shape` objects to keep what is computed for them from one query to the next.
    settings : RetrievalSettings, optional
        How many points, and how many shapes to match.

    Returns
    -------
    Retrieval
        The shapes in order.

    Raises
    ------
    MatchError
        If the list is empty, or a surface has too few vertices for the points that were asked for.
    MeshError, SettingsError
        If a surface is none, as its arrays, or the settings are others, as a dictionary.

    References
    ----------
    .. [1] F. Mémoli, "Gromov-Wasserstein distances and the metric approach to object matching", Foundations of
       Computational Mathematics 11, 2011: the third lower bound.
    """
    settings = RetrievalSettings.checked(settings)
    surfaces = [query, *([shapes] if isinstance(shapes, (TriangleMesh, Shape)) else shapes)]
    if len(surfaces) == 1:
        raise MatchError("There are no shapes to compare with: choose at least one beside the query.")
    names = ["query", *(f"shape {number} of the list" for number in range(1, len(surfaces)))]
    for name, surface in zip(names, surfaces, strict=True):
        check_surface(surface, name)
    prepared = []
    for name, surface in zip(names, surfaces, strict=True):
        prepared.append((yield from within(shape_steps(surface), 0.0, 0.0)))
        check_vertex_count(prepared[-1], settings.points, name)
    source, *targets = prepared
    signatures = []
    for number, shape in enumerate([source, *targets]):
        part = part_of(number, len(targets) + 1, end=0.5)
        yield from within(shape.sample_steps(settings.signature_samples), *part)
        signatures.append(_Signature(shape.limited(settings.signature_samples)))
    bounds = np.array([signatures[0].bound(signature) for signature in signatures[1:]])
    by_bound = np.argsort(bounds, kind="stable")
    matches = []
    count = min(settings.matched, len(targets))
    yield from within(source.sample_steps(settings.samples), 0.5, 0.5)
    for number, place in enumerate(by_bound[:count]):
        matching = _match_steps(source, targets[place], int(place), settings)
        match = yield from within(matching, *part_of(number, count, 0.5))
        matches.append(match)
    matches.sort(key=lambda match: match.score)
    scores = np.full(len(targets), np.nan)
    scores[[match.shape for match in matches]] = [match.score for match in matches]
    order = np.concatenate([[match.shape for match in matches], by_bound[count:]]).astype(np.int64)
    yield Progress(1.0, "Done")
    return Retrieval(order, scores, bounds, tuple(matches))


retrieve = at_once(retrieve_steps)


class _Signature:
    """Distributions of the distances around the samples of a shape.

    Attributes
    ----------
    areas : (k,) array of float
        Area of the cell of each sample, as a part of the whole.
    quantiles : (k, q) array of float
        Quantiles of the distances from each sample to the surface.
    """

    def __init__(self, shape: Shape) -> None:
        self.areas, distances = shape.samples.cell_areas, shape.samples.distances
        order = np.argsort(distances, axis=1)
        areas = self.areas[order]
        middle = np.cumsum(areas, axis=1) - areas / 2
        ordered = np.take_along_axis(distances, order, axis=1)
        self.quantiles = np.stack([np.interp(_LEVELS, m, d) for m, d in zip(middle, ordered, strict=True)])

    def bound(self, other: _Signature) -> float:
        """Lower bound on the root mean square change of distances."""
        table = squared_differences(self.quantiles, other.quantiles) / len(_LEVELS)
        return float(np.sqrt(max(self.areas @ table.min(axis=1), other.areas @ table.min(axis=0))))


def _match_steps(source: Shape, target: Shape, place: int, settings: RetrievalSettings) -> Steps[RetrievedMatch]:
    """Match one pair, by the best coarse matching alone: which of its mirror images it is does not change the score."""
    yield from within(target.sample_steps(settings.samples), 0.0, 0.8)
    # However many samples shapes have already, they compare the same.
    pair = Pair(source.limited(settings.samples), target.limited(settings.samples), settings.match)
    best = (yield from within(coarse_steps(pair), 0.8, 0.9, "Matching"))[0]
    sizes = level_sizes(len(best.matching.assignment), settings.points)
    levels = yield from within(refine_steps(best.pair, best.matching.assignment, sizes), 0.9, 1.0, "Matching")
    assignment = levels[-1].assignment
    k = len(assignment)
    change = pair.source_distances[:k, :k] - pair.target_distances[np.ix_(assignment, assignment)]
    return RetrievedMatch(
        place,
        SurfacePoints.at_vertices(source.original, source.vertices[source.samples.vertices[:k]]),
        SurfacePoints.at_vertices(target.original, target.vertices[target.samples.vertices[assignment]]),
        float(np.sqrt(np.square(change).sum() / (k * (k - 1)))),
    )
