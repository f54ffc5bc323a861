# SPDX-License-Identifier: GPL-3.0-or-later
import numpy as np

from engine import Skeleton
from engine.retarget.rig.digit_groups import digit_groups
from tests.hands import ARM, PALM, hand_body, hand_bones


def test_a_hand_is_found_and_a_trunk_with_limbs_is_none():
    skeleton = hand_bones()
    mesh, weights = hand_body(skeleton)
    mass = mesh.vertex_areas / mesh.area @ weights
    (group,) = digit_groups(skeleton, mass)
    assert (group.above, group.hub) == (ARM, PALM)
    assert group.chains == ((3, 4), (5, 6), (7, 8), (9, 10), (11, 12))
    assert digit_groups(skeleton, np.where(np.arange(len(mass)) < 3, 0.0, 0.1)) == []
    few = Skeleton(skeleton.parents[:7], skeleton.heads[:7], skeleton.tails[:7])
    assert digit_groups(few, mass[:7]) == []
