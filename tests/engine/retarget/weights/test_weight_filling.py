# SPDX-License-Identifier: GPL-3.0-or-later
"""Gaps in weights, filled along the surface."""

import numpy as np
import pytest
from scipy.sparse import csr_array

from engine import RigError, TriangleMesh
from engine.mesh.connectivity.welded_parts import WeldedParts
from engine.retarget.weights.skin_weights import normalised, row_sums
from engine.retarget.weights.weight_filling import continued, filled
from tests.engine.mesh.connectivity.test_welded_parts import together
from tests.shapes import cylinder, icosphere, permuted, plane, plane_with_slit


def parts_of(vertices, triangles):
    return WeldedParts.of(TriangleMesh(vertices, triangles))


def shares(values):
    """Weights of two bones: a number from 0 to 1 at each vertex, and the rest."""
    return csr_array(np.stack([values, 1 - values], axis=1))


def spoilt(weights, gap):
    """The same with nonsense in the gap."""
    dense = weights.toarray()
    dense[gap] = [0.0, 7.0]
    return csr_array(dense)


def test_linear_weights_are_restored_exactly():
    vertices, triangles = plane(16, jitter=0.3)
    x = vertices[:, 0] - vertices[:, 0].min()
    weights = shares(x / x.max())
    gap = np.linalg.norm(vertices - vertices.mean(axis=0), axis=1) < 0.3 * np.ptp(vertices[:, 0])
    assert 20 < gap.sum() < len(gap) / 2
    result = filled(spoilt(weights, gap), ~gap, parts_of(vertices, triangles))
    np.testing.assert_allclose(result.toarray(), weights.toarray(), atol=1e-6)


@pytest.mark.parametrize(("strength", "own_share"), [(1e-9, 0.0), (1e9, 1.0)])
def test_what_is_held_lies_between_its_own_weights_and_those_around_it(strength, own_share):
    vertices, triangles = plane(16, jitter=0.3)
    straight = shares(vertices[:, 0] / np.ptp(vertices[:, 0]))
    gap = np.linalg.norm(vertices - vertices.mean(axis=0), axis=1) < 0.3 * np.ptp(vertices[:, 0])
    parts, own = parts_of(vertices, triangles), spoilt(straight, gap).toarray()
    own[gap] = [0.25, 0.75]
    held = np.full(gap.sum(), strength)
    found = continued(csr_array(own), gap, parts, held).toarray()
    expected = (1 - own_share) * straight.toarray()[gap] + own_share * own[gap]
    np.testing.assert_allclose(found, expected, atol=1e-6)


def test_what_is_trusted_does_not_change_and_without_any_trust_nothing_does():
    vertices, triangles = icosphere(6)
    weights = normalised(csr_array(np.random.default_rng(0).random((len(vertices), 5))))
    parts, gap = parts_of(vertices, triangles), vertices[:, 2] > 0.7
    result = filled(weights, ~gap, parts)
    np.testing.assert_array_equal(result.toarray()[~gap], weights.toarray()[~gap])
    np.testing.assert_allclose(row_sums(result), 1)
    assert result.data.min() >= 0
    assert filled(weights, np.zeros(len(vertices), bool), parts) is weights
    assert filled(weights, np.ones(len(vertices), bool), parts) is weights


@pytest.mark.parametrize("scale", [1e-4, 1e4])
def test_scale_and_vertex_order_do_not_matter(scale):
    vertices, triangles = icosphere(6)
    weights, gap = shares((vertices[:, 0] > 0).astype(float)), abs(vertices[:, 0]) < 0.4
    first = filled(weights, ~gap, parts_of(vertices, triangles)).toarray()
    other_vertices, other_triangles, order = reordered(vertices, triangles)
    other = filled(csr_array(weights[order]), ~gap[order], parts_of(scale * other_vertices, other_triangles)).toarray()
    np.testing.assert_allclose(other, first[order], atol=1e-7)


def reordered(vertices, triangles):
    """The same mesh with its vertices in another order, and which vertex each was."""
    order = np.random.default_rng(3).permutation(len(vertices))
    place = np.empty(len(vertices), int)
    place[order] = np.arange(len(vertices))
    return vertices[order], place[triangles], order


def test_nothing_bleeds_across_a_slit():
    vertices, triangles = plane_with_slit(20, 0.9)
    copies = np.arange(len(vertices)) >= 21 * 21
    vertices[copies, 0] += 0.02  # open it: else it would be a seam
    right = np.zeros(len(vertices), bool)
    right[triangles[vertices[triangles][:, :, 0].mean(axis=1) > 0.5].ravel()] = True
    gap = (abs(vertices[:, 0] - 0.5) < 0.1) & (vertices[:, 1] < 0.6)
    weights = shares(right.astype(float))
    result = filled(spoilt(weights, gap), ~gap, parts_of(vertices, triangles))
    np.testing.assert_allclose(result.toarray(), weights.toarray(), atol=1e-6)


def test_a_seam_is_no_border():
    vertices, triangles = cylinder(24, 12)
    height = (vertices[:, 2] - vertices[:, 2].min()) / np.ptp(vertices[:, 2])
    corners = triangles.ravel()
    weights, gap = shares(height[corners]), abs(height[corners] - 0.5) < 0.2
    parts = parts_of(vertices[corners], np.arange(len(corners)).reshape(-1, 3))
    result = filled(spoilt(weights, gap), ~gap, parts)
    np.testing.assert_allclose(result.toarray(), weights.toarray(), atol=0.02)


def test_a_small_part_without_trust_follows_its_surroundings_as_one_and_a_large_one_bit_by_bit():
    body, button = icosphere(8), icosphere(2)
    coat = icosphere(6)
    vertices, triangles = together(body, (0.2 * button[0] + [0, 0, 1.25], button[1]), (1.6 * coat[0], coat[1]))
    ends = np.cumsum([len(body[0]), len(button[0]), len(coat[0])])
    weights = shares((vertices[:, 0] > 0).astype(float))
    trusted = np.arange(len(vertices)) < ends[0]
    result = filled(spoilt(weights, ~trusted), trusted, parts_of(vertices, triangles)).toarray()
    of_button, of_coat = result[ends[0] : ends[1]], result[ends[1] :]
    np.testing.assert_allclose(of_button, np.tile(of_button[0], (len(of_button), 1)), atol=1e-12)
    assert 0.1 < of_button[0, 0] < 0.9
    clear = abs(vertices[ends[1] :, 0]) > 0.3
    np.testing.assert_allclose(of_coat[clear], weights.toarray()[ends[1] :][clear])


def test_needles_and_triangles_without_area_do_no_harm():
    x, y = [0, 1, 2, 3, 0, 3, 9, 9, 8], [0, 0, 0, 0, 1, 1, 0, 1, 0]
    vertices = np.stack([x, y, np.zeros(9)], axis=1)
    triangles = np.array([[0, 1, 2], [1, 2, 3], [0, 3, 4], [3, 5, 4], [6, 7, 8]])
    weights = shares(np.linspace(0, 1, 9))
    gap = np.isin(np.arange(9), [1, 2])
    result = filled(weights, ~gap, parts_of(vertices, triangles))
    assert np.isfinite(result.data).all()
    np.testing.assert_allclose(row_sums(result), 1)


def test_wrong_shapes_are_refused():
    vertices, triangles = permuted(*icosphere(3))[:2]
    parts = parts_of(vertices, triangles)
    with pytest.raises(RigError, match="3 rows"):
        filled(csr_array((3, 2)), np.ones(len(vertices), bool), parts)
    with pytest.raises(RigError, match="the shape \\(2,\\)"):
        filled(csr_array((len(vertices), 2)), np.ones(2, bool), parts)
