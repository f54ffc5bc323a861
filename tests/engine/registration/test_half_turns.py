# SPDX-License-Identifier: GPL-3.0-or-later
"""Half turns of a body that lies on another: about which axis, and in which shape it starts."""

import numpy as np
import pytest

from engine import Shape, TriangleMesh, run
from engine.geometry.procrustes import agreement_in_place, nearest_similarity
from engine.registration.deformable import DeformableSurface
from engine.registration.half_turns import half_turned
from tests.shapes import icosphere, rotation


def made(vertices, triangles):
    """A surface, and its eigenfunctions."""
    shape = Shape(TriangleMesh(vertices, triangles))
    run(shape.spectrum_steps(40))
    return DeformableSurface(shape.mesh, shape.laplace), shape.unit_functions()


def pawn(feet):
    """A slim body with a thick head, whose foot points to one side."""
    vertices, triangles = icosphere(4)
    vertices = vertices * [0.5, 0.5, 2.0]
    x, _, z = vertices.T
    vertices[:, :2] *= np.where(z > 1.2, 2.0, 1.0)[:, None]
    foot = np.exp(-np.square(z + 1.6) / 0.05) * (feet * x > 0)
    vertices[:, 0] += feet * 0.5 * foot
    return vertices, triangles


@pytest.mark.parametrize("turned", [False, True])
def test_a_body_turns_about_the_axis_that_leaves_it_nearest_to_the_other(turned):
    turn = rotation([1.0, 2.0, 3.0], 0.7) if turned else np.eye(3)
    vertices, triangles = pawn(1)
    source, functions = made(vertices @ turn.T, triangles)
    found = half_turned(source, source, source.vertices, functions)
    linear, _ = nearest_similarity(source.vertices, found, source.mass)
    np.testing.assert_allclose(linear @ linear.T, np.eye(3), atol=1e-6)
    assert np.trace(linear) == pytest.approx(-1, abs=1e-6)
    assert agreement_in_place(source.vertices, found, source.mass) == pytest.approx(-1 / 3, abs=1e-6)
    upward = turn[:, 2]
    assert upward @ linear @ upward == pytest.approx(1, abs=0.02)  # around any other axis its head would be below


def test_feet_that_were_bent_back_point_forward_after_a_half_turn():
    (source, functions), (target, _) = made(*pawn(1)), made(*pawn(-1))
    lying = target.vertices  # the source was laid onto that vertex for vertex, and its foot made of nothing there
    tip = (source.vertices @ [1, 0, -0.2]).argmax()
    reached = (target.vertices @ [-1, 0, -0.2]).argmax()
    found = half_turned(source, target, lying, functions)
    beside, forward = -lying[tip, 0], target.vertices[reached, 0]  # where a turn alone would take it, and the foot
    assert abs(found[tip, 0] - forward) < 0.3 * abs(beside - forward)
    assert (found @ [1, 0, 0]).max() < 1.2 * (target.vertices @ [1, 0, 0]).max()  # no foot is left behind
