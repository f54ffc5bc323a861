# SPDX-License-Identifier: GPL-3.0-or-later
"""Wire frames and grids, and what they enclose."""

import numpy as np
import pytest

from engine import TriangleMesh
from engine.geometry.handle_loops import genus
from engine.mesh.connectivity.mesh_orientation import enclosed_volumes
from engine.repair.cleaning import clean
from engine.shapes.openwork import filled_openwork, is_openwork
from tests.shapes import icosphere, plane, rotation, torus, wire_box

CELLS, WIRE = 4, 0.05
SPACING = 0.06


@pytest.fixture(scope="module")
def cube():
    return TriangleMesh(*wire_box(CELLS, WIRE))


def test_a_frame_of_wire_is_openwork(cube):
    assert genus(cube) == 6 * CELLS**2 - 1  # a sphere with a hole for each cell
    assert is_openwork(cube)


def test_what_has_an_inside_or_no_holes_is_none():
    assert not is_openwork(TriangleMesh(*wire_box(1, 0.35, resolution=12)))
    assert not is_openwork(TriangleMesh(*icosphere(6)))
    assert not is_openwork(TriangleMesh(*torus(48, 8, thickness=0.04)))
    vertices, triangles = plane(12)
    holes = np.isin(np.arange(len(triangles)) // 2 % 12, (2, 5, 8))
    assert not is_openwork(TriangleMesh(vertices, triangles[~holes]))  # a sheet


@pytest.mark.parametrize("hole", [0.5, 0.15])
def test_a_frame_is_filled_whether_its_holes_are_as_wide_as_is_closed_or_wider(cube, hole):
    filled = filled_openwork(cube, SPACING, hole)
    assert genus(clean(filled).mesh) == 0
    assert enclosed_volumes(filled)[1].sum() == pytest.approx(2.1**3, rel=0.1)
    assert np.abs(filled.vertices).max() == pytest.approx(np.abs(cube.vertices).max(), abs=SPACING)


def test_place_size_and_turn_do_not_matter(cube):
    turn = rotation((1, 2, 3), 1.0)
    moved = TriangleMesh(100 * cube.vertices @ turn.T + [5.0, -3.0, 1.0], cube.triangles)
    volumes = [
        enclosed_volumes(filled_openwork(mesh, SPACING * size, 0.5 * size))[1].sum() / size**3
        for mesh, size in ((cube, 1), (moved, 100))
    ]
    assert volumes[1] == pytest.approx(volumes[0], rel=0.05)


def test_far_smaller_openwork_than_the_grid_is_filled_as_well(cube):
    small = TriangleMesh(0.01 * cube.vertices, cube.triangles)
    volume = enclosed_volumes(filled_openwork(small, SPACING, 0.5))[1].sum()
    assert volume == pytest.approx((0.01 * 2.1) ** 3, rel=0.3)


def test_openwork_far_larger_than_the_grid_is_filled_on_a_coarser_one(cube):
    large = TriangleMesh(1000 * cube.vertices, cube.triangles)
    volume = enclosed_volumes(filled_openwork(large, SPACING, 500.0))[1].sum()
    assert volume == pytest.approx(2100.0**3, rel=0.1)


def test_a_grating_encloses_nothing():
    grating = TriangleMesh(*wire_box(4, 0.02, (2.0, 2.0, 0.001), resolution=40))
    assert is_openwork(grating)
    assert filled_openwork(grating, SPACING, 0.5) is grating
