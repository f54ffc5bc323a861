# SPDX-License-Identifier: GPL-3.0-or-later
"""Similarities fitted to a map of a surface."""

import numpy as np
import pytest

from engine import SurfacePoints, TriangleMesh
from engine.dense.components.similarity_field import Surroundings
from tests.shapes import creature, icosphere, posed, rotation


@pytest.mark.parametrize("mirror", [1, -1])
@pytest.mark.parametrize("shape", [icosphere(1), icosphere(12), creature(0.0, 11)[:2]])
def test_a_similarity_is_found_exactly(shape, mirror):
    mesh = TriangleMesh(*shape)
    turn = rotation([1, 2, 3], 1.0) * [mirror, 1, 1]
    other = TriangleMesh(mesh.vertices @ turn.T * 2.5 + [1, 2, 3], mesh.triangles[:, ::mirror])
    around = Surroundings(mesh, other, SurfacePoints.at_vertices(other, np.arange(mesh.vertex_count)))
    random = np.random.default_rng(0)
    points, reach = random.normal(size=(60, 3)), 10 ** random.uniform(-3, 1, 60)
    found = around.similarities(points, reach)
    assert np.allclose(found(points), points @ turn.T * 2.5 + [1, 2, 3])
    assert np.allclose(found.scales, 2.5)
    assert np.allclose(found.rotations, turn)


def test_a_bent_limb_is_followed():
    _, triangles, rest = creature(0.0, 13)
    mesh, other = TriangleMesh(rest, triangles), TriangleMesh(posed(rest, 0.8), triangles)
    around = Surroundings(mesh, other, SurfacePoints.at_vertices(other, np.arange(len(rest))))
    points = rest + 0.05 * mesh.vertex_normals
    distances, nearest = around.nearest(points)
    assert (distances <= 0.05 + 1e-12).all()
    assert np.allclose(np.linalg.norm(rest[nearest] - points, axis=1), distances)
    errors = np.linalg.norm(around.similarities(points, distances)(points) - posed(points, 0.8), axis=1)
    assert np.median(errors) < 0.01
    assert errors.max() < 0.06


def test_a_collapsed_map_does_not_shrink_what_follows_to_nothing():
    mesh = TriangleMesh(*icosphere(3))
    collapsed = SurfacePoints.at_vertices(mesh, np.zeros(mesh.vertex_count, np.int64))
    points = np.array([[0.0, 0, 2]])
    found = Surroundings(mesh, mesh, collapsed).similarities(points, np.ones(1))
    assert np.isfinite(found(points)).all()
    assert found.scales[0] == pytest.approx(0.25)
