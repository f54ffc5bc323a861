# SPDX-License-Identifier: GPL-3.0-or-later
"""Seams that are closed, surfaces that only touch, and which parts are small."""

import numpy as np

from engine import TriangleMesh
from engine.mesh.connectivity.welded_parts import WeldedParts
from tests.shapes import icosphere, plane


def together(*pieces):
    """One mesh of several: vertices and triangles."""
    starts = np.cumsum([0, *(len(vertices) for vertices, _ in pieces)])
    vertices = np.concatenate([vertices for vertices, _ in pieces])
    return vertices, np.concatenate([triangles + start for (_, triangles), start in zip(pieces, starts, strict=False)])


def test_a_mesh_cut_into_its_triangles_is_one_part():
    vertices, triangles = icosphere(4)
    whole = WeldedParts.of(TriangleMesh(vertices, triangles))
    cut = WeldedParts.of(TriangleMesh(vertices[triangles.ravel()], np.arange(triangles.size).reshape(-1, 3)))
    assert whole.part_count == cut.part_count == 1
    assert whole.welded_count == cut.welded_count == len(vertices)
    assert len(whole.edges) == len(cut.edges) == len(vertices) + len(triangles) - 2
    np.testing.assert_allclose(cut.positions[cut.welded], cut.mesh.vertices)


def test_surfaces_that_touch_stay_apart_and_loose_vertices_are_parts():
    vertices, triangles = icosphere(3)
    two = together((vertices, triangles), (0.05 * vertices + [1.05, 0, 0], triangles))
    parts = WeldedParts.of(TriangleMesh(np.concatenate([two[0], [[9, 9, 9]]]), two[1]))
    assert parts.part_count == 3
    sizes = parts.sizes[parts.vertex_labels[[0, len(vertices), -1]]]
    np.testing.assert_allclose(sizes, [2, 0.1, 0], atol=0.05)
    np.testing.assert_array_equal(parts.small[parts.vertex_labels[[0, len(vertices), -1]]], [False, True, True])


def test_means_over_chosen_vertices():
    vertices, triangles = plane(3)
    parts = WeldedParts.of(TriangleMesh(vertices[triangles.ravel()], np.arange(triangles.size).reshape(-1, 3)))
    chosen = np.zeros(triangles.size, bool)
    chosen[[0, 4]] = True
    mean = parts.mean_over(chosen)
    assert set(np.flatnonzero(mean.sum(axis=1))) == set(parts.welded[[0, 4]])
    np.testing.assert_allclose(parts.mean_over(~chosen | chosen) @ np.ones(triangles.size), 1)


def test_the_best_copy_and_the_closed_mesh():
    vertices, triangles = icosphere(3)
    parts = WeldedParts.of(TriangleMesh(vertices[triangles.ravel()], np.arange(triangles.size).reshape(-1, 3)))
    assert parts.seams
    assert parts.closed.is_closed
    assert not WeldedParts.of(parts.closed).seams
    values = np.random.default_rng(0).uniform(size=triangles.size)
    best = parts.best_of(values)
    np.testing.assert_array_equal(parts.welded[best], np.arange(parts.welded_count))
    assert (values <= values[best][parts.welded]).all()
