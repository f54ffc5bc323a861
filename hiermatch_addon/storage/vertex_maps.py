# SPDX-License-Identifier: GPL-3.0-or-later
"""Dense maps as they are kept on the meshes: for every vertex the place on the other mesh, in attributes.

A place is named by three vertices and their weights, not by the number of a triangle: how Blender cuts faces into
triangles is its own affair and may change.  The numbers are of single precision, and so are all that the add-on
computes from a map; so what comes from a stored map is the same as what came from the map when it was new.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from ...engine import ClosestPoints, MeshError, SurfaceMap, SurfacePoints
from ..common.access import mesh_of
from ..scene.attribute_io import read_values
from ..scene.character import parts_of
from .stored_match import CornerPoints

if TYPE_CHECKING:
    from collections.abc import Sequence

    import bpy
    from numpy.typing import NDArray

    from ...engine import TriangleMesh
    from ..scene.character import Side
    from .contents import Content


@dataclass(frozen=True, eq=False)
class MapPair:
    """Dense maps between two meshes, both ways.

    Attributes
    ----------
    source, target : TriangleMesh
        The meshes, in world space.
    source_to_target : SurfaceMap
        Where every vertex of the source lies on the target.
    target_to_source : SurfaceMap
        Where every vertex of the target lies on the source.
    """

    source: TriangleMesh
    target: TriangleMesh
    source_to_target: SurfaceMap
    target_to_source: SurfaceMap

    @property
    def reverse(self) -> MapPair:
        """The same with source and target exchanged."""
        return MapPair(self.target, self.source, self.target_to_source, self.source_to_target)


@dataclass(frozen=True, eq=False)
class VertexMap:
    """What one mesh keeps of a map to another.

    Attributes
    ----------
    corners : (n, 3) array of int32
        For each vertex, three vertices of the other mesh.
    weights : (n, 3) array of float32
        Barycentric coordinates of its place between them.
    confidence : (n,) array of float32
        How far it may be trusted, 0 to 1.
    has_partner : (n,) array of bool
        Whether it has a counterpart on the other mesh at all.
    """

    corners: NDArray[np.int32]
    weights: NDArray[np.float32]
    confidence: NDArray[np.float32]
    has_partner: NDArray[np.bool_]

    @classmethod
    def of(cls, surface_map: SurfaceMap) -> VertexMap:
        """Take what is kept of a map."""
        return cls(
            surface_map.corners.astype(np.int32),
            surface_map.barycentric.astype(np.float32),
            surface_map.confidence.astype(np.float32),
            surface_map.has_partner,
        )

    @classmethod
    def read(cls, side: Side, name: str) -> VertexMap | None:
        """Read a map of that name from all parts of a side; None if it is not there, or not complete."""
        meshes = [mesh_of(part) for part in parts_of(side)]
        values = []
        for attribute, kind in _attributes(name):
            found = [read for mesh in meshes if (read := read_values(mesh, attribute, kind)) is not None]
            if len(found) < len(meshes):
                return None
            values.append(np.concatenate(found))
        *corners, weights, confidence = values
        has_partner = np.concatenate([_read_partners(mesh, name) for mesh in meshes])
        return cls(np.stack(corners, axis=1), weights, confidence, has_partner)

    def attributes(self, name: str) -> dict[str, NDArray[np.float32] | NDArray[np.int32]]:
        """Return the values of each attribute that keeps the map under a name."""
        values = (*self.corners.T, self.weights, self.confidence)
        kept = {attribute: value for (attribute, _), value in zip(_attributes(name), values, strict=True)}
        if not self.has_partner.all():
            kept[_partner_name(name)] = self.has_partner.astype(np.int32)
        return kept

    def leads_beyond(self, image: TriangleMesh) -> bool:
        """Tell whether places are on vertices of the other mesh that no triangle of it has."""
        return not np.isin(self.corners, image.triangles).all()

    def to(self, image: TriangleMesh) -> SurfaceMap:
        """Make the map again.

        Raises
        ------
        MeshError
            If that mesh has no such places.
        """
        weights = self.weights.astype(np.float64)
        total = weights.sum(axis=1, keepdims=True)
        inside = (self.corners >= 0).all() and (self.corners < image.vertex_count).all() and (weights >= 0).all()
        known = (self.confidence >= 0).all() and (self.confidence <= 1).all()
        if not (inside and known and (total > 0).all() and np.isfinite(total).all()):
            raise MeshError("The attributes of the stored map hold numbers that no match has written. Match again.")
        points = place_points(image, CornerPoints(self.corners.astype(np.int64), weights / total))
        return SurfaceMap.from_points(image, points, self.confidence.astype(np.float64), self.has_partner)


def _read_partners(mesh: bpy.types.Mesh, name: str) -> NDArray[np.bool_]:
    """Read which vertices of a part have a counterpart: all, where it is not said, as by earlier versions."""
    partners = read_values(mesh, _partner_name(name), "INT")
    return np.ones(len(mesh.vertices), bool) if partners is None else partners != 0


@dataclass(frozen=True, eq=False)
class StoredMaps:
    """What both meshes keep of the maps of one answer.

    Attributes
    ----------
    of_source, of_target : VertexMap
        What each keeps: its map to the other.
    """

    of_source: VertexMap
    of_target: VertexMap

    @classmethod
    def of(cls, source_to_target: SurfaceMap, target_to_source: SurfaceMap) -> StoredMaps:
        """Take what is kept of the two maps."""
        return cls(VertexMap.of(source_to_target), VertexMap.of(target_to_source))

    @property
    def reverse(self) -> StoredMaps:
        """The same with source and target exchanged."""
        return StoredMaps(self.of_target, self.of_source)

    @classmethod
    def read(cls, source: Side, target: Side, name: str) -> StoredMaps | None:
        """Read both maps of that name; None if one is not there."""
        of_source, of_target = VertexMap.read(source, name), VertexMap.read(target, name)
        return None if of_source is None or of_target is None else cls(of_source, of_target)

    def between(self, source: TriangleMesh, target: TriangleMesh) -> MapPair:
        """Make the maps again.

        Raises
        ------
        MeshError
            If they are not maps between these meshes.
        """
        if (len(self.of_source.corners), len(self.of_target.corners)) != (source.vertex_count, target.vertex_count):
            raise MeshError("The stored map is one of meshes with other vertices. Match again.")
        return MapPair(source, target, self.of_source.to(target), self.of_target.to(source))


def map_name(prefix: str, place: int = 0) -> str:
    """Return what the names of a map's attributes start with; the place is that among `StoredMatch.order`."""
    return f"{prefix} Map" if place == 0 else f"{prefix} Other Map" if place == 1 else f"{prefix} Other Map {place}"


def read_all_maps(source: Side, target: Side, prefix: str, count: int) -> tuple[StoredMaps | None, ...]:
    """Read the maps of all answers, as far as they were made, in the order of `StoredMatch.order`."""
    return tuple(StoredMaps.read(source, target, map_name(prefix, place)) for place in range(count))


def add_maps(prepared: tuple[Content, Content], prefix: str, kept: Sequence[StoredMaps | None]) -> None:
    """Add what both meshes keep of the maps of all answers to what is written on them, in the same order."""
    for place, maps in enumerate(kept):
        if maps is not None:
            for content, vertex_map in zip(prepared, (maps.of_source, maps.of_target), strict=True):
                content.values.update(vertex_map.attributes(map_name(prefix, place)))


def place_points(mesh: TriangleMesh, points: CornerPoints) -> SurfacePoints:
    """Put points on a mesh as it is triangulated now."""
    try:
        return SurfacePoints.from_corners(mesh, points.corners, points.barycentric)
    except MeshError:
        # Blender cuts a face with more than three corners in another way once it is bent.
        positions = np.einsum("kc,kcd->kd", points.barycentric, mesh.vertices[points.corners])
        found = ClosestPoints(mesh).walk(positions, points.nearest_vertices)
        return SurfacePoints.from_barycentric(mesh, found.triangles, found.barycentric)


def _attributes(name: str) -> tuple[tuple[str, str], ...]:
    """List name and type of the attributes that keep a map."""
    corners = tuple((f"{name} Vertex {number}", "INT") for number in (1, 2, 3))
    return (*corners, (f"{name} Weights", "FLOAT_VECTOR"), (f"{name} Confidence", "FLOAT"))


def _partner_name(name: str) -> str:
    """Name the attribute that says which vertices have a partner, which there is if some have none."""
    return f"{name} Partner"
