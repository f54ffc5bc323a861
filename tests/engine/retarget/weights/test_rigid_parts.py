# SPDX-License-Identifier: GPL-3.0-or-later
"""Eyes and buttons that keep their shape."""

import numpy as np
from scipy.sparse import csr_array

from engine import ClosestPoints, SurfaceMap, TriangleMesh
from engine.mesh.connectivity.welded_parts import WeldedParts
from engine.retarget.weights.rigid_parts import with_rigid_parts
from engine.retarget.weights.skin_weights import carried
from tests.engine.mesh.connectivity.test_welded_parts import together
from tests.shapes import icosphere


def body_with_eye(subdivisions, eye):
    body, ball = icosphere(subdivisions), icosphere(eye)
    mesh = TriangleMesh(*together(body, (0.05 * ball[0] + [0, 0, 1.1], ball[1])))
    return mesh, np.arange(mesh.vertex_count) >= len(body[0])


def onto(domain, image):
    found = ClosestPoints(image).nearest(domain.vertices)
    return SurfaceMap.from_barycentric(image, found.triangles, found.barycentric)


def test_a_part_moves_as_one_if_its_counterpart_does():
    source, source_eye = body_with_eye(8, 3)
    target, eye = body_with_eye(6, 2)
    height = 0.5 + source.vertices[:, 0] / 3
    weights = csr_array(np.stack([np.where(source_eye, 0.25, height), np.where(source_eye, 0.75, 1 - height)], axis=1))
    to_source = onto(target, source)
    # Some of its vertices go astray.
    triangles, stray = to_source.triangles.copy(), np.flatnonzero(eye)[:4]
    triangles[stray] = 0
    to_source = SurfaceMap.from_barycentric(source, triangles, to_source.barycentric)
    plain = carried(weights, to_source)
    parts = WeldedParts.of(target), weights, WeldedParts.of(source)
    result = with_rigid_parts(plain, *parts, to_source).toarray()
    np.testing.assert_allclose(result[eye], np.tile([0.25, 0.75], (eye.sum(), 1)))
    np.testing.assert_array_equal(result[~eye], plain.toarray()[~eye])
    assert abs(plain.toarray()[stray] - [0.25, 0.75]).max() > 0.1


def test_a_part_bends_if_its_counterpart_does_and_one_part_is_none_beside_others():
    source, _ = body_with_eye(8, 3)
    target, _ = body_with_eye(6, 2)
    height = 0.5 + source.vertices[:, 0] / 3
    weights = csr_array(np.stack([height, 1 - height], axis=1))
    to_source = onto(target, source)
    plain = carried(weights, to_source)
    kept = with_rigid_parts(plain, WeldedParts.of(target), weights, WeldedParts.of(source), to_source)
    np.testing.assert_array_equal(kept.toarray(), plain.toarray())
    ball = TriangleMesh(*icosphere(4))
    even = csr_array(np.full((ball.vertex_count, 2), 0.5))
    parts = WeldedParts.of(ball)
    assert with_rigid_parts(even, parts, even, parts, SurfaceMap.identity(ball)) is even
