# SPDX-License-Identifier: GPL-3.0-or-later
"""How many of some pairs of places two maps follow."""

import numpy as np
import pytest

from engine import SurfaceMap, SurfacePoints, TriangleMesh, followed_share
from tests.shapes import icosphere


def test_what_is_taken_to_its_partner_and_what_is_taken_to_that_of_another():
    mesh = TriangleMesh(*icosphere(4))
    same = SurfaceMap.identity(mesh)
    ends = np.array([mesh.vertices[:, axis].argmax() for axis in range(3)])
    pairs = np.column_stack([ends, ends])
    assert followed_share((same, same), (mesh, mesh), pairs) == 1
    # The images of two of three places are exchanged, one way.
    points = SurfacePoints.at_vertices(mesh, np.arange(mesh.vertex_count))
    taken = np.arange(mesh.vertex_count)
    taken[ends[:2]] = ends[1::-1]
    crossed = SurfaceMap.from_barycentric(mesh, points.triangles[taken], points.barycentric[taken])
    assert followed_share((crossed, same), (mesh, mesh), pairs) == pytest.approx(4 / 6)
    assert followed_share((crossed, crossed), (mesh, mesh), pairs[:, ::-1]) == pytest.approx(1 / 3)
    assert followed_share((same, same), (mesh, mesh), pairs[[[0], [1]], [[0, 1]]]) == 1


def test_no_pairs_are_all_followed():
    mesh = TriangleMesh(*icosphere(2))
    same = SurfaceMap.identity(mesh)
    assert followed_share((same, same), (mesh, mesh), np.empty((0, 2), int)) == 1
