# SPDX-License-Identifier: GPL-3.0-or-later
"""Places of the faces of one mesh, and of their corners, on another that its vertices are mapped to."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy.spatial import cKDTree

from ...mesh.closest_points import ClosestPoints, FoundPoints
from ...mesh.polygons import Polygons
from ...mesh.surface_map import SurfaceMap
from ...mesh.surface_points import SurfacePoints
from ...mesh.triangle_mesh import TriangleMesh
from ...runtime.arrays import Bools, Floats, Ints
from ...runtime.errors import MatchError
from .charts import CornerSheets

_TOWARDS_CORNER = 2 / 3
"""How far from the centre of a face towards each corner it is sampled: about the middle of what lies nearest there."""

_CENTRE_WEIGHT = 1.5
"""What the centre of a face counts more than the samples around it, so that it decides where these are divided."""

_INSIDE = 0.02
"""How far inside a face, as a part of the way to its centre, its corners are sought at first."""

_REACHED = 1e-9
"""Distances below this part of the surface's extent are rounding."""


@dataclass(frozen=True, eq=False)
class CornerPlaces:
    """Where the corners of faces lie on a cut surface, each on the sheet under the centre of its face.

    Attributes
    ----------
    triangles : (l,) array of int
        Triangle of each.
    barycentric : (l, 3) array of float
        Coordinates in it.
    offsets : (l, 3) array of float
        From there to where the map takes the corner's vertex: zero, unless that is on another sheet.
    near_border : (l,) array of bool
        Which corners may have a border between them and the centre of their face.
    seats : FoundPoints
        The places of the faces that this holds for.
    """

    triangles: Ints
    barycentric: Floats
    offsets: Floats
    near_border: Bools
    seats: FoundPoints

    @cached_property
    def is_beyond(self) -> Bools:
        """Which corners lie beyond the border of the sheet, (l,)."""
        return self.offsets.any(axis=1)


@dataclass(frozen=True, eq=False)
class FaceSamples:
    """Places on the image, several for each face.

    Attributes
    ----------
    faces : (s,) array of int
        Whose sample each is.
    triangles : (s,) array of int
        The triangle of the image under it.
    weights : (s,) array of float
        How much each counts.
    """

    faces: Ints
    triangles: Ints
    weights: Floats


class FacePlaces:
    """The faces of a mesh, the domain, on the image of its vertices.

    Parameters
    ----------
    image : TriangleMesh
        The surface that the map leads to.
    polygons : Polygons
        The faces of the domain.
    surface_map : SurfaceMap
        Where each vertex of the domain lies on the image.

    Attributes
    ----------
    images : (l, 3) array of float
        Where the map takes the vertex of each corner.
    seats : FoundPoints
        The place on the image under the centre of each face.
    centres : (f, 3) array of float
        Where that is.

    Raises
    ------
    MatchError
        If map, image and faces do not belong together.
    """

    def __init__(self, image: TriangleMesh, polygons: Polygons, surface_map: SurfaceMap) -> None:
        if surface_map.image_vertex_count != image.vertex_count:
            raise MatchError(
                f"The map leads to a mesh of {surface_map.image_vertex_count} vertices, not {image.vertex_count}."
            )
        if polygons.corner_vertices.max(initial=-1) >= len(surface_map):
            raise MatchError("The faces use vertices that the map does not know. Match again.")
        self.image = image
        self.polygons = polygons
        self.map = surface_map
        self.images = surface_map.positions[polygons.corner_vertices]
        self._search = ClosestPoints(image)
        # Three corners to start from, spread around the face: the search keeps to the sheet where they are.
        sizes = polygons.face_sizes
        corners = polygons.starts[:-1, None] + np.stack([0 * sizes, sizes // 3, 2 * sizes // 3], axis=1)
        starts = surface_map.nearest_vertices[polygons.corner_vertices[corners]]
        found = self._search.walk(polygons.face_means(self.images), starts)
        self.seats = found
        self.centres = found.interpolate(image.triangles, image.vertices)
        self._extent = float(np.ptp(image.vertices, axis=0).max())

    @cached_property
    def reaches(self) -> Floats:
        """Distance from the centre of each face to the image of its farthest corner, (f,)."""
        away = np.linalg.norm(self.images - self.centres[self.polygons.corner_faces], axis=1)
        return np.maximum.reduceat(away, self.polygons.starts[:-1]) if len(away) else away

    @cached_property
    def confidence(self) -> Floats:
        """Mean confidence of the map at the corners of each face, (f,)."""
        return self.polygons.face_means(self.map.confidence[self.polygons.corner_vertices])

    @cached_property
    def samples(self) -> FaceSamples:
        """The centre of each face, and a place towards each of its corners."""
        faces = self.polygons.corner_faces
        nearest = self.seats.nearest_vertices(self.image.triangles)
        points = self.centres[faces] + _TOWARDS_CORNER * (self.images - self.centres[faces])
        found = self._search.walk(points, nearest[faces])
        return FaceSamples(
            np.concatenate([np.arange(len(self.centres)), faces]),
            np.concatenate([self.seats.triangles, found.triangles]),
            np.concatenate([np.full(len(self.centres), _CENTRE_WEIGHT), np.ones(len(faces))]),
        )

    def on_sheets(
        self, sheets: CornerSheets, seats: FoundPoints | None = None, before: CornerPlaces | None = None
    ) -> CornerPlaces:
        """Place each corner on the sheet under the centre of its face.

        From there the search walks towards the corner's image without crossing a cut.  So a face never takes one
        corner from here and the other from beyond a cut: not from another sheet, and not from the same sheet where
        it meets itself, as around an arm, either.

        Parameters
        ----------
        sheets : CornerSheets
            The image, cut.
        seats : FoundPoints, optional
            Other places for the faces than those under their centres.
        before : CornerPlaces, optional
            Places for other seats, which are kept for all faces whose seat is still the same.
        """
        seats = seats or self.seats
        faces, vertices = self.polygons.corner_faces, self.polygons.corner_vertices
        triangles, barycentric = self.map.triangles[vertices], self.map.barycentric[vertices]
        same = sheets.labels[triangles] == sheets.labels[seats.triangles[faces]]
        if before is None:
            offsets = np.zeros_like(self.images)
            near_border = ~(same & self._is_clear(sheets)[faces])
            rest = np.flatnonzero(near_border)
        else:
            anew = (seats.triangles != before.seats.triangles)[faces]
            triangles = np.where(anew, triangles, before.triangles)
            barycentric = np.where(anew[:, None], barycentric, before.barycentric)
            offsets = np.where(anew[:, None], 0, before.offsets)
            near_border = before.near_border | anew
            rest = np.flatnonzero(anew)
        if len(rest):
            found = self._walked(sheets, seats, rest)
            missed = found.squared_distances > (_REACHED * self._extent) ** 2
            # A walk that ends inside a sheet was caught behind a fold of it; the image itself is a better place then.
            caught = missed & same[rest] & ~sheets.is_at_border(found.triangles, found.barycentric)
            triangles[rest[~caught]], barycentric[rest[~caught]] = found.triangles[~caught], found.barycentric[~caught]
            index = rest[missed & ~caught]
            points = SurfacePoints.from_barycentric(self.image, triangles[index], barycentric[index])
            offsets[index] = self.images[index] - points.positions
        return CornerPlaces(triangles, barycentric, offsets, near_border, seats)

    def _walked(self, sheets: CornerSheets, seats: FoundPoints, corners: Ints) -> FoundPoints:
        """Walk from the seats of faces towards the images of some corners (k,), within sheets."""
        faces = self.polygons.corner_faces[corners]
        images = self.images[corners]
        # First to a point a little inside: both sides of a cut are equally near to one upon it.
        inside = images + _INSIDE * (self.centres[faces] - images)
        first = sheets.search.walk(inside, seats.nearest_vertices(sheets.surface.triangles)[faces])
        return sheets.search.walk(images, first.nearest_vertices(sheets.surface.triangles))

    def seated_beside(self, sheets: CornerSheets, seats: FoundPoints, faces: Ints, neighbours: Ints) -> FoundPoints:
        """Move some faces (k,) to the sheets on which other faces (k,) lie."""
        starts = seats.nearest_vertices(sheets.surface.triangles)[neighbours]
        return seats.with_others(faces, sheets.search.walk(self.centres[faces], starts))

    def _is_clear(self, sheets: CornerSheets) -> Bools:
        """Say of each face whether no border of a sheet is within its reach."""
        ends = sheets.surface.vertices[sheets.border_edges]  # (b, 2, 3)
        half = float(np.linalg.norm(ends[:, 1] - ends[:, 0], axis=1).max(initial=0.0)) / 2
        away = cKDTree(ends.mean(axis=1)).query(self.centres)[0]
        return away - half > self.reaches
