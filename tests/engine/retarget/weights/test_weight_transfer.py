# SPDX-License-Identifier: GPL-3.0-or-later
"""Weights carried and put in: what is new, locked, shared, and gives way."""

import numpy as np
import pytest
from scipy.sparse import csr_array

from engine import MatchError, SurfaceMap, SurfacePoints, TriangleMesh, run
from engine.retarget.weights.skin_weights import carried, row_differences, row_sums
from engine.retarget.weights.weight_transfer import Columns, carry_weights_steps, put_in
from tests.engine.retarget.weights.test_rigid_parts import body_with_eye, onto
from tests.engine.retarget.weights.test_weight_rejection import broken
from tests.shapes import creature, cut_open
from tests.skeletons import creature_weights


def sparse(rows):
    return csr_array(np.array(rows, float))


def columns(new, locked=None, shared=None, *, yielding=False):
    count = len(new)
    return Columns(
        np.array(locked or [False] * count), np.array(new), np.array(shared or [True] * count), yielding=yielding
    )


def test_torn_vertices_are_filled_in_and_told():
    vertices, triangles, rest = creature(0.0, 9)
    mesh, weights = TriangleMesh(vertices, triangles), creature_weights(rest)
    surface_map, astray = broken(mesh, [(3, ([0.46, 0.2, -0.8], [-0.5, -0.2, -0.7]))])
    result = run(carry_weights_steps(weights, mesh, mesh, surface_map))
    assert result.torn[astray].all()
    assert row_differences(result.weights, weights)[astray].max() < 0.2
    plain = run(carry_weights_steps(weights, mesh, mesh, surface_map, fill=False))
    assert not plain.torn.any()
    np.testing.assert_array_equal(plain.weights.toarray(), carried(weights, surface_map).toarray())
    # A mask that is no bone's tears nothing.
    mask = csr_array((np.arange(mesh.vertex_count) % 2).astype(float)[:, None])
    both = csr_array(np.concatenate([np.ones((mesh.vertex_count, 1)), mask.toarray()], axis=1))
    told = run(carry_weights_steps(both, mesh, mesh, surface_map, telling=np.array([True, False])))
    assert not told.torn.any()


def test_a_loose_part_moves_as_one_or_by_one_bone_or_as_the_map_has_it():
    (source, source_eye), (target, eye) = body_with_eye(8, 3), body_with_eye(6, 2)
    height = 0.5 + source.vertices[:, 0] / 3
    weights = csr_array(np.stack([np.where(source_eye, 0.25, height), np.where(source_eye, 0.75, 1 - height)], axis=1))
    to_source = onto(target, source)
    triangles = to_source.triangles.copy()
    triangles[np.flatnonzero(eye)[:4]] = 0  # which go astray
    to_source = SurfaceMap.from_barycentric(source, triangles, to_source.barycentric)
    strays = carried(weights, to_source).toarray()[eye]
    for known, expected in ((0, [[0.25, 0.75]]), (1, [[0.0, 1.0]]), (-1, strays)):
        pieces = np.where(eye, known, 0)
        result = run(carry_weights_steps(weights, source, target, to_source, fill=False, pieces=pieces))
        np.testing.assert_allclose(result.weights.toarray()[eye], np.broadcast_to(expected, strays.shape))


def test_weights_and_maps_of_other_meshes_are_refused():
    vertices, triangles, rest = creature(0.0, 5)
    mesh, few = TriangleMesh(vertices, triangles), TriangleMesh(np.eye(3), [[0, 1, 2]])
    weights, own = csr_array(creature_weights(rest)), SurfaceMap.identity(mesh)
    with pytest.raises(MatchError, match="leads to a mesh of"):
        run(carry_weights_steps(weights, few, mesh, own))
    with pytest.raises(MatchError, match="one of 3 vertices"):
        run(carry_weights_steps(weights, mesh, mesh, SurfaceMap.identity(few)))
    with pytest.raises(MatchError, match="weights of 3 vertices"):
        run(carry_weights_steps(csr_array(np.ones((3, 1))), mesh, mesh, own))


def test_what_has_no_partner_takes_the_weights_around_it_if_wanted():
    vertices, triangles, rest = creature(0.0, 9)
    mesh, weights = TriangleMesh(vertices, triangles), creature_weights(rest)
    alone = np.abs(rest[:, 0] - 1.15) < 0.1  # a part of the head, where the map leads to the tail
    wrong = np.where(alone, int(rest[:, 0].argmin()), np.arange(mesh.vertex_count))
    back = SurfaceMap(SurfacePoints.at_vertices(mesh, wrong), np.ones(len(wrong)), mesh.vertex_count, ~alone)
    plain, filled = (
        run(carry_weights_steps(weights, mesh, mesh, back, fill=False, fill_alone=wanted)).weights
        for wanted in (False, True)
    )
    assert row_differences(filled, weights)[alone].mean() < row_differences(plain, weights)[alone].mean() / 2
    np.testing.assert_allclose(filled.toarray()[~alone], plain.toarray()[~alone], atol=1e-12)


@pytest.mark.parametrize("fill", [False, True])
def test_what_was_cut_open_at_seams_gets_the_same_weights(fill):
    vertices, triangles, rest = creature(0.0, 9)
    mesh, weights = TriangleMesh(vertices, triangles), creature_weights(rest)
    vertices, triangles, home = cut_open(vertices, triangles, mesh.vertices[triangles].mean(axis=1)[:, 0] > 0.1)
    barycentric = SurfaceMap.identity(mesh).barycentric[home]
    barycentric[mesh.vertex_count :] = 1 / 3
    back = SurfaceMap.from_barycentric(mesh, SurfaceMap.identity(mesh).triangles[home], barycentric)
    target = TriangleMesh(vertices, triangles)
    got = run(carry_weights_steps(weights, mesh, target, back, fill=fill)).weights
    assert row_differences(carried(weights, back), carried(weights, back)[home]).max() > 0.01
    assert row_differences(got, got[home]).max() == 0
    np.testing.assert_allclose(row_sums(got), 1)


def test_new_weights_replace_what_was_there_and_sum_to_one():
    result = put_in(sparse([[1, 0], [1, 0]]), sparse([[0, 0.5], [0.2, 0.6]]), columns([True, True]))
    np.testing.assert_allclose(result.toarray(), [[0, 1], [0.25, 0.75]])


def test_locked_columns_stay_and_others_share_the_rest():
    result = put_in(sparse([[0.4, 1]]), sparse([[0.9, 0.1]]), columns([True, True], [True, False]))
    np.testing.assert_allclose(result.toarray(), [[0.4, 0.6]])


def test_columns_that_are_not_shared_are_no_part_of_the_whole():
    result = put_in(
        sparse([[0, 0, 0.2]]), sparse([[0.5, 0.5, 0.7]]), columns([True] * 3, shared=[True, True, False]), limit=1
    )
    np.testing.assert_allclose(result.toarray(), [[1, 0, 0.7]])


def test_other_columns_give_way_to_some():
    before = sparse([[0.5, 0.5, 0], [0, 0.2, 0.8], [0, 0, 0], [0.9, 0.1, 0]])
    new = sparse([[0, 0, 0.4], [0, 0, 1], [0, 0, 0.3], [0, 0, 0]])
    which = columns([False, False, True], [False, True, False], yielding=True)
    result = put_in(before, new, which).toarray()
    np.testing.assert_allclose(result, [[0.1, 0.5, 0.4], [0, 0.2, 0.8], [0, 0, 0.3], [0.9, 0.1, 0]])
    kept = put_in(before, new, which, normalise=False).toarray()
    np.testing.assert_allclose(kept, [[0.5, 0.5, 0.4], [0, 0.2, 1], [0, 0, 0.3], [0.9, 0.1, 0]])


def test_tiny_weights_go_and_tiny_masks_entirely():
    which = columns([True] * 3, shared=[True, True, False])
    result = put_in(csr_array((1, 3)), sparse([[0.004, 0.996, 0.004]]), which, threshold=0.01)
    np.testing.assert_allclose(result.toarray(), [[0, 1, 0]])
    assert result.nnz == 1


@pytest.mark.parametrize("limit", [0, 1, 2, 4])
def test_limits_and_sums_go_together(limit):
    random = np.random.default_rng(limit)
    new = csr_array(random.dirichlet(np.ones(6), 50))
    result = put_in(csr_array((50, 6)), new, columns([True] * 6), threshold=0.01, limit=limit)
    np.testing.assert_allclose(row_sums(result), 1)
    assert np.diff(result.indptr).max() <= (limit or 6)


def test_added_weights():
    result = put_in(sparse([[0.5, 0.5]]), sparse([[1, 0]]), columns([True, True]), factor=0.5, add=True)
    np.testing.assert_allclose(result.toarray(), [[2 / 3, 1 / 3]])
