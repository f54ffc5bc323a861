# SPDX-License-Identifier: GPL-3.0-or-later
"""Poses of one model, each meshed anew, so that no two surfaces have triangles in common; the truth is kept."""

from dataclasses import dataclass

import numpy as np
from scipy.spatial import cKDTree

from engine import TriangleMesh
from engine.geodesics import GeodesicSolver
from engine.shape import Shape

PLACES = 300


@dataclass(frozen=True)
class Remeshed:
    """A new mesh; for each of its vertices one of the model (n,), and for those of the model one of it (m,)."""

    mesh: TriangleMesh
    model: np.ndarray
    places: np.ndarray


def remeshed(vertices, triangles, name, count):
    """Mesh a pose of a model anew, with `count` vertices."""
    mesh = Shape(TriangleMesh(vertices, triangles), name, count).mesh
    return Remeshed(mesh, cKDTree(vertices).query(mesh.vertices)[1], cKDTree(mesh.vertices).query(vertices)[1])


def errors(source, target, found):
    """Distances x 100 of images of some vertices from where they belong, over the square root of the area, (k,)."""
    chosen = np.random.default_rng(0).permutation(source.mesh.vertex_count)[:PLACES]
    rows = GeodesicSolver(target.mesh).distances(target.places[source.model[chosen]])
    away = rows[np.arange(len(chosen)), found.nearest_vertices[chosen]]
    return 100 * away / np.sqrt(target.mesh.area)
