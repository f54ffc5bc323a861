# SPDX-License-Identifier: GPL-3.0-or-later
import numpy as np
import pytest

from engine import Shape, TriangleMesh
from engine.shapes.borders import has_border, longest_border
from tests.shapes import compacted, cylinder, icosphere


def test_only_open_surfaces_have_a_border():
    vertices, triangles = icosphere(8)
    assert not has_border(Shape(TriangleMesh(vertices, triangles)))
    assert not has_border(Shape(TriangleMesh(vertices, triangles[1:])))
    half = compacted(vertices, triangles[vertices[triangles].mean(axis=1)[:, 0] > 0])
    assert has_border(Shape(TriangleMesh(*half[:2])))


def test_the_longest_border_counts_and_not_all_of_them_together():
    vertices, triangles = cylinder(60, 40)
    one_end = 2 * np.pi / np.sqrt(2 * np.pi * 2)  # of a tube of radius 1 and height 2, in the root of its area
    assert longest_border(Shape(TriangleMesh(vertices, triangles))) == pytest.approx(one_end, rel=0.01)
    assert longest_border(Shape(TriangleMesh(*icosphere(8)))) == 0
