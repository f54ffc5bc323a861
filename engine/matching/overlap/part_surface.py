# SPDX-License-Identifier: GPL-3.0-or-later
"""A surface that may show only a part of a body, in a unit that it shares with the other one."""

from __future__ import annotations

from functools import cached_property

import numpy as np
from scipy.sparse import csr_array, diags_array
from scipy.sparse.csgraph import dijkstra
from scipy.sparse.linalg import SuperLU

from ...geometry.laplacian import laplace_beltrami
from ...geometry.sampling import farthest_point_sampling
from ...geometry.symmetric_factor import symmetric_factor
from ...mesh.closest_points import ClosestPoints
from ...mesh.connectivity.adjacency import edge_graph
from ...mesh.triangle_mesh import TriangleMesh
from ...registration.deformable import heat_curvatures
from ...registration.elastic import ElasticSurface
from ...runtime.arrays import Bools, Floats, Ints, marked
from ...runtime.progress import Steps
from ...shapes.proxy import proxy_steps

_PINHOLE = 0.08
"""Length of a loop of the border, in sqrt(area) of the surface, up to which nothing was cut off there: it is a hole."""

_CURVATURE_TIMES = 6e-4, 2e-3
"""How long the mean curvature is smoothed by heat, in units of area."""

_UNREACHED = 9.0
"""Distance to the border, in units of length, where there is none: farther than any surface of unit area is wide."""


class PartSurface:
    """A surface and what is needed to find what it shares with another one.

    All lengths are in one unit for both surfaces: parts have no sizes of their own to be compared in.

    Parameters
    ----------
    mesh : TriangleMesh
        The surface, connected, in that unit, n vertices.
    ids : (n,) array of int, optional
        For each vertex the one that it stands for on the surface that this is a proxy of; by default itself.

    Attributes
    ----------
    vertices, normals : (n, 3) array of float
        Positions and unit normals.
    mass : (n,) array of float
        Area of each vertex.
    """

    is_sent_once = True
    """See `parallel_map.shared_steps`."""

    def __init__(self, mesh: TriangleMesh, ids: Ints | None = None) -> None:
        self.mesh = mesh
        self.ids = np.arange(mesh.vertex_count) if ids is None else ids
        self.vertices, self.normals = mesh.vertices, mesh.vertex_normals
        self._laplace = laplace_beltrami(mesh)
        self.mass = self._laplace.mass
        self.area = float(self.mass.sum())
        self._factors: dict[float, SuperLU] = {}

    def __getstate__(self) -> dict[str, object]:
        """Leave out the factors, which cannot be sent."""
        return {**self.__dict__, "_factors": {}}

    def proxy_steps(self, vertices: int) -> Steps[PartSurface]:
        """Make a coarse surface of about so many vertices that stands for this one."""
        proxy = yield from proxy_steps(self.mesh, vertices)
        return PartSurface(proxy.mesh, proxy.vertices)

    @property
    def count(self) -> int:
        """Number of vertices."""
        return len(self.vertices)

    @property
    def spacing(self) -> float:
        """Distance between neighbouring vertices, about."""
        return float(np.sqrt(self.area / self.count))

    @cached_property
    def search(self) -> ClosestPoints:
        """Search for points of the surface; its triangles serve all searches on it."""
        return ClosestPoints(self.mesh)

    @cached_property
    def elastic(self) -> ElasticSurface:
        """Its resistance to deformation."""
        return ElasticSurface(self.vertices, self._laplace)

    @cached_property
    def curvatures(self) -> Floats:
        """Mean curvature at two scales, without unit, (n, 2); see `heat_curvatures`."""
        return heat_curvatures(self._laplace.stiffness, self.mass, self.vertices, self.normals, _CURVATURE_TIMES)

    @cached_property
    def graph(self) -> csr_array:
        """Lengths of the edges, in both directions, (n, n)."""
        return edge_graph(self.mesh)

    @cached_property
    def border(self) -> Bools:
        """Vertices (n,) at which something may have been cut off: those of loops of the border that are no pinholes."""
        cut = self.mesh.boundary_edges[self.mesh.border_lengths > _PINHOLE * np.sqrt(self.area)]
        return marked(cut, self.count)

    @cached_property
    def border_distances(self) -> Floats:
        """Distance of each vertex to where the surface was cut, (n,); `_UNREACHED` where it was not."""
        if not self.border.any():
            return np.full(self.count, _UNREACHED)
        return np.minimum(dijkstra(self.graph, indices=np.flatnonzero(self.border), min_only=True), _UNREACHED)

    def paths(self, vertices: Ints) -> Floats:
        """Lengths of the shortest paths from vertices (k,) to all, (k, n); infinite where there is none."""
        return dijkstra(self.graph, indices=vertices)

    def samples(self, count: int) -> Ints:
        """Take vertices far from each other, at most so many, that do not depend on the order of the vertices."""
        if self.border.any():
            start = int(self.border_distances.argmax())
        else:
            centre = self.mass @ self.vertices / self.area
            start = int(np.square(self.vertices - centre).sum(axis=1).argmax())
        return farthest_point_sampling(self.graph, min(count, self.count), start)

    def smoothed(self, values: Floats, time: float) -> Floats:
        """Let values (n, ...) at the vertices spread like heat for a time, in units of area."""
        if time not in self._factors:
            self._factors[time] = symmetric_factor(diags_array(self.mass) + time * self._laplace.stiffness)
        flat = values.reshape(self.count, -1)
        return self._factors[time].solve(self.mass[:, None] * flat).reshape(values.shape)

    def largest_piece(self, chosen: Bools) -> Bools:
        """Keep of the chosen vertices (n,) those of the connected piece with the largest area."""
        pieces = self.mesh.parts_of(chosen)
        areas = np.bincount(pieces, self.mass * chosen)
        return chosen & (pieces == areas.argmax())
