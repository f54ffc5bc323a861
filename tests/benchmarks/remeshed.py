# SPDX-License-Identifier: GPL-3.0-or-later
"""Poses of one model, each meshed anew, so that no two surfaces have triangles in common; the truth is kept."""

import time
from dataclasses import dataclass

import numpy as np
from scipy.spatial import cKDTree

from engine import HierMatchError, MatchSettings, TriangleMesh, match
from engine.geometry.geodesics import GeodesicSolver
from engine.shapes.shape import Shape

PLACES = 300
FAR, WRONG = 15.0, 0.03
"""From which error on a place is far away, and from which share of such places on a map is wrong."""


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


def unlike_poses(places, count, points):
    """Take so many poses of some (f, n, 3): the most usual first, then each as far as can be from those before.

    They are compared by the distances between so many of their vertices.
    """
    some = np.random.default_rng(0).permutation(places.shape[1])[:points]
    distances = np.linalg.norm(places[:, some, None] - places[:, None, some], axis=3).reshape(len(places), -1)
    chosen = [int(np.linalg.norm(distances - np.median(distances, axis=0), axis=1).argmin())]
    while len(chosen) < min(count, len(places)):
        apart = np.linalg.norm(distances[:, None] - distances[chosen], axis=2).min(axis=1)
        chosen.append(int(apart.argmax()))
    return places[chosen]


def errors(source, target, found):
    """Distances x 100 of images of some vertices from where they belong, over the square root of the area, (k,)."""
    chosen = np.random.default_rng(0).permutation(source.mesh.vertex_count)[:PLACES]
    rows = GeodesicSolver(target.mesh).distances(target.places[source.model[chosen]])
    away = rows[np.arange(len(chosen)), found.nearest_vertices[chosen]]
    return 100 * away / np.sqrt(target.mesh.area)


def compared(label, source, target):
    """Match two poses of a model; return a row to be printed, whether either map is wrong, and the numbers of the row.

    These are the mean errors there and back, the confidence and the seconds; None if there is no match.
    """
    start = time.perf_counter()
    try:
        result = match(source.mesh, target.mesh, MatchSettings(dense=True))
    except HierMatchError as error:
        return f"{label} {error}", True, None
    seconds = time.perf_counter() - start
    away = errors(source, target, result.source_to_target), errors(target, source, result.target_to_source)
    wrong = any((e > FAR).mean() > WRONG for e in away)
    what = "  ".join(f"{e.mean():6.2f} {(e > FAR).mean():6.1%}" for e in away)
    quality = result.quality
    return said(label, what, quality, seconds, wrong), wrong, (*(e.mean() for e in away), quality.confidence, seconds)


def said(label, what, quality, seconds, wrong):
    """A row to be printed: what came of a match, and what it says of itself."""
    margin = "-" if quality.margin is None else f"{quality.margin:.2f}"
    return f"{label} {what:30s} {margin:>6s} {quality.confidence:5.2f} {seconds:6.1f}  {'WRONG' if wrong else ''}"
