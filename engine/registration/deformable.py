# SPDX-License-Identifier: GPL-3.0-or-later
"""A surface prepared for registration: brought to unit area, with what its points are recognised by."""

from __future__ import annotations

from functools import cached_property
from typing import Any

import numpy as np
from scipy.sparse import csr_array, diags_array
from scipy.sparse.linalg import SuperLU

from ..geometry.laplacian import LaplaceBeltrami
from ..geometry.symmetric_factor import symmetric_factor
from ..mesh.closest_points import ClosestPoints
from ..mesh.triangle_mesh import TriangleMesh
from ..runtime.arrays import TINY, Bools, Floats, marked
from ..runtime.progress import Progress, Steps
from .elastic import ElasticSurface
from .normal_equations import NormalEquations

_HEAT_STEPS = 3
"""Implicit steps in which heat spreads."""

_CURVATURE_TIMES = 1e-3, 3e-3
"""How long the mean curvature is smoothed by heat, in units of area: over some hundredths of the surface's size."""

_PREPARED = "search", "curvatures", "elastic", "equations"


class DeformableSurface:
    """A surface of unit area around the origin.

    Parameters
    ----------
    mesh : TriangleMesh
        The surface; every vertex has a triangle.
    laplace : LaplaceBeltrami
        Its operator.
    cut : (n,) array of bool, optional
        At which vertices it ends only because it was cut out of a surface that goes on there.

    Attributes
    ----------
    mesh : TriangleMesh
        The surface, in its own units.
    vertices : (n, 3) array of float
        Positions, in units of the square root of the area, the centre of the surface at the origin.
    triangles : (m, 3) array of int
        Its triangles.
    normals : (n, 3) array of float
        Unit normals at the vertices.
    mass : (n,) array of float
        Area of each vertex; they sum to one.
    """

    is_sent_once = True
    """See `parallel_map.shared_steps`."""

    def __init__(self, mesh: TriangleMesh, laplace: LaplaceBeltrami, cut: Bools | None = None) -> None:
        self.mesh = mesh
        self._laplace, self._cut = laplace, cut
        self._centre = np.average(mesh.vertices, axis=0, weights=mesh.vertex_areas)
        self._scale = float(np.sqrt(mesh.area))
        self.vertices = (mesh.vertices - self._centre) / self._scale
        self.triangles = mesh.triangles
        self.normals = mesh.vertex_normals
        self.mass = laplace.mass / laplace.area
        self._spreaders: dict[float, SuperLU] = {}

    def __getstate__(self) -> dict[str, Any]:
        """Leave out the factors, which cannot be sent to another process."""
        return {**self.__dict__, "_spreaders": {}}

    @cached_property
    def search(self) -> ClosestPoints:
        """Search for points of the surface, at rest; its triangles serve all searches on it."""
        return ClosestPoints(self.mesh)

    @cached_property
    def border(self) -> Floats:
        """One for the vertices at which the surface ends, zero for all others, (n,)."""
        return marked(self.mesh.boundary_edges, len(self.vertices)).astype(np.float64)

    @cached_property
    def rim(self) -> Floats:
        """The same without where it was cut, (n,)."""
        return self.border if self._cut is None else self.border * ~self._cut

    @cached_property
    def elastic(self) -> ElasticSurface:
        """Its resistance to deformation."""
        return ElasticSurface(self.vertices, self._laplace)

    @cached_property
    def equations(self) -> NormalEquations:
        """What its elastic energy and points that it is drawn to demand together."""
        return NormalEquations(self.elastic.stiffness, self.triangles)

    def prepare_steps(self) -> Steps[None]:
        """Compute what registrations need of the surface, in short steps."""
        for number, name in enumerate(_PREPARED):
            getattr(self, name)
            yield Progress((number + 1) / len(_PREPARED), "Fitting the surfaces")

    def in_its_units(self, positions: Floats) -> Floats:
        """Turn positions (k, 3) around the unit surface into the coordinates of its mesh."""
        return positions * self._scale + self._centre

    def in_unit_size(self, positions: Floats) -> Floats:
        """Turn coordinates of its mesh (k, 3) into positions around the unit surface."""
        return (positions - self._centre) / self._scale

    def smoothed(self, values: Floats, functions: Floats) -> Floats:
        """Make values (n, k) of functions (n, f) alone, which are orthonormal under its mass: without finer noise."""
        return functions @ (functions.T @ (self.mass[:, None] * values))

    def averaged(self, values: Floats, radius: float) -> Floats:
        """Average values (n, k) over a neighbourhood that heat spreads over, of such a radius in sqrt(area).

        Parameters
        ----------
        values : (n, k) array of float
            One row for each vertex.
        radius : float
            Root mean square way of the heat; with 0 the values stay as they are.

        Returns
        -------
        (n, k) array of float
            The means.
        """
        if radius <= 0:
            return values
        if radius not in self._spreaders:
            mass = diags_array(np.maximum(self.mass, TINY))
            self._spreaders[radius] = symmetric_factor(mass + radius**2 / 4 * self._laplace.stiffness)
        return self._spreaders[radius].solve(self.mass[:, None] * values)

    @cached_property
    def curvatures(self) -> Floats:
        """Mean curvature at two scales, positive where the surface bulges outwards, (n, 2); see `heat_curvatures`."""
        return heat_curvatures(self._laplace.stiffness, self.mass, self.vertices, self.normals, _CURVATURE_TIMES)


def heat_curvatures(
    stiffness: csr_array, mass: Floats, vertices: Floats, normals: Floats, times: tuple[float, ...]
) -> Floats:
    r"""Mean curvature at several scales, smoothed by heat.

    Parameters
    ----------
    stiffness : (n, n) csr_array of float
        Stiffness matrix of the surface.
    mass : (n,) array of float
        Area of each vertex.
    vertices, normals : (n, 3) array of float
        Positions and unit normals, in the unit of length that belongs to these areas.
    times : tuple of k floats
        How long heat spreads, in that unit squared.

    Returns
    -------
    (n, k) array of float
        :math:`\sqrt{t} \, e^{-t \Delta} H`, positive where the surface bulges outwards; without unit.
    """
    # The stiffness applied to the positions is the mean curvature normal, integrated over each vertex's area.
    integrated = np.einsum("nd,nd->n", stiffness @ vertices, normals) / 2
    smoothed = []
    for time in times:
        factor = symmetric_factor(diags_array(mass) + time / _HEAT_STEPS * stiffness)
        heat = factor.solve(integrated)
        for _ in range(_HEAT_STEPS - 1):
            heat = factor.solve(mass * heat)
        smoothed.append(np.sqrt(time) * heat)
    return np.stack(smoothed, axis=1)
