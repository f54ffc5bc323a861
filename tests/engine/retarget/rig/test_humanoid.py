# SPDX-License-Identifier: GPL-3.0-or-later
from __future__ import annotations

import numpy as np
import pytest

from engine import RigError, Skeleton, humanoid_bones
from tests.people import HANGING, at_rest_in, fine_rig, person
from tests.shapes import rotation
from tests.skeletons import creature_bones

UP = np.array([0.0, 0, 1])
WHAT = {
    "hips": "hips",
    "neck": "neck",
    "head": "head",
    "upper_arm": "upper_arm",
    "lower_arm": "forearm",
    "hand": "hand",
    "upper_leg": "thigh",
    "lower_leg": "shin",
    "foot": "foot",
}
"""What bones are, and what our person's are called."""


@pytest.fixture(scope="module")
def someone():
    return person(resolution=12)


def wanted(found, origins):
    """Whether what was found are the true bones, of those that have a name in `WHAT`."""
    for what, bone in found.items():
        side = {"left_": ".L", "right": ".R"}.get(what[:5], "")
        name = WHAT.get(what.split("_", 1)[1] if side else what)
        if name is not None:
            assert name + side in origins[bone], what
    return set(found)


@pytest.mark.parametrize("pose", [{}, HANGING])
@pytest.mark.parametrize("turn", [0.0, 2.0])
def test_bones_of_a_person_however_it_stands(someone, pose, turn):
    body = at_rest_in(someone, pose)
    spin = rotation(UP, turn)
    skeleton = Skeleton(
        body.rig.skeleton.parents,
        *(90 * ends @ spin.T + 7 for ends in (body.rig.skeleton.heads, body.rig.skeleton.tails)),
    )
    moving = np.asarray(body.rig.weights.sum(axis=0)).ravel() > 0
    found = wanted(humanoid_bones(skeleton, moving, UP), body.rig.origins)
    assert {f"{side}_{what}" for side in ("left", "right") for what in ("hand", "foot", "upper_arm")} <= found
    assert {"left_thumb_1", "right_index_2"} <= found


def test_bones_in_several_pieces(someone):
    rig = fine_rig(someone)
    moving = np.asarray(rig.weights.sum(axis=0)).ravel() > 0
    found = humanoid_bones(rig.skeleton, moving, UP)
    wanted(found, rig.origins)
    assert {"chest", "left_lower_leg", "right_hand"} <= set(found)


def test_another_axis_may_be_up(someone):
    lying = rotation(np.array([1.0, 0, 0]), -np.pi / 2)
    tree = someone.rig.skeleton
    skeleton = Skeleton(tree.parents, tree.heads @ lying.T, tree.tails @ lying.T)
    moving = np.ones(len(tree), bool)
    assert humanoid_bones(skeleton, moving, lying @ UP) == humanoid_bones(tree, moving, UP)


def test_an_animal_is_no_person():
    names, parents, heads, tails = creature_bones()
    with pytest.raises(RigError, match="open what its bones are"):
        humanoid_bones(Skeleton(parents[:5], heads[:5], tails[:5]), np.ones(5, bool), UP)
    assert names
