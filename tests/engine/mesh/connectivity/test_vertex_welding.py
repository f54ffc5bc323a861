# SPDX-License-Identifier: GPL-3.0-or-later
"""Welding along seams."""

import numpy as np
import pytest

from engine.mesh.connectivity.halfedges import group_half_edges
from engine.mesh.connectivity.vertex_welding import weld_boundaries
from tests.messes import cut_along_seam, in_pieces, together
from tests.shapes import icosphere, plane, plane_with_slit


def welded(vertices, triangles):
    return weld_boundaries(vertices, triangles, group_half_edges(triangles, len(vertices)))


def test_copies_stand_for_the_first():
    vertices, triangles = icosphere(3)
    cut, parts = cut_along_seam(vertices, triangles)
    first = welded(cut, parts)
    for vertex in range(len(cut)):
        assert first[vertex] == np.flatnonzero((cut == cut[vertex]).all(axis=1))[0]
    pieces = in_pieces(vertices, triangles)
    assert len(np.unique(welded(*pieces))) == len(vertices)
    vertices, triangles = plane_with_slit(10)
    assert len(np.unique(welded(vertices, triangles))) == 121


def test_minus_zero_is_zero():
    vertices, triangles = plane(3)
    cut, parts = cut_along_seam(vertices, triangles)
    cut[9:, 2] = -0.0
    assert len(np.unique(welded(cut, parts))) == 9


@pytest.mark.parametrize(("gap", "closed"), [(0.009, True), (0.011, False)])
def test_gaps_are_measured_by_the_shortest_edge(gap, closed):
    vertices, triangles = plane(5, size=4.0)
    both = together((vertices, triangles), (vertices + np.array([4 + gap, 0, 0]), triangles))
    assert (len(np.unique(welded(*both))) == 45) == closed


def test_finely_cut_borders_do_not_collapse():
    """The rim of a fan of very many triangles: neighbours are much closer than the fan is wide."""
    angle = np.linspace(0, 2 * np.pi, 5001)[:-1]
    vertices = np.concatenate([np.zeros((1, 3)), np.stack([np.cos(angle), np.sin(angle), 0 * angle], axis=1)])
    rim = 1 + np.arange(5000)
    triangles = np.stack([np.zeros(5000, int), rim, np.roll(rim, -1)], axis=1)
    assert np.array_equal(welded(vertices, triangles), np.arange(5001))


def test_whole_surfaces_in_one_place_stay_apart():
    both = together(icosphere(3), icosphere(3))
    assert np.array_equal(welded(*both), np.arange(len(both[0])))
