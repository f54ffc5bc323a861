# SPDX-License-Identifier: GPL-3.0-or-later
"""Proxy meshes: the remeshing of a mesh on which the match is computed, coarser for dense meshes."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import csr_array, diags_array

from ..geometry.symmetric_factor import symmetric_factor
from ..mesh.closest_points import ClosestPoints, FoundPoints
from ..mesh.edge_splitting import split_longest_edges
from ..mesh.surface_points import SurfacePoints, interpolation_matrix
from ..mesh.triangle_mesh import TriangleMesh
from ..runtime.arrays import Floats, Ints, numbered, slices
from ..runtime.progress import Progress, Steps, within
from .remeshing.dual_triangulation import manifold_part
from .remeshing.surface_cells import SurfaceCells, grid_labels, nearest_members
from .remeshing.voronoi_regions import VoronoiRegions, spread_regions_steps

MATCHED = 5000
"""About how many vertices stand for a denser mesh, by default."""

_LARGE = 1.6  # times as many vertices as wanted: meshes with fewer stand for themselves
_CELLS = 20.0  # cells for each vertex of the proxy: some where it is densest, and none ever joins two fingers
_CELL_SIZE = 0.85  # of sqrt(area / cells); a cube cuts more from a slanted surface than its side squared
_FITS = 2
_TETHER = 0.02  # weight of staying in place against that of the vertices around, where these leave freedom
_FINER = 2.0  # more vertices for the second attempt
_GOOD_PART = 0.98  # of the triangles that must have stayed for the first attempt to be taken
_STEP = 200_000  # vertices projected between two reports of progress


@dataclass(frozen=True, eq=False)
class Proxy:
    """A mesh that stands for another: a coarse one for a dense one, or the other way round.

    Attributes
    ----------
    mesh : TriangleMesh
        The mesh that stands for the other, a manifold.
    points : SurfacePoints
        For each vertex of the other mesh, (n,), its place on this one.
    vertices : (k,) array of int
        For each vertex of this mesh, the nearest vertex of the other of those that it stands for.  All differ, but
        where this mesh is the finer one.
    ends : (k - n, 2) array of int, optional
        Of a finer mesh, whose first n vertices are those of the other, the two vertices between which, in the middle
        of an edge, each of the rest lies.
    """

    mesh: TriangleMesh
    points: SurfacePoints
    vertices: Ints
    ends: Ints | None = None

    @property
    def is_identity(self) -> bool:
        """Whether the mesh stands for itself."""
        return self.mesh.vertex_count == len(self.points)

    @property
    def is_finer(self) -> bool:
        """Whether the mesh has more vertices than the one that it stands for."""
        return self.ends is not None

    @property
    def is_coarser(self) -> bool:
        """Whether the mesh has fewer vertices than the one that it stands for."""
        return self.mesh.vertex_count < len(self.points)

    @classmethod
    def identity(cls, mesh: TriangleMesh) -> Proxy:
        """Let a mesh, all vertices of which have triangles, stand for itself."""
        vertices = np.arange(mesh.vertex_count)
        return cls(mesh, SurfacePoints.at_vertices(mesh, vertices), vertices)

    @classmethod
    def finer(cls, mesh: TriangleMesh, vertices: int) -> Proxy:
        """Let a mesh, all vertices of which have triangles, have about so many of them: split its longest edges.

        No edge is split twice, so there are at most four times as many.
        """
        own = np.arange(mesh.vertex_count)
        fine, ends = split_longest_edges(mesh, vertices - mesh.vertex_count)
        return cls(fine, SurfacePoints.at_vertices(fine, own), np.concatenate([own, ends[:, 0]]), ends)

    def on_finer(self, values: NDArray[np.floating[Any]]) -> NDArray[np.floating[Any]]:
        """Interpolate values (n, ...) at the vertices of the other mesh at those of this one, if that is finer."""
        return values if self.ends is None else np.concatenate([values, values[self.ends].mean(axis=1)])


def proxy_steps(mesh: TriangleMesh, vertices: int = MATCHED) -> Steps[Proxy]:
    """Approximate a dense mesh by a coarse one.

    Parameters
    ----------
    mesh : TriangleMesh
        A manifold, consistently oriented, as `clean` leaves it: it may have open boundaries, but small holes, in which
        no loop of the proxy's edges would fit, are closed.  Every vertex has a triangle.
    vertices : int
        About how many vertices the proxy should have.

    Yields
    ------
    Progress
        How far it is.

    Returns
    -------
    Proxy
        The coarse mesh: a manifold of the same genus and the same boundary loops as the dense one.  A mesh of less
        than 1.6 times as many vertices stands for itself.

    Notes
    -----
    The vertices are gathered in the cubes of a grid, twenty for each vertex of the proxy and split into parts that
    hang together, so that all that follows costs the same whatever the number of vertices.  Seeds are spread over these
    cells with a least distance between each two (Poisson-disk sampling [1]_), smaller where the surface bends, so that
    the features by which it is recognised are kept; moved to the centres of their Voronoi regions twice [2]_; and
    joined by the triangulation dual to the regions.  Where that is not a manifold like the surface, farther seeds are
    added to the regions at fault; so thin and intricate parts get more vertices, and in the limit all of the mesh.
    Last, the positions are fitted to the vertices in the least squares sense, which restores most of the volume that
    coarse triangles cut away.

    Should faults remain (a mesh that is not a manifold, say), a proxy of twice as many vertices is tried, and then the
    largest part without faults is taken.

    The result does not depend on the order of the vertices but for ties of distances and for rounding, nor on the
    scale; it turns with the mesh as far as the grid allows.

    References
    ----------
    .. [1] R. Cook, "Stochastic sampling in computer graphics", ACM Transactions on Graphics 5, 1986.
    .. [2] S. Lloyd, "Least squares quantization in PCM", IEEE Transactions on Information Theory 28, 1982.
    """
    fitted = yield from within(_fitted_steps(mesh, vertices), 0.0, 0.75)
    return Proxy.identity(mesh) if fitted is None else (yield from within(_placed_steps(mesh, *fitted), 0.75, 1.0))


def coarse_mesh_steps(mesh: TriangleMesh, vertices: int) -> Steps[TriangleMesh]:
    """Find the mesh of the proxy alone, see `proxy_steps`."""
    fitted = yield from _fitted_steps(mesh, vertices)
    return mesh if fitted is None else _mesh_of(fitted[0])


def _divided_steps(mesh: TriangleMesh, count: int) -> Steps[tuple[VoronoiRegions, Ints]]:
    """Divide a mesh into about so many regions: these, and the triangles between them that are a manifold, (t,)."""
    yield Progress(0.0, "Simplifying the mesh")
    cell_size = _CELL_SIZE * float(np.sqrt(mesh.area / (_CELLS * count)))
    labels = grid_labels(mesh, cell_size)
    yield Progress(0.33, "Simplifying the mesh")
    cells = SurfaceCells.build(mesh, labels)
    yield Progress(0.67, "Simplifying the mesh")
    regions = yield from within(spread_regions_steps(cells, count), 0.67, 0.83)
    yield Progress(0.83, "Simplifying the mesh")
    regions = regions.repaired(mesh)
    triangles = regions.dual.triangles
    if regions.dual.faulty.any():
        return regions, manifold_part(triangles, len(regions.seeds))
    return regions, np.arange(len(triangles))


def _fitted_steps(mesh: TriangleMesh, vertices: int) -> Steps[tuple[ClosestPoints, Ints] | None]:
    """Fit a coarse triangulation to a mesh, see `proxy_steps`; None if the mesh is to stand for itself.

    Returned are the search on it, and which of its vertices is about where each of the mesh is, (n,), -1 where none is.
    """
    if mesh.vertex_count <= _LARGE * vertices:
        return None
    regions, kept = yield from within(_divided_steps(mesh, vertices), 0.0, 0.4)
    if len(kept) < _GOOD_PART * len(regions.dual.triangles):
        regions, kept = yield from within(_divided_steps(mesh, int(_FINER * vertices)), 0.4, 0.8)
    if not len(kept) or len(regions.seeds) > mesh.vertex_count / 2:
        return None
    cells = regions.cells
    used, triangles = np.unique(regions.dual.triangles[kept], return_inverse=True)
    place = numbered(used, len(regions.seeds))[regions.labels[cells.labels]]
    search = ClosestPoints(TriangleMesh(_first_positions(regions)[used], triangles.reshape(-1, 3)))

    # One vertex of each cell speaks for all in the fit.
    samples = cells.nearest_vertices(mesh.vertices)
    known = np.flatnonzero(place[samples] >= 0)
    samples, weights = samples[known], cells.areas[known]
    for fit in range(_FITS):
        yield Progress(0.8 + 0.1 * fit, "Simplifying the mesh")
        part = slice(None, None, _FITS - fit)  # at first, fewer do
        wanted = mesh.vertices[samples[part]]
        found = search.walk(wanted, place[samples[part]])
        search = search.moved(_fitted_positions(search, found, wanted, weights[part]))
    return search, place


def _placed_steps(mesh: TriangleMesh, search: ClosestPoints, place: Ints) -> Steps[Proxy]:
    """Find the place of each vertex of a mesh on a coarse one, from the vertices (n,) where it about is."""
    n, coarse = mesh.vertex_count, _mesh_of(search)
    lost = np.flatnonzero(place < 0)
    place[lost] = search.nearest_vertices(mesh.vertices[lost])
    where, barycentric = np.empty(n, np.int64), np.empty((n, 3))
    for part in slices(n, _STEP):
        yield Progress(part.start / n, "Simplifying the mesh")
        found = search.walk(mesh.vertices[part], place[part])
        where[part], barycentric[part] = found.triangles, found.barycentric

    offsets = mesh.vertices - coarse.vertices[place]
    distances = np.einsum("nd,nd->n", offsets, offsets)
    distances[lost] = np.inf
    vertices = nearest_members(place, distances, coarse.vertex_count)
    return Proxy(coarse, SurfacePoints.from_barycentric(coarse, where, barycentric), vertices)


def _mesh_of(search: ClosestPoints) -> TriangleMesh:
    """Take the surface of a search for a mesh."""
    return TriangleMesh(search.vertices, search.triangles)


def _first_positions(regions: VoronoiRegions) -> Floats:
    """Seeds' positions (k, 3), but for regions at open boundaries that of the nearest place there.

    Else a triangulation dual to regions would end half a region before the boundary.
    """
    cells, seeds, labels = regions.cells, regions.seeds, regions.labels
    offsets = cells.positions - cells.positions[seeds][labels]
    distances = np.where(cells.at_boundary, np.einsum("cd,cd->c", offsets, offsets), np.inf)
    ends = nearest_members(labels, distances, len(seeds))
    return cells.positions[np.where(cells.at_boundary[ends], ends, seeds)]


def _fitted_positions(search: ClosestPoints, points: FoundPoints, wanted: Floats, weights: Floats) -> Floats:
    """Positions of the vertices, (k, 3), so that points of the surface come as near to where they are wanted as can be.

    The points, (s,), have positions `wanted`, (s, 3), and weights, (s,).
    """
    k = len(search.vertices)
    interpolate = interpolation_matrix(points.barycentric, search.triangles[points.triangles], k)
    weighted = csr_array(interpolate.T @ diags_array(weights))
    tether = np.full(k, _TETHER * weights.sum() / k)
    system = weighted @ interpolate + diags_array(tether)
    return symmetric_factor(system).solve(weighted @ wanted + tether[:, None] * search.vertices)
