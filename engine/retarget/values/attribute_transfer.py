# SPDX-License-Identifier: GPL-3.0-or-later
"""Values of any kind at points, edges, faces or corners, carried from one mesh to another."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any, ClassVar, Literal

import numpy as np
from numpy.typing import NDArray

from ...mesh.polygons import Polygons
from ...mesh.surface_map import SurfaceMap
from ...mesh.triangle_mesh import TriangleMesh
from ...runtime.background import can_go_beside
from ...runtime.errors import MatchError
from ...runtime.progress import Steps
from .corner_transfer import carry_corner_values, carry_point_marks, carry_point_values
from .edge_tracing import CarriedValues, nearest_edge_values, trace_edges_steps
from .face_correspondence import FacePlaces
from .face_transfer import carry_face_values

Domain = Literal["POINT", "EDGE", "FACE", "CORNER"]
"""What has the values."""

_MARKED = 0.5
"""If at most this part of all edges has a value, it marks lines; else every edge has one of its own."""


@dataclass(frozen=True, eq=False)
class Crossing:
    """Two meshes with their faces, and the maps between their vertices.

    Attributes
    ----------
    source, target : TriangleMesh
        The meshes.
    source_faces, target_faces : Polygons
        Their faces, those of the source cut as `source` is.
    source_to_target, target_to_source : SurfaceMap
        The maps.
    """

    source: TriangleMesh
    target: TriangleMesh
    source_faces: Polygons
    target_faces: Polygons
    source_to_target: SurfaceMap
    target_to_source: SurfaceMap
    is_sent_once: ClassVar[bool] = True
    """See `parallel_map.shared_steps`."""

    def __repr__(self) -> str:
        return f"<{type(self).__name__}>"

    @cached_property
    def places(self) -> FacePlaces:
        """Where the faces of the target lie on the source."""
        return FacePlaces(self.source, self.target_faces, self.target_to_source)


@can_go_beside
def carry_values_steps(
    values: NDArray[Any], domain: Domain, crossing: Crossing, *, blended: bool = True, marks: bool = False
) -> Steps[CarriedValues]:
    """Carry values from the source to the target.

    Parameters
    ----------
    values : (k, ...) array
        One for each point, edge, face or corner of the source: numbers, or texts as bytes.
    domain : {"POINT", "EDGE", "FACE", "CORNER"}
        Which of these.
    crossing : Crossing
        The meshes and maps.
    blended : bool
        Whether real numbers may be interpolated; not those that are the parts of a rotation or a matrix.
    marks : bool
        Whether numbers at points mark single ones, and are not values of a smooth field.

    Yields
    ------
    Progress
        While edges are traced.

    Returns
    -------
    CarriedValues
        The values on the target.  On edges, those that mark some of all edges by a positive number or by being true
        are traced along the target's edges; others come from the nearest edge.

    Raises
    ------
    MatchError
        If there is not one value for each.
    """
    array = np.asarray(values)
    faces = crossing.source_faces
    wanted = {
        "POINT": crossing.source.vertex_count,
        "EDGE": len(faces.edges),
        "FACE": faces.face_count,
        "CORNER": faces.corner_count,
    }[domain]
    if len(array) != wanted:
        raise MatchError(f"There should be one value for each of {wanted}, but there are {len(array)}.")
    if array.dtype.kind == "S":
        # Numbers stand for the texts; that of the empty one, which edges without a source have, is zero.
        texts, numbers = np.unique(np.append(array, b""), return_inverse=True)
        carried = yield from carry_values_steps(numbers[:-1].reshape(array.shape), domain, crossing)
        return CarriedValues(texts[carried.values], carried.lost)
    if np.issubdtype(array.dtype, np.floating) and not blended:
        # The same bits as whole numbers, which are never mixed.
        real = np.ascontiguousarray(array, np.float64 if array.itemsize > np.float64().itemsize else array.dtype)
        carried = yield from carry_values_steps(real.view(f"i{real.itemsize}"), domain, crossing)
        return CarriedValues(carried.values.view(real.dtype).astype(array.dtype, copy=False), carried.lost)
    if np.issubdtype(array.dtype, np.floating) and not np.isfinite(array).all():
        array = np.nan_to_num(array, nan=0.0, posinf=0.0, neginf=0.0)
    if domain == "EDGE":
        return (yield from _edge_steps(array, crossing))
    if domain == "FACE":
        carried_values = carry_face_values(array, faces, crossing.places)
    elif domain == "CORNER":
        carried_values = carry_corner_values(array, faces, crossing.places)
    elif marks:
        carried_values = carry_point_marks(array, crossing.source_to_target)
    else:
        carried_values = carry_point_values(array, crossing.target_to_source)
    return CarriedValues(carried_values.astype(array.dtype, copy=False))


def _edge_steps(values: NDArray[Any], crossing: Crossing) -> Steps[CarriedValues]:
    """Carry values of edges: trace marks, or take each from the nearest edge."""
    faces, edges = crossing.source_faces, crossing.target_faces.edges
    if not len(values) or not len(edges):
        return CarriedValues(np.zeros((len(edges), *values.shape[1:]), values.dtype))
    countable = values.ndim == 1 and (values.dtype == bool or np.issubdtype(values.dtype, np.floating))
    if not countable or (values < 0).any() or np.count_nonzero(values) > _MARKED * len(values):
        carried = nearest_edge_values(values, crossing.source, faces.edges, edges, crossing.target_to_source)
        return CarriedValues(carried)
    marked = values > 0
    traced = yield from trace_edges_steps(
        faces.edges[marked],
        values[marked],
        crossing.source,
        edges,
        source_to_target=crossing.source_to_target,
        target_to_source=crossing.target_to_source,
    )
    return CarriedValues(traced.values.astype(values.dtype), traced.lost)
