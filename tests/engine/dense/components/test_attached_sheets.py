# SPDX-License-Identifier: GPL-3.0-or-later
"""Sheets on the main part that touch each other: lashes, tears and shells of an eye."""

import numpy as np
import pytest

from engine import SurfacePoints, TriangleMesh
from engine.dense.components.attached_sheets import mapped_sheets
from engine.dense.components.similarity_field import Surroundings
from engine.repair.cleaning import clean
from tests.messes import together
from tests.shapes import compacted, creature, posed


@pytest.fixture(scope="module")
def rest():
    _, triangles, vertices = creature(0.0, 17)
    return vertices, triangles


def sheets(body, gap):
    """Two sheets over a place of a body, an inner one and one that bulges: with no gap their borders coincide."""
    vertices, triangles = body
    normals = TriangleMesh(*body).vertex_normals
    away = np.linalg.norm(vertices - vertices[np.argmax(vertices[:, 0])], axis=1)
    near = triangles[(away[triangles] < 0.14).all(axis=1)]
    inner = vertices + 0.01 * normals
    inside = np.ones(len(vertices), bool)  # of the patch, without its border
    edges = np.sort(np.concatenate([near[:, [0, 1]], near[:, [1, 2]], near[:, [2, 0]]]), axis=1)
    once, counts = np.unique(edges, axis=0, return_counts=True)
    inside[once[counts == 1]] = False
    outer = inner + (gap + 0.03 * inside[:, None]) * normals
    return [compacted(layer, near) for layer in (inner, outer)]


def mapped(x_mesh, y_mesh, body_count):
    x, y = clean(TriangleMesh(*x_mesh)), clean(TriangleMesh(*y_mesh))
    known = x.main.original_vertices
    images = SurfacePoints.at_vertices(y.mesh, y.vertex_images[known])
    assert body_count == x.mesh.vertex_count
    return x, y, mapped_sheets(x, y, Surroundings(x.mesh, y.mesh, images))


@pytest.mark.parametrize("gaps", [(0.0, 0.004), (0.004, 0.0), (0.0, 0.0)])
def test_each_sheet_finds_its_own_though_they_are_welded(rest, gaps):
    x_mesh = together(rest, *sheets(rest, gaps[0]))
    vertices, triangles = together(rest, *sheets(rest, gaps[1]))
    y_mesh = posed(vertices, 0.4), triangles
    x, y, found = mapped(x_mesh, y_mesh, len(rest[0]))
    assert len(x.pieces) + len(y.pieces) < 6  # on one of them they are one piece
    assert np.array_equal(np.sort(found.vertices), np.arange(len(rest[0]), len(x_mesh[0])))
    at = SurfacePoints.from_barycentric(y.original, found.triangles, found.barycentric)
    wanted = y_mesh[0][found.vertices]
    assert np.linalg.norm(at.positions - wanted, axis=1).max() < 0.02
    first = len(rest[0]) + (len(x_mesh[0]) - len(rest[0])) // 2
    assert np.array_equal(found.vertices < first, y_mesh[1][found.triangles, 0] < first)
    assert (found.partners > 0).all()


def test_pieces_that_are_one_sheet_are_left_to_be_compared_as_pieces(rest):
    mesh = together(rest, *sheets(rest, 0.004))
    assert len(mapped(mesh, mesh, len(rest[0]))[2].vertices) == 0
    assert len(mapped(rest, rest, len(rest[0]))[2].vertices) == 0
