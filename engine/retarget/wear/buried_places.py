# SPDX-License-Identifier: GPL-3.0-or-later
"""Places of a surface that lie within the solid that it encloses, as where parts of a character are closed."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.spatial import cKDTree

from ...mesh.area_samples import AreaSamples, even_samples
from ...mesh.triangle_mesh import TriangleMesh
from ...runtime.arrays import Bools, Floats, Ints, marked, slices, squared_differences
from .contact import Surface
from .sight_lines import depths_behind

_DIRECTIONS = 40
"""From how many sides is looked at the surface, to find quickly what may lie within."""

_SAMPLES = 20_000
"""Points that stand for the surface."""

_CELL = 2.5
"""How wide the cells are that it is looked at in, in distances between these points, so that hardly any is empty."""

_DEEP = 0.015
"""How far behind what is in front of it, in sqrt(area), a place lies at least: 2 cm on a human, more than layers of
cloth are apart."""

_ABOVE = 0.007
"""How far above it, in the same unit, has to be within as well: as far as the points are apart."""

_WITHIN = 0.5
"""Winding number from which on a point is within."""

_ONE, _AS_LARGE = 1e-6, 1e-3
"""Distance, in the same unit, between the middles of two triangles, and part of their area, up to which they are one:
what single precision leaves of it."""

_CHUNK = 256
"""Points treated at once, which bounds the memory."""


@dataclass(frozen=True, eq=False)
class Buried:
    """What of a body is buried if it becomes another one.

    Attributes
    ----------
    vertices : (n,) array of bool
        Which of its vertices are.
    middles : (k, 3) array of float
        Middles of triangles that are, though no corner of them is, on the body before.
    """

    vertices: Bools
    middles: Floats


@dataclass(frozen=True, eq=False)
class BuriedPlaces:
    """Vertices, and triangles between others, that do not belong to the outside of a body.

    Attributes
    ----------
    mesh : TriangleMesh
        The body.
    hidden : (h,) array of int
        Vertices that lie deep behind others from whatever side one looks, as also between thighs.
    triangles : (t,) array of int
        Triangles no corner of which does so, but their middle: large ones, as those that close a waist.
    within : (h + t,) array of bool
        Which of them lie within: above them is no air but the inside.
    """

    mesh: TriangleMesh
    hidden: Ints
    triangles: Ints
    within: Bools

    @classmethod
    def of(cls, body: TriangleMesh) -> BuriedPlaces:
        """Look for them on a surface, which may be open, and made of many parts that cross."""
        centre = body.vertices.mean(axis=0)  # away from which rounding grows
        mesh = TriangleMesh(body.vertices - centre, body.triangles)
        samples = even_samples(mesh, mesh.area / _SAMPLES)
        middles = mesh.vertices[mesh.triangles].mean(axis=1)
        found = _hidden(mesh, np.concatenate([mesh.vertices, middles]), samples)
        hidden, inner = found[: mesh.vertex_count], found[mesh.vertex_count :]
        triangles = np.flatnonzero(inner & ~hidden[mesh.triangles].any(axis=1))
        nothing = _coincident(middles, np.flatnonzero(inner), mesh)
        samples = samples.of_triangles(~marked(nothing, mesh.triangle_count))
        points = np.concatenate([mesh.vertices[hidden], middles[triangles]])
        normals = np.concatenate([mesh.vertex_normals[hidden], mesh.triangle_normals[triangles]])
        within = _winding_numbers(mesh, samples, points + _ABOVE * np.sqrt(mesh.area) * normals) > _WITHIN
        return cls(body, np.flatnonzero(hidden), triangles, within)

    def on(self, surface: Surface, images: Floats) -> Buried:
        """Tell what is buried if vertices come to images (n, 3) at another body.

        Where parts are closed by faces that are turned over it cannot be told by the one body alone what is within;
        but these have no place on the other one, and come to lie deep in it.
        """
        corners = self.mesh.triangles[self.triangles]
        found = surface.clearance(np.concatenate([images[self.hidden], images[corners].mean(axis=1)]))
        deep = self.within | found.known & (found.distances < -_DEEP * np.sqrt(surface.mesh.area))
        count = len(self.hidden)
        middles = self.mesh.vertices[corners[deep[count:]]].mean(axis=1)
        return Buried(marked(self.hidden[deep[:count]], len(images)), middles)


def _hidden(mesh: TriangleMesh, places: Floats, samples: AreaSamples) -> Bools:
    """Tell which places (k, 3) no side shows, (k,)."""
    unit = np.sqrt(mesh.area)
    surface, cell = np.concatenate([places, samples.positions]), _CELL * unit / np.sqrt(_SAMPLES)
    hidden = np.ones(len(places), bool)
    for depths in depths_behind(surface, places, cell, _DIRECTIONS):
        hidden &= depths > _DEEP * unit
    return hidden


def _coincident(middles: Floats, chosen: Ints, mesh: TriangleMesh) -> Ints:
    """Choose those triangles, by their middles (m, 3), that lie on others as large.

    Where two parts were cut apart and closed, there is nothing between.  But if the faces that close them look the same
    way, the inside of one seems to be outside.
    """
    if not len(chosen):
        return chosen
    near, other = cKDTree(middles).query(middles[chosen], [2], distance_upper_bound=_ONE * np.sqrt(mesh.area))
    lying = np.flatnonzero(np.isfinite(near[:, 0]))
    own, areas = chosen[lying], mesh.triangle_areas
    return own[np.isclose(areas[own], areas[other[lying, 0]], rtol=_AS_LARGE)]


def _winding_numbers(mesh: TriangleMesh, samples: AreaSamples, points: Floats) -> Floats:
    """Find how often the surface goes around points (k, 3), as its samples see it, (k,)."""
    vectors = samples.areas[:, None] * mesh.triangle_normals[samples.triangles]
    least = mesh.area / _SAMPLES  # nearer than that a sample is no point any more
    found = np.empty(len(points))
    along = (samples.positions * vectors).sum(axis=1)
    for part in slices(len(points), _CHUNK):
        squares = squared_differences(points[part], samples.positions).clip(min=least)
        shares = 1 / (squares * np.sqrt(squares))
        found[part] = shares @ along - ((shares @ vectors) * points[part]).sum(axis=1)
    return found / (4 * np.pi)
