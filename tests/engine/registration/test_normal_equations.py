# SPDX-License-Identifier: GPL-3.0-or-later
"""Surfaces drawn to points: the same solutions as those of the full matrix, for one set of points after another."""

import numpy as np
import pytest
from scipy.sparse import csr_array

from engine import TriangleMesh
from engine.geometry.laplacian import laplace_beltrami
from engine.mesh.closest_points import FoundPoints
from engine.registration.normal_equations import NormalEquations
from tests.shapes import creature


@pytest.fixture(scope="module")
def body():
    mesh = TriangleMesh(*creature(0.4, 9)[:2])
    # On the intrinsic triangulation, which joins other vertices than the triangles do.
    stiffness = laplace_beltrami(mesh).stiffness
    return mesh, stiffness, NormalEquations(stiffness, mesh.triangles)


def some_points(mesh, count, seed):
    random = np.random.default_rng(seed)
    barycentric = random.dirichlet([1, 1, 1], count)
    return FoundPoints(random.integers(mesh.triangle_count, size=count), barycentric, np.zeros(count))


def evaluation(mesh, points):
    """Matrix (k, n) of the points' barycentric coordinates."""
    rows = np.repeat(np.arange(len(points)), 3)
    columns = mesh.triangles[points.triangles].ravel()
    return csr_array((points.barycentric.ravel(), (rows, columns)), shape=(len(points), mesh.vertex_count))


@pytest.mark.parametrize("seed", [0, 1])
def test_the_solution_is_that_of_the_full_matrix(seed, body):
    mesh, stiffness, equations = body
    random = np.random.default_rng(seed)
    points = some_points(mesh, 300, seed)
    own, weights = random.uniform(0.1, 2, mesh.vertex_count), random.uniform(0, 5, 300)
    right = random.normal(size=(mesh.vertex_count, 3))
    evaluate = evaluation(mesh, points).toarray()
    full = stiffness.toarray() + np.diag(own) + evaluate.T @ (weights[:, None] * evaluate)
    solve = equations.solver(own, points, weights, stiffness)
    np.testing.assert_allclose(solve(right), np.linalg.solve(full, right), rtol=1e-8, atol=1e-10)
    np.testing.assert_allclose(solve(right[:, :1]), np.linalg.solve(full, right[:, :1]), rtol=1e-8, atol=1e-10)


def test_points_in_the_same_place_and_none_at_all(body):
    mesh, stiffness, equations = body
    own, right = np.ones(mesh.vertex_count), mesh.vertices
    once = some_points(mesh, 1, 3)
    twice = FoundPoints(once.triangles.repeat(2), once.barycentric.repeat(2, axis=0), np.zeros(2))
    together = equations.solver(own, twice, np.array([1.0, 2.0]), stiffness)(right)
    np.testing.assert_allclose(together, equations.solver(own, once, np.array([3.0]), stiffness)(right), rtol=1e-9)
    free = equations.solver(own, some_points(mesh, 0, 0), np.empty(0), stiffness)(right)
    np.testing.assert_allclose(stiffness @ free + free, right, atol=1e-9)


def test_forces_are_shared_out_by_the_barycentric_coordinates(body):
    mesh, _, equations = body
    points = some_points(mesh, 50, 5)
    forces = np.random.default_rng(6).normal(size=(50, 3))
    np.testing.assert_allclose(equations.pull(points, forces), evaluation(mesh, points).T @ forces, atol=1e-12)


def test_another_stiffness_at_the_same_places(body):
    mesh, stiffness, equations = body
    points = some_points(mesh, 200, 5)
    own, weights = np.full(mesh.vertex_count, 0.5), np.full(200, 2.0)
    entries = stiffness.tocoo()
    factors = np.random.default_rng(5).uniform(0.2, 3, mesh.vertex_count)
    other = csr_array((entries.data * factors[entries.row] * factors[entries.col], (entries.row, entries.col)))
    evaluate = evaluation(mesh, points).toarray()
    full = other.toarray() + np.diag(own) + evaluate.T @ (weights[:, None] * evaluate)
    solved = equations.solver(own, points, weights, other)(mesh.vertices)
    np.testing.assert_allclose(solved, np.linalg.solve(full, mesh.vertices), rtol=1e-8, atol=1e-10)
    # The equations themselves are as they were.
    full += stiffness.toarray() - other.toarray()
    solved = equations.solver(own, points, weights, stiffness)(mesh.vertices)
    np.testing.assert_allclose(solved, np.linalg.solve(full, mesh.vertices), rtol=1e-8, atol=1e-10)
