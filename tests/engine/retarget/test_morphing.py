# SPDX-License-Identifier: GPL-3.0-or-later
"""Shapes between two poses."""

import numpy as np
import pytest

from engine import MeshError, TriangleMesh
from engine.retarget.morphing import in_between
from tests.shapes import creature, cut_open, icosphere, rotation

THREE = np.array([0.0, 0.5, 1.0])


def test_the_ends_are_met():
    rest, triangles, _ = creature(0.0, 9)
    bent = creature(1.0, 9)[0]
    first, _, last = in_between(TriangleMesh(rest, triangles), bent, THREE)
    np.testing.assert_allclose(first, rest, atol=1e-5)
    np.testing.assert_allclose(last, bent, atol=1e-5)


def test_what_was_cut_open_at_seams_stays_whole():
    rest, triangles, _ = creature(0.0, 9)
    bent = creature(1.0, 9)[0]
    vertices, cut, home = cut_open(rest, triangles, rest[triangles].mean(axis=1)[:, 1] > 0)
    between = in_between(TriangleMesh(vertices, cut), bent[home], THREE)
    np.testing.assert_array_equal(between, between[:, home])
    np.testing.assert_allclose(between, in_between(TriangleMesh(rest, triangles), bent, THREE)[:, home], atol=1e-6)


def test_a_turn_goes_around():
    mesh = TriangleMesh(*icosphere(5))
    turned = mesh.vertices @ rotation([0, 0, 1], 2.4).T
    halfway = in_between(mesh, turned, THREE)[1]
    np.testing.assert_allclose(halfway, mesh.vertices @ rotation([0, 0, 1], 1.2).T, atol=1e-5)


def test_growth_and_a_way_are_even():
    mesh = TriangleMesh(*icosphere(5))
    (quarter,) = in_between(mesh, 3 * mesh.vertices + [4, 0, 0], np.array([0.25]))
    np.testing.assert_allclose(quarter, 1.5 * mesh.vertices + [1, 0, 0], atol=1e-5)


def test_edges_keep_their_length_on_the_way():
    rest, triangles, _ = creature(0.0, 9)
    bent = creature(1.0, 9)[0]
    mesh = TriangleMesh(rest, triangles)

    def lengths(points):
        return np.linalg.norm(points[mesh.edges[:, 0]] - points[mesh.edges[:, 1]], axis=1)

    mean = (mesh.edge_lengths + lengths(bent)) / 2
    kept = lengths(in_between(mesh, bent, THREE)[1]) / mean
    straight = lengths((rest + bent) / 2) / mean
    assert (kept < 0.9).mean() < 0.2 * (straight < 0.9).mean()


def test_loose_parts_go_along():
    ball, triangles = icosphere(5)
    small, inner = icosphere(2, radius=0.1)
    mesh = TriangleMesh(
        np.concatenate([ball, small + np.array([0.8, 0, 0])]), np.concatenate([triangles, inner + len(ball)])
    )
    turned = mesh.vertices @ rotation([0, 0, 1], 2.4).T
    halfway = in_between(mesh, turned, THREE)[1]
    expected = mesh.vertices @ rotation([0, 0, 1], 1.2).T
    np.testing.assert_allclose(halfway - halfway.mean(axis=0), expected - expected.mean(axis=0), atol=1e-4)


def test_other_numbers_of_vertices_are_refused():
    mesh = TriangleMesh(*icosphere(2))
    with pytest.raises(MeshError, match="one finite position"):
        in_between(mesh, mesh.vertices[1:], THREE)
