# SPDX-License-Identifier: GPL-3.0-or-later
"""Single vertices that stick out are found and pulled in, and nothing else is."""

import numpy as np
import pytest

from engine import TriangleMesh
from engine.repair.cleaning import clean
from engine.repair.spikes import find_spikes, pulled_in
from tests.shapes import creature, icosphere, permuted, rotation


@pytest.fixture(scope="module")
def body():
    vertices, triangles, _ = creature(0.3, 9)
    return vertices, triangles


def with_spikes(body, tips, length=1.5):
    """Move vertices along their normals."""
    vertices, triangles = body
    vertices = vertices.copy()
    vertices[tips] += length * TriangleMesh(*body).vertex_normals[tips]
    return vertices, triangles


def ring(triangles, vertex):
    around = np.unique(triangles[(triangles == vertex).any(axis=1)])
    return around[around != vertex]


@pytest.mark.parametrize("tips", [[40], [40, 200, 350]])
def test_spikes_are_found_wherever_and_however_large_they_are(body, tips):
    vertices, triangles = with_spikes(body, tips)
    np.testing.assert_array_equal(find_spikes(vertices, triangles), tips)
    moved = 1e-4 * vertices @ rotation([1, 2, 3], 1.0).T + 5
    np.testing.assert_array_equal(find_spikes(moved, triangles), tips)
    inward, _ = with_spikes(body, tips, -1.5)
    np.testing.assert_array_equal(find_spikes(inward, triangles), tips)


def test_the_order_of_vertices_does_not_matter(body):
    vertices, triangles, new = permuted(*with_spikes(body, [40]), seed=3)
    assert len(find_spikes(vertices, triangles)) == 1
    old = find_spikes(*with_spikes(body, [40]))
    np.testing.assert_allclose(vertices[find_spikes(vertices, triangles)], with_spikes(body, [40])[0][old])
    assert len(new) == len(vertices)


def test_surfaces_without_spikes_have_none(body):
    assert not len(find_spikes(*body))
    assert not len(find_spikes(*icosphere(5)))
    cone, triangles = icosphere(6)
    cone = cone.copy()
    cone[:, 2] = np.where(cone[:, 2] > 0, 4 * cone[:, 2], cone[:, 2])
    assert not len(find_spikes(cone, triangles))
    noisy = body[0] + np.random.default_rng(0).normal(size=body[0].shape) * 0.03
    assert not len(find_spikes(noisy, body[1]))
    flap = np.array([[0.0, 0, 0], [0.1, 0, 0], [9.0, 5, 0]])
    assert not len(find_spikes(flap, np.array([[0, 1, 2]])))


def test_a_tip_goes_to_the_middle_of_its_ring(body):
    vertices, triangles = with_spikes(body, [40])
    pulled = pulled_in(vertices, triangles, np.array([40]))
    np.testing.assert_allclose(pulled[40], vertices[ring(triangles, 40)].mean(axis=0))
    others = np.arange(len(vertices)) != 40
    np.testing.assert_array_equal(pulled[others], vertices[others])


def test_cleaning_pulls_spikes_in_and_says_so(body):
    spiked = TriangleMesh(*with_spikes(body, [40]))
    cleaned = clean(spiked, "scan")
    assert cleaned.notes == ("The scan had 1 spike of one vertex: it was pulled in for matching.",)
    assert cleaned.mesh.area == pytest.approx(TriangleMesh(*body).area, rel=0.01)
    assert spiked.area > 1.05 * cleaned.mesh.area
    np.testing.assert_array_equal(cleaned.vertex_parts, 0)
