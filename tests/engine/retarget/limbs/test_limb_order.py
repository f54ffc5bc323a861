# SPDX-License-Identifier: GPL-3.0-or-later
"""Bones of limbs paired by their order and lengths, whatever the surface says of their places."""

from __future__ import annotations

import numpy as np
import pytest

from engine import Skeleton
from engine.retarget.limbs.limb_order import in_order

LEG = {"thigh": (0, 0, -0.4), "calf": (0, 0.07, -0.43), "foot": (0, -0.16, -0.08), "ball": (0, -0.1, 0.0)}
SHORT_LEG = {"upper": (0, 0, -0.23), "lower": (0, 0.03, -0.14), "foot": (0, -0.12, -0.12), "toes": (0, -0.2, 0.0)}
ARM = {"clavicle": (0.15, 0.13, 0.02), "upper": (0.3, 0, 0), "lower": (0.28, 0, 0), "hand": (0.2, 0, 0)}
SHORT_ARM = {"upper": (0.24, 0, 0), "lower": (0.26, 0, 0), "wrist": (0.08, 0, 0), "hand": (0.17, 0, 0)}


def hung(steps, start):
    """A skeleton of a trunk and a limb on either side of it, and the bone on the other side of each."""
    count = len(steps)
    parents, heads, tails = [-1], [(0, 0, 0)], [(0, 0, 0.5)]
    for side in (1, -1):
        above, place = 0, np.array([side * start, 0, 0])
        for step in steps:
            parents.append(above)
            heads.append(place)
            tails.append(place + np.array(step) * (side, 1, 1))
            above, place = len(parents) - 1, tails[-1]
    numbers = np.arange(1, count + 1)
    mirrors = np.concatenate([[0], numbers + count, numbers])
    return Skeleton(np.array(parents), np.array(heads, float), np.array(tails, float)), mirrors


def partners(one, other, pairs=((1, 1),), *, starts=(0.1, 0.1), size=1.0, turn=None, given=frozenset()):
    """Names of the bones of two limbs of the same side that are paired, if the surface says only so much."""
    turn = np.eye(3) if turn is None else turn
    steps = [size * turn @ np.array(step) for step in other.values()]
    trees, mirrors = zip(hung(one.values(), starts[0]), hung(steps, size * starts[1]), strict=True)
    counts = [len(tree) for tree in trees]
    scores = np.full(counts[::-1], -np.inf)
    for source, target in pairs:
        scores[target, source] = 0.5
    moving = tuple(np.ones(count, bool) for count in counts)
    found = in_order(np.array(pairs), scores, trees, moving, mirrors, given=given)
    names = [["trunk", *each] for each in (one, other)]
    return {(names[0][a], names[1][b]) for a, b in found.tolist()}


STRAIGHT = {("upper", "thigh"), ("lower", "calf"), ("foot", "foot"), ("toes", "ball")}


@pytest.mark.parametrize("pairs", [((1, 1),), ((1, 1), (4, 3)), ((3, 2), (2, 1))])
def test_a_short_leg_with_a_large_foot_is_paired_joint_by_joint(pairs):
    assert partners(SHORT_LEG, LEG, pairs) == STRAIGHT


def test_a_thigh_is_not_left_at_the_trunk_though_what_is_left_would_be_as_far_apart():
    long_leg = {"thigh": (0, -0.04, -0.48), "calf": (0, 0.03, -0.54), "foot": (0, 0.01, -0.18)}
    found = partners(SHORT_LEG, long_leg, ((1, 2), (2, 2), (4, 3)), starts=(0.17, 0.08))
    assert found == {("upper", "thigh"), ("lower", "calf"), ("foot", "foot"), ("toes", "foot")}


@pytest.mark.parametrize("size", [0.01, 7.0])
def test_sizes_do_not_matter(size):
    assert partners(SHORT_LEG, LEG, size=size) == STRAIGHT


def test_nor_does_the_pose_of_the_limb_as_a_whole():
    bent = np.array([[0.8, 0, 0.6], [0, 1, 0], [-0.6, 0, 0.8]])
    assert partners(SHORT_LEG, LEG, turn=bent) == STRAIGHT


STRAIGHT_ARM = {"collar": (0.12, 0, 0)} | {name: step for name, step in ARM.items() if name != "clavicle"}


@pytest.mark.parametrize(("arm", "first"), [(ARM, 0.02), (STRAIGHT_ARM, 0.04)])
def test_a_collar_bone_stays_alone_and_a_wrist_shares_a_partner(arm, first):
    known, starts = ((1, 2), (2, 3)), (0.21, first)
    found = partners(SHORT_ARM, arm, known, starts=starts)
    assert found - {("wrist", "lower"), ("wrist", "hand")} == {(name, name) for name in ("upper", "lower", "hand")}
    assert "wrist" in {source for source, _ in found}
    swapped = tuple((target, source) for source, target in known)
    assert partners(arm, SHORT_ARM, swapped, starts=starts[::-1]) == {(other, one) for one, other in found}


def test_limbs_without_a_pair_and_those_with_given_ones_stay_as_they_are():
    assert partners(SHORT_LEG, LEG, ((0, 0),)) == {("trunk", "trunk")}
    assert partners(SHORT_LEG, LEG, ((1, 1), (4, 3)), given={(4, 3)}) == {("upper", "thigh"), ("toes", "foot")}
