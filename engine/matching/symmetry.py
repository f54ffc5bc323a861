# SPDX-License-Identifier: GPL-3.0-or-later
"""The intrinsic symmetry of a surface: matched to itself, the identity excluded."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np

from ..geometry.best_distinct import best_distinct
from ..hierarchical.exact.branch_and_bound import BoundedMatching, matchings_of_each_steps
from ..hierarchical.exact.exclusion import Exclusion
from ..hierarchical.hierarchy import level_sizes, refine_steps
from ..hierarchical.lifted_samples import CURVATURE_WEIGHT, curvature_agreement, mean_orientation, sample_misfits
from ..hierarchical.sampled_pair import Pair
from ..hierarchical.settings import MatchSettings
from ..hierarchical.sparse_hypotheses import coarse_candidates
from ..mesh.surface_points import SurfacePoints
from ..mesh.triangle_mesh import TriangleMesh
from ..runtime.arrays import TINY, Floats, Ints
from ..runtime.background import can_go_beside
from ..runtime.errors import MatchError
from ..runtime.progress import Progress, Steps, at_once, within
from ..shapes.shape import Shape, check_vertex_count, shape_steps

_FAR = 0.2  # a point moved farther than this, in sqrt(area), is in another place
_MOVED_SHARE = 0.3  # part of the coarse points that has to be in another place: the others may lie on the axis
_INVOLUTION_SCALE = 0.1  # mean distance between a point and the image of its image that counts as far
_OVERSAMPLING = 2  # times the hypotheses of a match: many swap left and right in a part of the body only
_ROUNDS = 4  # of making the map its own inverse, and of placing the images; both settle in two or three


@dataclass(frozen=True, eq=False)
class SymmetryResult:
    """A map of a surface to itself that nearly keeps all distances and is not the identity.

    Attributes
    ----------
    source_points, target_points : SurfacePoints
        Points and their images, k each, on the same surface.
    asymmetry : float
        Root mean square change of the distance between two of the points under the map, in units of the square root
        of the area: 0 for a perfectly symmetric surface.  It does not depend on units, and little on the number of
        points.  For comparison: such distances are about 0.7, bodies that are symmetric at rest have 0.005 to 0.06,
        more the more their pose stretches the skin.  Legs and ears whose lengths differ by a tenth make 0.015; up to
        0.01 comes from errors of the distances where the triangulation itself is irregular.
    orientation : float
        Agreement of the orientation of the surface with that around the images, -1 to 1: near -1 if the map reverses
        it, as that from left to right does, near 1 if it is a turn.
    involution : float
        Mean distance between a point and the image of its image, in units of the square root of the area: 0 if the
        map is its own inverse.
    curvature : float
        Correlation of the mean curvature with that at the images, at most 1.  Distances cannot tell left-right from
        front-back on a thin body; this can.
    sides : (n,) array of float
        For each vertex of the surface, on which side of the axis it lies: positive on one, negative on the other,
        growing with the distance from the axis (in the units of the mesh, at most about half the distance between the
        vertex and its image); NaN on other parts of the surface than the largest.
    axis_points : SurfacePoints
        Where edges cross the fixed curve, the symmetry axis; none if the map keeps the orientation.
    alternatives : tuple of SymmetryResult
        Other symmetries, most credible first: of several, or of a nearly symmetric surface.  Those of a ball are
        examples of infinitely many.
    proven : bool
        Whether the coarse matching from which the map was grown is known to be the optimum of its problem.
    notes : tuple of str
        What the user should know: one sentence each.
    """

    source_points: SurfacePoints
    target_points: SurfacePoints
    asymmetry: float
    orientation: float
    involution: float
    curvature: float
    sides: Floats
    axis_points: SurfacePoints
    alternatives: tuple[SymmetryResult, ...]
    proven: bool
    notes: tuple[str, ...]

    def __repr__(self) -> str:
        kind = "a reflection" if self.reverses_orientation else "a turn"
        return f"<SymmetryResult: {kind}, {len(self.source_points)} points, asymmetry {self.asymmetry:.3g}>"

    @property
    def reverses_orientation(self) -> bool:
        """Whether the map is a reflection."""
        return self.orientation < 0


class _Candidate(NamedTuple):
    """A map of all samples, on its way to a result."""

    coarse: BoundedMatching
    images: Ints  # (S,) sample numbers
    orientation: float
    involution: float
    curvature: float
    score: float  # smaller is more credible


@can_go_beside
def find_symmetry_steps(
    surface: TriangleMesh | Shape, settings: MatchSettings | None = None, alternatives: int = 3
) -> Steps[SymmetryResult]:
    """Find the intrinsic symmetry of a surface, for bodies the map from left to right.

    The surface is matched to itself, away from the identity [1]_ [2]_.  It need not be symmetric in space: a body in
    any pose is as symmetric as at rest, as far as the pose keeps distances along its skin.

    Parameters
    ----------
    surface : TriangleMesh or Shape
        The surface; the main part is used.
    settings : MatchSettings, optional
        How many points, and how hard to search.
    alternatives : int
        How many other symmetries are placed on the surface, at most.

    Returns
    -------
    SymmetryResult
        The most credible reflection, or turn if there is no reflection, however poor: see its `asymmetry`.

    Raises
    ------
    MatchError
        If the surface has too few vertices for the points, or is so small that nothing can move.
    MeshError, SettingsError
        If the surface is none, as its arrays, or the settings are others, as a dictionary.

    References
    ----------
    .. [1] D. Raviv, A. Dubrovina, R. Kimmel, "Hierarchical Matching of Non-rigid Shapes", SSVM 2011.
    .. [2] D. Raviv, A. M. Bronstein, M. M. Bronstein, R. Kimmel, "Full and partial symmetries of non-rigid shapes",
       IJCV 89, 2010.
    """
    settings = MatchSettings.checked(settings)
    shape = yield from within(shape_steps(surface), 0.0, 0.0)
    check_vertex_count(shape, settings.points)
    samples = max(settings.samples, 2 * settings.points)
    yield from within(shape.sample_steps(samples), 0.0, 0.5)
    if Pair.needs_spectrum(settings):
        yield from within(shape.spectrum_steps(settings.eigenpairs), 0.5, 0.55)
    shape = shape.limited(samples)
    pair = Pair(shape, shape, settings)
    coarse = yield from within(_coarse_steps(pair), 0.55, 0.7, "Matching the surface to itself")
    candidates = yield from within(_candidate_steps(pair, coarse), 0.7, 0.9, "Comparing symmetries")
    best = next((c for c in candidates if c.orientation < 0), candidates[0])
    chosen = [best, *(c for c in candidates if c is not best)][: 1 + max(alternatives, 0)]
    results = []
    for number, candidate in enumerate(chosen):
        yield Progress(0.9 + 0.1 * number / len(chosen), "Placing the points")
        results.append(_result(shape, candidate, settings.points))
    yield Progress(1.0, "Done")
    return replace(results[0], alternatives=tuple(results[1:]))


find_symmetry = at_once(find_symmetry_steps)


def _coarse_steps(pair: Pair) -> Steps[list[BoundedMatching]]:
    """Match the coarse points to themselves exactly, away from the identity: the best distinct matchings."""
    settings = pair.settings
    points = min(settings.coarse_points, settings.points)
    problem = pair.problem(points, coarse_candidates(pair))
    geodesic = pair.target.samples.distances[: problem.size[1], : problem.size[1]]
    far = geodesic > _FAR * min(1.0, float(geodesic.max()))
    identity = Exclusion(far[:points], int(np.ceil(_MOVED_SHARE * points)))
    problems = [problem] * (_OVERSAMPLING * settings.hypotheses)
    found = yield from matchings_of_each_steps(problems, far, settings.node_limit, [identity])
    if not found:
        raise MatchError(
            "The mesh is too coarse to be matched to anything but itself: use more Coarse Candidates or subdivide it."
        )
    return found


def _candidate_steps(pair: Pair, coarse: list[BoundedMatching]) -> Steps[list[_Candidate]]:
    """Grow each coarse matching to maps of all samples, of either orientation; distinct ones, most credible first."""
    sizes = level_sizes(len(coarse[0].assignment), pair.settings.points)
    candidates = []
    for number, matching in enumerate(coarse):
        for sign in (-1, 1):
            here = (number + (sign > 0) / 2) / len(coarse)
            term = pair.orientation_term(matching.assignment, sign)
            levels = yield from within(refine_steps(pair, matching.assignment, sizes, term), here, here)
            candidates.append(_assess(pair.source, matching, levels[-1].assignment, sign))
    distances = pair.source.samples.distances
    identity = np.arange(len(pair.source.samples))

    def moved(candidate: _Candidate, other: Ints) -> bool:
        """Say whether a candidate takes a good part of the samples elsewhere than other images (n,)."""
        return bool((distances[candidate.images, other] > _FAR / 2).mean() > _MOVED_SHARE)

    ranked = sorted(candidates, key=lambda candidate: candidate.score)
    moving = [candidate for candidate in ranked if moved(candidate, identity)]
    return best_distinct(moving, lambda candidate, other: moved(candidate, other.images)) or ranked[:1]


def _assess(shape: Shape, coarse: BoundedMatching, assignment: Ints, sign: int) -> _Candidate:
    """Carry a matching to all samples, make the map its own inverse if it can be, and judge it."""
    distances, count = shape.samples.distances, len(assignment)
    everywhere = np.arange(len(distances))
    misfit = sample_misfits(shape, shape, assignment, sign).all
    images = misfit.argmin(axis=1)
    of_first = float(distances[images[images], everywhere].mean())
    for _ in range(_ROUNDS):
        # An involution that keeps distances takes x to y and y to x: both have to fit.
        before = images
        images = (misfit + misfit.T).argmin(axis=1)
        if np.array_equal(images, before):
            break
        misfit = sample_misfits(shape, shape, images[:count], sign).all
    orientation = mean_orientation(shape, shape, images[:count], images)
    change = distances[:, :count] - distances[np.ix_(images, images[:count])]
    curvature = curvature_agreement(shape, shape, images)
    # A map that moves points by little cannot change distances by much, as the flip of a thin body from front to back:
    # what counts is the change for the way that the points go.
    way = float(np.square(distances[images, everywhere]).mean())
    score = np.log(max(float(np.square(change).mean()), TINY) / max(way, TINY))
    score += (of_first / _INVOLUTION_SCALE) ** 2 - CURVATURE_WEIGHT * curvature
    involution = float(distances[images[images], everywhere].mean())
    return _Candidate(coarse, images, orientation, involution, curvature, float(score))


def _result(shape: Shape, candidate: _Candidate, count: int) -> SymmetryResult:
    """Place the images of the points at vertices, between the samples, and measure the map there."""
    rows = shape.samples.rows[:count].astype(np.float64)
    nearest = candidate.images[:count]
    images, image_rows = shape.samples.vertices[nearest], shape.samples.rows[nearest].astype(np.float64)
    for _ in range(_ROUNDS):
        before = images
        images = _images_at_vertices(shape, rows, image_rows)
        if np.array_equal(images, before):
            break
        image_rows = shape.solver.distances(images) / shape.scale
    points = shape.samples.vertices[:count]
    change = rows[:, points] - image_rows[:, images]
    whole_sides = shape.surface.spread(_sides(shape, rows - image_rows) * shape.scale, np.nan)
    return SymmetryResult(
        source_points=SurfacePoints.at_vertices(shape.original, shape.vertices[points]),
        target_points=SurfacePoints.at_vertices(shape.original, shape.vertices[images]),
        asymmetry=float(np.sqrt(np.square(change).sum() / (count * (count - 1)))),
        orientation=candidate.orientation,
        involution=candidate.involution,
        curvature=candidate.curvature,
        sides=whole_sides,
        axis_points=_zero_crossings(shape.original, whole_sides, reflection=candidate.orientation < 0),
        alternatives=(),
        proven=candidate.coarse.proven,
        notes=shape.surface.cleaned.notes,
    )


def _images_at_vertices(shape: Shape, rows: Floats, image_rows: Floats) -> Ints:
    """Find the vertex near each point's image that keeps its distances to all points and images best, (k,).

    `rows` and `image_rows` (k, n) are the distances from the points, which are the first samples, and from their
    images.
    """
    points = shape.samples.vertices[: len(rows)]
    # The map takes points to images and images back to points: both kinds of distances have to be kept.
    here = np.concatenate([rows[:, points], image_rows[:, points]])
    reach = float(shape.samples.rows.min(axis=0).max())  # no vertex is farther than this from the samples
    found = np.empty(len(points), np.int64)
    for i, row in enumerate(image_rows):
        near = np.flatnonzero(row <= reach)
        there = np.concatenate([image_rows[:, near], rows[:, near]])
        found[i] = near[np.square(there - here[:, i : i + 1]).sum(axis=0).argmin()]
    return found


def _sides(shape: Shape, differences: Floats) -> Floats:
    """Tell the sides of the axis apart by how much nearer each vertex is to points than to their images, (n,).

    `differences` (k, n) is d(v, p_i) - d(v, T p_i).  A vertex is nearer to whichever of the two lies on its own side:
    the shortest path to the other one crosses the axis, from where both are equally far.  So up to noise the table has
    the signs of an outer product, and its leading singular vectors tell the sides of points and of vertices.
    """
    _, vectors = np.linalg.eigh((differences * shape.mesh.vertex_areas) @ differences.T)
    weights = vectors[:, -1]
    weights *= np.sign(weights[np.abs(weights).argmax()])
    return -(weights / np.abs(weights).sum()) @ differences / 2


def _zero_crossings(mesh: TriangleMesh, values: Floats, *, reflection: bool) -> SurfacePoints:
    """Points on edges at which a function given at the vertices, NaN where unknown, changes its sign."""
    corners = mesh.triangles if reflection else mesh.triangles[:0]
    first, second = corners.ravel(), np.roll(corners, -1, axis=1).ravel()
    crossing = np.flatnonzero((values[first] >= 0) & (values[second] < 0) | (values[first] < 0) & (values[second] >= 0))
    ends = np.sort([first[crossing], second[crossing]], axis=0)
    flat = crossing[np.sort(np.unique(ends, axis=1, return_index=True)[1])]  # each edge in its first triangle
    triangles, corner = np.divmod(flat, 3)
    a, b = values[first[flat]], values[second[flat]]
    weights = np.zeros((len(flat), 3))
    rows = np.arange(len(flat))
    weights[rows, corner] = b / (b - a)
    weights[rows, (corner + 1) % 3] = a / (a - b)
    return SurfacePoints.from_barycentric(mesh, triangles, weights)
