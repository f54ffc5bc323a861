# SPDX-License-Identifier: GPL-3.0-or-later
"""A map that is moved to take some vertices where they belong."""

import numpy as np
import pytest

from engine import SurfacePoints, TriangleMesh
from engine.mesh.closest_points import ClosestPoints
from engine.registration.landmark_snapping import pinned
from tests.shapes import icosphere, plane


def itself(mesh):
    return SurfacePoints.at_vertices(mesh, np.arange(mesh.vertex_count))


def moved(mesh, vertices, partners):
    """The map of a mesh to itself, once vertices are to be taken to partners."""
    return pinned(mesh, mesh, itself(mesh), np.array(vertices), np.array(partners), search=ClosestPoints(mesh))


def at(mesh, *place):
    return int(np.linalg.norm(mesh.vertices - place, axis=1).argmin())


@pytest.fixture(scope="module")
def sheet():
    return TriangleMesh(*plane(41))


@pytest.fixture(scope="module")
def ball():
    return TriangleMesh(*icosphere(12))


def test_what_is_right_already_stays(ball):
    found = moved(ball, [5, 90, 400], [5, 90, 400])
    np.testing.assert_allclose(found.positions, ball.vertices, atol=1e-12)


def test_vertices_arrive_exactly(ball):
    vertices = np.array([at(ball, 0, 0, 1), at(ball, 1, 0, 0), at(ball, 0, -1, 0)])
    partners = np.array([at(ball, 0.1, 0.1, 1), at(ball, 1, 0.2, 0), at(ball, 0.1, -1, 0)])
    found = moved(ball, vertices, partners)
    assert (vertices != partners).all()
    np.testing.assert_array_equal(found.positions[vertices], ball.vertices[partners])
    np.testing.assert_array_equal(found.nearest_vertices[vertices], partners)


def test_the_surroundings_follow_and_what_is_far_stays(sheet):
    vertex, partner = at(sheet, 0.5, 0.5, 0), at(sheet, 0.55, 0.5, 0)
    steps = moved(sheet, [vertex], [partner]).positions - sheet.vertices
    away = np.linalg.norm(sheet.vertices - sheet.vertices[vertex], axis=1)
    assert np.abs(steps[away > 4 * 0.05 + 1e-9]).max() < 1e-12
    assert steps[(away > 0) & (away < 0.04), 0].min() > 0.02
    np.testing.assert_allclose(steps[:, 1:], 0, atol=1e-9)
    # Along a line of the grid, where distances along edges are exact, by the function that is named.
    line = np.flatnonzero((sheet.vertices[:, 1] == sheet.vertices[vertex, 1]) & (away < 0.2))
    t = away[line] / 0.2
    np.testing.assert_allclose(steps[line, 0], 0.05 * (1 - t) ** 4 * (4 * t + 1), atol=1e-9)


def test_nothing_folds(sheet):
    found = moved(sheet, [at(sheet, 0.5, 0.5, 0)], [at(sheet, 0.6, 0.55, 0)])
    a, b, c = found.positions[sheet.triangles].transpose(1, 0, 2)
    assert np.cross(b - a, c - a)[:, 2].min() > 0


def test_what_is_held_is_not_moved_by_others(sheet):
    here, beside = at(sheet, 0.5, 0.5, 0), at(sheet, 0.55, 0.5, 0)
    found = moved(sheet, [here, beside], [at(sheet, 0.475, 0.5, 0), beside])
    np.testing.assert_array_equal(found.positions[beside], sheet.vertices[beside])
    beyond = sheet.vertices[:, 0] > 0.55 + 1e-9
    np.testing.assert_allclose(found.positions[beyond], sheet.vertices[beyond], atol=1e-12)


def test_images_stay_on_the_surface(ball):
    found = moved(ball, [at(ball, 0, 0, 1)], [at(ball, 0.3, 0, 1)])
    assert (found.barycentric >= 0).all()
    np.testing.assert_allclose(found.barycentric.sum(axis=1), 1)
    assert (np.linalg.norm(found.positions, axis=1) > 0.97).all()
    assert (np.linalg.norm(found.positions - ball.vertices, axis=1) > 1e-3).sum() > 20


@pytest.mark.parametrize("scale", [1e-3, 1e3])
def test_the_size_of_the_target_does_not_matter(scale, ball):
    vertices, partners = np.array([at(ball, 0, 0, 1)]), np.array([at(ball, 0.2, 0, 1)])
    large = TriangleMesh(scale * ball.vertices, ball.triangles)
    found = pinned(ball, large, itself(large), vertices, partners, search=ClosestPoints(large))
    np.testing.assert_allclose(found.positions / scale, moved(ball, vertices, partners).positions, atol=1e-6)


def test_two_landmarks_at_one_place_each_arrive(sheet):
    """As at the corner of a closed mouth: the lips are two vertices at one place."""
    lips = [at(sheet, 0.4, 0.5, 0), at(sheet, 0.6, 0.5, 0)]
    vertices = sheet.vertices.copy()
    vertices[lips] = vertices[lips].mean(axis=0)
    closed = TriangleMesh(vertices, sheet.triangles)
    partners = [at(sheet, 0.45, 0.55, 0), at(sheet, 0.55, 0.45, 0)]
    found = pinned(closed, sheet, itself(sheet), np.array(lips), np.array(partners), search=ClosestPoints(sheet))
    np.testing.assert_allclose(found.positions[lips], sheet.vertices[partners], atol=1e-12)
    assert np.isfinite(found.positions).all()
