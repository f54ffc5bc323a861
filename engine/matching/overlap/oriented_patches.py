# SPDX-License-Identifier: GPL-3.0-or-later
"""Polar maps of the surroundings of points, by which places of two surfaces are recognised, and how they are turned."""

from __future__ import annotations

from dataclasses import dataclass, fields

import numpy as np

from ...geometry.orientation import tangent_frames
from ...runtime.arrays import TINY, Floats, Ints, group_sums, unit_vectors
from .part_surface import PartSurface

_RADII = np.array([0.0, 0.045, 0.09, 0.14, 0.2, 0.27, 0.35])
"""Between which distances from the middle, in units of length, the rings of a patch lie."""

RINGS, TURNS = len(_RADII) - 1, 16
"""How many rings, and directions, the cells of a patch are in."""

_HEIGHT, _FACING = 0.1, 0.7
"""Length that counts as one, and how much a difference of normals counts against that."""

_SMOOTHING = 4e-4
"""How long normals spread before they say which way a patch faces, in units of area."""

_FULL, _LEAST = 2e-4, 2e-5
"""Area in a cell from which on it is seen wholly, and up to which nothing is seen in it."""


@dataclass(frozen=True, eq=False)
class OrientedPatches:
    """The surroundings of s points of a surface, each as it is seen by who stands there.

    Attributes
    ----------
    vertices : (s,) array of int
        The points.
    paths : (s, n) array of float
        Lengths of paths from them to all vertices.
    frames : (s, 3, 3) array of float
        Axes at each point, the last along the normal; the turn about that is free.
    values : (s, RINGS, TURNS, 4) array of float
        In each cell: how high the surface is over the tangent plane, by how much it is foreshortened, and how its
        normal is inclined, upwards and outwards.
    weights : (s, RINGS, TURNS) array of float
        How much of each cell there is: nothing where the surface was cut off.
    """

    vertices: Ints
    paths: Floats
    frames: Floats
    values: Floats
    weights: Floats

    def __len__(self) -> int:
        return len(self.vertices)

    @property
    def between(self) -> Floats:
        """Lengths of the paths between the points, (s, s)."""
        return self.paths[:, self.vertices]

    def first(self, count: int) -> OrientedPatches:
        """Return the patches of the first points, which are spread over the surface as well."""
        return OrientedPatches(*(getattr(self, each.name)[:count] for each in fields(self)))


def oriented_patches(surface: PartSurface, count: int) -> OrientedPatches:
    """Describe the surroundings of points that are spread over a surface.

    Parameters
    ----------
    surface : PartSurface
        The surface.
    count : int
        About how many points.
    """
    vertices = surface.samples(count)
    paths = surface.paths(vertices)
    frames = tangent_frames(unit_vectors(surface.smoothed(surface.normals, _SMOOTHING)[vertices]))
    corners, mesh = surface.mesh.triangles, surface.mesh
    places = np.concatenate([surface.vertices, surface.vertices[corners].mean(axis=1)])
    normals = np.concatenate([surface.normals, mesh.triangle_normals])
    areas = np.concatenate([surface.mass, mesh.triangle_areas])
    shape = len(vertices), RINGS, TURNS
    values, weights = np.zeros((*shape, 4)), np.zeros(shape)
    for number, (vertex, axes) in enumerate(zip(vertices, frames, strict=True)):
        lengths = np.concatenate([paths[number], paths[number][corners].mean(axis=1)])
        near = np.flatnonzero(lengths < _RADII[-1])
        offsets = (places[near] - surface.vertices[vertex]) @ axes.T
        cells, seen = _seen(offsets, normals[near] @ axes.T, lengths[near])
        sums = group_sums(cells, areas[near, None] * seen, RINGS * TURNS).reshape(RINGS, TURNS, 4)
        amounts = np.bincount(cells, areas[near], RINGS * TURNS).astype(np.float64).reshape(RINGS, TURNS)
        sums, amounts = _blurred(sums), _blurred(amounts)
        values[number] = sums / np.maximum(amounts, _LEAST / 100)[..., None]
        weights[number] = np.minimum(amounts / _FULL, 1) * (amounts > _LEAST)
    return OrientedPatches(vertices, paths, frames, values, weights)


def _seen(offsets: Floats, normals: Floats, lengths: Floats) -> tuple[Ints, Floats]:
    """Find the cells of points (k,) and what is seen there, (k, 4), by places, normals and lengths of paths."""
    aside = np.hypot(offsets[:, 0], offsets[:, 1])
    outwards = (normals[:, :2] * offsets[:, :2]).sum(axis=1) / np.maximum(aside, TINY)
    seen = offsets[:, 2] / _HEIGHT, (aside - lengths) / _HEIGHT, _FACING * normals[:, 2], _FACING * outwards
    angles = np.arctan2(offsets[:, 1], offsets[:, 0]) / (2 * np.pi) * TURNS
    rings = np.searchsorted(_RADII, lengths, side="right") - 1
    cells: Ints = rings * TURNS + np.floor(angles).astype(np.int64) % TURNS
    return cells, np.stack(seen, axis=1)


def _blurred(cells: Floats) -> Floats:
    """Share what is in cells (RINGS, TURNS, ...) with those beside them on the ring."""
    return cells + (np.roll(cells, 1, axis=1) + np.roll(cells, -1, axis=1)) / 2
