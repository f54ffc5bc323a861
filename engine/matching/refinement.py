# SPDX-License-Identifier: GPL-3.0-or-later
"""A dense map made better around landmarks, without searching for it again."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike
from scipy.spatial import cKDTree

from ..dense.components.masked_maps import left_out_beyond, piece_of, with_pieces_only
from ..dense.dense_registration import EIGENPAIRS, RegisteredPair
from ..dense.densify import dense_match_steps
from ..dense.quality import DenseMatch
from ..mesh.reflection import reflected_mesh
from ..mesh.surface_map import SurfaceMap
from ..mesh.surface_points import SurfacePoints
from ..mesh.triangle_mesh import TriangleMesh, check_mesh
from ..registration.deformable import DeformableSurface
from ..registration.positional_constraints import Ties
from ..registration.registration import FINE, Stage, register_steps, restarted_steps
from ..runtime.arrays import Bools, Floats, Ints
from ..runtime.background import can_go_beside
from ..runtime.errors import MatchError
from ..runtime.progress import Steps, at_once, run, within
from ..shapes.enclosing_surface import joined_shapes_steps, with_limbs_steps
from ..shapes.landmarks import locate_landmarks, vertex_pairs
from ..shapes.prepared_surface import PreparedSurface
from ..shapes.shape import Shape, left_out_of
from ..shapes.shape_preparation import finer_shapes

_DETAILED = 100
"""Eigenfunctions that a surface is placed by before it is registered."""

_BRIEF = Stage((160, 640, 1280), 0.05, 0.0, matched="around")
"""How dense meshes are registered in full resolution: from a map that is nearly right, a quarter of the rounds do."""

_CLOSE = Stage((640, 640, 1280, 1280, 1280, 1280), 0.05, 0.0, matched="around", lead=1.0)
"""How the surfaces come to rest on each other: there is less way to slide than from a map that is rough."""

_ANCHORS = 96
"""Points at most that the distances to others are measured from."""


@can_go_beside
def refine_map_steps(
    source: TriangleMesh,
    target: TriangleMesh,
    source_to_target: SurfaceMap,
    landmarks: ArrayLike,
    excluded: tuple[Bools | None, Bools | None] = (None, None),
    *,
    target_to_source: SurfaceMap | None = None,
) -> Steps[DenseMatch]:
    """Make a dense map better around landmarks.

    The source is laid smoothly onto the target where the map takes it, and registered from there, held at the
    landmarks; then the target onto the source.  So the map stays what it is as a whole: one that takes a limb to
    another limb is to be matched again.  Nothing is sampled, compared or proposed, which takes most of the time of a
    match.

    Parameters
    ----------
    source, target : TriangleMesh
        The surfaces.
    source_to_target : SurfaceMap
        The map to begin with; also one that mirrors the surface stays one.
    landmarks : (k, 2) array_like of int
        Pairs of a vertex of the source and one of the target, one at least.
    excluded : pair of (n,) array of bool, optional
        Vertices of the source and of the target to leave out.
    target_to_source : SurfaceMap, optional
        The map back.  What has no partner by either map, if that is much and has no landmark, is left out as well.

    Returns
    -------
    DenseMatch
        The maps, exact at the landmarks.

    Raises
    ------
    MatchError
        If there are no landmarks, they cannot be used, or a map is not one of these surfaces.
    MeshError
        If a surface is none.
    """
    for mesh, name in ((source, "source"), (target, "target")):
        check_mesh(mesh, name)
    if target_to_source is not None:
        target_to_source.check(target, source)
    masks = left_out_of((source, target), excluded)
    mirrored = source_to_target.orientation(source, target) < 0
    pairs = vertex_pairs(landmarks)
    if not len(pairs):
        raise MatchError("There are no landmarks to refine the map around. Name at least one pair of vertices.")
    ends = pairs[:, 0], pairs[:, 1]
    pieces = piece_of(source, source_to_target, ends[0]), piece_of(target, target_to_source, ends[1])
    first, second = map(left_out_beyond, pieces, masks)
    seen = reflected_mesh(source) if mirrored else source
    x = yield from within(Shape.steps(seen, "source", excluded=first), 0.0, 0.05)
    y = yield from within(Shape.steps(target, "target", excluded=second), 0.05, 0.08)
    x, y = yield from within(joined_shapes_steps(x, y, source_to_target, ends), 0.08, 0.1)
    known = locate_landmarks(x, y, pairs, len(pairs))
    places = source_to_target.positions[x.vertices]
    x, y = finer_shapes(x, y)
    yield from within(x.spectrum_steps(EIGENPAIRS), 0.1, 0.15)
    yield from within(y.spectrum_steps(EIGENPAIRS), 0.15, 0.2)
    moving, fixed = (DeformableSurface(each.mesh, each.laplace, each.surface.cut_border(each.mesh)) for each in (x, y))
    places = fixed.in_unit_size(x.surface.proxy.on_finer(places))
    # Without the noise of the map, which the surface would keep as folds.
    start = moving.smoothed(places, x.unit_functions(_DETAILED))
    proxies = x.surface.proxy, y.surface.proxy
    ties = Ties.of_landmarks(*proxies, fixed, known.source, known.target)
    there = yield from within(register_steps(moving, fixed, start, (FINE, _CLOSE), ties=ties), 0.2, 0.5)
    ties = Ties.of_landmarks(*proxies[::-1], moving, known.target, known.source)
    matches = there.on_source, there.on_target
    steps = restarted_steps(fixed, moving, y.unit_functions(_DETAILED), matches, stages=(FINE, _CLOSE), ties=ties)
    back = yield from within(steps, 0.5, 0.75)
    pair = RegisteredPair(x, y, moving, fixed, there, back, (), None, known, mirrored)
    dense = yield from within(dense_match_steps(pair, _BRIEF), 0.75, 1.0)
    return with_pieces_only(dense, (source, target), pieces)


refine_map = at_once(refine_map_steps)


def placed_by_map(
    source: TriangleMesh, target: TriangleMesh, source_points: SurfacePoints, found: SurfaceMap
) -> tuple[SurfacePoints, Floats]:
    """Let matched points lie where a map takes them.

    Parameters
    ----------
    source, target : TriangleMesh
        The surfaces.
    source_points : SurfacePoints
        The matched points (k,) of the source, at vertices.
    found : SurfaceMap
        A map from the source to the target.

    Returns
    -------
    target_points : SurfacePoints
        Their images, k.
    point_distortion : (k,) array of float
        See `point_distortions`.
    """
    vertices = source_points.nearest_vertices
    images = SurfacePoints.from_barycentric(target, found.triangles[vertices], found.barycentric[vertices])
    return images, point_distortions(source, target, vertices, images.nearest_vertices)


def distortion_after(distortion: float, before: Floats, after: Floats) -> float:
    """Scale the distortion of a match, which is made of the squares of its points' (k,), to what these are now."""
    squares = float(np.square(before).sum())
    return distortion * float(np.square(after).sum()) / squares if squares > 0 else distortion


def point_distortions(
    source: TriangleMesh, target: TriangleMesh, source_vertices: ArrayLike, target_vertices: ArrayLike
) -> Floats:
    """Measure how much the distances between corresponding vertices differ on two surfaces.

    Parameters
    ----------
    source, target : TriangleMesh
        The surfaces.
    source_vertices, target_vertices : (k,) array_like of int
        Corresponding vertices of them.

    Returns
    -------
    (k,) array of float
        Root mean square, over the other vertices or a spread part of them, of the difference of the distances, each
        in units of the square root of the area of its surface; zero for a vertex without a path to others.  What is
        on a piece beside the main part, such as an eye, is measured from the place of the main part next to it.
    """
    count = np.size(source_vertices)
    anchors = np.unique(np.linspace(0, count - 1, min(count, _ANCHORS)).round().astype(np.int64))
    rows = []
    for mesh, given in ((source, source_vertices), (target, target_vertices)):
        vertices = np.asarray(given, np.int64)
        shape = run(with_limbs_steps(Shape(mesh), "mesh", vertices))
        own = _on_main_part(shape.surface, vertices)
        rows.append(shape.solver.distances(own[anchors])[:, own] / shape.scale)
    squares = np.square(rows[0] - rows[1])  # (a, k)
    others = np.maximum(len(anchors) - np.isin(np.arange(count), anchors), 1)
    return np.sqrt(np.where(np.isfinite(squares), squares, 0.0).sum(axis=0) / others)


def _on_main_part(surface: PreparedSurface, vertices: Ints) -> Ints:
    """Find the vertex of the surface that is matched that stands for each of some original ones, (k,)."""
    on_main = surface.cleaned.vertex_parts[vertices] == 0
    found = np.empty(len(vertices), np.int64)
    found[on_main] = surface.mesh_vertices(vertices[on_main])
    found[~on_main] = cKDTree(surface.mesh.vertices).query(surface.original.vertices[vertices[~on_main]])[1]
    return found
