# SPDX-License-Identifier: GPL-3.0-or-later
"""Samples of a surface: farthest points, and their distances to all vertices."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from numpy.typing import NDArray
from scipy.sparse.csgraph import dijkstra

from ..geometry.geodesics import GeodesicSolver
from ..geometry.mean_curvature import smoothed_mean_curvature
from ..geometry.orientation import tangent_directions
from ..geometry.sampling import FarthestPointSampler
from ..mesh.triangle_mesh import TriangleMesh
from ..runtime.arrays import Floats, Ints
from ..runtime.progress import Progress, Steps

_CURVATURE_RADII = (0.02, 0.03)  # in units of sqrt(area): on a person, some fingers wide

_TAKEN_TOGETHER, _FOLLOWED_TOGETHER = 100, 40
"""Samples that are taken, and from which paths are followed, in one step."""

_COMPARED = 8
"""Samples by whose distances it is found how much longer paths are."""


@dataclass(frozen=True, eq=False)
class SurfaceSamples:
    """Some vertices of a surface, and all that is known of them.

    Attributes
    ----------
    mesh : TriangleMesh
        The surface.
    vertices : (S,) array of int
        The samples, farthest points first.
    rows : (S, n) array of float32
        Distance from each sample to each vertex, in sqrt(area).
    measured : int
        From how many of them, the first, distances are measured by fast marching; from the others they are estimated.
    """

    mesh: TriangleMesh
    vertices: Ints
    rows: NDArray[np.float32]
    measured: int

    def __len__(self) -> int:
        return len(self.rows)

    def first(self, count: int) -> SurfaceSamples:
        """Return the first of the samples alone."""
        return SurfaceSamples(self.mesh, self.vertices[:count], self.rows[:count], min(self.measured, count))

    def on(self, mesh: TriangleMesh) -> SurfaceSamples:
        """Return the samples of a mesh with the same vertices and the same distances, such as the reflected one."""
        return replace(self, mesh=mesh)

    @cached_property
    def cell_areas(self) -> Floats:
        """Area of each sample's Voronoi cell as a part of the whole, (S,)."""
        return np.bincount(self.rows.argmin(axis=0), self.mesh.vertex_areas, len(self)) / self.mesh.area

    @cached_property
    def distances(self) -> Floats:
        """Distances between the samples, (S, S), symmetric with a zero diagonal."""
        square = self.rows[:, self.vertices].astype(np.float64)
        measured = self.measured
        square[measured:, :measured] = square[:measured, measured:].T
        square = (square + square.T) / 2
        np.fill_diagonal(square, 0)
        return square

    @cached_property
    def directions(self) -> Floats:
        """Unit direction at each sample in which the distance from each sample grows, (S at, S from, 2)."""
        return tangent_directions(self.mesh, self.vertices, self.rows)

    @cached_property
    def curvatures(self) -> Floats:
        """Mean curvature at each sample, smoothed at two scales, (2, S)."""
        scale = float(np.sqrt(self.mesh.area))
        distances = self.rows * scale
        return np.stack([smoothed_mean_curvature(self.mesh, distances, r * scale) for r in _CURVATURE_RADII])


class SurfaceSampler:
    """Takes farthest points of a surface one after the other, and measures the distances from them.

    Parameters
    ----------
    mesh : TriangleMesh
        The surface.
    solver : GeodesicSolver
        Measures distances on it.
    start : (k,) array of int, optional
        The first samples; by default one end of the surface, which does not depend on the order of the vertices.

    Attributes
    ----------
    taken : SurfaceSamples
        The samples so far from which distances were measured.
    """

    def __init__(self, mesh: TriangleMesh, solver: GeodesicSolver, start: Ints | None = None) -> None:
        self._mesh, self._solver, self._start = mesh, solver, start
        self._paths: dict[int, NDArray[np.float32]] = {}
        self.taken = SurfaceSamples(mesh, np.empty(0, np.int64), np.empty((0, mesh.vertex_count), np.float32), 0)

    @cached_property
    def _farthest(self) -> FarthestPointSampler:
        graph, start = self._solver.graph, self._start
        if start is not None:
            return FarthestPointSampler(graph, start)
        centre = np.average(self._mesh.vertices, axis=0, weights=self._mesh.vertex_areas)
        outermost = int(np.square(self._mesh.vertices - centre).sum(axis=1).argmax())
        return FarthestPointSampler(graph, int(dijkstra(graph, indices=outermost).argmax()))

    def on(self, mesh: TriangleMesh, solver: GeodesicSolver) -> SurfaceSampler:
        """Return a sampler of a mesh with the same vertices and distances, with what was computed so far."""
        other = SurfaceSampler(mesh, solver, self._start)
        other._farthest, other._paths, other.taken = self._farthest, self._paths, self.taken.on(mesh)
        return other

    def lacks(self, count: int, measured: int | None = None) -> bool:
        """Say whether `steps` would have anything to do."""
        count, measured = self._bounded(count, measured)
        return len(self.taken) < measured or any(number not in self._paths for number in range(measured, count))

    def steps(self, count: int, measured: int | None = None) -> Steps[None]:
        """Take samples until there are `count`; see `Shape.sample_steps`."""
        count, measured = self._bounded(count, measured)
        for taken in range(len(self._farthest.samples), count, _TAKEN_TOGETHER):
            self._farthest.extend(min(taken + _TAKEN_TOGETHER, count))
            yield Progress(0.0, "Measuring distances")
        known, scale = len(self.taken), float(np.sqrt(self._mesh.area))
        new = np.array(self._farthest.samples[known:measured], np.int64)
        followed = [*range(min(_COMPARED, measured)), *range(measured, count)] if measured < count else []
        followed = [number for number in followed if number not in self._paths]
        total = max(len(new) + len(followed), 1)
        if len(new):
            # float32 keeps a hundred thousand vertices in reach of an ordinary machine; its error, 1e-7 of the
            # distance, is far below that of fast marching.
            rows = np.empty((measured, self._mesh.vertex_count), np.float32)
            rows[:known] = self.taken.rows
            for first, block in self._solver.distances_in_blocks(new):
                rows[known + first : known + first + len(block)] = block / scale
                yield Progress((first + len(block)) / total, "Measuring distances")
            if measured > len(self.taken):  # more may have been taken between two steps
                self.taken = SurfaceSamples(self._mesh, np.array(self._farthest.samples[:measured]), rows, measured)
        for start in range(0, len(followed), _FOLLOWED_TOGETHER):
            part = followed[start : start + _FOLLOWED_TOGETHER]
            lengths = self._solver.path_lengths([self._farthest.samples[number] for number in part]) / scale
            self._paths.update(zip(part, lengths.astype(np.float32), strict=True))
            yield Progress((len(new) + start + len(part)) / total, "Measuring distances")

    def estimated(self, count: int, measured: int) -> SurfaceSamples:
        """Return the first `count` samples, with the distances from all but the first `measured` of them estimated.

        Estimates are the lengths of paths, divided by how much longer paths from the first samples are than distances,
        in the mean.
        """
        compared = min(_COMPARED, measured)
        lengths = sum(float(self._paths[number].sum()) for number in range(compared))
        rows = np.empty((count, self._mesh.vertex_count), np.float32)
        rows[:measured] = self.taken.rows[:measured]
        np.stack([self._paths[number] for number in range(measured, count)], out=rows[measured:])
        rows[measured:] *= float(rows[:compared].sum()) / lengths
        return SurfaceSamples(self._mesh, np.array(self._farthest.samples[:count]), rows, measured)

    def _bounded(self, count: int, measured: int | None) -> tuple[int, int]:
        """Bound numbers of samples by that of the vertices."""
        count = min(count, self._mesh.vertex_count)
        return count, count if measured is None else min(measured, count)
