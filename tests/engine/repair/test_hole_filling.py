# SPDX-License-Identifier: GPL-3.0-or-later
"""Small holes, and the ends of a surface."""

import numpy as np
import pytest

from engine import TriangleMesh
from engine.mesh.connectivity.boundary_loops import boundary_loops
from engine.mesh.connectivity.halfedges import group_half_edges
from engine.repair.hole_filling import fill_holes, small_holes
from tests.messes import without_disc
from tests.shapes import cylinder, icosphere


def loops_of(vertices, triangles):
    groups = group_half_edges(triangles, len(vertices))
    return boundary_loops(vertices, triangles, groups.order[groups.starts[groups.counts == 1]])


def are_small(mesh):
    return small_holes(*mesh, loops_of(*mesh), TriangleMesh(*mesh).area).tolist()


@pytest.mark.parametrize("scale", [1e-3, 1.0, 1e3])
def test_size_decides_relative_to_the_surface(scale):
    vertices, triangles = icosphere(16, scale)
    for radius, small in ((0.15, True), (0.4, False)):
        assert are_small(without_disc(vertices, triangles, vertices[20], radius * scale)) == [small]


def test_the_ends_of_tubes_stay_open():
    # Lids of 0.6 % of the area: as holes in a sheet they would be filled.
    assert are_small(cylinder(20, 40, radius=0.1, height=8.0)) == [False, False]
    assert are_small(cylinder(20, 40, radius=0.1, height=80.0)) == [True, True]


def test_filling_closes_the_surface():
    vertices, triangles = icosphere(12)
    mesh = without_disc(*without_disc(vertices, triangles, vertices[0], 0.12), vertices[5], 0.12)
    loops = loops_of(*mesh)
    centres, fans = fill_holes(loops, np.array([True, True]), len(vertices))
    filled = TriangleMesh(np.concatenate([vertices, centres]), np.concatenate([mesh[1], fans]))
    assert filled.is_closed
    volume = np.linalg.det(filled.vertices[filled.triangles]).sum() / 6
    assert volume == pytest.approx(np.linalg.det(vertices[triangles]).sum() / 6, rel=1e-2)
    centres, fans = fill_holes(loops, np.array([False, True]), len(vertices))
    assert len(centres) == 1
    assert set(fans[:, 2]) == {len(vertices)}
    assert set(fans[:, 0]) == set(loops.tails[loops.labels == 1])
