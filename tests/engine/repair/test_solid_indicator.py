# SPDX-License-Identifier: GPL-3.0-or-later
"""What is inside of surfaces."""

import numpy as np
import pytest

from engine import TriangleMesh
from engine.repair.solid_indicator import solid_indicator
from tests.messes import together, without_disc
from tests.shapes import creature, icosphere, rotation


def places(solid):
    counts = np.indices(solid.values.shape).transpose(1, 2, 3, 0)
    return solid.origin + solid.spacing * counts


def at(solid, point):
    return solid.values[tuple(np.round((np.asarray(point) - solid.origin) / solid.spacing).astype(int))]


def test_a_ball_is_inside_of_itself():
    solid = solid_indicator(TriangleMesh(*icosphere(12)), 0.04)
    distances = np.linalg.norm(places(solid), axis=-1)
    assert solid.values[distances < 0.88] == pytest.approx(1, abs=0.02)
    assert solid.values[distances > 1.12] == pytest.approx(0, abs=0.02)
    middle = solid.values[abs(distances - 1) < 0.01]
    assert middle.mean() == pytest.approx(0.5, abs=0.06)


def test_what_lies_in_two_balls_counts_twice():
    vertices, triangles = icosphere(12)
    both = together((vertices, triangles), (vertices + np.array([1.0, 0, 0]), triangles))
    solid = solid_indicator(TriangleMesh(*both), 0.04)
    assert at(solid, [0.5, 0, 0]) == pytest.approx(2, abs=0.03)
    assert at(solid, [-0.5, 0, 0]) == pytest.approx(1, abs=0.03)
    assert at(solid, [1.5, 0, 0]) == pytest.approx(1, abs=0.03)


def test_an_opening_fades():
    opened = TriangleMesh(*without_disc(*icosphere(12), np.array([0.0, 0, 1]), 0.3))
    solid = solid_indicator(opened, 0.04)
    assert at(solid, [0, 0, 0]) == pytest.approx(1, abs=0.05)
    assert at(solid, [0, 0, 0.97]) == pytest.approx(0.5, abs=0.15)
    assert at(solid, [0, 0, 1.2]) == pytest.approx(0, abs=0.2)


@pytest.mark.parametrize("shift", [[0.5, 0, 0], [0.9, 0.9, 0.9], [-1.7, 0.2, 0]])
def test_surfaces_that_are_added_later_count_as_those_at_once(shift):
    ball, triangles = icosphere(12)
    large, small = (2 * ball, triangles), (0.4 * ball + shift, triangles)
    begun = solid_indicator(TriangleMesh(*large), 0.05)
    before = begun.values.copy()
    added = begun.with_surfaces(TriangleMesh(*small))
    alone = solid_indicator(TriangleMesh(*small), 0.05)
    assert np.array_equal(begun.values, before)
    assert (added.spacing, added.origin.tolist()) == (begun.spacing, begun.origin.tolist())
    for point in np.random.default_rng(0).uniform(-0.6, 0.6, (50, 3)) + shift:
        near = np.abs(np.linalg.norm(point - shift) - 0.4) < 0.15  # where a place may be on either side
        inside = np.linalg.norm(point - shift) < 0.4
        if not near:
            assert at(added, point) - at(begun, point) == pytest.approx(float(inside), abs=0.03)
    at_once = at(solid_indicator(TriangleMesh(*together(large, small)), 0.05), shift)
    assert at(added, shift) == pytest.approx(at_once, abs=0.03)
    assert at(alone, shift) == pytest.approx(1, abs=0.03)


def test_surfaces_that_reach_beyond_the_places_are_cut_off_there():
    ball, triangles = icosphere(12)
    begun = solid_indicator(TriangleMesh(ball, triangles), 0.05)
    added = begun.with_surfaces(TriangleMesh(3 * ball, triangles))
    assert added.values.shape == begun.values.shape
    assert at(added, [0, 0, 0]) == pytest.approx(2, abs=0.03)
    assert at(added, [0, 0, 1.3]) == pytest.approx(1, abs=0.03)


def test_inside_out_is_outside():
    vertices, triangles = icosphere(8)
    solid = solid_indicator(TriangleMesh(vertices, triangles[:, ::-1]), 0.05)
    assert at(solid, [0, 0, 0]) == pytest.approx(-1, abs=0.03)


@pytest.mark.parametrize("scale", [1e-3, 1.0, 1e4])
def test_size_and_place_do_not_matter(scale):
    vertices, triangles, _ = creature(0.5, 9)
    turned = vertices @ rotation([1.0, 2, 3], 0.8).T
    solid = solid_indicator(TriangleMesh(scale * turned + 5 * scale, triangles), 0.05 * scale)
    corners = vertices[triangles]
    volume = np.einsum("md,md->m", corners[:, 0], np.cross(corners[:, 1], corners[:, 2])).sum() / 6
    assert solid.values.sum() * (solid.spacing / scale) ** 3 == pytest.approx(volume, rel=0.03)
    assert solid.spacing == 0.05 * scale


def test_scattered_pieces_get_a_coarser_grid():
    vertices, triangles = icosphere(4)
    far = together((vertices, triangles), (vertices + 100.0, triangles))
    solid = solid_indicator(TriangleMesh(*far), 0.05)
    assert solid.values.size < 8_000_000
    assert solid.spacing > 0.05


@pytest.mark.parametrize("axis", [0, 1, 2])
def test_a_needle_gets_a_coarser_grid(axis):
    vertices, triangles = icosphere(6)
    stretched = 1e-3 * vertices
    stretched[:, axis] *= 1e9
    assert solid_indicator(TriangleMesh(stretched, triangles), 1e-4).values.size < 20_000_000
