# SPDX-License-Identifier: GPL-3.0-or-later
"""One surface laid onto another along a map, whole and without folds."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from scipy.sparse import csr_array, diags_array

from ..dense.components.similarity_field import Surroundings
from ..geometry.laplacian import laplace_beltrami
from ..geometry.procrustes import nearest_similarity
from ..geometry.symmetric_factor import symmetric_factor
from ..mesh.connectivity.adjacency import edge_means, vertex_adjacency
from ..mesh.connectivity.welded_parts import WeldedParts
from ..mesh.reflection import reflected_map, reflected_mesh
from ..mesh.surface_map import SurfaceMap
from ..mesh.surface_points import SurfacePoints
from ..mesh.triangle_mesh import TriangleMesh
from ..registration.elastic import ElasticSurface
from ..runtime.arrays import Bools, Floats, group_largest, group_means, group_smallest, marked
from ..runtime.background import can_go_beside
from ..runtime.errors import MatchError
from ..runtime.progress import Progress, Steps
from .values.deformation_gradients import surface_frames

_RETURN = 0.04
"""How far from where it set out, in sqrt(area), a vertex may return from the way there and back: one that returns
elsewhere lies where the target has no such part."""

_LEAST_CONFIDENCE = 0.05
"""Places below hold nothing."""

_WEIGHTS = 40.0, 160.0, 640.0, 2560.0, 1e4, 1e4, 1e4, 1e4
"""How much the distance from the map counts against the elastic energy, round after round; the last rounds are only for
what is folded still."""

_SOLVES = 3
"""How often positions and rotations are found in turn in each round."""

_RADIUS = 0.01
"""Over what distance rotations are averaged, in sqrt(area)."""

_RINGS = 4
"""Around what is folded still the surface is smoothed so many edges wide at most: with more, noses and ears go."""

_COINCIDENT = 1e-6
"""Vertices closer than this part of the diagonal of the bounding box are one place."""

_LOOSE = 1e-4
"""How much, beside others, parts count that nothing holds: they stay near where their surroundings take them."""


@dataclass(frozen=True, eq=False)
class WrappedSurface:
    """A surface laid onto another.

    Attributes
    ----------
    positions : (n_x, 3) array of float
        Its vertices, in the space of the target.
    held : (n_x,) array of bool
        Which of them lie on the target; the others are parts that the target lacks, and follow their surroundings.
    folded : float
        Area of its triangles that are turned over against their neighbours, as a part of all, 0 to 1.
    """

    positions: Floats
    held: Bools
    folded: float

    def __repr__(self) -> str:
        return f"<WrappedSurface: {len(self.positions)} vertices, {self.folded:.1%} folded>"


@can_go_beside
def wrap_steps(
    source: TriangleMesh,
    target: TriangleMesh,
    source_to_target: SurfaceMap,
    target_to_source: SurfaceMap,
    registered: Floats | None = None,
) -> Steps[WrappedSurface]:
    """Lay the source onto the target.

    The source is an elastic surface, at rest in the size of the target, that the map draws onto the target with a
    growing force.  A vertex is not drawn if the way to the target and back leads elsewhere, if the map has no
    confidence in it, or if a triangle there is turned over: such places deform as rigidly as possible with their
    surroundings.  Vertices at a seam that the source was cut open at, as for UVs, are one point before, and stay one:
    of the places that the map has for it, the one in which it has most confidence counts.  What is folded at the end
    is smoothed with what is around it.

    Parameters
    ----------
    source, target : TriangleMesh
        The surfaces.
    source_to_target, target_to_source : SurfaceMap
        The maps between them.
    registered : (n_x, 3) array of float, optional
        Where the vertices of the source belong, if that is known better than from the map.

    Yields
    ------
    Progress
        After each round.

    Returns
    -------
    WrappedSurface
        The source on the target.

    Raises
    ------
    MatchError
        If the maps are not those of the surfaces, or do not hold the source anywhere.
    """
    source_to_target.check(source, target)
    target_to_source.check(target, source)
    wanted = source_to_target.positions if registered is None else np.asarray(registered, np.float64)
    if wanted.shape != source.vertices.shape:
        raise MatchError(
            f"There are {source.vertex_count} vertices, but places where they belong of the shape {wanted.shape}."
        )
    if source_to_target.mirrors(source, target):  # what lies there without a crease is the mirror image
        source = reflected_mesh(source)
        target_to_source = reflected_map(source, target_to_source)
    held = _held(source, source_to_target, target_to_source)
    confidence, points = source_to_target.confidence, source_to_target.points
    parts = WeldedParts.of(source)
    if parts.seams:
        best = parts.best_of(held + confidence)
        wanted, held, confidence, points = wanted[best], held[best], confidence[best], points.at(best)
        source = parts.closed
    if not held[source.triangles].all(axis=1).any():
        raise MatchError(
            "The map does not hold the source anywhere on the target: the two are too different. Match them again."
        )
    yield Progress(0.0, "Placing parts that the target lacks")
    start = _start(source, target, points, wanted, held)
    unit = float(np.sqrt(target.area))
    growth = unit / float(np.sqrt(source.area))
    laplace = laplace_beltrami(source)
    elastic = ElasticSurface(source.vertices * (growth / unit), laplace)
    mass = laplace.mass / laplace.area
    mass = np.where(mass > 0, mass, mass.mean())  # of loose vertices
    positions, goal = start / unit, start / unit
    folded = np.zeros(source.triangle_count, bool)
    for number, weight in enumerate(_WEIGHTS):
        drawn = weight * mass * np.where(held, confidence.clip(min=_LEAST_CONFIDENCE), _LOOSE)
        factor = symmetric_factor(elastic.stiffness + diags_array(drawn))
        for solve in range(_SOLVES):
            yield Progress((number + solve / _SOLVES) / len(_WEIGHTS), "Laying the surface onto the other")
            pull = elastic.pull(elastic.rotations(positions, _RADIUS))
            positions = factor.solve(pull + drawn[:, None] * goal)
        folded = _folded(source, positions)
        if not folded.any():
            if weight == max(_WEIGHTS):
                break
            continue
        held = held.copy()
        held[source.triangles[folded]] = False
    positions, folded = _smoothed(source, positions, folded)
    share = float(source.triangle_areas[folded].sum() / source.area)
    turns = growth * elastic.rotations(positions, _RADIUS)
    placed = _united(parts.mesh, (positions * unit)[parts.welded], turns[parts.welded])
    return WrappedSurface(placed, held[parts.welded], share)


def kept_in_place(mesh: TriangleMesh, positions: Floats) -> Floats:
    """Turn and move a deformed surface back to where the surface was, as well as that goes without deforming it.

    Parameters
    ----------
    mesh : TriangleMesh
        The surface.
    positions : (n, 3) array of float
        Its vertices when deformed.

    Returns
    -------
    (n, 3) array of float
        The same shape: the distances of the vertices from where they were are least in the sense of least squares, by
        area.
    """
    linear, translation = nearest_similarity(positions, mesh.vertices, mesh.vertex_areas, scale=1.0)
    return positions @ linear.T + translation


def _smoothed(mesh: TriangleMesh, positions: Floats, folded: Bools) -> tuple[Floats, Bools]:
    """Span the surface (n, 3) evenly over what is folded, (m,), and around that as far as needed: new ones of both."""
    graph = vertex_adjacency(mesh)
    spread = csr_array(diags_array(graph.sum(axis=1)) - graph)
    for rings in range(1, _RINGS + 1):
        if not folded.any():
            break
        free = marked(mesh.triangles[folded], mesh.vertex_count)
        for _ in range(rings):
            free |= graph @ free > 0
        # A piece that is free as a whole has nothing to be spanned between.
        fixed = marked(mesh.component_labels[~free], mesh.component_labels.max() + 1)
        free &= fixed[mesh.component_labels]
        if not free.any():
            continue
        smooth = positions.copy()
        pull = -spread[free][:, ~free] @ positions[~free]
        smooth[free] = symmetric_factor(csr_array(spread[free][:, free])).solve(pull)
        still = _folded(mesh, smooth)
        if mesh.triangle_areas[still].sum() < mesh.triangle_areas[folded].sum():
            positions, folded = smooth, still
    return positions, folded


def _united(mesh: TriangleMesh, positions: Floats, turns: Floats) -> Floats:
    """Bring vertices at one place of the mesh together again, (n, 3), unless they belong to different places by now.

    Such as both ends of an edge without length, or the corners of two shields one before the other; but not hands that
    touched, and that the other surface holds apart.  What little they were apart they stay, turned and scaled by turns
    (n, 3, 3): an edge that loses its length takes the custom normals around it along.
    """
    size = float(np.linalg.norm(np.ptp(mesh.vertices, axis=0)))
    cells = np.round(mesh.vertices / (_COINCIDENT * size))
    _, first, place = np.unique(cells, axis=0, return_index=True, return_inverse=True)
    place = place.ravel()
    counts = np.bincount(place)
    middle, center = (group_means(place, points, len(counts)) for points in (positions, mesh.vertices))
    apart = np.einsum("nij,nj->ni", turns[first[place]], mesh.vertices - center[place])
    away = group_largest(place, np.linalg.norm(positions - middle[place], axis=1), len(counts))
    one, other = mesh.edges.T
    around = edge_means(mesh, np.linalg.norm(positions[one] - positions[other], axis=1))
    together = ((counts > 1) & (away <= group_smallest(place, around, len(counts))))[place]
    return np.where(together[:, None], middle[place] + apart, positions)


def _held(source: TriangleMesh, there: SurfaceMap, back: SurfaceMap) -> Bools:
    """Tell which vertices of the source have a place on the target, (n_x,)."""
    away = np.linalg.norm(there.transfer(back.positions) - source.vertices, axis=1)
    return (away <= _RETURN * np.sqrt(source.area)) & (there.confidence >= _LEAST_CONFIDENCE)


def _start(source: TriangleMesh, target: TriangleMesh, points: SurfacePoints, wanted: Floats, held: Bools) -> Floats:
    """Where the vertices belong, those without a place moved along with what is around them, (n_x, 3)."""
    if held.all():
        return wanted
    part, vertices, _ = source.submesh(held)
    surroundings = Surroundings(part, target, replace(points.at(vertices), positions=wanted[vertices]))
    free = np.flatnonzero(~held)
    distances, _ = surroundings.nearest(source.vertices[free])
    # A loose part moves as one: all of it follows the surroundings of its farthest vertex.
    labels = source.component_labels
    with_hold = marked(labels[held], labels.max() + 1)
    reach = group_largest(labels[free], distances, labels.max() + 1)
    loose = ~with_hold[labels[free]]
    centres = group_means(labels, source.vertices, len(reach))
    at = np.where(loose[:, None], centres[labels[free]], source.vertices[free])
    fitted = surroundings.similarities(at, np.where(loose, reach[labels[free]], distances))
    start = wanted.copy()
    start[free] = fitted(source.vertices[free])
    return start


def _folded(mesh: TriangleMesh, positions: Floats) -> Bools:
    """Tell which triangles are turned over against the way the surface around them is turned, (m,)."""
    frames = surface_frames(mesh, positions, radius=_RADIUS)
    a, b, c = (positions[corner] for corner in mesh.triangles.T)
    rotated = frames.rotations[mesh.triangles].sum(axis=1) @ mesh.triangle_normals[:, :, None]
    return np.einsum("md,md->m", np.cross(b - a, c - a), rotated[:, :, 0]) < 0
