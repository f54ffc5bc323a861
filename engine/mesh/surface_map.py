# SPDX-License-Identifier: GPL-3.0-or-later
"""A map that takes every vertex of one surface to a point of another."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.sparse import csr_array

from ..runtime.arrays import Bools, Floats, Ints, slices
from ..runtime.errors import MatchError
from .closest_points import ClosestPoints
from .surface_points import SurfacePoints, at_corners, interpolation_matrix
from .triangle_mesh import TriangleMesh

_CHUNK = 100_000
"""Rows computed at once, which bounds the memory of what is gathered for them."""

_FLAT = 1e-9
"""Mapped triangles whose area is a smaller part of their longest side squared have no side to be seen from."""


def _everywhere() -> Bools:
    """Stand for one truth value for each vertex, all true."""
    return np.ones(0, bool)


@dataclass(frozen=True, eq=False)
class SurfaceMap:
    """A map of every vertex of one mesh, the domain, to a point on another, the image.

    Values at the vertices of the image are carried to the domain (`transfer`): the opposite way.

    Attributes
    ----------
    points : SurfacePoints
        For each of the n vertices of the domain, its point on the image.
    confidence : (n,) array of float
        How far each may be trusted, 0 to 1.
    image_vertex_count : int
        Number of vertices of the image.
    has_partner : (n,) array of bool, optional
        Whether each has a counterpart on the image at all; by default all have.  One without goes to the point that
        follows from what is around it, with confidence zero.

    Raises
    ------
    MatchError
        If the confidence is not one number from 0 to 1 for each vertex, a point is not on such an image, or there is
        not one truth value for each vertex.
    """

    points: SurfacePoints
    confidence: Floats
    image_vertex_count: int
    has_partner: Bools = field(default_factory=_everywhere)

    def __post_init__(self) -> None:
        confidence = np.asarray(self.confidence, np.float64)
        if confidence.shape != (len(self.points),):
            raise MatchError(
                f"A map of {len(self.points)} vertices needs one confidence for each, "
                f"but got an array of the shape {confidence.shape}."
            )
        if not ((confidence >= 0) & (confidence <= 1)).all():
            raise MatchError("The confidence of a map should be between 0 and 1 everywhere.")
        outside = self.corners[(self.corners < 0) | (self.corners >= self.image_vertex_count)]
        if len(outside):
            raise MatchError(
                f"A map to a mesh of {self.image_vertex_count} vertices has a point at vertex {outside[0]}: "
                "its points are on another mesh."
            )
        partners = np.asarray(self.has_partner, bool)
        if not partners.size:
            partners = np.ones(len(self.points), bool)
        if partners.shape != (len(self.points),):
            raise MatchError(
                f"A map of {len(self.points)} vertices needs one truth value for each that says whether it has a "
                f"partner, but got an array of the shape {partners.shape}."
            )
        object.__setattr__(self, "confidence", np.where(partners, confidence, 0.0))
        object.__setattr__(self, "has_partner", partners)

    @classmethod
    def from_points(
        cls,
        image: TriangleMesh,
        points: SurfacePoints,
        confidence: Floats | None = None,
        has_partner: Bools | None = None,
    ) -> SurfaceMap:
        """Make a map from points (n,) on the image; trusted everywhere if no confidence (n,) is given."""
        trusted = np.ones(len(points)) if confidence is None else confidence
        return cls(points, trusted, image.vertex_count, _everywhere() if has_partner is None else has_partner)

    @classmethod
    def from_barycentric(
        cls,
        image: TriangleMesh,
        triangles: Ints,
        barycentric: Floats,
        confidence: Floats | None = None,
        has_partner: Bools | None = None,
    ) -> SurfaceMap:
        """Make a map from triangles (n,) of the image and barycentric coordinates (n, 3) there."""
        points = SurfacePoints.from_barycentric(image, triangles, barycentric)
        return cls.from_points(image, points, confidence, has_partner)

    @classmethod
    def identity(cls, mesh: TriangleMesh) -> SurfaceMap:
        """Map every vertex of a mesh to itself.

        Raises
        ------
        MeshError
            If a vertex is in no triangle: there is no surface at it.
        """
        return cls.from_points(mesh, SurfacePoints.at_vertices(mesh, np.arange(mesh.vertex_count)))

    def __len__(self) -> int:
        return len(self.points)

    def __repr__(self) -> str:
        return f"<SurfaceMap: {len(self)} vertices to a mesh of {self.image_vertex_count}>"

    @property
    def triangles(self) -> Ints:
        """Triangle of the image in which the point of each vertex lies, (n,)."""
        return self.points.triangles

    @property
    def barycentric(self) -> Floats:
        """Barycentric coordinates of each point in its triangle, (n, 3)."""
        return self.points.barycentric

    @property
    def corners(self) -> Ints:
        """Vertices of these triangles, in the order of `barycentric`, (n, 3)."""
        return self.points.corners

    @property
    def nearest_vertices(self) -> Ints:
        """Corner with the largest coordinate for each point, (n,)."""
        return self.points.nearest_vertices

    @property
    def positions(self) -> Floats:
        """Where the points are, (n, 3)."""
        return self.points.positions

    @property
    def interpolation(self) -> csr_array:
        """The matrix (n, m) that interpolates values at the vertices of the image for those of the domain."""
        return interpolation_matrix(self.barycentric, self.corners, self.image_vertex_count)

    def transfer(self, values: ArrayLike) -> NDArray[Any]:
        """Carry values at the vertices of the image to those of the domain.

        Parameters
        ----------
        values : (m, ...) array_like
            For each vertex of the image, a number, a vector, or anything else.

        Returns
        -------
        (n, ...) array
            For each vertex of the domain, the value at its point: interpolated inside the triangle if the values are
            real or complex numbers, and then of double precision; that of the nearest corner, of the type given, if
            they are integers, truth values or other things, which number or name something and have no mean.

        Raises
        ------
        MatchError
            If there is not one value for each vertex of the image.
        """
        array = np.asarray(values)
        if array.ndim == 0 or len(array) != self.image_vertex_count:
            raise MatchError(
                f"To be carried over, there should be one value for each of the {self.image_vertex_count} vertices "
                f"that the map leads to, but the array has the shape {array.shape}."
            )
        if not np.issubdtype(array.dtype, np.inexact):
            return array[self.nearest_vertices]
        flat = array.reshape(len(array), -1)
        carried = np.empty((len(self), flat.shape[1]), np.result_type(flat, np.float64))
        for part in slices(len(self), _CHUNK):
            weights, corners = self.barycentric[part], self.corners[part]
            carried[part] = weights[:, :1] * at_corners(flat, corners[:, 0], weights[:, 0])
            for corner in (1, 2):
                carried[part] += weights[:, corner, None] * at_corners(flat, corners[:, corner], weights[:, corner])
        return carried.reshape(len(self), *array.shape[1:])

    def then(self, other: SurfaceMap, image: TriangleMesh, search: ClosestPoints | None = None) -> SurfaceMap:
        """Follow this map from A to B by another from B to C.

        Between the vertices of B the other map is continued linearly inside triangles, and brought back to C by a
        search along its surface.

        Parameters
        ----------
        other : SurfaceMap
            The map from B to C.
        image : TriangleMesh
            C.
        search : ClosestPoints, optional
            A search on C, if there is one already.

        Returns
        -------
        SurfaceMap
            The map from A to C, whose confidence is the product of both.  A vertex has a partner if it has one on B,
            and that has one on C.

        Raises
        ------
        MatchError
            If the other map does not start where this one ends, or does not end on `image`.
        """
        if len(other) != self.image_vertex_count:
            raise MatchError(
                f"Two maps can follow one another if the second starts on the mesh where the first ends, but that has "
                f"{self.image_vertex_count} vertices, and the second map starts from {len(other)}."
            )
        other._check_image(image)
        search = search or ClosestPoints(image)
        found = search.walk(self.transfer(other.positions), other.nearest_vertices[self.nearest_vertices])
        # Rounding may leave an interpolated one above one.
        confidence = np.minimum(self.confidence * self.transfer(other.confidence), 1)
        partners = self.has_partner & self.transfer(other.has_partner)
        return SurfaceMap.from_barycentric(image, found.triangles, found.barycentric, confidence, partners)

    def edge_stretch(self, domain: TriangleMesh, image: TriangleMesh) -> Floats:
        """Measure how the map stretches each edge of the domain.

        Returns
        -------
        (e,) array of float
            For each of `domain.edges` its length on the image in a straight line by its length on the domain, both in
            units of the square root of the area: 1 where the map keeps lengths.  An edge without length has no stretch
            and is NaN.
        """
        self.check(domain, image)
        a, b = domain.edges.T
        mapped = np.linalg.norm(self.positions[b] - self.positions[a], axis=1) / np.sqrt(image.area)
        original = domain.edge_lengths / np.sqrt(domain.area)
        return np.divide(mapped, original, out=np.full(len(mapped), np.nan), where=original > 0)

    def rms_edge_stretch(self, domain: TriangleMesh, image: TriangleMesh) -> float:
        """Root of the mean squared `edge_stretch`: 1 for an isometry, much more for a map with tears or folds."""
        return float(np.sqrt(np.nanmean(self.edge_stretch(domain, image) ** 2)))

    def flipped_faces(self, domain: TriangleMesh, image: TriangleMesh) -> float:
        """Area of the domain's triangles whose image shows its back, as a part of the area of the domain, 0 to 1."""
        return self._area_share(domain, self.face_orientations(domain, image) < 0)

    def orientation(self, domain: TriangleMesh, image: TriangleMesh) -> float:
        """Mean of `face_orientations` by area, -1 to 1: towards -1 for a map that mirrors the surface."""
        signs = self.face_orientations(domain, image)
        return self._area_share(domain, signs > 0) - self._area_share(domain, signs < 0)

    def mirrors(self, domain: TriangleMesh, image: TriangleMesh) -> bool:
        """Say whether the domain lies on the image as if seen in a mirror, its left side on the right.

        Then most of it is turned over, and what fits the map best on the whole is a reflection: where only the
        triangles of one of the two are the wrong way round, it is a rotation.
        """
        self.check(domain, image)
        shares = domain.vertex_areas / domain.area
        here, there = (each - shares @ each for each in (domain.vertices, self.positions))
        spread = there.T @ (shares[:, None] * here)
        return bool(np.linalg.det(spread) < 0) and self.orientation(domain, image) < 0

    def face_orientations(self, domain: TriangleMesh, image: TriangleMesh) -> NDArray[np.int8]:
        """Say of each triangle of the domain how its image lies on the surface.

        Returns
        -------
        (t,) array of int
            1 if the triangle of the three mapped corners looks to the side of the image's normal there, -1 if to the
            other, 0 if it has no area: the sign of the Jacobian of the map.
        """
        self.check(domain, image)
        normals = self.transfer(image.vertex_normals)
        signs = np.empty(domain.triangle_count, np.int8)
        for part in slices(domain.triangle_count, _CHUNK):
            corners = domain.triangles[part]
            a, b, c = (self.positions[corner] for corner in corners.T)
            sides = np.stack([b - a, c - a, c - b])
            mapped = np.cross(sides[0], sides[1])
            there = normals[corners].sum(axis=1)
            seen = np.einsum("td,td->t", mapped, there)
            flat = np.linalg.norm(mapped, axis=1) <= _FLAT * np.einsum("std,std->st", sides, sides).max(axis=0)
            signs[part] = np.where(flat, 0, np.sign(seen))
        return signs

    @staticmethod
    def _area_share(domain: TriangleMesh, selected: Bools) -> float:
        return float(domain.triangle_areas[selected].sum() / domain.area)

    def check(self, domain: TriangleMesh, image: TriangleMesh) -> None:
        """Raise an error if these are not the meshes that the map leads from and to, by their numbers of vertices.

        Raises
        ------
        MatchError
            If they are not.
        """
        self.check_domain(domain)
        self._check_image(image)

    def check_domain(self, domain: TriangleMesh) -> None:
        """Raise an error if this is not the mesh that the map leads from, by its number of vertices.

        Raises
        ------
        MatchError
            If it is not.
        """
        if domain.vertex_count != len(self):
            raise MatchError(
                f"The map is one of {len(self)} vertices, but the mesh it should lead from has {domain.vertex_count}."
            )

    def _check_image(self, image: TriangleMesh) -> None:
        if image.vertex_count != self.image_vertex_count:
            raise MatchError(
                f"The map leads to a mesh of {self.image_vertex_count} vertices, "
                f"but the mesh given as its image has {image.vertex_count}."
            )
