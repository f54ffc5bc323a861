# SPDX-License-Identifier: GPL-3.0-or-later
"""Legs and arms, found in two rigs."""

import numpy as np
import pytest

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
