# SPDX-License-Identifier: GPL-3.0-or-later
"""Normals that turn with a deformed surface."""

from __future__ import annotations

import numpy as np
import pytest

from engine import MeshError, TriangleMesh, turned_normals
from tests.shapes import creature, cut_open, rotation

TURN = rotation([1.0, 2.0, -1.0], 2.0)


@pytest.fixture(scope="module")
def body():
    """A body, cut open, and itself in another pose, in other units; and which vertex each was before it was cut."""
    first, second = creature(0.0, 9), creature(0.7, 9)
    centres = first[0][first[1]].mean(axis=1)
    vertices, triangles, home = cut_open(*first[:2], centres[:, 1] > 0)
    return TriangleMesh(vertices, triangles), 30 * second[0][home], home


def smooth(body):
    """Normals of all corners as if the body had not been cut open."""
    mesh, _, home = body
    whole = TriangleMesh(mesh.vertices[: home.max() + 1], home[mesh.triangles])
    return whole.vertex_normals[home[mesh.triangles.ravel()]]


def test_a_rotation_turns_all_alike(body):
    mesh = body[0]
    normals = np.random.default_rng(3).normal(size=(3 * mesh.triangle_count, 3))
    normals /= np.linalg.norm(normals, axis=1, keepdims=True)
    turned = turned_normals(normals, mesh.triangles.ravel(), mesh, 7 * mesh.vertices @ TURN.T + [1, 2, 3])
    np.testing.assert_allclose(turned, normals @ TURN.T, atol=1e-6)


def test_smooth_normals_stay_smooth_and_alike_along_seams(body):
    mesh, positions, home = body
    corners = mesh.triangles.ravel()
    turned = turned_normals(smooth(body), corners, mesh, positions)
    whole = TriangleMesh(positions[: home.max() + 1], home[mesh.triangles])
    np.testing.assert_allclose(turned, whole.vertex_normals[home[corners]], atol=1e-6)


def test_as_many_normals_as_corners(body):
    mesh = body[0]
    with pytest.raises(MeshError, match="one normal for each"):
        turned_normals(np.zeros((3, 3)), mesh.triangles.ravel(), mesh, mesh.vertices)
