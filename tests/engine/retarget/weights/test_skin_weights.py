# SPDX-License-Identifier: GPL-3.0-or-later
"""Arithmetic of sparse weights: what sums to one, what is locked, what goes, and that nothing jumps."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.sparse import csr_array

from engine import MatchError, RigError, SurfaceMap, TriangleMesh
from engine.retarget.weights.skin_weights import (
    carried,
    limited,
    mixed,
    normalised,
    pruned,
    row_differences,
    row_sums,
    with_rows,
)
from tests.shapes import icosphere


def sparse(rows):
    return csr_array(np.array(rows, float))


def random_weights(seed, rows=40, columns=9, share=0.6):
    random = np.random.default_rng(seed)
    dense = random.random((rows, columns)) * (random.random((rows, columns)) < share)
    return csr_array(dense)


seeds = st.integers(0, 10_000)


def test_the_identity_carries_weights_as_they_are():
    mesh = TriangleMesh(*icosphere(4))
    weights = random_weights(0, mesh.vertex_count)
    there = carried(weights, SurfaceMap.identity(mesh))
    np.testing.assert_allclose(there.toarray(), weights.toarray(), atol=1e-15)
    assert (there.data > 0).all()


def test_weights_are_interpolated_inside_triangles_and_sums_are_kept():
    mesh = TriangleMesh(*icosphere(4))
    weights = normalised(random_weights(1, mesh.vertex_count))
    random = np.random.default_rng(2)
    triangles = random.integers(0, mesh.triangle_count, 70)
    surface_map = SurfaceMap.from_barycentric(mesh, triangles, random.dirichlet([1, 1, 1], 70))
    there = carried(weights, surface_map)
    np.testing.assert_allclose(there.toarray(), surface_map.transfer(weights.toarray()), atol=1e-14)
    np.testing.assert_allclose(row_sums(there), surface_map.transfer(row_sums(weights)), atol=1e-14)


def test_weights_of_another_mesh_are_refused():
    mesh = TriangleMesh(*icosphere(4))
    with pytest.raises(MatchError, match="there are 7 rows"):
        carried(random_weights(0, 7), SurfaceMap.identity(mesh))


def test_normalised_rows_sum_to_one_and_empty_ones_stay_empty():
    weights = sparse([[0.2, 0.2, 0], [3, 0, 1], [0, 0, 0]])
    np.testing.assert_allclose(normalised(weights).toarray(), [[0.5, 0.5, 0], [0.75, 0, 0.25], [0, 0, 0]])
    np.testing.assert_allclose(weights.toarray(), [[0.2, 0.2, 0], [3, 0, 1], [0, 0, 0]])


def test_others_share_what_locked_columns_leave():
    locked = np.array([True, False, False])
    weights = sparse([[0.4, 0.1, 0.2], [1.0, 0.5, 0], [0.3, 0, 0], [0, 2, 2]])
    expected = [[0.4, 0.2, 0.4], [1.0, 0, 0], [0.3, 0, 0], [0, 0.5, 0.5]]
    np.testing.assert_allclose(normalised(weights, locked=locked).toarray(), expected)


@given(seeds, st.lists(st.booleans(), min_size=9, max_size=9))
@settings(max_examples=40, deadline=None)
def test_normalising_again_changes_nothing_and_locked_columns_never_change(seed, locked):
    weights, locked = random_weights(seed), np.array(locked)
    once = normalised(weights, locked=locked)
    np.testing.assert_allclose(normalised(once, locked=locked).toarray(), once.toarray(), atol=1e-12)
    np.testing.assert_array_equal(once.toarray()[:, locked], weights.toarray()[:, locked])
    had_free = weights.toarray()[:, ~locked].sum(axis=1) > 0
    full = np.maximum(weights.toarray()[:, locked].sum(axis=1), 1)
    np.testing.assert_allclose(row_sums(once)[had_free], full[had_free])


@given(seeds, st.integers(1, 9))
@settings(max_examples=40, deadline=None)
def test_the_largest_weights_stay_and_the_sum_is_kept(seed, count):
    weights = random_weights(seed)
    left = limited(weights, count)
    assert (np.diff(left.indptr) <= count).all()
    np.testing.assert_allclose(row_sums(left), row_sums(weights))
    smallest_left = np.where(left.toarray() > 0, weights.toarray(), np.inf).min(axis=1)
    largest_gone = np.where(left.toarray() > 0, 0, weights.toarray()).max(axis=1)
    assert (smallest_left >= largest_gone).all()
    few = np.diff(weights.indptr) <= count
    np.testing.assert_array_equal(left.toarray()[few], weights.toarray()[few])


def test_a_weight_fades_before_it_goes():
    def at(t):
        return limited(sparse([[0.6, 0.2 + t, 0.2 - t]]), 2).toarray()[0]

    steps = np.array([at(t) for t in np.linspace(-0.15, 0.15, 601)])
    assert np.abs(np.diff(steps, axis=0)).max() < 0.01
    np.testing.assert_allclose(steps.sum(axis=1), 1)
    np.testing.assert_allclose(steps[300], [1, 0, 0], atol=1e-12)


def test_vertices_without_weights_stay_so():
    weights = sparse([[0, 0, 0], [0.5, 0.4, 0.1], [0.5, 0.4, 0.1], [0, 0, 0]])
    np.testing.assert_allclose(limited(weights, 2).sum(axis=1), [0, 1, 1, 0])


def test_equal_weights_stay_equal_where_some_must_go():
    np.testing.assert_allclose(limited(sparse([[0.2] * 5]), 4).toarray(), [[0.25, 0.25, 0.25, 0.25, 0]])


def test_locked_weights_stay_and_count():
    locked = np.array([True, False, False, False])
    left = limited(sparse([[0.01, 0.4, 0.3, 0.1]]), 2, locked=locked).toarray()[0]
    np.testing.assert_allclose(left, [0.01, 0.8, 0, 0])
    left = limited(sparse([[0.01, 0.4, 0.3, 0.1]]), 1, locked=locked).toarray()[0]
    np.testing.assert_allclose(left, [0.01, 0, 0, 0])


def test_tiny_weights_go_but_never_the_last_one():
    locked = np.array([False, False, True])
    weights = sparse([[0.005, 0.9, 0.004], [0.002, 0.001, 0]])
    np.testing.assert_allclose(pruned(weights, 0.01, locked=locked).toarray(), [[0, 0.9, 0.004], [0.002, 0, 0]])


def test_mixing():
    before, new = sparse([[1, 0], [0.4, 0.6]]), sparse([[0, 1], [0.8, 0.2]])
    np.testing.assert_allclose(mixed(before, new).toarray(), new.toarray())
    np.testing.assert_allclose(mixed(before, new, 0).toarray(), before.toarray())
    np.testing.assert_allclose(mixed(before, new, 0.25).toarray(), [[0.75, 0.25], [0.5, 0.5]])
    np.testing.assert_allclose(mixed(before, new, 0.5, add=True).toarray(), [[1, 0.5], [0.8, 0.7]])
    locked = np.array([False, True])
    np.testing.assert_allclose(mixed(before, new, locked=locked).toarray(), [[0, 0], [0.8, 0.6]])
    np.testing.assert_allclose(mixed(before, new, add=True, locked=locked).toarray(), [[1, 0], [1, 0.6]])


def test_what_cannot_be_mixed_is_refused():
    with pytest.raises(RigError, match="cannot be mixed"):
        mixed(random_weights(0), random_weights(0, 41))
    with pytest.raises(RigError, match="from 0 to 1"):
        mixed(random_weights(0), random_weights(1), 1.5)
    with pytest.raises(RigError, match="whether it is locked"):
        normalised(random_weights(0), locked=np.zeros(3, bool))


def test_rows():
    weights = sparse([[1, 0], [0.5, 0.5], [0, 1]])
    np.testing.assert_allclose(row_differences(weights, weights[[1, 1, 0]]), [1, 0, 2])
    replaced = with_rows(weights, np.array([2, 0]), sparse([[0.1, 0], [0, 0.2]]))
    np.testing.assert_allclose(replaced.toarray(), [[0, 0.2], [0.5, 0.5], [0.1, 0]])
    assert row_sums(csr_array((3, 2))).dtype == float
