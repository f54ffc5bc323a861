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


def test_the_order_of_bones_does_not_matter(someone):
    tree = someone.rig.skeleton
    order = np.arange(len(tree))[::-1]
    parents = np.where(tree.parents < 0, -1, len(tree) - 1 - tree.parents)[order]
    found = humanoid_bones(Skeleton(parents, tree.heads[order], tree.tails[order]), np.ones(len(tree), bool), UP)
    expected = humanoid_bones(tree, np.ones(len(tree), bool), UP)
    assert {what: order[bone] for what, bone in found.items()} == expected


def test_bones_of_the_palm_are_no_fingers(someone):
    """Such as MakeHuman's: one for each finger but the thumb, from near the wrist; the fingers have three more."""
    tree, names = someone.rig.skeleton, list(someone.rig.names)
    parents, heads, tails = tree.parents.tolist(), tree.heads.tolist(), tree.tails.tolist()
    for side in "LR":
        wrist = tree.heads[names.index(f"hand.{side}")]
        for finger in ("index", "middle"):
            first, second = (names.index(f"{finger}{number}.{side}") for number in (1, 2))
            parents.append(parents[first])
            parents[first] = len(heads)
            heads.append(wrist + 0.3 * (tree.heads[first] - wrist))
            tails.append(tree.heads[first])
            parents.append(second)
            heads.append(tree.tails[second])
            tails.append(2 * tree.tails[second] - tree.heads[second])
    skeleton = Skeleton(np.array(parents), np.array(heads), np.array(tails))
    found = humanoid_bones(skeleton, np.ones(len(skeleton), bool), UP)
    for side, letter in (("left", "L"), ("right", "R")):
        for finger in ("index", "middle"):
            assert found[f"{side}_{finger}_1"] == names.index(f"{finger}1.{letter}")
        assert found[f"{side}_thumb_1"] == names.index(f"thumb1.{letter}")


def test_another_axis_may_be_up(someone):
    lying = rotation(np.array([1.0, 0, 0]), -np.pi / 2)
    tree = someone.rig.skeleton
    skeleton = Skeleton(tree.parents, tree.heads @ lying.T, tree.tails @ lying.T)
    moving = np.ones(len(tree), bool)
    assert humanoid_bones(skeleton, moving, lying @ UP) == humanoid_bones(tree, moving, UP)


def test_wide_shoulders_on_short_legs(someone):
    tree, names = someone.rig.skeleton, list(someone.rig.names)
    low = tree.heads[:, 2].min()
    middle = tree.heads[names.index("thigh.L"), 2]

    def toon(places):
        places = places * [1.0, 1.0, 1.0]
        arms = np.abs(places[:, 0]) > np.abs(tree.heads[names.index("upper_arm.L"), 0]) - 1e-9
        places[arms, 0] += np.sign(places[arms, 0]) * 0.2 * np.ptp(tree.heads[:, 2])
        below = places[:, 2] < middle
        places[below, 2] = middle - 0.45 * (middle - places[below, 2])
        return places

    skeleton = Skeleton(tree.parents, toon(tree.heads), toon(tree.tails))
    assert (middle - skeleton.heads[:, 2].min()) / np.ptp(skeleton.tails[:, 2]) < 0.4
    assert low < skeleton.heads[:, 2].min()
    found = humanoid_bones(skeleton, np.ones(len(tree), bool), UP)
    assert {"left_upper_arm", "right_lower_arm", "left_lower_leg"} <= wanted(found, someone.rig.origins)


def test_legs_may_hang_on_a_root_on_the_ground(someone):
    tree, names = someone.rig.skeleton, list(someone.rig.names)
    ground = np.array([[0.0, 0, tree.heads[:, 2].min()]])
    parents = np.where(tree.parents < 0, len(tree), tree.parents)
    for side in "LR":
        parents[names.index(f"thigh.{side}")] = len(tree)
    skeleton = Skeleton(
        np.append(parents, -1), np.concatenate([tree.heads, ground]), np.concatenate([tree.tails, ground + 0.01])
    )
    moving = np.append(np.ones(len(tree), bool), False)
    found = humanoid_bones(skeleton, moving, UP)
    assert {"hips", "left_upper_leg", "right_hand"} <= wanted(found, someone.rig.origins)


@pytest.mark.parametrize("lean", [30.0, 60.0])
def test_what_leans_far_forward_is_another_creature(someone, lean):
    tree, names = someone.rig.skeleton, list(someone.rig.names)
    legs = [
        bone
        for bone in range(len(tree))
        if any(names[above].startswith("thigh") for above in [bone, *ancestors(tree, bone)])
    ]
    turn, pivot = rotation(np.array([1.0, 0, 0]), np.radians(lean)), tree.heads[names.index("hips")]
    ends = []
    for places in (tree.heads, tree.tails):
        turned = (places - pivot) @ turn.T + pivot
        turned[legs] = places[legs]
        ends.append(turned)
    leaning = Skeleton(tree.parents, *ends)
    if lean > 45.0:
        with pytest.raises(RigError, match=r"leans by [56]\d degrees"):
            humanoid_bones(leaning, np.ones(len(tree), bool), UP)
    else:
        assert "left_hand" in wanted(humanoid_bones(leaning, np.ones(len(tree), bool), UP), someone.rig.origins)


def ancestors(tree, bone):
    """All bones that a bone hangs on."""
    found = []
    while tree.parents[bone] >= 0:
        bone = tree.parents[bone]
        found.append(bone)
    return found


def test_an_animal_is_no_person():
    names, parents, heads, tails = creature_bones()
    with pytest.raises(RigError, match="its bones cannot be identified"):
        humanoid_bones(Skeleton(parents[:5], heads[:5], tails[:5]), np.ones(5, bool), UP)
    assert names
