# SPDX-License-Identifier: GPL-3.0-or-later
"""The curves in which surfaces end."""

import numpy as np
import pytest

from engine.mesh.connectivity.boundary_loops import boundary_loops
from engine.mesh.connectivity.halfedges import group_half_edges
from tests.shapes import cylinder, icosphere, plane_with_hole


def loops_of(vertices, triangles):
    groups = group_half_edges(triangles, len(vertices))
    return boundary_loops(vertices, triangles, groups.order[groups.starts[groups.counts == 1]])


def test_a_cylinder_has_two_ends():
    loops = loops_of(*cylinder(60, 5, radius=2.0, height=3.0))
    assert loops.count == 2
    assert np.array_equal(np.bincount(loops.labels), [60, 60])
    assert np.allclose(np.sort(loops.centres, axis=0), [[0, 0, 0], [0, 0, 3]])
    assert loops.areas == pytest.approx(60 / 2 * 4 * np.sin(2 * np.pi / 60))


def test_a_hole_runs_the_other_way():
    vertices, triangles = plane_with_hole(10, 0.3, 0.6)
    loops = loops_of(vertices, triangles)
    assert sorted(loops.areas) == pytest.approx([0.09, 1])
    turns = [
        np.cross(vertices[loops.tails[loops.labels == i]], vertices[loops.heads[loops.labels == i]])[:, 2].sum() / 2
        for i in range(2)
    ]
    assert sorted(turns) == pytest.approx([-0.09, 1])
    # Halving edges of the loop does not move its centre.
    assert loops.centres[loops.areas.argmin()] == pytest.approx([0.45, 0.45, 0])


def test_closed_surfaces_have_none():
    assert loops_of(*icosphere(2)).count == 0
