# SPDX-License-Identifier: GPL-3.0-or-later
"""Triangles that agree, and look outward."""

import numpy as np
import pytest

from engine.mesh.connectivity.components import triangle_components
from engine.mesh.connectivity.halfedges import group_half_edges, pair_half_edges
from engine.mesh.connectivity.mesh_orientation import inward_components, orient_consistently, turn_triangles
from tests.messes import partly_turned, together
from tests.shapes import creature, cylinder, icosphere, plane, torus


def paired(vertices, triangles):
    return pair_half_edges(vertices, triangles, group_half_edges(triangles, len(vertices)))


def areas(vertices, triangles):
    a, b, c = vertices[triangles].transpose(1, 0, 2)
    return np.linalg.norm(np.cross(b - a, c - a), axis=1) / 2


def test_components_hang_together():
    vertices, triangles = together(icosphere(2), torus(9, 6), plane(4))
    components = triangle_components(paired(vertices, triangles))
    sizes = [len(mesh[1]) for mesh in (icosphere(2), torus(9, 6), plane(4))]
    expected = np.repeat([0, 1, 2], sizes)
    assert len(np.unique(components)) == 3
    assert len(np.unique(components * 3 + expected)) == 3


@pytest.mark.parametrize("part", [0.0, 0.1, 0.45])
@pytest.mark.parametrize("shape", [torus(16, 8), creature(0.0, 9)[:2], cylinder(12, 6)])
def test_turning_makes_neighbours_agree(shape, part):
    vertices, triangles = partly_turned(*shape, part)
    twins = paired(vertices, triangles)
    orientation = orient_consistently(triangles, areas(vertices, triangles), twins)
    turned, moved = turn_triangles(triangles, orientation.twins, orientation.turned)
    assert np.array_equal(np.sort(turned, axis=1), np.sort(triangles, axis=1))
    inside = np.flatnonzero(moved >= 0)
    assert np.array_equal(moved[moved[inside]], inside)
    tail, head = turned.ravel(), np.roll(turned, -1, axis=1).ravel()
    assert np.array_equal(tail[inside], head[moved[inside]])
    assert np.array_equal(np.sort(np.roll(turned, -1, axis=1)), np.sort(np.roll(shape[1], -1, axis=1)))
    wrong = (triangles != shape[1]).any(axis=1)
    assert np.array_equal(orientation.turned, wrong)


def test_what_falls_apart_when_it_is_cut_open_is_several_components():
    around, across = 3, 4
    i = np.arange(around * across).reshape(around, across)
    a, b, c, d = (part.ravel() for part in (i[:-1, :-1], i[:-1, 1:], i[1:, 1:], i[1:, :-1]))
    last, first = i[-1], i[0][::-1]  # glued with half a turn
    a, b = np.append(a, last[:-1]), np.append(b, last[1:])
    c, d = np.append(c, first[1:]), np.append(d, first[:-1])
    strip = np.concatenate([np.stack([a, b, c], axis=1), np.stack([a, c, d], axis=1)])
    found = 0
    for seed in range(120):
        rng = np.random.default_rng(seed)
        vertices, triangles = rng.standard_normal((around * across, 3)), strip[rng.random(len(strip)) < 0.9]
        twins = paired(vertices, triangles)
        orientation = orient_consistently(triangles, areas(vertices, triangles), twins)
        np.testing.assert_array_equal(orientation.components, triangle_components(orientation.twins))
        found += orientation.components.max() > triangle_components(twins).max()
    assert found


def test_volume_says_what_is_inside():
    outside = icosphere(3)
    inside = icosphere(3)[0] * 0.2 + 5, icosphere(3)[1][:, ::-1]
    bottle = cylinder(20, 10)
    vertices, triangles = together(outside, inside, bottle, (bottle[0] + 9, bottle[1][:, ::-1]), plane(5))
    for shift in (0.0, 1e5):
        twins = paired(vertices, triangles)
        components = triangle_components(twins)
        inward = inward_components(vertices + shift, triangles, twins, components)
        starts = np.cumsum([0, *(len(mesh[1]) for mesh in (outside, inside, bottle, bottle))])
        assert inward[components[starts]].tolist() == [False, True, False, True, False]


def test_less_than_half_a_ball_has_no_inside():
    vertices, triangles = icosphere(8)
    for height, known in ((0.6, False), (-0.6, True)):
        cap = triangles[vertices[triangles][:, :, 2].mean(axis=1) > height][:, ::-1]
        twins = paired(vertices, cap)
        assert inward_components(vertices, cap, twins, triangle_components(twins)).tolist() == [known]
