# SPDX-License-Identifier: GPL-3.0-or-later
"""Bodies that end where clothes begin."""

import numpy as np
import pytest
from scipy.sparse import csr_array

from engine import Skeleton, TriangleMesh, continues_body, ends_at_joint
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


def moved_by(bone, mesh, count=3):
    return csr_array(
        (np.ones(mesh.vertex_count), (np.arange(mesh.vertex_count), np.full(mesh.vertex_count, bone))),
        shape=(mesh.vertex_count, count),
    )


def ball(centre, size):
    vertices, triangles = icosphere(6)
    return TriangleMesh(vertices * size + np.array(centre), triangles)


HEADS = np.array([[0, 0, 4.0], [0, 0, 2.0], [0, 0, 0.0]])
BONES = Skeleton(np.array([-1, 0, 1]), HEADS, np.array([[0, 0, 2.0], [0, 0, 0], [0, -1.0, 0]]))
"""A limb of two bones, and one at its lower end."""

SHIN = ball((0.0, 0.0, 2.0), (0.4, 0.4, 2.0))
SHOE = ball((0.0, -0.4, -0.3), (0.4, 0.9, 0.3))


def ends(body, item, bone, of_body=1, skeleton=BONES):
    return ends_at_joint(body, item, (moved_by(of_body, body), moved_by(bone, item)), skeleton)


def test_a_shoe_below_a_closed_leg_is_its_foot():
    assert not continues_body(SHIN, SHOE)  # by its shape alone it might hang there
    assert ends(SHIN, SHOE, 2)
    turn = rotation([1.0, -2.0, 0.5], 0.8)
    bones = Skeleton(BONES.parents, *(37.0 * each @ turn.T + [5.0, 0.0, -90.0] for each in (BONES.heads, BONES.tails)))
    body, item = turned(SHIN), turned(SHOE)
    assert ends(body, item, 2, skeleton=bones)


def test_what_moves_with_the_skin_is_worn():
    assert not ends(SHIN, SHOE, 1)
    foot = ball((0.0, -0.4, -0.3), (0.35, 0.8, 0.25))
    triangles = np.concatenate([SHIN.triangles, foot.triangles + SHIN.vertex_count])
    body = TriangleMesh(np.concatenate([SHIN.vertices, foot.vertices]), triangles)
    bones = csr_array(np.concatenate([moved_by(1, SHIN).toarray(), moved_by(2, foot).toarray()]))
    assert not ends_at_joint(body, SHOE, (bones, moved_by(2, SHOE)), BONES)


def test_a_plait_with_a_bone_of_its_own_is_no_part_of_the_head():
    head = ball((0.0, 0.0, 1.0), 1.0)
    plait = ball((0.0, 1.2, 0.6), (0.15, 0.3, 1.0))
    heads = np.array([[0, 0, -1.0], [0, 0, 0.2], [0, 1.0, 1.2]])
    bones = Skeleton(np.array([-1, 0, 1]), heads, heads + np.array([0, 0, 0.5]))
    assert not ends(head, plait, 2, skeleton=bones)


def test_an_item_without_weights_is_worn():
    nothing = csr_array((SHOE.vertex_count, 3))
    assert not ends_at_joint(SHIN, SHOE, (moved_by(1, SHIN), nothing), BONES)
