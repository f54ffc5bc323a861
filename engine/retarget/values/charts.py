# SPDX-License-Identifier: GPL-3.0-or-later
"""A surface cut into sheets where values at its corners jump: the islands of a UV layer, the sides of a hard edge."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from ...mesh.closest_points import ClosestPoints
from ...mesh.connectivity.components import joined_components, triangle_components
from ...mesh.connectivity.halfedges import following, triangle_slots, twins_of
from ...mesh.polygons import Polygons
from ...mesh.triangle_mesh import TriangleMesh
from ...runtime.arrays import TINY, Bools, Floats, Ints
from ...runtime.errors import MeshError


@dataclass(frozen=True, eq=False)
class CornerSheets:
    """A triangle mesh cut along all edges across which corner values jump.

    Half-edge 3 t + i leads from corner i of triangle t to corner i + 1.

    Attributes
    ----------
    values : (t, 3, d) array of float
        The values at the corners of each triangle.
    labels : (t,) array of int
        The sheet of each triangle: triangles hang together where values are continuous.
    surface : TriangleMesh
        The cut surface: triangles of the same numbers and places, but vertices doubled along the cuts.
    borders : (3 t,) array of bool
        Which half-edges are at a cut, or at a boundary of the uncut surface.
    """

    values: Floats
    labels: Ints
    surface: TriangleMesh
    borders: Bools

    @cached_property
    def search(self) -> ClosestPoints:
        """Search for closest points that never walks across a cut."""
        return ClosestPoints(self.surface)

    @property
    def count(self) -> int:
        """Number of sheets."""
        return int(self.labels.max()) + 1

    @cached_property
    def border_edges(self) -> Ints:
        """Vertices of the cut surface where the half-edges at borders begin and end, (b, 2)."""
        triangles, borders = self.surface.triangles, np.flatnonzero(self.borders)
        return np.stack([triangle_slots(triangles, borders, end) for end in (0, 1)], axis=1)

    def is_at_border(self, triangles: Ints, barycentric: Floats) -> Bools:
        """Say which places, triangles (k,) and coordinates (k, 3), are on a border."""
        absent = barycentric <= 0
        # Half-edge i is opposite to corner i + 2.
        on_side = (absent[:, [2, 0, 1]] & self.borders.reshape(-1, 3)[triangles]).any(axis=1)
        corner = self.surface.triangles[triangles, barycentric.argmax(axis=1)]
        return on_side | ((absent.sum(axis=1) >= 2) & np.isin(corner, self.border_edges))

    def at(self, triangles: Ints, barycentric: Floats) -> Floats:
        """Interpolate the values at places, (k, d)."""
        return np.einsum("kc,kcd->kd", barycentric, self.values[triangles])

    @cached_property
    def gradients(self) -> Floats:
        """How values change with the place around each vertex of the cut surface, (w, d, 3): the mean by area."""
        a, b, c = (self.surface.vertices[corner] for corner in self.surface.triangles.T)
        normals = self.surface.triangle_normals
        # The gradient of a linear function, times the area: the opposite sides turned by a right angle.
        turned = np.stack([np.cross(normals, side) for side in (c - b, a - c, b - a)], axis=1) / 2
        products = np.einsum("tcd,tcx->tdx", self.values, turned)
        areas = np.maximum(self.surface.sum_at_vertices(self.surface.triangle_areas), TINY)
        columns = [self.surface.sum_at_vertices(column) for column in products.reshape(len(products), -1).T]
        return (np.stack(columns, axis=1) / areas[:, None]).reshape(-1, *products.shape[1:])

    @cached_property
    def density(self) -> float:
        """How far values of two numbers change, on the whole, over a unit of length: the root of the ratio of areas."""
        first, second = (self.values[:, side] - self.values[:, 0] for side in (1, 2))
        areas = np.abs(first[:, 0] * second[:, 1] - first[:, 1] * second[:, 0]) / 2
        return float(np.sqrt(areas.sum() / self.surface.area))

    def beyond(self, triangles: Ints, barycentric: Floats, offsets: Floats) -> Floats:
        """Continue the values linearly from places by offsets in space, (k, 3): what to add to `at`, (k, d)."""
        slopes = np.einsum("kc,kcdx->kdx", barycentric, self.gradients[self.surface.triangles[triangles]])
        return np.einsum("kdx,kx->kd", slopes, offsets)


def cut_into_sheets(mesh: TriangleMesh, polygons: Polygons, values: Floats, tolerance: float) -> CornerSheets:
    """Cut a surface along all edges across which corner values jump.

    Parameters
    ----------
    mesh : TriangleMesh
        The surface.
    polygons : Polygons
        Its faces, cut as the mesh is.
    values : (l, d) array of float
        Values at the corners of the faces.
    tolerance : float
        Values that differ by no more than this in each of their numbers are the same.

    Raises
    ------
    MeshError
        If there is not one value for each corner, or one is not a finite number.
    """
    if values.ndim != 2 or len(values) != polygons.corner_count:
        raise MeshError(f"There should be one value for each of {polygons.corner_count} corners, not {values.shape}.")
    if not np.isfinite(values).all():
        raise MeshError("Some values at the corners of faces are not finite numbers. Repair them, or leave them out.")
    at_triangles = values[polygons.triangle_corners]  # (t, 3, d)
    twins = twins_of(mesh.vertices, mesh.triangles)
    slots = at_triangles.reshape(-1, values.shape[1])
    one = np.flatnonzero(twins >= 0)
    other = twins[one]
    starts = mesh.triangles.ravel()
    # The twin runs the other way, unless its triangle is turned the wrong way round.
    opposite = starts[one] == starts[following(other)]
    mates = (np.where(opposite, following(other), other), np.where(opposite, other, following(other)))
    ends = (one, following(one))
    close = [(np.abs(slots[end] - slots[mate]) <= tolerance).all(axis=1) for end, mate in zip(ends, mates, strict=True)]
    joined = close[0] & close[1]
    open_twins = np.full(len(twins), -1)
    open_twins[one[joined]] = other[joined]
    tail, head = (np.concatenate([pair[0][joined], pair[1][joined]]) for pair in (ends, mates))
    wedge = joined_components(len(twins), tail, head)
    positions = np.empty((int(wedge.max()) + 1, 3))
    positions[wedge] = mesh.vertices[starts]
    surface = TriangleMesh(positions, wedge.reshape(-1, 3))
    return CornerSheets(at_triangles, triangle_components(open_twins), surface, open_twins < 0)
