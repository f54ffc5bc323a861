# SPDX-License-Identifier: GPL-3.0-or-later
"""What differs at rest by the build of two bodies, and what by their poses."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from engine import BonePairing
from engine.retarget.motion.limbs import limbs_of
from engine.retarget.motion.rest_rotations import posed_rotations
from engine.retarget.motion.segments import Segments
from tests.people import person
from tests.shapes import rotation

UPS = np.array([[0.0, 0, 1]] * 2)


@pytest.fixture(scope="module")
def rig():
    """The bones of somebody with fingers."""
    return person(resolution=12).rig


def posed(rig, seen, upright=None):
    """Rotations of the rig's bones in another of the same joints, whose surface is turned so (name -> vector)."""
    upright = np.eye(3) if upright is None else upright
    numbers, turns = np.arange(len(rig.names)), np.tile(upright, (len(rig.names), 1, 1))
    for name, vector in seen.items():
        turns[rig.names.index(name)] = rotation(vector, np.linalg.norm(vector)) @ upright
    tree = type(rig.skeleton)(rig.skeleton.parents, rig.skeleton.heads @ upright.T, rig.skeleton.tails @ upright.T)
    pairing = BonePairing(numbers, numbers, np.ones(len(numbers)), turns, tree.heads, upright)
    segments = Segments.of(numbers, numbers, rig.skeleton, tree)
    limbs = limbs_of(segments, rig.skeleton, tree, UPS)
    found = posed_rotations(pairing, segments, limbs, (rig.skeleton, tree), UPS[1])
    return turns, dict(zip(rig.names, found, strict=True))


def test_a_trunk_and_feet_that_are_a_little_tilted_rest_as_they_are_built(rig):
    turn = rotation([0, 0, 1], 0.7)
    tilted = {"spine2": (0.3, 0, 0), "hips": (0.2, 0.2, 0), "foot.L": (0.8, 0, 0), "toe.L": (1.5, 0, 0)}
    _, found = posed(rig, tilted, turn)
    for name in tilted:
        assert np.allclose(found[name], turn)


def test_no_foot_stands_backwards_but_it_may_hang(rig):
    # The map of a thin leg may be turned around it; a foot that hangs is tilted.
    turns, found = posed(rig, {"foot.L": (0, 0, 3.0), "foot.R": (1.5, 0, 0)})
    assert np.allclose(found["foot.L"], np.eye(3))
    assert np.allclose(found["foot.R"], turns[rig.names.index("foot.R")])


def test_a_leg_that_stands_is_bent_but_not_twisted(rig):
    tree, shin = rig.skeleton, rig.names.index("shin.L")
    axis = tree.heads[rig.names.index("foot.L")] - tree.heads[shin]
    bend, twist = rotation([1, 0, 0], 0.4), rotation(axis, 0.9)
    turns, found = posed(rig, {"shin.L": Rotation.from_matrix(bend @ twist).as_rotvec(), "forearm.L": (0.9, 0, 0)})
    assert np.allclose(found["shin.L"] @ axis, bend @ axis)
    assert Rotation.from_matrix(found["shin.L"]).magnitude() < 0.41
    assert np.allclose(found["forearm.L"], turns[rig.names.index("forearm.L")])  # palms may look elsewhere


def test_limbs_that_rest_in_another_pose_and_a_body_that_lies_are_seen(rig):
    bent = {"upper_arm.L": (0, 0.9, 0), "thigh.R": (0.4, 0, 0), "neck": (0.4, 0, 0), "hips": (1.5, 0, 0)}
    turns, found = posed(rig, bent)
    for name in bent:
        assert np.allclose(found[name], turns[rig.names.index(name)])


def test_fingers_are_turned_as_their_hand_is_and_bent_as_their_joints_lie(rig):
    hand = rotation([1, 0, 0], 0.6)
    _, found = posed(rig, {"hand.L": (0.6, 0, 0), "index1.L": (1.2, 0, 0), "middle2.L": (0, 0, 1.0)})
    assert np.allclose(found["hand.L"], hand)
    for name in ("index1.L", "thumb1.L"):
        bone = rig.names.index(name)
        along = rig.skeleton.heads[rig.skeleton.children(bone)[0]] - rig.skeleton.heads[bone]
        assert np.allclose(found[name] @ along, along)  # the joints of both rigs are the same
        assert np.isclose(np.linalg.det(found[name]), 1)
    assert np.allclose(found["middle2.L"], found["middle1.L"])
