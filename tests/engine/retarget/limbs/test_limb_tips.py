# SPDX-License-Identifier: GPL-3.0-or-later
"""Ends of limbs that two rigs have in the same places, whichever way the bodies look."""

import numpy as np
import pytest
from scipy.sparse import csr_array

from engine import RiggedBody, Skeleton, TriangleMesh, paired_limb_tips
from tests.people import person, renamed
from tests.shapes import rotation


def body_of(someone, rig=None, turn=None, scale=1.0, parents=None):
    """A person, with a rig, turned and scaled."""
    rig, turn = someone.rig if rig is None else rig, np.eye(3) if turn is None else turn
    mesh = TriangleMesh(scale * someone.mesh.vertices @ turn.T + 3, someone.mesh.triangles)
    heads, tails = (scale * ends @ turn.T + 3 for ends in (rig.skeleton.heads, rig.skeleton.tails))
    bones = Skeleton(rig.skeleton.parents if parents is None else parents, heads, tails)
    return RiggedBody(mesh, bones, rig.weights)


@pytest.mark.parametrize("degrees", [0, 90, 180, 270, 200])
def test_limbs_are_told_whichever_way_a_body_looks(someone, degrees):
    turned = body_of(someone, renamed(someone.rig), rotation([0, 0, 1], np.radians(degrees)), 100.0)
    pairs = paired_limb_tips(body_of(someone), turned)
    assert len(pairs) == 5
    np.testing.assert_array_equal(pairs[:, 0], pairs[:, 1])  # the vertices are numbered alike
    places = someone.mesh.vertices[pairs[:, 0]]
    assert sorted(np.round(places[:, 0], 1)) == pytest.approx([-0.8, -0.1, 0, 0.1, 0.8], abs=0.15)


def test_fingers_are_one_limb_and_feet_that_are_next_to_each_other_are_two():
    someone = person(resolution=16)
    assert len(paired_limb_tips(body_of(someone), body_of(someone))) == 5


def test_feet_may_hang_on_the_root_as_goals_of_a_solver_do(someone):
    parents = someone.rig.skeleton.parents.copy()
    parents[[someone.rig.names.index(f"foot.{side}") for side in "LR"]] = someone.rig.names.index("hips")
    pairs = paired_limb_tips(body_of(someone), body_of(someone, parents=parents))
    assert len(pairs) == 5
    np.testing.assert_array_equal(pairs[:, 0], pairs[:, 1])


def test_other_proportions_do_no_harm(someone):
    other = person(resolution=16, legs=0.5, arms=0.7, fingers=False)
    pairs = paired_limb_tips(body_of(someone), body_of(other, turn=rotation([0, 0, 1], np.pi)))
    assert len(pairs) == 5
    sides = [mesh.vertices[ends, 0] for mesh, ends in zip((someone.mesh, other.mesh), pairs.T, strict=True)]
    assert (sides[0] * sides[1] >= -1e-3).all()


def test_a_body_that_lies_does_not_stand_alike_and_one_bone_has_no_limbs(someone):
    assert not len(paired_limb_tips(body_of(someone), body_of(someone, turn=rotation([1, 0, 0], np.pi / 2))))
    one = Skeleton(np.array([-1]), np.zeros((1, 3)), np.ones((1, 3)))
    whole = RiggedBody(someone.mesh, one, someone.rig.weights[:, :1])
    assert not len(paired_limb_tips(body_of(someone), whole))
    unbound = body_of(someone)._replace(weights=csr_array(someone.rig.weights.shape))
    assert not len(paired_limb_tips(body_of(someone), unbound))
