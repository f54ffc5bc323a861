# SPDX-License-Identifier: GPL-3.0-or-later
"""Distances between points inside triangles."""

import numpy as np
import pytest

from engine import Shape, SurfacePoints, TriangleMesh, run, use_processes
from engine.shapes.surface_distances import EmbeddedDistances, SurfaceDistances, squared_offsets, symmetric_roots
from tests.shapes import icosphere, plane, plane_with_hole, torus


def shape_of(mesh):
    return Shape(TriangleMesh(*mesh))


def random_points(mesh, count, seed=0):
    random = np.random.default_rng(seed)
    triangles = random.integers(0, mesh.triangle_count, count)
    return SurfacePoints.from_barycentric(mesh, triangles, random.dirichlet([1, 1, 1], count))


@pytest.fixture
def alone():
    """Count what is done in this process, where all of it is."""
    use_processes(1)
    yield
    use_processes()


@pytest.fixture
def flat():
    return shape_of(plane(15, size=3.0, jitter=0.35, seed=2))


def test_in_the_plane_distances_are_straight(flat):
    distances = SurfaceDistances(flat)
    points = random_points(flat.mesh, 60)
    # some in one triangle, and some in two that share an edge
    points = SurfacePoints.from_barycentric(flat.mesh, np.append(points.triangles[:40], [0] * 20), points.barycentric)
    run(distances.prepare_steps(points))
    # What is left is the error of fast marching at some needles: edges are 0.07 long.
    straight = np.linalg.norm(points.positions[:, None] - points.positions, axis=2) / 3.0
    error = np.abs(symmetric_roots(distances.squares_between(points)) - straight)
    assert error.max() < 1e-2
    assert error.mean() < 2e-4
    squares = distances.squares_to_vertices(points, np.arange(flat.mesh.vertex_count))
    straight = np.linalg.norm(points.positions[:, None] - flat.mesh.vertices, axis=2) / 3.0
    error = np.abs(np.sqrt(np.maximum(squares, 0)) - straight)
    assert error.max() < 1e-2
    assert error.mean() < 2e-4


def test_distances_of_a_triangle_to_itself_are_exact(flat):
    random = np.random.default_rng(1)
    points = SurfacePoints.from_barycentric(flat.mesh, np.full(10, 7), random.dirichlet([1, 1, 1], 10))
    distances = SurfaceDistances(flat)
    run(distances.prepare_steps(points))
    straight = np.linalg.norm(points.positions[:, None] - points.positions, axis=2) / 3.0
    np.testing.assert_allclose(symmetric_roots(distances.squares_between(points)), straight, atol=1e-6)


def test_on_a_sphere_they_are_closer_than_those_of_the_nearest_vertices():
    shape = shape_of(icosphere(8))
    points = random_points(shape.mesh, 80)
    distances = SurfaceDistances(shape)
    run(distances.prepare_steps(points))
    unit = points.positions / np.linalg.norm(points.positions, axis=1, keepdims=True)
    great_circle = np.arccos(np.clip(unit @ unit.T, -1, 1)) / shape.scale
    smooth = great_circle * shape.scale < 2.8  # beyond, other shortest paths are as short
    error = np.abs(symmetric_roots(distances.squares_between(points)) - great_circle)[smooth]
    rounded = shape.solver.distances(points.nearest_vertices)[:, points.nearest_vertices] / shape.scale
    assert error.max() < 0.015
    assert error.mean() < 0.3 * np.abs(rounded - great_circle)[smooth].mean()


@pytest.mark.parametrize("surface", [plane(15, size=3.0, jitter=0.35, seed=2), torus(30, 15)])
def test_by_nearest_vertices_they_are_almost_the_same(surface):
    shape = shape_of(surface)
    points = random_points(shape.mesh, 50)
    distances, fewer = SurfaceDistances(shape), SurfaceDistances(shape)
    run(distances.prepare_steps(points))
    run(fewer.prepare_nearest_steps(points))
    exact, near = (
        np.square(symmetric_roots(d)) for d in (distances.squares_between(points), fewer.squares_by_nearest(points))
    )
    edge = shape.mesh.edge_lengths.max() / shape.scale
    far = exact > (3 * edge) ** 2
    rounded = np.square(
        symmetric_roots(fewer.squares_between(SurfacePoints.at_vertices(shape.mesh, points.nearest_vertices)))
    )
    assert np.percentile(np.abs(near - exact)[far], 95) < edge**2
    assert np.abs(near - exact)[far].mean() < 0.1 * np.abs(rounded - exact)[far].mean()


def test_at_vertices_they_are_the_solvers():
    shape = shape_of(torus(20, 10))
    vertices = np.array([3, 50, 120, 121])
    points = SurfacePoints.at_vertices(shape.mesh, vertices)
    distances = SurfaceDistances(shape)
    run(distances.prepare_steps(points))
    rows = shape.solver.distances(vertices) / shape.scale
    squares = distances.squares_to_vertices(points, np.arange(shape.mesh.vertex_count))
    np.testing.assert_allclose(squares, rows**2, atol=1e-6)
    np.testing.assert_allclose(distances.squares_between(points), rows[:, vertices] ** 2, atol=1e-6)


def test_they_are_symmetric_and_continuous_across_edges():
    shape = shape_of(plane_with_hole(12))
    mesh = shape.mesh
    a, b = mesh.edges[~(mesh.edges[:, None] == mesh.boundary_edges[:, None].T.reshape(1, -1, 2)).all(axis=2).any(1)][30]
    sides = np.flatnonzero(np.isin(mesh.triangles, [a, b]).sum(axis=1) == 2)
    assert len(sides) == 2
    corners = mesh.triangles[sides]
    on_edge = SurfacePoints.from_barycentric(mesh, sides, 0.3 * (corners == a) + 0.7 * (corners == b))
    others = random_points(mesh, 20, seed=3)
    points = SurfacePoints.from_barycentric(
        mesh, np.append(sides, others.triangles), np.concatenate([on_edge.barycentric, others.barycentric])
    )
    distances = SurfaceDistances(shape)
    run(distances.prepare_steps(points))
    between = symmetric_roots(distances.squares_between(points))
    np.testing.assert_array_equal(between, between.T)
    np.testing.assert_allclose(between[0], between[1], atol=1e-6)
    assert between[0, 1] == pytest.approx(0, abs=1e-3)


@pytest.mark.usefixtures("alone")
def test_rows_are_computed_once_and_their_memory_is_bounded(monkeypatch):
    shape = shape_of(icosphere(5))
    asked = []
    original = shape.solver.distances_in_blocks
    monkeypatch.setattr(shape.solver, "distances_in_blocks", lambda rows: asked.extend(rows) or original(rows))
    distances = SurfaceDistances(shape)
    points = random_points(shape.mesh, 30)
    run(distances.prepare_steps(points))
    expected = symmetric_roots(distances.squares_between(points))
    assert sorted(asked) == sorted(set(points.corners.ravel()))
    run(distances.prepare_steps(points))
    assert len(asked) == len(set(asked))

    small = SurfaceDistances(shape, memory=4 * shape.mesh.vertex_count * 100)
    for seed in range(6):
        run(small.prepare_steps(random_points(shape.mesh, 30, seed)))
        assert len(small._rows) <= 100  # noqa: SLF001
    run(small.prepare_steps(points))
    np.testing.assert_array_equal(symmetric_roots(small.squares_between(points)), expected)


@pytest.mark.usefixtures("alone")
def test_rows_of_the_samples_are_used(monkeypatch):
    shape = shape_of(icosphere(5))
    run(shape.sample_steps(20))
    monkeypatch.setattr(shape.solver, "distances_in_blocks", lambda rows: pytest.fail("again") if len(rows) else ())
    distances = SurfaceDistances(shape)
    points = SurfacePoints.at_vertices(shape.mesh, shape.samples.vertices)
    run(distances.prepare_steps(points))
    np.testing.assert_allclose(symmetric_roots(distances.squares_between(points)), shape.samples.distances, atol=1e-5)


def test_estimates_from_the_samples_are_not_used():
    shape = shape_of(icosphere(5))
    run(shape.sample_steps(30, 10))
    estimated = shape.limited(30, 10)
    distances = SurfaceDistances(estimated)
    points = SurfacePoints.at_vertices(shape.mesh, estimated.samples.vertices)
    run(distances.prepare_steps(points))
    true = shape.solver.distances(estimated.samples.vertices)[:, estimated.samples.vertices] / shape.scale
    np.testing.assert_allclose(symmetric_roots(distances.squares_between(points)), (true + true.T) / 2, atol=1e-5)


def test_embedded_distances_are_straight_through_their_space():
    mesh = TriangleMesh(*torus(16, 8))
    coordinates = np.random.default_rng(0).standard_normal((mesh.vertex_count, 5))
    distances = EmbeddedDistances(mesh, coordinates)
    points = random_points(mesh, 25)
    assert list(distances.prepare_steps(points)) == []
    places = points.interpolate(coordinates)
    straight = np.linalg.norm(places[:, None] - places, axis=2)
    np.testing.assert_allclose(symmetric_roots(distances.squares_between(points)), straight, atol=1e-6)
    vertices = np.array([4, 9])
    expected = np.square(places[:, None] - coordinates[vertices]).sum(axis=2)
    np.testing.assert_allclose(distances.squares_to_vertices(points, vertices), expected)
    # Inside a triangle they follow from those at its corners.
    at_corners = distances.squares_to_vertices(points, mesh.triangles[3])
    for barycentric in (np.array([0.2, 0.5, 0.3]), np.array([0.0, 0.4, 0.6])):
        offset = squared_offsets(barycentric, distances.squared_sides(np.array([3]))[0])
        expected = np.square(places - barycentric @ coordinates[mesh.triangles[3]]).sum(axis=1)
        np.testing.assert_allclose(at_corners @ barycentric - offset, expected)
