# SPDX-License-Identifier: GPL-3.0-or-later
"""Weights of wings and horns, which stand off from the body that they touch."""

import numpy as np
import pytest
from scipy.sparse import csr_array

from engine import TriangleMesh
from engine.mesh.connectivity.welded_parts import WeldedParts
from engine.retarget.weights.loose_weights import with_loose_parts
from engine.retarget.weights.skin_weights import row_sums
from tests.engine.mesh.connectivity.test_welded_parts import together
from tests.shapes import icosphere, permuted, plane

BODY = icosphere(6)
WING = plane(9)
SIZE = len(BODY[0])


def winged():
    """A sphere and a square that stands off from it, with the distance of its vertices from the sphere."""
    vertices, triangles = together(BODY, (WING[0] + [1, -0.5, 0], WING[1]))
    return vertices, triangles, np.concatenate([np.zeros(SIZE), WING[0][:, 0]])


def stretched(away):
    """The body has one bone, and the wing goes over to another one towards its tip."""
    return csr_array(np.stack([1 - away, away], axis=1))


def test_a_wing_follows_the_body_where_it_touches_it():
    vertices, triangles, away = winged()
    parts, weights = WeldedParts.of(TriangleMesh(vertices, triangles)), stretched(away)
    result = with_loose_parts(weights, np.where(away < 0.2, 0.5, 0.0), parts)
    np.testing.assert_array_equal(result.toarray()[:SIZE], weights.toarray()[:SIZE])
    np.testing.assert_allclose(row_sums(result), 1)
    assert result.toarray()[SIZE:, 1].max() < 0.15
    assert result.data.min() >= 0


def test_where_the_map_is_sure_nothing_changes():
    vertices, triangles, away = winged()
    weights = stretched(away)
    result = with_loose_parts(weights, np.full(len(away), 0.7), WeldedParts.of(TriangleMesh(vertices, triangles)))
    np.testing.assert_allclose(result.toarray(), weights.toarray(), atol=0.01)


@pytest.mark.parametrize("confidence", [0.0, 1.0], ids=["nowhere", "on the body"])
def test_a_part_without_any_confidence_keeps_its_mean(confidence):
    vertices, triangles, away = winged()
    parts, weights = WeldedParts.of(TriangleMesh(vertices, triangles)), stretched(away)
    result = with_loose_parts(weights, np.where(np.arange(len(away)) < SIZE, confidence, 0.0), parts)
    if not confidence:
        assert result is weights
    else:
        np.testing.assert_allclose(result.toarray()[SIZE:, 1], 0.5, atol=0.1)


@pytest.mark.parametrize("scale", [1e-3, 1e3])
def test_scale_order_and_how_sure_the_whole_is_do_not_matter(scale):
    vertices, triangles, away = winged()
    confidence = 1 / (1 + (away / 0.2) ** 2)
    parts = WeldedParts.of(TriangleMesh(vertices, triangles))
    before = with_loose_parts(stretched(away), confidence, parts).toarray()
    moved, turned, order = permuted(scale * vertices, triangles)
    there = np.empty(len(away))
    there[order] = away
    sure = np.empty(len(away))
    sure[order] = confidence / 3
    after = with_loose_parts(stretched(there), sure, WeldedParts.of(TriangleMesh(moved, turned))).toarray()
    np.testing.assert_allclose(after[order], before, atol=1e-6)


def test_a_lone_vertex_stays():
    vertices, triangles, away = winged()
    parts = WeldedParts.of(TriangleMesh(np.concatenate([vertices, [[5, 5, 5]]]), triangles))
    weights = stretched(np.append(away, 0.5))
    result = with_loose_parts(weights, np.append(1 / (1 + (away / 0.05) ** 2), 0.0), parts)
    np.testing.assert_array_equal(result.toarray()[-1], [0.5, 0.5])
