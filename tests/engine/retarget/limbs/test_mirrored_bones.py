# SPDX-License-Identifier: GPL-3.0-or-later
"""Left and right of a rig, told by its joints."""

import re

import numpy as np
from scipy.spatial.transform import Rotation

from engine import Skeleton
from engine.retarget.limbs.mirrored_bones import evened_rotations, mirrored_bones
from tests.people import fine_rig, person, renamed
from tests.shapes import rotation


def others(names):
    """Names of the bones on the other side."""
    return [re.sub(r"[.][LR]", lambda side: ".R" if side[0] == ".L" else ".L", name) for name in names]


def test_left_and_right_are_told_however_the_rig_stands(someone):
    for rig in (person(resolution=12).rig, fine_rig(someone)):
        turn = rotation([1, 2, 3], 1.0)
        tree = Skeleton(rig.skeleton.parents, rig.skeleton.heads @ turn.T + 5, rig.skeleton.tails @ turn.T + 5)
        found = mirrored_bones(tree)
        assert [rig.names[bone] for bone in found] == others(rig.names)


def test_the_order_does_not_matter_and_a_little_difference_neither(someone):
    rig = renamed(someone.rig)
    noise = 0.005 * np.random.default_rng(0).normal(size=rig.skeleton.heads.shape)
    found = mirrored_bones(Skeleton(rig.skeleton.parents, rig.skeleton.heads + noise, rig.skeleton.tails))
    names = [next(iter(origin)) for origin in rig.origins]
    assert [names[bone] for bone in found] == others(names)


def test_what_has_no_other_side_has_no_partner(someone):
    tree = someone.rig.skeleton
    tail = [[0.0, 0.2, 0.9], [0.3, 0.3, 0.8]]
    more = Skeleton(np.append(tree.parents, [0, len(tree)]), np.r_[tree.heads, tail], np.r_[tree.tails, tail] + 0.01)
    assert mirrored_bones(more)[-1] == -1
    steps = np.arange(6.0)
    chain = Skeleton(np.arange(6) - 1, np.c_[steps, steps**2, steps**3], np.c_[steps, steps**2, steps**3 + 1])
    assert (mirrored_bones(chain) == -1).all()
    assert (mirrored_bones(Skeleton(np.array([-1]), np.zeros((1, 3)), np.ones((1, 3)))) == -1).all()


def seen(rig, vectors, whole):
    """Turn the bones of a rig, in another that stands turned by `whole`: what is so of both sides after that."""
    numbers, tree = np.arange(len(rig.names)), rig.skeleton
    other = Skeleton(tree.parents, tree.heads @ whole.T, tree.tails @ whole.T)
    turns = np.tile(whole, (len(numbers), 1, 1))
    for name, vector in vectors.items():
        turns[rig.names.index(name)] = whole @ Rotation.from_rotvec(vector).as_matrix()
    mirrors = mirrored_bones(tree), mirrored_bones(other)
    found = evened_rotations(turns, (numbers, numbers), (tree, other), mirrors, whole)
    return {name: whole.T @ turn for name, turn in zip(rig.names, found, strict=True)}


def test_rotations_of_both_sides_are_mirror_images(someone):
    whole = rotation([1, 2, 3], 1.0)
    hanging = {"upper_arm.L": (0, 0.9, 0.1), "upper_arm.R": (0, -0.9, -0.1)}
    exact = seen(someone.rig, hanging, whole)
    for name, vector in hanging.items():
        assert np.allclose(Rotation.from_matrix(exact[name]).as_rotvec(), vector)
    found = seen(someone.rig, {"upper_arm.L": (0, 0.9, 0.1), "upper_arm.R": (0.1, -0.8, 0)}, whole)
    flip = np.diag([-1.0, 1, 1])
    assert np.allclose(found["upper_arm.L"], flip @ found["upper_arm.R"] @ flip)
    assert 0.8 < Rotation.from_matrix(found["upper_arm.L"]).magnitude() < 0.9


def test_a_foot_that_is_turned_over_is_as_the_other_one(someone):
    found = seen(someone.rig, {"foot.L": (2.0, 1.0, 0.5), "foot.R": (0.1, 0, 0)}, rotation([0, 0, 1], 2.0))
    assert np.allclose(Rotation.from_matrix(found["foot.L"]).as_rotvec(), [0.1, 0, 0], atol=0.02)
    assert np.allclose(found["shin.L"], np.eye(3))


def test_rigs_without_two_sides_keep_their_rotations():
    tree = Skeleton(np.array([-1, 0, 0]), np.eye(3), 2 * np.eye(3) + 0.1)
    none = np.full(3, -1)
    turns, numbers = Rotation.random(3, random_state=0).as_matrix(), np.arange(3)
    assert np.array_equal(evened_rotations(turns, (numbers, numbers), (tree, tree), (none, none), np.eye(3)), turns)
