# SPDX-License-Identifier: GPL-3.0-or-later
"""One side of a posed body, whose mirror images are known, taken to the other."""

import numpy as np
import pytest
from scipy.sparse import csr_array

from engine import ClosestPoints, MatchError, SurfaceMap, TriangleMesh
from engine.retarget.values.symmetrising import Symmetriser
from tests.bodies import mirrored_body
from tests.shapes import icosphere

MIRROR = np.diag([1.0, -1.0, 1.0])


@pytest.fixture(scope="module")
def body():
    """A posed body, where its vertices are at rest (mirror images differ in the sign of y), and its true self-map."""
    vertices, triangles, rest = mirrored_body(0.6, 9, seed=0)
    mesh = TriangleMesh(vertices, triangles)
    there = ClosestPoints(TriangleMesh(rest, triangles)).nearest(rest @ MIRROR)
    return mesh, rest, SurfaceMap.from_barycentric(mesh, there.triangles, there.barycentric)


@pytest.fixture(scope="module")
def ball():
    """A sphere, symmetric about y = 0, with its map to itself."""
    mesh = TriangleMesh(*icosphere(8))
    found = ClosestPoints(mesh).nearest(mesh.vertices @ MIRROR)
    return mesh, SurfaceMap.from_barycentric(mesh, found.triangles, found.barycentric)


@pytest.mark.parametrize("hint", ["everywhere", "a hand", "one side only", "the pose"])
def test_sides_are_told_apart_by_little(body, hint):
    mesh, rest, mirror = body
    hints = {
        "everywhere": rest[:, 1],
        "a hand": np.sign(rest[:, 1]) * (rest[:, 2] < -0.7),
        "one side only": 1.0 * (rest[:, 1] > 0) * (rest[:, 2] < -0.4),
        "the pose": mesh.vertices[:, 1],
    }[hint]
    own = Symmetriser.of(mesh, mirror, hints).own
    far = np.abs(rest[:, 1]) > 0.1
    np.testing.assert_array_equal(own[far], rest[far, 1] > 0)
    assert (own[np.abs(rest[:, 1]) < 1e-6] == 0.5).all()


def test_values_and_weights(body):
    mesh, rest, mirror = body
    symmetriser = Symmetriser.of(mesh, mirror, rest[:, 1])
    left, right = np.maximum(rest[:, 1], 0), np.maximum(-rest[:, 1], 0)
    values = np.where(rest[:, 1] >= 0, rest[:, 0], 7.0)
    far = np.abs(rest[:, 1]) > 0.1
    np.testing.assert_allclose(symmetriser.values(values)[far], rest[far, 0], atol=0.03)
    weights = csr_array(np.stack([left, 0.3 * right, np.ones(len(rest))], axis=1))
    made = symmetriser.weights(weights, np.array([1, 0, 2])).toarray()
    np.testing.assert_allclose(made[far, 1], right[far], atol=0.03)
    np.testing.assert_allclose(made[:, 0], left, atol=0.03)
    np.testing.assert_allclose(made[:, 2], 1)


def test_offsets_are_reflected(ball):
    mesh, mirror = ball
    symmetriser = Symmetriser.of(mesh, mirror, mesh.vertices[:, 1])
    bump = np.exp(-((mesh.vertices - [0, 0.9, 0.3]) ** 2).sum(axis=1) / 0.1)[:, None]
    offsets = bump * [0.3, 1.0, 0.2]
    # A key of the left, and what was there for the right: wrong.
    made = symmetriser.offsets(np.stack([offsets, 0 * offsets + 0.01]), np.array([1, 0]))
    expected = np.exp(-((mesh.vertices - [0, -0.9, 0.3]) ** 2).sum(axis=1) / 0.1)[:, None] * [0.3, -1.0, 0.2]
    right = mesh.vertices[:, 1] < -0.3
    np.testing.assert_allclose(made[1][right], expected[right], atol=0.05)
    np.testing.assert_allclose(made[0][~right & (mesh.vertices[:, 1] > 0.3)], offsets[mesh.vertices[:, 1] > 0.3])
    np.testing.assert_allclose(symmetriser.mirrored_offsets(offsets), expected, atol=0.05)


def test_a_posed_limb_is_reflected_in_its_own_frame(body):
    mesh, rest, mirror = body
    symmetriser = Symmetriser.of(mesh, mirror, rest[:, 1])
    swollen = mesh.vertex_normals
    turned = symmetriser.mirrored_offsets(swollen)
    products = np.einsum("nd,nd->n", turned / np.linalg.norm(turned, axis=1, keepdims=True), swollen)
    assert np.median(products) > 0.9  # a swelling stays one


def test_what_is_not_trusted_keeps_what_it_has(ball):
    mesh, mirror = ball
    confidence = np.where(mesh.vertices[:, 2] > 0.5, 0.0, 1.0)
    unsure = SurfaceMap(mirror.points, confidence, mesh.vertex_count)
    own = Symmetriser.of(mesh, unsure, mesh.vertices[:, 1]).own
    assert (own[confidence == 0] == 1).all()


def test_hints_that_tell_nothing_are_refused(ball):
    mesh, mirror = ball
    with pytest.raises(MatchError, match="Nothing tells the two sides apart"):
        Symmetriser.of(mesh, mirror, np.ones(mesh.vertex_count))
    with pytest.raises(MatchError, match="a map to itself"):
        Symmetriser.of(mesh, mirror, np.ones(3))
