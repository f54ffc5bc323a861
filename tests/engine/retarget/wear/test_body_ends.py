# SPDX-License-Identifier: GPL-3.0-or-later
"""Bodies that end where clothes begin."""

import numpy as np
import pytest

from engine import TriangleMesh, continues_body
from tests.shapes import cylinder, icosphere, rotation

LEG = TriangleMesh(*cylinder(24, 20, 0.5, 4.0))


def tube(low, high, radius):
    vertices, triangles = cylinder(24, 20, radius, high - low)
    return TriangleMesh(vertices + np.array([0.0, 0.0, low]), triangles)


def hat(height):
    """A cap on the upper end of the leg."""
    vertices, triangles = icosphere(6)
    upper = TriangleMesh(vertices * [0.52, 0.52, height], triangles).submesh(vertices[:, 2] > -0.1)[0]
    return TriangleMesh(upper.vertices + np.array([0.0, 0.0, 4.0]), upper.triangles)


def turned(mesh):
    """The same elsewhere, in other units, cut open at every edge."""
    corners = mesh.triangles.ravel()
    vertices = 37.0 * mesh.vertices[corners] @ rotation([1.0, -2.0, 0.5], 0.8).T + [5.0, 0.0, -90.0]
    return TriangleMesh(vertices, np.arange(len(corners)).reshape(-1, 3))


@pytest.mark.parametrize(
    ("item", "continues"),
    [
        (tube(-3.0, 0.5, 0.55), True),  # a boot without a foot
        (tube(-0.3, 3.0, 0.55), False),  # a stocking
        (tube(1.0, 2.0, 0.55), False),  # a bandage
        (hat(0.6), False),  # hair on an open skull
        (hat(3.0), True),  # the rest of the limb
    ],
)
def test_what_goes_on_beyond_an_open_end_is_part_of_the_body(item, continues):
    assert continues_body(LEG, item) == continues
    assert continues_body(turned(LEG), turned(item)) == continues


def test_what_holds_a_body_together_is_part_of_it():
    ball = TriangleMesh(*icosphere(6))
    ends = [ball.vertices * 0.6 + np.array([0.0, 0.0, height]) for height in (-2.0, 2.0)]
    apart = TriangleMesh(np.concatenate(ends), np.concatenate([ball.triangles, ball.triangles + ball.vertex_count]))
    assert continues_body(apart, tube(-2.0, 2.0, 0.61))
    assert continues_body(turned(apart), turned(tube(-2.0, 2.0, 0.61)))
    assert not continues_body(apart, tube(-2.5, -1.0, 0.61))
    whole = TriangleMesh(ball.vertices * [0.6, 0.6, 3.0], ball.triangles)
    assert not continues_body(whole, tube(-2.0, 2.0, 0.61))


def test_a_closed_body_is_whole():
    assert not continues_body(TriangleMesh(*icosphere(6)), tube(2.0, 9.0, 0.5))
