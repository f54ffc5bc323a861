# SPDX-License-Identifier: GPL-3.0-or-later
"""Left and right of a rig, told by its joints."""

import re

import numpy as np

from engine import Skeleton
from engine.retarget.motion.mirrored_bones import mirrored_bones
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
