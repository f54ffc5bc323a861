# SPDX-License-Identifier: GPL-3.0-or-later
from itertools import combinations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from engine import TriangleMesh
from engine.geometry.geodesics import GeodesicSolver
from engine.geometry.orientation import orientation_agreement, signed_area_tables, signed_areas, tangent_gradient
from tests.shapes import icosphere, plane, rotation


def directions(mesh, vertices, distances):
    gradient = (tangent_gradient(mesh, vertices) @ distances.T).reshape(len(vertices), 2, -1).transpose(0, 2, 1)
    return gradient / np.maximum(np.linalg.norm(gradient, axis=2, keepdims=True), 1e-12)


@given(st.integers(0, 1000))
def test_gradient_of_a_linear_function_on_a_plane_is_exact(seed):
    rng = np.random.default_rng(seed)
    vertices, triangles = plane(8, jitter=0.3, seed=seed)
    slope = rng.standard_normal(3)
    turned = rotation(rng.standard_normal(3), rng.uniform(0, 6)) @ np.eye(3)
    mesh = TriangleMesh(vertices @ turned.T, triangles)
    normal = mesh.triangle_normals[0]
    tangential = slope - (slope @ normal) * normal
    chosen = rng.permutation(mesh.vertex_count)[:5]
    gradient = (tangent_gradient(mesh, chosen) @ (mesh.vertices @ slope)).reshape(-1, 2)
    np.testing.assert_allclose(np.linalg.norm(gradient, axis=1), np.linalg.norm(tangential), rtol=1e-9)


def test_the_frame_turns_with_the_outward_normal():
    mesh = TriangleMesh(*icosphere(8))
    x, y, _ = mesh.vertices.T
    gradient = (tangent_gradient(mesh, np.arange(mesh.vertex_count)) @ np.stack([x, y]).T).reshape(-1, 2, 2)
    # On the unit sphere the tangential parts of e_x and e_y span the area n_z.
    area = gradient[:, 0, 0] * gradient[:, 1, 1] - gradient[:, 1, 0] * gradient[:, 0, 1]
    np.testing.assert_allclose(area, mesh.vertices[:, 2], atol=0.05)


@given(st.integers(0, 10_000))
def test_agreement_is_the_correlation_of_the_signed_areas(seed):
    rng = np.random.default_rng(seed)
    u, v = rng.standard_normal((2, 3, 5, 2))
    first, second = (
        np.array(
            [
                [w[k, j, 0] * w[k, i, 1] - w[k, j, 1] * w[k, i, 0] for j, i in combinations(range(5), 2)]
                for k in range(3)
            ]
        )
        for w in (u, v)
    )
    np.testing.assert_allclose(signed_areas(u), first, atol=1e-12)
    tables, (one, other) = signed_area_tables(u), np.triu_indices(5, 1)
    np.testing.assert_array_equal(tables[:, one, other], signed_areas(u))
    np.testing.assert_array_equal(tables, -tables.transpose(0, 2, 1))
    expected = (first * second).sum(axis=1) / np.sqrt((first**2).sum(axis=1) * (second**2).sum(axis=1))
    np.testing.assert_allclose(orientation_agreement(u, v), expected, atol=1e-9)


def test_a_copy_agrees_and_a_mirror_image_disagrees():
    vertices, triangles = icosphere(8)
    vertices = vertices * [1.0, 1.3, 1.7]
    mesh = TriangleMesh(vertices, triangles)
    mirrored = TriangleMesh(vertices * [-1, 1, 1], triangles[:, ::-1])
    chosen = np.array([0, 20, 50, 90, 130, 200])
    here, there = (directions(each, chosen, GeodesicSolver(each).distances(chosen)) for each in (mesh, mirrored))
    assert orientation_agreement(here, here).min() == pytest.approx(1)
    assert orientation_agreement(here, there).max() == pytest.approx(-1, abs=1e-6)


def test_no_direction_says_nothing():
    assert orientation_agreement(np.zeros((2, 4, 2)), np.ones((2, 4, 2))).tolist() == [0, 0]
