# SPDX-License-Identifier: GPL-3.0-or-later
"""Eyes and buttons that keep their shape."""

import numpy as np
from scipy.sparse import csr_array

from engine import ClosestPoints, SurfaceMap, TriangleMesh
from engine.mesh.connectivity.welded_parts import WeldedParts
from engine.retarget.weights.rigid_parts import with_rigid_parts, with_single_bones
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
    for free in (np.array([True, True]), np.array([False, False])):
        freed = with_rigid_parts(plain, *parts, to_source, free=free).toarray()
        np.testing.assert_array_equal(freed, plain.toarray() if free.all() else result)


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


def plates(subdivisions, heights, size=0.45):
    """Balls one above the other, each half as high as wide, and which of them each vertex belongs to."""
    ball = icosphere(subdivisions)
    pieces = [(size * ball[0] * [1, 1, 0.5] + [0, 0, height], ball[1]) for height in heights]
    mesh = TriangleMesh(*together(*pieces))
    return mesh, np.repeat(np.arange(len(heights)), len(ball[0]))


def test_a_large_part_moves_as_one_if_nearly_all_of_it_lies_on_plates_that_move_alike():
    source, plate = plates(4, [0, 0.5, 1, 1.5])
    bones = np.array([0, 1, 1, 2])[plate]  # the two in the middle move alike
    weights = csr_array(np.eye(3)[bones])
    target, piece = plates(3, [0, 0.75, 1.5])
    to_source = onto(target, source)
    plain = carried(weights, to_source)
    parts = WeldedParts.of(target)
    assert not parts.small.any()
    result = with_rigid_parts(plain, parts, weights, WeldedParts.of(source), to_source)
    np.testing.assert_array_equal(result.toarray()[piece == 1], np.tile([0, 1, 0], ((piece == 1).sum(), 1)))
    np.testing.assert_array_equal(result.toarray(), np.eye(3)[piece])
    free = np.ones(3, bool)
    left = with_rigid_parts(plain, parts, weights, WeldedParts.of(source), to_source, free=free)
    np.testing.assert_array_equal(left.toarray(), plain.toarray())


def test_a_body_beside_a_button_stays_soft_on_a_source_of_plates():
    source, plate = plates(4, [0, 0.5, 1, 1.5])
    weights = csr_array(np.eye(4)[plate])
    body, ball = icosphere(6), icosphere(2)
    target = TriangleMesh(
        *together((body[0] * [0.5, 0.5, 1] + [0, 0, 0.75], body[1]), (0.05 * ball[0] + [0, 0, 2], ball[1]))
    )
    to_source = onto(target, source)
    plain = carried(weights, to_source)
    result = with_rigid_parts(plain, WeldedParts.of(target), weights, WeldedParts.of(source), to_source)
    soft = slice(len(body[0]))
    np.testing.assert_array_equal(result.toarray()[soft], plain.toarray()[soft])


def test_chosen_parts_move_by_the_bone_that_has_most_weight_there():
    mesh, piece = plates(3, [0, 2, 4])
    bones = np.stack(
        [np.where(piece == 1, 0.7, 0.2), np.where(piece == 1, 0.3, 0.8), np.linspace(0, 1, len(piece))], axis=1
    )
    bones[piece == 2] = 0
    weights = csr_array(bones)
    parts = WeldedParts.of(mesh)
    chosen = np.zeros(3, bool)
    chosen[parts.vertex_labels[piece >= 1]] = True
    result = with_single_bones(weights, parts, chosen, np.array([True, True, False])).toarray()
    np.testing.assert_array_equal(result[piece == 0], bones[piece == 0])
    np.testing.assert_array_equal(result[piece == 1][:, :2], np.tile([1, 0], ((piece == 1).sum(), 1)))
    np.testing.assert_array_equal(result[piece == 1][:, 2], bones[piece == 1][:, 2])  # no bone: a mask
    np.testing.assert_array_equal(result[piece == 2], bones[piece == 2])  # nothing to choose from
