# SPDX-License-Identifier: GPL-3.0-or-later
from __future__ import annotations

import numpy as np
import pytest

from engine import TriangleMesh
from engine.retarget.open_ends import open_ends
from tests.shapes import cylinder, icosphere, torus


@pytest.mark.parametrize("scale", [1e-3, 1.0, 1e4])
def test_a_tube_has_two_ends_and_closed_surfaces_none(scale):
    for (vertices, triangles), count in ((cylinder(), 2), (icosphere(), 0), (torus(), 0)):
        assert open_ends(TriangleMesh(scale * vertices + 5 * scale, triangles)) == count


def test_a_small_hole_is_no_end():
    vertices, triangles = icosphere()
    assert open_ends(TriangleMesh(vertices, triangles[:-1])) == 0


def test_a_seam_is_no_end():
    """Every triangle on its own, as a mesh that was split everywhere: the tube is still open at its two ends only."""
    vertices, triangles = cylinder()
    loose = TriangleMesh(vertices[triangles].reshape(-1, 3), np.arange(3 * len(triangles)).reshape(-1, 3))
    assert open_ends(loose) == 2


def test_a_seam_that_is_not_quite_closed_is_no_end_wherever_it_stands():
    vertices, triangles = cylinder()
    corners = vertices[triangles].reshape(-1, 3)
    random = np.random.default_rng(0)
    corners += 1e-7 * random.standard_normal(corners.shape)
    for shift in random.uniform(-1, 1, (10, 3)):
        assert open_ends(TriangleMesh(corners + shift, np.arange(len(corners)).reshape(-1, 3))) == 2


@pytest.mark.parametrize("turned", [False, True])
def test_an_opening_that_another_piece_goes_into_is_no_end(turned):
    """A ball in one end of a tube, as a neck in a collar; far away it fills nothing."""
    (vertices, triangles), (ball, around) = cylinder(), icosphere(3)
    top = vertices[vertices[:, 2] > vertices[:, 2].max() - 1e-9].mean(axis=0)
    width = np.ptp(vertices, axis=0).min()
    around = around[:, ::-1] if turned else around
    for place, count in ((top, 1), (top + 20 * width * np.eye(3)[0], 2)):
        both = np.concatenate([vertices, 0.3 * width * ball + place])
        assert open_ends(TriangleMesh(both, np.concatenate([triangles, around + len(vertices)]))) == count
