# SPDX-License-Identifier: GPL-3.0-or-later
"""What is seen around a point of a surface."""

import numpy as np

from engine import TriangleMesh
from engine.matching.overlap.oriented_patches import RINGS, TURNS, oriented_patches
from engine.matching.overlap.part_surface import PartSurface
from tests.shapes import icosphere, plane


def test_a_ball_falls_away_the_same_on_all_sides_the_more_the_farther():
    vertices, triangles = icosphere(16)
    patches = oriented_patches(PartSurface(TriangleMesh(vertices / np.sqrt(4 * np.pi), triangles)), 12)
    heights = patches.values[:, 1:, :, 0]
    assert (heights.std(axis=2) < 0.1 * np.abs(heights.mean(axis=2))).all()
    assert (np.diff(heights.mean(axis=2), axis=1) < 0).all()
    np.testing.assert_allclose(patches.weights[:, 1:], 1)


def test_a_plane_is_flat_and_there_is_nothing_beyond_its_border():
    surface = PartSurface(TriangleMesh(*plane(40)))
    patches = oriented_patches(surface, 30)
    seen = patches.weights > 0
    assert np.abs(patches.values[..., 0][seen]).max() < 1e-9
    middle = np.linalg.norm(surface.vertices[patches.vertices] - surface.vertices.mean(axis=0), axis=1).argmin()
    assert seen[middle, 1:].all()
    corner = np.linalg.norm(surface.vertices[patches.vertices] - surface.vertices.mean(axis=0), axis=1).argmax()
    assert 0.15 < seen[corner, -1].mean() < 0.5
    assert patches.weights.shape == (len(patches), RINGS, TURNS)


def test_the_first_patches_are_those_of_fewer_points():
    patches = oriented_patches(PartSurface(TriangleMesh(*plane(20))), 12)
    few = patches.first(5)
    assert len(few) == 5
    np.testing.assert_array_equal(few.between, patches.between[:5, :5])
