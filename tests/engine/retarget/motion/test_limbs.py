# SPDX-License-Identifier: GPL-3.0-or-later
"""Legs and arms, found in two rigs."""

import numpy as np
import pytest

from engine import Skeleton
from engine.retarget.motion.limbs import limbs_of
from engine.retarget.motion.segments import Segments
from tests.people import coarse_rig, fine_rig, renamed

UPS = np.array([[0.0, 0, 1]] * 2)


@pytest.mark.parametrize("make", [lambda body: renamed(body.rig), fine_rig, coarse_rig])
def test_two_legs_stand_on_the_ground_and_two_arms_do_not(someone, paired, make):
    rig = make(someone)
    pairing = paired(someone, rig)
    trees = someone.rig.skeleton, rig.skeleton
    limbs = limbs_of(Segments.of(pairing.sources, pairing.targets, *trees), *trees, UPS)
    works = {
        (limb.foot, *[frozenset().union(*(rig.origins[bone] for bone in bones)) for bones in (limb.upper, limb.lower)])
        for limb in limbs
    }
    for side in "LR":
        assert (True, frozenset([f"thigh.{side}"]), frozenset([f"shin.{side}"])) in works
        assert (False, frozenset([f"upper_arm.{side}"]), frozenset([f"forearm.{side}"])) in works
    for limb in limbs:
        if limb.foot:
            assert np.isclose(limb.source_length, limb.target_length, rtol=0.02)


def test_a_back_that_bears_legs_is_no_limb_and_a_leg_of_four_reaches_the_ground():
    # A back of three bones along x; at its ends two legs of four bones and a stub of a belly; a neck and a head.
    parents, heads = [-1, 0, 1], [[0.0, 0, 1], [0.6, 0, 1], [1.2, 0, 1]]
    for bone, x in ((0, 0.0), (2, 1.2)):
        for side in (-0.2, 0.2):
            parents += [bone, *range(len(parents), len(parents) + 3)]
            heads += [[x, side, 0.9], [x + 0.1, side, 0.6], [x - 0.05, side, 0.25], [x, side, 0.05]]
    parents += [1, 2, len(parents) + 1]
    heads += [[0.6, 0, 0.95], [1.4, 0, 1.2], [1.6, 0, 1.4]]
    points = np.array(heads)
    bones = Skeleton(np.array(parents), points, points + np.array([0.05, 0, 0]))
    numbers = np.arange(len(parents))
    limbs = limbs_of(Segments.of(numbers, numbers, bones, bones), bones, bones, UPS)
    legs = [limb for limb in limbs if limb.foot]
    assert sorted(limb.parts for limb in legs) == [(3, 4), (7, 8), (11, 12), (15, 16)]
    assert all((0, False) not in limb.source_joints and not {0, 1, 2} & set(limb.parts) for limb in limbs)
    assert np.allclose(legs[0].source_points(bones), points[[5, 6]])


@pytest.mark.parametrize("unit", [0.001, 1.0, 1000.0])
def test_the_two_parts_of_a_limb_do_not_depend_on_units(unit):
    # Two legs of three parts, of which one rig has the upper two longest, and the other the lower two.
    def rig(knee, ankle):
        joints = [(0.0, 0, 1.0)]
        for side in (-0.2, 0.2):
            joints += [(0, side, 0.9), (0.05, side, knee), (-0.05, side, ankle), (0, side, 0.05)]
        return np.array(joints)

    parents = np.array([-1, 0, 1, 2, 3, 0, 5, 6, 7])
    high, low = rig(0.6, 0.25), rig(0.75, 0.5)
    source = Skeleton(parents, unit * high, unit * (high + np.array([0.05, 0, 0])))
    target = Skeleton(parents, low, low + np.array([0.05, 0, 0]))
    numbers = np.arange(len(parents))
    limbs = limbs_of(Segments.of(numbers, numbers, source, target), source, target, UPS)
    assert sorted(limb.parts for limb in limbs) == [(2, 3), (6, 7)]


def test_a_foot_that_an_importer_made_as_long_as_the_shin_is_no_part_of_the_leg():
    joints = [(0.0, 0, 1.0)]
    for side in (-0.1, 0.1):
        joints += [(side, 0, 0.95), (side, -0.05, 0.5), (side, 0, 0.02)]
    heads, parents = np.array(joints), np.array([-1, 0, 1, 2, 0, 4, 5])
    tails = heads + np.array([0, 0, 0.1])
    tails[[1, 2, 4, 5]], tails[[3, 6]] = heads[[2, 3, 5, 6]], heads[[3, 6]] + np.array([0, -0.48, 0])
    bones, numbers = Skeleton(parents, heads, tails), np.arange(7)
    limbs = limbs_of(Segments.of(numbers, numbers, bones, bones), bones, bones, UPS)
    assert sorted((limb.parts, limb.foot) for limb in limbs) == [((1, 2), True), ((4, 5), True)]
