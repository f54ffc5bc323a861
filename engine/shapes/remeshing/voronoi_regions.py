# SPDX-License-Identifier: GPL-3.0-or-later
"""Voronoi regions of a surface whose dual triangulation is a manifold like it."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.sparse.csgraph import dijkstra
from scipy.spatial import cKDTree

from ...mesh.connectivity.components import joined_components
from ...mesh.triangle_mesh import TriangleMesh
from ...runtime.arrays import TINY, Floats, Ints, group_sums, marked, numbered
from ...runtime.progress import Progress, Steps
from .dual_triangulation import DualTriangulation, dual_triangulation
from .sizing_field import vertex_density
from .surface_cells import SurfaceCells, nearest_members

_LABEL = "Simplifying the mesh"
_SPACING = 0.75  # least distance of seeds, in units of sqrt(area / vertices)
_CANDIDATES = 8.0  # cells that may become seeds, for each one that will
_LLOYD_STEPS = 2
_REPAIRS = 24  # rounds; each may double the seeds where something is wrong
_DISSOLVING = 6  # in every so many rounds regions that are still wrong fall apart into single vertices


@dataclass(frozen=True, eq=False)
class VoronoiRegions:
    """Cells gathered around seeds, and the triangulation of their neighbourhoods.

    Attributes
    ----------
    cells : SurfaceCells
        The surface, c cells.
    seeds : (k,) array of int
        The cell in the middle of each region.
    labels : (c,) array of int
        The region of each cell: that of the nearest seed.
    distances : (c,) array of float
        How far it is.
    dual : DualTriangulation
        The triangulation dual to the regions.
    """

    cells: SurfaceCells
    seeds: Ints
    labels: Ints
    distances: Floats
    dual: DualTriangulation

    @classmethod
    def around(cls, cells: SurfaceCells, seeds: Ints) -> VoronoiRegions:
        """Divide a surface into the regions of seeds (k,); every component has a seed."""
        distances, labels = _nearest_seeds(cells, seeds)
        return cls(cells, seeds, labels, distances, dual_triangulation(cells, labels, len(seeds)))

    def with_seeds(self, added: Ints) -> VoronoiRegions:
        """Return the regions that there are with further seeds (q,)."""
        # A seed takes no cell from another that is farther from it than any now is from its own.
        distances, labels = _nearest_seeds(self.cells, added, limit=float(self.distances.max()))
        closer = distances < self.distances
        distances = np.where(closer, distances, self.distances)
        labels = np.where(closer, len(self.seeds) + labels, self.labels)
        seeds = np.concatenate([self.seeds, added])
        return VoronoiRegions(self.cells, seeds, labels, distances, dual_triangulation(self.cells, labels, len(seeds)))

    def repaired(self, mesh: TriangleMesh) -> VoronoiRegions:
        """Add seeds until the dual triangulation is a manifold like the surface, or the rounds run out.

        Parameters
        ----------
        mesh : TriangleMesh
            What the cells are made of.
        """
        regions = self
        for repair in range(1, _REPAIRS + 1):
            faulty = regions.dual.faulty
            if not faulty.any():
                break
            cells, seeds, labels = regions.cells, regions.seeds, regions.labels
            farthest = nearest_members(labels, -regions.distances, len(seeds))[faulty]
            added = farthest[regions.distances[farthest] > 0]
            if not len(added) or repair % _DISSOLVING == 0:
                in_faulty = faulty[labels] & (np.bincount(cells.labels, minlength=cells.count) > 1)
                if in_faulty.any():
                    chosen = cells.nearest_vertices(mesh.vertices)[np.concatenate([seeds, added])]
                    cells = cells.dissolved(mesh, in_faulty)
                    regions = VoronoiRegions.around(cells, cells.labels[chosen])
                    continue
            if not len(added):
                break
            regions = regions.with_seeds(added)
        return regions


def spread_regions_steps(cells: SurfaceCells, count: int) -> Steps[VoronoiRegions]:
    """Divide a surface into about `count` regions, smaller ones where it bends; see `vertex_density`.

    Parameters
    ----------
    cells : SurfaceCells
        The surface.
    count : int
        Number of regions; a surface of many parts may have more.

    Yields
    ------
    Progress
        In between.

    Returns
    -------
    VoronoiRegions
        The regions.
    """
    density = vertex_density(cells)
    yield Progress(0.2, _LABEL)
    seeds = _poisson_disk(cells, count, density)
    # A part too small for a seed of its own still needs one.
    components = joined_components(cells.count, *cells.pairs.T)
    parts, first = np.unique(components, return_index=True)
    seeds = np.concatenate([seeds, first[~np.isin(parts, components[seeds])]])
    # Centres of such weights keep the density as it is: regions shrink by the fourth root of what their cells weigh.
    weights = cells.areas * np.square(density)
    for number in range(_LLOYD_STEPS):
        yield Progress(0.5 + 0.5 * number / (_LLOYD_STEPS + 1), _LABEL)
        _, labels = _nearest_seeds(cells, seeds)
        sums = np.bincount(labels, weights, len(seeds))
        moments = group_sums(labels, weights[:, None] * cells.positions, len(seeds))
        centres = moments / np.maximum(sums, TINY)[:, None]
        offsets = cells.positions - centres[labels]
        seeds = nearest_members(labels, np.einsum("cd,cd->c", offsets, offsets), len(seeds))
    yield Progress(1 - 0.5 / (_LLOYD_STEPS + 1), _LABEL)
    return VoronoiRegions.around(cells, seeds)


def _poisson_disk(cells: SurfaceCells, count: int, density: Floats) -> Ints:
    """Choose cells in random order, each unless a chosen one is too near for the density there.

    Of many small cells only some are asked, so that there are as many to choose from for each seed everywhere.
    """
    random = np.random.default_rng(0)
    asked = random.random(cells.count) * cells.unit**2 < _CANDIDATES * count * cells.areas * density
    candidates = np.flatnonzero(asked)
    positions, normals = cells.positions[candidates], cells.normals[candidates]
    radii = _SPACING * cells.unit / np.sqrt(count * density[candidates])
    pairs = cKDTree(positions).query_pairs(float(radii.max(initial=0.0)), output_type="ndarray")
    offsets = positions[pairs[:, 0]] - positions[pairs[:, 1]]
    near = np.einsum("pd,pd->p", offsets, offsets) < np.square(radii[pairs].mean(axis=1))
    # Cells that face away from one another are on different sides of something thin.
    agreement = np.einsum("pd,pd->p", normals[pairs[:, 0]], normals[pairs[:, 1]])
    pairs = pairs[near & (agreement >= 0)]
    priority = random.permutation(len(candidates))
    ahead = np.where((priority[pairs[:, 0]] < priority[pairs[:, 1]])[:, None], pairs, pairs[:, ::-1])
    # As if one after the other: whoever has nobody undecided ahead is chosen, and rules out all behind.
    chosen, undecided = np.zeros(len(candidates), bool), np.ones(len(candidates), bool)
    while undecided.any():
        new = undecided & ~marked(ahead[:, 1], len(candidates))
        chosen |= new
        undecided &= ~new
        undecided[ahead[new[ahead[:, 0]], 1]] = False
        ahead = ahead[undecided[ahead].all(axis=1)]
    return candidates[chosen]


def _nearest_seeds(cells: SurfaceCells, seeds: Ints, limit: float = np.inf) -> tuple[Floats, Ints]:
    """Distance from the nearest seed, and which it is, (c,) each; infinite and any beyond a limit."""
    distances, _, sources = dijkstra(
        cells.graph, directed=True, indices=seeds, min_only=True, return_predecessors=True, limit=limit
    )
    return distances, np.maximum(numbered(seeds, cells.count)[np.maximum(sources, 0)], 0)
